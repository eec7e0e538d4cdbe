//! Several records of one platform in one fit: their clock, their columns, the unknowns of each alone.

use core::ops::Range;
use std::sync::Arc;

use gyrocal::trajectory::Orientation;
use gyrocal_hypothesis::{Column, ModelExtension, Rows};
use gyrocal_inference::NoiseScore;
use gyrocal_record::{Bench, Record};
use nalgebra::{Cholesky, DMatrix};

use super::{FittedPlatform, NoiseModel, Parts, of_site};
use crate::coefficients::{BIASES, PARAMETERS};
use crate::error::CalibrationError;
use crate::platform::{PLATFORM, rows_of};
use crate::problem::{Problem, Unknown};
use crate::settings::filter_settings;
use crate::solve::MAX_PASSES;
use crate::temperature::TemperatureScale;

/// Distance between the clocks of two records, in usual intervals between rows: to every test a gap.
const GAP_INTERVALS: f64 = 10.0;

/// Turn-on sigma of a gyro whose turn-ons are declared equal while those of others differ, deg/h.
const SAME_DEG_PER_H: f64 = 1e-9;

/// What a fit to several records has beside that to one.
#[derive(Clone)]
pub(super) struct Several {
    /// Rows of all records on one clock.
    pub(super) clock: Rows,
    /// Attitude at each of them.
    pub(super) points: Vec<Orientation>,
    /// Offsets of each turn-on: parameters of the model that have one.
    pub(super) offsets: Vec<usize>,
    /// Their standard deviations before the records.
    pub(super) offset_sigmas: Vec<f64>,
}

impl Several {
    /// Number of unknowns that belong to one record alone, all records together.
    pub(super) fn unknowns(&self) -> usize {
        self.offsets.len() * (self.clock.starts.len() + 1)
    }
}

/// Records one after the other, as one record: on a clock that goes on ten intervals after the end of each.
/// The first keeps its own. Temperature is that of all, or none. Then the first rows of the records after
/// the first.
#[must_use]
pub fn joined_record(records: &[&Record]) -> (Record, Vec<usize>) {
    let mut all = Record {
        time_s: Vec::new(),
        accel_g: Vec::new(),
        temperature_c: records
            .iter()
            .all(|record| record.temperature_c.is_some())
            .then(Vec::new),
    };
    let mut starts = Vec::new();
    for record in records {
        let mut offset_s = 0.0;
        if let (Some(last_s), Some(first_s)) = (all.time_s.last(), record.time_s.first()) {
            let interval_s = record.duration_s() / record.len().saturating_sub(1).max(1) as f64;
            offset_s = last_s + GAP_INTERVALS * interval_s - first_s;
            starts.push(all.time_s.len());
        }
        all.time_s
            .extend(record.time_s.iter().map(|t| t + offset_s));
        all.accel_g.extend_from_slice(&record.accel_g);
        if let (Some(all), Some(own)) = (&mut all.temperature_c, &record.temperature_c) {
            all.extend_from_slice(own);
        }
    }
    (all, starts)
}

impl<'a> FittedPlatform<'a> {
    /// One model fitted to several records of one platform, from the fits to each with its bench: the
    /// coefficients and all effects are those of the platform, attitude and clock those of each record.
    /// Where the benches declare that turn-ons differ, each has offsets of the constant drifts.
    /// Accelerometer noise and left-out values are those of each fit, the noise of the gyros is declared.
    ///
    /// # Errors
    /// [`CalibrationError::NoRecords`] without fits, [`CalibrationError::UnlikeBenches`], and as
    /// [`Self::refitted`].
    pub fn joined(parts: &[Self], benches: &[&Bench]) -> Result<Self, CalibrationError> {
        let (Some(first), Some(bench)) = (parts.first(), benches.first()) else {
            return Err(CalibrationError::NoRecords);
        };
        if let Some((record, key)) = contradiction(benches) {
            return Err(CalibrationError::UnlikeBenches { record, key });
        }
        let extension = of_site(bench);
        let turn_on = bench.prior.turn_on_sigma_deg_per_h;
        let differ = parts.len() > 1 && turn_on.iter().any(|sigma| *sigma > 0.0);
        let mut unknowns = first.problem.unknowns[..PARAMETERS].to_vec();
        let (mut offsets, mut offset_sigmas) = (Vec::new(), Vec::new());
        if differ {
            for (axis, bias) in BIASES.into_iter().enumerate() {
                // The prior of the mean over turn-ons, not that of one.
                unknowns[bias].sigma = bench.prior.bias_sigma_deg_per_h[axis];
                offsets.push(bias);
                offset_sigmas.push(turn_on[axis].max(SAME_DEG_PER_H));
            }
        }
        unknowns.extend(
            extension
                .parameters
                .iter()
                .map(|(_, sigma)| Unknown::estimated(*sigma)),
        );
        let count = unknowns.len();
        let records: Vec<&Record> = parts
            .iter()
            .map(|part| part.problem.runs[0].rows.record())
            .collect();
        let (record, starts) = joined_record(&records);
        let scale = TemperatureScale::of(&record, &starts);
        let clock = rows_of(&record, starts, Vec::new());
        let noise = joined_noise(parts);
        let mut values: Vec<f64> = (0..PARAMETERS).map(|i| mean_value(parts, i)).collect();
        values.resize(count, 0.0);
        let mut runs = Vec::with_capacity(parts.len());
        for (part, bench) in parts.iter().zip(benches) {
            let mut run = part.problem.runs[0].clone();
            run.set_walks(Vec::new());
            let density =
                filter_settings(bench, gyrocal::Discretisation::default()).drift_noise_density();
            run.noise_density = [density; 3];
            run.rows.set_temperature_scale(scale);
            runs.push(run);
        }
        let problem = Problem {
            model: first.problem.model,
            integration: first.problem.integration,
            longest_step_s: first.problem.longest_step_s,
            unknowns,
            runs,
            values,
        };
        let several = (parts.len() > 1).then(|| Several {
            clock,
            points: Vec::new(),
            offsets,
            offset_sigmas,
        });
        let parts = Parts {
            noise,
            several,
            most_passes: MAX_PASSES,
        };
        Self::solved(problem, extension, parts)
    }

