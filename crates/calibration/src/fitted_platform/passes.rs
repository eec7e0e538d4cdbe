//! Passes over a record with a fitted model: what signatures, sudden changes and noise would say.

use gyrocal::effect::Need;
use gyrocal::{Catalogue, EFFECTS, Effect};
use gyrocal_hypothesis::{Column, ExtraColumns, StateJump};
use gyrocal_inference::{KeptRecord, NoiseScore, Pass, Reduced, Whitened};
use nalgebra::{DMatrix, DVector};

use super::FittedPlatform;
use super::several::add_score;
use crate::coefficients::PARAMETERS;
use crate::error::CalibrationError;
use crate::noise;
use gyrocal_record::NoiseEstimate;

impl FittedPlatform<'_> {
    /// A record linearised about the fit, if it was short enough to be kept.
    pub(super) fn kept(&self, run: usize) -> Option<&KeptRecord> {
        self.solution.kept[run].as_deref()
    }

    /// Whitened innovations of the fit, row by row; NaN where there is no value.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn whitened(&self) -> Result<Vec<[f64; 3]>, CalibrationError> {
        let mut whitened = vec![[f64::NAN; 3]; self.points().len()];
        for (run, rows) in self.record_rows().into_iter().enumerate() {
            let parameters = self.problem.parameters(run);
            let own = &mut whitened[rows];
            self.problem
                .with_run(run, &parameters, |pass| {
                    let keep =
                        |value: &Whitened<'_>| own[value.row][value.output] = value.columns[0];
                    pass.on(self.kept(run)).reduce(keep)
                })
                .map_err(|error| CalibrationError::pass(run, error))?;
        }
        Ok(whitened)
    }

    /// Score and information of a sudden turn about the platform axes, rad, in each step, the unknowns
    /// of the fit free, by the row that ends the step; `None` for the first row.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn jumps(&self) -> Result<Vec<Option<StateJump>>, CalibrationError> {
        let mut jumps: Vec<Option<StateJump>> = vec![None; self.points().len()];
        for (run, rows) in self.record_rows().into_iter().enumerate() {
            self.jumps_in(run, &mut jumps[rows])?;
        }
        Ok(jumps)
    }

    /// The same of one record.
    fn jumps_in(
        &self,
        run: usize,
        jumps: &mut [Option<StateJump>],
    ) -> Result<(), CalibrationError> {
        let parameters = self.problem.parameters(run);
        let covariance = &self.uncertainty.conditional;
        let count = covariance.nrows();
        let unknowns = self.problem.runs[run].column_unknowns();
        self.problem
            .with_run(run, &parameters, |pass| {
                pass.on(self.kept(run)).jumps(|row, found| {
                    let mut cross = DMatrix::zeros(count, 3);
                    for (unknowns, column) in unknowns.iter().zip(&found.columns[1..]) {
                        for unknown in *unknowns {
                            for (axis, value) in column.iter().enumerate() {
                                cross[(*unknown, axis)] += value;
                            }
                        }
                    }
                    let projected = covariance * &cross;
                    jumps[row] = Some(StateJump {
                        // Columns are derivatives of the innovations: those of a jump too.
                        score: DVector::from_row_slice(&found.columns[0]),
                        information: DMatrix::from_fn(3, 3, |i, j| {
                            found.information[3 * i + j] - cross.column(i).dot(&projected.column(j))
                        }),
                        outputs: DVector::from_fn(3, |output, _| found.readings[output]),
                    });
                })
            })
            .map_err(|error| CalibrationError::pass(run, error))
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
    ) -> Result<Reduced, CalibrationError> {
        let all: Vec<usize> = (0..Catalogue::PARAMETERS).collect();
        self.signatures_of(&all, further, &mut watch)
    }

    /// The Gram matrix of [`Self::signatures`]. Where no record has a temperature, its columns are zero
    /// without a pass.
    pub(super) fn gram_of_signatures(
        &self,
        further: &[Column],
    ) -> Result<DMatrix<f64>, CalibrationError> {
        let mut runs = self.problem.runs.iter();
        if runs.any(|run| run.rows.has_temperature()) {
            return Ok(self.signatures(further, |_| ())?.gram);
        }
        let count = Catalogue::PARAMETERS;
        let zero: Vec<usize> = of_logged_quantities().collect();
        let active: Vec<usize> = (0..count).filter(|place| !zero.contains(place)).collect();
        let part = self.signatures_of(&active, further, &mut |_| ())?.gram;
        let residual = core::iter::once(0);
        let parameters = active.iter().map(|place| place + 1);
        let size = part.ncols() + zero.len();
        let places: Vec<usize> = residual.chain(parameters).chain(1 + count..size).collect();
        let mut gram = DMatrix::zeros(size, size);
        for (from, column) in places.iter().enumerate() {
            for (row, value) in places.iter().zip(part.column(from).iter()) {
                gram[(*row, *column)] = *value;
            }
        }
        Ok(gram)
    }

    fn signatures_of(
        &self,
        active: &[usize],
        further: &[Column],
        watch: &mut dyn FnMut(&Whitened<'_>),
    ) -> Result<Reduced, CalibrationError> {
        let mut total: Option<Reduced> = None;
        for run in 0..self.records() {
            let mut own = self.reduced(run, active, None, further, watch)?;
            own.gram = self.without_offsets(own.gram, run)?;
            add(&mut total, own);
        }
        total.ok_or(CalibrationError::NoRecords)
    }

    /// The Gram matrices of [`Self::signatures`] in two parts: of all records but the last, the offsets of their
    /// turn-ons eliminated, and of the last by itself, with that of its turn-on among its parameters. The
    /// residuals of the last are at [`Self::parameters_in`] it, those of the others at
    /// [`Self::shared_parameters`].
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn earlier_and_last(
        &self,
        further: &[Column],
    ) -> Result<[DMatrix<f64>; 2], CalibrationError> {
        let all: Vec<usize> = (0..Catalogue::PARAMETERS).collect();
        let of_run = |run| {
            let reduced = self.reduced(run, &all, None, further, &mut |_| ())?;
            Ok::<_, CalibrationError>(reduced.gram)
        };
        let last = of_run(self.records() - 1)?;
        let mut earlier = DMatrix::zeros(last.nrows(), last.ncols());
        for run in 0..self.records() - 1 {
            earlier += self.without_offsets(of_run(run)?, run)?;
        }
        Ok([earlier, last])
    }

    /// The same with the parameters of the fit as columns only, in the order of
    /// [`Self::values`], then the extension's own further columns, then `further`.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn conditional(&self, further: &[Column]) -> Result<Reduced, CalibrationError> {
        let mut total: Option<Reduced> = None;
        for run in 0..self.records() {
            add(&mut total, self.conditional_in(run, further)?);
        }
        total.ok_or(CalibrationError::NoRecords)
    }

    /// The same of one of the records.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn conditional_in(
        &self,
        run: usize,
        further: &[Column],
    ) -> Result<Reduced, CalibrationError> {
        let own: Vec<usize> = (0..PARAMETERS)
            .chain(self.extension.parameters.iter().map(|(place, _)| *place))
            .collect();
        // What the fit has kept is in the order of the model, each parameter once.
        let mut active = own.clone();
        active.sort_unstable();
        active.dedup();
        let mut reduced = self.reduced(run, &active, self.kept(run), further, &mut |_| ())?;
        let first = active.len() + 1;
        let columns: Vec<usize> = core::iter::once(0)
            .chain(
                own.iter()
                    .map(|place| active.partition_point(|other| other < place) + 1),
            )
            .chain(first..reduced.gram.ncols())
            .collect();
        reduced.gram = reduced.gram.select_rows(&columns).select_columns(&columns);
        reduced.gram = self.without_offsets(reduced.gram, run)?;
        Ok(reduced)
    }

    fn reduced(
        &self,
        run: usize,
        active: &[usize],
        kept: Option<&KeptRecord>,
        further: &[Column],
        watch: &mut dyn FnMut(&Whitened<'_>),
    ) -> Result<Reduced, CalibrationError> {
        let leg = &self.problem.runs[run];
        let own = self.extension.columns.columns().len();
        let mut columns = leg.further.columns().to_vec();
        columns.extend(self.columns_of(further, run));
        let mut all = ExtraColumns::new(columns);
        let amplitudes = leg
            .amplitudes
            .iter()
            .map(|unknown| self.problem.values[*unknown]);
        all.set_amplitudes(amplitudes);
        debug_assert_eq!(own, leg.amplitudes.len());
        let parameters = self.problem.parameters(run);
        self.problem
            .with_active(run, &parameters, active, &all, |pass| {
                pass.on(kept).reduce(watch)
            })
            .map_err(|error| CalibrationError::pass(run, error))
    }

    /// Noise by maximum likelihood, over what the fit believes.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub fn noise(&self) -> Result<NoiseEstimate, CalibrationError> {
        noise::estimate(|factors, first| {
            let mut total: Option<NoiseScore> = None;
            for run in 0..self.records() {
                let parameters = self.problem.parameters(run);
                let score = self.problem.with_run(run, &parameters, |pass| {
                    let mut factors = factors.to_vec();
                    factors.resize(factors.len() + pass.further.walks.walks.len(), 1.0);
                    Pass {
                        factors: &factors,
                        ..pass.on(self.kept(run))
                    }
                    .noise_score_from(first)
                });
                let score = score.map_err(|error| CalibrationError::pass(run, error))?;
                add_score(&mut total, score);
            }
            total.ok_or(CalibrationError::NoRecords)
        })
    }
}

/// Parameters of effects that need a logged quantity.
fn of_logged_quantities() -> impl Iterator<Item = usize> {
    let needs_one = |effect: &&Effect| {
        let mut needs = effect.needs.iter();
        needs.any(|need| matches!(need, Need::Column(_)))
    };
    EFFECTS
        .iter()
        .filter(needs_one)
        .flat_map(Effect::model_parameters)
}

/// Adds a pass over another record, whose columns are the same.
fn add(total: &mut Option<Reduced>, own: Reduced) {
    let Some(total) = total else {
        *total = Some(own);
        return;
    };
    total.gram += own.gram;
    total.log_variance += own.log_variance;
    total.values += own.values;
    total.rows += own.rows;
    total.last = own.last;
    total.last_covariance = own.last_covariance;
}
