//! One step of the trajectory: from a point to the next row, with all derivatives.

use gyrocal_estimation::{
    Corrected, Derivatives, EstimationError, Integration, Integrator, Manifold,
};

use crate::series::Series;

/// Most parts of one interval; more are a mistake in the times or in the longest step.
const MAX_PARTS: f64 = 1e6;

/// Derivatives of a step by the moving states, and the covariance of its noise.
#[derive(Clone, Copy)]
pub(crate) struct Step<const M: usize> {
    /// Moving columns of the transition.
    pub(crate) moving: [[f64; M]; M],
    /// Covariance that each noise input adds over the step.
    pub(crate) shares: [[[f64; M]; M]; M],
}

impl<const M: usize> Step<M> {
    /// A step of no time.
    pub(crate) fn still() -> Self {
        Self {
            moving: identity(),
            shares: [[[0.0; M]; M]; M],
        }
    }

    /// Transforms the derivatives to corrections of the point that a correction of the prediction
    /// leads to.
    pub(crate) fn correct(&mut self, corrected: &Corrected<M>) {
        self.moving = product(&corrected.point, &self.moving);
        for share in &mut self.shares {
            *share = sandwich(&corrected.correction, share);
        }
    }
}

/// Integrates points over steps; owns the workspace of a step.
pub(crate) struct Stepper<'a, D, I, const M: usize, const Y: usize> {
    pub(crate) model: &'a D,
    pub(crate) inputs: I,
    pub(crate) integration: Integration,
    pub(crate) longest_step_s: f64,
    pub(crate) noise_density: [f64; M],
    /// Parameter columns of the last step, one row for each moving state.
    pub(crate) columns: Vec<f64>,
    part: Vec<f64>,
    stages: Vec<f64>,
}

impl<'a, D, const M: usize, const Y: usize> Stepper<'a, D, D::Inputs, M, Y>
where
    D: Manifold<M, Y>,
{
    pub(crate) fn new(
        model: &'a D,
        inputs: D::Inputs,
        integration: Integration,
        longest_step_s: f64,
        noise_density: [f64; M],
    ) -> Self {
        let p = model.parameters();
        Self {
            model,
            inputs,
            integration,
            longest_step_s,
            noise_density,
            columns: vec![0.0; M * p],
            part: vec![0.0; M * p],
            stages: vec![0.0; 4 * M * p],
        }
    }

    /// Integrates from `point` at `row` to the next row. Returns the derivatives of the step and the
    /// point that the model predicts; leaves the parameter columns in [`Self::columns`].
    pub(crate) fn advance(
        &mut self,
        series: &impl Series<D::Inputs, Y>,
        row: usize,
        point: &D::Point,
        parameters: &[f64],
    ) -> Result<(Step<M>, D::Point), EstimationError> {
        let (start_s, end_s) = (series.time_s(row), series.time_s(row + 1));
        let interval_s = end_s - start_s;
        let count = parts(interval_s, self.longest_step_s)?;
        let part_s = interval_s / count as f64;
        let mut moving = [0.0; M];
        self.model.place(point, &mut moving, &mut self.inputs);
        let mut step = Step::still();
        for index in 0..count {
            let from_s = start_s + part_s * index as f64;
            series.over(row, from_s, from_s + part_s, &mut self.inputs);
            let first = index == 0;
            let derivatives = self.integrate_part(first, part_s, &mut moving, parameters)?;
            self.add_part(first, part_s, &derivatives, &mut step);
        }
        Ok((step, self.model.point(&moving, &self.inputs)))
    }

    /// Integrates the moving states over a part of an interval and moves the chart; leaves the
    /// parameter columns of the first part in [`Self::columns`], those of others in `part`.
    fn integrate_part(
        &mut self,
        first: bool,
        part_s: f64,
        moving: &mut [f64; M],
        parameters: &[f64],
    ) -> Result<Derivatives<f64, M>, EstimationError> {
        let p = parameters.len();
        let target = if first {
            &mut self.columns
        } else {
            &mut self.part
        };
        let mut derivatives = Integrator {
            model: self.model,
            inputs: &self.inputs,
            parameters,
            columns: target,
            stages: &mut self.stages,
            at_origin: self.model.has_chart(),
        }
        .integrate(self.integration, part_s, moving);
        if !moving.iter().all(|state| state.is_finite()) {
            return Err(EstimationError::NotFinite {
                quantity: "a predicted moving state",
            });
        }
        if let Some(map) = self.model.recentre(moving, &mut self.inputs) {
            derivatives.moving = product(&map, &derivatives.moving);
            derivatives.noise = product(&map, &derivatives.noise);
            map_columns(&map, target, p);
        }
        if let Some(same) = self.model.noise_parameters() {
            for (i, row) in derivatives.noise.iter_mut().enumerate() {
                for (noise, parameter) in row.iter_mut().zip(same) {
                    *noise = target[i * p + parameter];
                }
            }
        }
        Ok(derivatives)
    }

    /// Chains the derivatives of a part to those of the step so far.
    fn add_part(
        &mut self,
        first: bool,
        part_s: f64,
        derivatives: &Derivatives<f64, M>,
        step: &mut Step<M>,
    ) {
        if first {
            step.moving = derivatives.moving;
        } else {
            map_columns(&derivatives.moving, &mut self.columns, self.part.len() / M);
            for (sum, value) in self.columns.iter_mut().zip(&self.part) {
                *sum += value;
            }
            step.moving = product(&derivatives.moving, &step.moving);
            for share in &mut step.shares {
                *share = sandwich(&derivatives.moving, share);
            }
        }
        for (input, share) in step.shares.iter_mut().enumerate() {
            let variance = self.noise_density[input] / part_s;
            for i in 0..M {
                for j in 0..M {
                    share[i][j] +=
                        derivatives.noise[i][input] * variance * derivatives.noise[j][input];
                }
            }
        }
    }
}

