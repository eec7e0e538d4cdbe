//! Several records and the parameters they share, as one problem.

use gyrocal::estimation::batch::{Columns, Linearisation, Manifold, Series};
use gyrocal::trajectory::Orientation;
use gyrocal::{Chart, Integration};

use crate::further::Further;
use crate::run::{Conditions, Rows};

/// One parameter of the joint problem.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Unknown {
    /// Mean of its prior.
    pub(crate) prior: f64,
    /// Standard deviation of its prior.
    pub(crate) sigma: f64,
    /// Whether it keeps its prior mean and only widens the covariance of the others.
    pub(crate) considered: bool,
}

impl Unknown {
    /// Estimated from zero.
    pub(crate) fn estimated(sigma: f64) -> Self {
        Self {
            prior: 0.0,
            sigma,
            considered: false,
        }
    }

    /// Held at zero; 0 is the sigma of what counts as known.
    pub(crate) fn considered(sigma: Option<f64>) -> Self {
        Self {
            prior: 0.0,
            sigma: sigma.unwrap_or(0.0),
            considered: true,
        }
    }
}

/// One record within the joint problem.
#[derive(Clone)]
pub(crate) struct Leg<'a, I> {
    pub(crate) rows: Rows<'a>,
    pub(crate) chart: Chart<f64, I>,
    pub(crate) noise_density: [f64; 3],
    /// Attitude that the bench declares for the first row.
    pub(crate) prior: Orientation,
    pub(crate) prior_covariance: [[f64; 3]; 3],
    /// Attitude at each row.
    pub(crate) points: Vec<Orientation>,
    /// For each parameter of the model the unknowns whose sum it is; none if it is zero for
    /// good.
    pub(crate) sums: Vec<Vec<usize>>,
    /// Columns beside the model's parameters, and the unknown that is the amplitude of each.
    pub(crate) further: Further,
    pub(crate) amplitudes: Vec<usize>,
}

impl<I> Leg<'_, I> {
    /// For each column the unknowns whose sum it is.
    pub(crate) fn columns(&self) -> Vec<&[usize]> {
        let parameters = self.sums.iter().filter(|unknowns| !unknowns.is_empty());
        parameters
            .map(Vec::as_slice)
            .chain(self.amplitudes.iter().map(core::slice::from_ref))
            .collect()
    }
}

/// All records, and what they have in common.
#[derive(Clone)]
pub(crate) struct Problem<'a, D, I> {
    pub(crate) model: &'a D,
    pub(crate) integration: Integration,
    pub(crate) longest_step_s: f64,
    pub(crate) unknowns: Vec<Unknown>,
    pub(crate) legs: Vec<Leg<'a, I>>,
    /// Every unknown's present value.
    pub(crate) values: Vec<f64>,
}

impl<D, I> Problem<'_, D, I>
where
    D: Manifold<3, 3, Inputs = Chart<f64, I>, Point = Orientation>,
    I: Conditions,
{
    /// The parameters of the model in one record.
    pub(crate) fn parameters(&self, leg: usize) -> Vec<f64> {
        self.legs[leg]
            .sums
            .iter()
            .map(|unknowns| unknowns.iter().map(|index| self.values[*index]).sum())
            .collect()
    }

    /// Outputs that the model gives at each row of a record for these attitudes.
    pub(crate) fn outputs(&self, leg: usize, points: &[Orientation]) -> Vec<[f64; 3]> {
        let parameters = self.parameters(leg);
        let leg = &self.legs[leg];
        let (mut chart, mut moving) = (leg.chart, [0.0; 3]);
        points
            .iter()
            .enumerate()
            .map(|(row, point)| {
                self.model.place(point, &mut moving, &mut chart);
                Series::<Chart<f64, I>, 3>::at(&leg.rows, row, &mut chart);
                let mut outputs_g = self.model.output(&moving, &parameters, &chart);
                for (output, reading_g) in outputs_g.iter_mut().enumerate() {
                    *reading_g += leg.further.reading_g(row, output);
                }
                outputs_g
            })
            .collect()
    }

    pub(crate) fn with_leg<R>(
        &self,
        index: usize,
        parameters: &[f64],
        pass: impl FnOnce(&Linearisation<'_, D, Rows<'_>, Further, 3, 3>) -> R,
    ) -> R {
        self.with_columns(index, parameters, &self.legs[index].further, pass)
    }

    /// A pass over a record with these columns beside those of its parameters.
    pub(crate) fn with_columns<R, C: Columns<3, 3>>(
        &self,
        index: usize,
        parameters: &[f64],
        further: &C,
        pass: impl FnOnce(&Linearisation<'_, D, Rows<'_>, C, 3, 3>) -> R,
    ) -> R {
        let active: Vec<usize> = (0..parameters.len())
            .filter(|parameter| !self.legs[index].sums[*parameter].is_empty())
            .collect();
        self.with_active(index, parameters, &active, further, pass)
    }

    /// A pass over a record as if some of its rows had no value.
    pub(crate) fn without_rows<R>(
        &self,
        index: usize,
        parameters: &[f64],
        left_out: core::ops::Range<usize>,
        pass: impl FnOnce(&Linearisation<'_, D, Rows<'_>, Further, 3, 3>) -> R,
    ) -> R {
        let mut rows = self.legs[index].rows.again();
        rows.leave_out(left_out);
        let active: Vec<usize> = (0..parameters.len())
            .filter(|parameter| !self.legs[index].sums[*parameter].is_empty())
            .collect();
        let further = &self.legs[index].further;
        self.with_active(index, parameters, &active, further, |all| {
            pass(&Linearisation {
                series: &rows,
                ..*all
            })
        })
    }

    /// A pass over a record with any parameters as columns.
    pub(crate) fn with_active<R, C: Columns<3, 3>>(
        &self,
        index: usize,
        parameters: &[f64],
        active: &[usize],
        further: &C,
        pass: impl FnOnce(&Linearisation<'_, D, Rows<'_>, C, 3, 3>) -> R,
    ) -> R {
        let leg = &self.legs[index];
        pass(&Linearisation {
            model: self.model,
            inputs: leg.chart,
            series: &leg.rows,
            integration: self.integration,
            longest_step_s: self.longest_step_s,
            noise_density: leg.noise_density,
            prior: leg.prior,
            prior_covariance: leg.prior_covariance,
            points: &leg.points,
            parameters,
            active,
            further,
            tape: None,
        })
    }

    /// Indices of the unknowns that are estimated.
    pub(crate) fn estimated(&self) -> Vec<usize> {
        (0..self.unknowns.len())
            .filter(|index| !self.unknowns[*index].considered)
            .collect()
    }

    /// Twice the cost of the unknowns' distance from their priors.
    pub(crate) fn prior_cost(&self) -> f64 {
        self.unknowns
            .iter()
            .zip(&self.values)
            .filter(|(unknown, _)| !unknown.considered)
            .map(|(unknown, value)| ((value - unknown.prior) / unknown.sigma).powi(2))
            .sum()
    }
}