    /// Number of records.
    #[must_use]
    pub fn records(&self) -> usize {
        self.problem.runs.len()
    }

    /// The rows of each record among those of all.
    #[must_use]
    pub fn record_rows(&self) -> Vec<Range<usize>> {
        let mut next = 0;
        let runs = self.problem.runs.iter();
        runs.map(|run| {
            let first = next;
            next += run.points.len();
            first..next
        })
        .collect()
    }

    /// Rows of the fitted records as the search needs them; `record` is that of the fit, or
    /// [`joined_record`] of several.
    #[must_use]
    pub fn rows(&self, record: &Record) -> Rows {
        let covariates = crate::platform::covariates(&self.predicted_g());
        let starts = self.several.as_ref().map(|several| &several.clock.starts);
        rows_of(record, starts.cloned().unwrap_or_default(), covariates)
    }

    /// All parameters of [`gyrocal::Catalogue`] without the offset of any turn-on.
    #[must_use]
    pub fn shared_parameters(&self) -> Vec<f64> {
        let shared = |unknowns: &Vec<usize>| {
            let unknowns = unknowns.iter().filter(|unknown| **unknown < self.shared);
            unknowns.map(|unknown| self.problem.values[*unknown]).sum()
        };
        self.problem.runs[0]
            .parameter_unknowns
            .iter()
            .map(shared)
            .collect()
    }

    /// All parameters of [`gyrocal::Catalogue`] in one record, with the offset of its turn-on.
    #[must_use]
    pub fn parameters_in(&self, record: usize) -> Vec<f64> {
        self.problem.parameters(record)
    }

    /// Onsets and time constants on the clock of one record.
    #[must_use]
    pub fn shapes_in(&self, record: usize) -> Vec<f64> {
        shapes_of(self.several.as_ref(), &self.extension, record)
    }

    /// Columns over the rows of all records, as one of them has them.
    pub(super) fn columns_of(&self, columns: &[Column], run: usize) -> Vec<Column> {
        columns_of(self.several.as_ref(), columns, run)
    }

    /// Eliminates the offsets of a turn-on from the Gram matrix of its record, whose columns after the
    /// first begin with the nominal parameters.
    pub(super) fn without_offsets(
        &self,
        gram: DMatrix<f64>,
        run: usize,
    ) -> Result<DMatrix<f64>, CalibrationError> {
        let Some(several) = self.several.as_ref().filter(|one| !one.offsets.is_empty()) else {
            return Ok(gram);
        };
        let count = several.offsets.len();
        let first = self.shared + run * count;
        let columns: Vec<usize> = several.offsets.iter().map(|offset| offset + 1).collect();
        let mut cross = gram.select_columns(&columns);
        let mut own = cross.select_rows(&columns);
        let mut gram = gram;
        for (i, sigma) in several.offset_sigmas.iter().enumerate() {
            // The prior is one more row: of the residual -v/s, of the column -1/s.
            let weight = sigma.powi(-2);
            let value = self.problem.values[first + i];
            gram[(0, 0)] += weight * value * value;
            cross[(0, i)] += weight * value;
            own[(i, i)] += weight;
        }
        let solved = Cholesky::new(own)
            .ok_or(CalibrationError::NotPositiveDefinite)?
            .solve(&cross.transpose());
        Ok(gram - cross * solved)
    }

    /// Estimates of each turn-on's constant drifts about the shared ones, deg/h, with their standard
    /// deviations, by axis; empty where turn-ons do not differ.
    #[must_use]
    pub fn turn_ons_deg_per_h(&self) -> Vec<[[f64; 2]; 3]> {
        let Some(several) = self.several.as_ref().filter(|one| !one.offsets.is_empty()) else {
            return Vec::new();
        };
        let count = several.offsets.len();
        let of_run = |run: usize| {
            core::array::from_fn(|axis| {
                let place = self.shared + run * count + axis;
                let variance = self.uncertainty.total[(place, place)];
                [self.problem.values[place], variance.sqrt()]
            })
        };
        (0..self.records()).map(of_run).collect()
    }
}

