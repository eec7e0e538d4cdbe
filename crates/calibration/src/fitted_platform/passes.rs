//! Passes over a record with a fitted model: what signatures, sudden changes and noise would say.

use gyrocal::estimation::batch::{Linearisation, Reduced, Tape, Whitened};
use gyrocal::{Catalogue, EstimationError};
use gyrocal_hypothesis::{Column, ExtraColumns, StateJump};
use nalgebra::{DMatrix, DVector};

use super::FittedPlatform;
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::noise::{self, NoiseEstimate};

impl FittedPlatform<'_> {
    /// Whitened innovations of the fit, row by row; NaN where there is no value.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn whitened(&self) -> Result<Vec<[f64; 3]>, CalibrationError> {
        let parameters = self.parameters();
        let mut whitened = vec![[f64::NAN; 3]; self.points().len()];
        self.problem
            .with_run(0, &parameters, |pass| {
                let tape = self.solution.tapes[0].as_deref();
                Linearisation { tape, ..*pass }
                    .reduce(|value| whitened[value.row][value.output] = value.columns[0])
            })
            .map_err(|error| CalibrationError::pass(0, error))?;
        Ok(whitened)
    }

    /// Score and information of a sudden turn about the platform axes, rad, in each step, the unknowns
    /// of the fit free, by the row that ends the step; `None` for the first row.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn jumps(&self) -> Result<Vec<Option<StateJump>>, CalibrationError> {
        let parameters = self.parameters();
        let covariance = &self.uncertainty.conditional;
        let count = covariance.nrows();
        let mut jumps: Vec<Option<StateJump>> = vec![None; self.points().len()];
        self.problem
            .with_run(0, &parameters, |pass| {
                let tape = self.solution.tapes[0].as_deref();
                Linearisation { tape, ..*pass }.jumps(|row, found| {
                    let cross = DMatrix::from_fn(count, 3, |i, j| found.columns[i + 1][j]);
                    let projected = covariance * &cross;
                    jumps[row] = Some(StateJump {
                        // Columns are derivatives of the innovations: those of a jump too.
                        score: DVector::from_row_slice(&found.columns[0]),
                        information: DMatrix::from_fn(3, 3, |i, j| {
                            found.information[i][j] - cross.column(i).dot(&projected.column(j))
                        }),
                        outputs: DVector::from_fn(3, |output, _| found.readings[output]),
                    });
                })
            })
            .map_err(|error| CalibrationError::pass(0, error))?;
        Ok(jumps)
    }

    /// Passes over the record with all parameters of [`Catalogue`] as columns (all but those in
    /// the extension are zero at the linearisation point), then `further` columns. The
    /// extension's own further columns are not among them unless they are in `further`, but
    /// their amplitudes are taken into account. `watch` sees every whitened value.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn signatures(
        &self,
        further: &[Column],
        mut watch: impl FnMut(&Whitened<'_>),
    ) -> Result<Reduced<3>, CalibrationError> {
        let all: Vec<usize> = (0..Catalogue::PARAMETERS).collect();
        self.reduced(&all, None, further, &mut watch)
    }

    /// The same with the parameters of the fit as columns only, in the order of
    /// [`Self::values`], then the extension's own further columns, then `further`.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn conditional(&self, further: &[Column]) -> Result<Reduced<3>, CalibrationError> {
        let own: Vec<usize> = (0..PARAMETERS)
            .chain(self.extension.parameters.iter().map(|(place, _)| *place))
            .collect();
        // What the fit has kept is in the order of the model, each parameter once.
        let mut active = own.clone();
        active.sort_unstable();
        active.dedup();
        let tape = self.solution.tapes[0].as_deref();
        let mut reduced = self.reduced(&active, tape, further, &mut |_| ())?;
        let first = active.len() + 1;
        let columns: Vec<usize> = core::iter::once(0)
            .chain(
                own.iter()
                    .map(|place| active.partition_point(|other| other < place) + 1),
            )
            .chain(first..reduced.gram.ncols())
            .collect();
        reduced.gram = reduced.gram.select_rows(&columns).select_columns(&columns);
        Ok(reduced)
    }

    fn reduced(
        &self,
        active: &[usize],
        tape: Option<&Tape<3>>,
        further: &[Column],
        watch: &mut dyn FnMut(&Whitened<'_>),
    ) -> Result<Reduced<3>, CalibrationError> {
        let leg = &self.problem.runs[0];
        let own = self.extension.columns.columns().len();
        let mut columns = self.extension.columns.columns().to_vec();
        columns.extend_from_slice(further);
        let mut all = ExtraColumns::new(columns);
        let amplitudes = leg
            .amplitudes
            .iter()
            .map(|unknown| self.problem.values[*unknown]);
        all.set_amplitudes(amplitudes);
        debug_assert_eq!(own, leg.amplitudes.len());
        let parameters = self.parameters();
        self.problem
            .with_active(0, &parameters, active, &all, |pass| {
                Linearisation { tape, ..*pass }.reduce(watch)
            })
            .map_err(|error| CalibrationError::pass(0, error))
    }

    /// Noise by maximum likelihood, over what the fit believes.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn noise(&self) -> Result<NoiseEstimate, CalibrationError> {
        let parameters = self.parameters();
        self.problem
            .with_run(0, &parameters, |pass| {
                let tape = self.solution.tapes[0].as_deref();
                let pass = Linearisation { tape, ..*pass };
                noise::estimate(|factors| {
                    let mut factors = factors.to_vec();
                    factors.resize(factors.len() + pass.walks.walks.len(), 1.0);
                    pass.noise_score(&factors)
                })
            })
            .map_err(|error: EstimationError| CalibrationError::pass(0, error))
    }
}