/// Number of equal parts, none longer than `longest_step_s`, that an interval is divided into.
fn parts(interval_s: f64, longest_step_s: f64) -> Result<usize, EstimationError> {
    if !(interval_s > 0.0 && interval_s.is_finite()) {
        return Err(EstimationError::InvalidArgument {
            expected: "times that rise",
        });
    }
    let parts = interval_s / longest_step_s;
    if parts > MAX_PARTS {
        return Err(EstimationError::InvalidArgument {
            expected: "an interval of at most a million longest steps",
        });
    }
    let whole = parts as usize;
    Ok((whole + usize::from(parts > whole as f64)).max(1))
}

fn identity<const M: usize>() -> [[f64; M]; M] {
    let mut matrix = [[0.0; M]; M];
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    matrix
}

pub(crate) fn product<const M: usize>(a: &[[f64; M]; M], b: &[[f64; M]; M]) -> [[f64; M]; M] {
    let mut result = [[0.0; M]; M];
    for i in 0..M {
        for l in 0..M {
            for j in 0..M {
                result[i][j] += a[i][l] * b[l][j];
            }
        }
    }
    result
}

/// a b aᵀ of a symmetric b, symmetric to the last bit.
pub(crate) fn sandwich<const M: usize>(a: &[[f64; M]; M], b: &[[f64; M]; M]) -> [[f64; M]; M] {
    let left = product(a, b);
    let mut result = [[0.0; M]; M];
    for i in 0..M {
        for j in 0..=i {
            let mut sum = 0.0;
            for l in 0..M {
                sum += left[i][l] * a[j][l];
            }
            (result[i][j], result[j][i]) = (sum, sum);
        }
    }
    result
}

/// Replaces the M rows of `columns` by their product with `map` from the left.
pub(crate) fn map_columns<const M: usize>(map: &[[f64; M]; M], columns: &mut [f64], stride: usize) {
    let mut rest = &mut columns[..M * stride];
    let mut rows: [&mut [f64]; M] = core::array::from_fn(|_| {
        let (row, others) = core::mem::take(&mut rest).split_at_mut(stride);
        rest = others;
        row
    });
    for column in 0..stride {
        let old: [f64; M] = core::array::from_fn(|i| rows[i][column]);
        for (row, weights) in rows.iter_mut().zip(map) {
            row[column] = old
                .iter()
                .zip(weights)
                .map(|(value, weight)| value * weight)
                .sum();
        }
    }
}