/// The first bench that contradicts the first of all, and the key that differs.
fn contradiction(benches: &[&Bench]) -> Option<(usize, &'static str)> {
    let first = benches.first()?;
    benches.iter().enumerate().find_map(|(record, bench)| {
        let differs = [
            ("[prior]", first.prior != bench.prior),
            ("[uncertainty]", first.uncertainty != bench.uncertainty),
            (
                "[site] while [uncertainty] declares it uncertain",
                !of_site(first).parameters.is_empty()
                    && (first.latitude_deg, first.gravity) != (bench.latitude_deg, bench.gravity),
            ),
            (
                "magnetic_field_gauss",
                first.magnetic_field_gauss.is_some() != bench.magnetic_field_gauss.is_some(),
            ),
        ];
        let (key, _) = differs.into_iter().find(|(_, differs)| *differs)?;
        Some((record, key))
    })
}

/// Mean of an estimate of all fits, each weighted by its information.
fn mean_value(parts: &[FittedPlatform<'_>], place: usize) -> f64 {
    let weighted = parts.iter().map(|part| {
        let weight = 1.0 / part.covariance()[(place, place)];
        (weight, weight * part.values()[place])
    });
    let (weights, sum) = weighted.fold((0.0, 0.0), |all, one| (all.0 + one.0, all.1 + one.1));
    sum / weights
}

/// The noise of all records: weights of all rows, root mean squares of ratios.
fn joined_noise(parts: &[FittedPlatform<'_>]) -> NoiseModel {
    let weights = parts.iter().any(|part| part.noise.weights.is_some());
    let of_part = |part: &FittedPlatform<'_>| match &part.noise.weights {
        Some(weights) => weights.clone(),
        None => vec![[1.0; 3]; part.points().len()],
    };
    NoiseModel {
        accel_ratio: core::array::from_fn(|axis| {
            let squares = parts
                .iter()
                .map(|part| part.noise.accel_ratio[axis].powi(2));
            (squares.sum::<f64>() / parts.len() as f64).sqrt()
        }),
        weights: weights.then(|| parts.iter().flat_map(of_part).collect()),
        ..NoiseModel::default()
    }
}

/// The shapes of an extension on the clock of a record.
pub(super) fn shapes_of(
    several: Option<&Several>,
    extension: &ModelExtension,
    run: usize,
) -> Vec<f64> {
    let shapes = extension.all_shapes(&PLATFORM);
    let Some(several) = several else {
        return shapes;
    };
    let rows = several.clock.records().nth(run);
    rows.map_or(shapes.clone(), |rows| {
        several.clock.shapes_in(&PLATFORM, &shapes, &rows)
    })
}

/// Columns over the rows of all records, as one of them has them.
pub(super) fn columns_of(several: Option<&Several>, columns: &[Column], run: usize) -> Vec<Column> {
    let rows = several.and_then(|several| several.clock.records().nth(run));
    match rows {
        Some(rows) => columns
            .iter()
            .map(|column| in_record(column, &rows))
            .collect(),
        None => columns.to_vec(),
    }
}

/// A column as a record has it.
fn in_record(column: &Column, rows: &Range<usize>) -> Column {
    // Nothing happens in this record.
    let nothing = || Column::Output {
        output: 0,
        change: Arc::from([]),
    };
    let part = |series: &Arc<[f64]>, end: usize| -> Arc<[f64]> {
        let end = end.min(series.len());
        Arc::from(&series[rows.start.min(end)..end])
    };
    match column {
        Column::InitialState { row, state } if rows.contains(row) => Column::InitialState {
            row: row - rows.start,
            state: *state,
        },
        Column::StateJump { row, state } if rows.contains(row) => Column::StateJump {
            row: row - rows.start,
            state: *state,
        },
        Column::Step { parameter, row } if rows.contains(row) => Column::Step {
            parameter: *parameter,
            row: row - rows.start,
        },
        Column::TimeProfile { parameter, steps } => Column::TimeProfile {
            parameter: *parameter,
            steps: part(steps, rows.end.saturating_sub(1)),
        },
        Column::Output { output, change } => Column::Output {
            output: *output,
            change: part(change, rows.end),
        },
        _ => nothing(),
    }
}

/// Adds the score of another record to a score with the same columns.
pub(super) fn add_score(total: &mut Option<NoiseScore>, one: NoiseScore) {
    let Some(total) = total else {
        *total = Some(one);
        return;
    };
    total.values += one.values;
    total.log_variance += one.log_variance;
    total.gram += one.gram;
    for (sum, own) in total.d_log_variance.iter_mut().zip(one.d_log_variance) {
        *sum += own;
    }
    for (sum, own) in total.d_gram.iter_mut().zip(one.d_gram) {
        *sum += own;
    }
    for (sum, own) in total.information.iter_mut().zip(one.information) {
        *sum += own;
    }
    for (sum, own) in total.with_rows.iter_mut().zip(one.with_rows) {
        *sum += own;
    }
}
