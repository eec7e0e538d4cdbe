//! Rows of a record as signatures need them: times, regressors and covariates.

use core::ops::Range;
use std::sync::Arc;

use gyrocal_scalar::effect::Role;

use crate::plant::{Plant, WeightInputs};

/// Onset of an effect that does not act in a record, after its end, s.
const AFTER_END_S: f64 = 1.0;

/// A known function of the moving states at each row, such as a component of specific force.
#[derive(Clone, Debug, PartialEq)]
pub struct Covariate {
    /// Name, such as `specific force along x`.
    pub name: &'static str,
    /// Smallest range over which a dependence on it is looked for, in its unit.
    pub least_range: f64,
    /// Its value at each row.
    pub values: Vec<f64>,
}

/// Rows of one record, or of several one after the other.
///
/// The rows of several records have times on one clock, which rises from record to record; an onset is a
/// time on it and lies in one record. Functions of time begin anew with each record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// Time of each row, s.
    pub time_s: Vec<f64>,
    /// First row of each record after the first; empty of one record.
    pub starts: Vec<usize>,
    /// Logged regressors about their means, in the order of the plant's; empty if not logged.
    pub regressors: Vec<Vec<f64>>,
    /// What terms depend on that derives from the regressors, such as their rates of change; the plant's
    /// weights have it after them.
    pub derived: Vec<Vec<f64>>,
    /// Covariates, in the order of the plant's; empty where no trajectory is known.
    pub covariates: Vec<Covariate>,
}

impl Rows {
    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Time of the first row, s.
    #[must_use]
    pub fn first_s(&self) -> f64 {
        self.time_s.first().copied().unwrap_or(0.0)
    }

    /// Time from the first row to the last, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.time_s.last().copied().unwrap_or(0.0) - self.first_s()
    }

    /// Time of a row since the first, s.
    #[must_use]
    pub fn since_first_s(&self, row: usize) -> f64 {
        self.time_s[row] - self.first_s()
    }

    /// The rows of each record.
    pub fn records(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let firsts = core::iter::once(0).chain(self.starts.iter().copied());
        let ends = self.starts.iter().copied().chain([self.len()]);
        firsts.zip(ends).map(|(first, end)| first..end)
    }

    /// Time from the first row to the last of the longest record, s.
    #[must_use]
    pub fn longest_record_s(&self) -> f64 {
        let of_record = |rows: Range<usize>| match &self.time_s[rows] {
            [first, .., last] => last - first,
            _ => 0.0,
        };
        self.records().map(of_record).fold(0.0, f64::max)
    }

    /// Number of rows before a time since the first row.
    #[must_use]
    pub fn rows_before(&self, time_s: f64) -> usize {
        let first_s = self.first_s();
        self.time_s.partition_point(|t| t - first_s < time_s)
    }

    /// A weight of a plant in each step: in its middle, regressors and covariates interpolated.
    #[must_use]
    pub fn step_weights(&self, plant: &Plant, weight: usize, shapes: &[f64]) -> Arc<[f64]> {
        let middle = |values: &[f64], step: usize| 0.5 * (values[step] + values[step + 1]);
        self.evaluate(
            plant,
            weight,
            shapes,
            self.len().saturating_sub(1),
            |step, first_s, inputs| {
                inputs.time_s = 0.5 * (self.time_s[step] + self.time_s[step + 1]) - first_s;
                inputs.interval_s = self.time_s[step + 1] - self.time_s[step];
                for (target, values) in inputs.regressors.iter_mut().zip(self.all_regressors()) {
                    *target = middle(values, step);
                }
                for (target, covariate) in inputs.covariates.iter_mut().zip(&self.covariates) {
                    *target = middle(&covariate.values, step);
                }
            },
        )
    }

    /// A weight of a plant at each row.
    #[must_use]
    pub fn row_weights(&self, plant: &Plant, weight: usize, shapes: &[f64]) -> Arc<[f64]> {
        self.evaluate(plant, weight, shapes, self.len(), |row, first_s, inputs| {
            inputs.time_s = self.time_s[row] - first_s;
            inputs.interval_s = 1.0;
            for (target, values) in inputs.regressors.iter_mut().zip(self.all_regressors()) {
                *target = values[row];
            }
            for (target, covariate) in inputs.covariates.iter_mut().zip(&self.covariates) {
                *target = covariate.values[row];
            }
        })
    }

    /// The regressors, then what derives from them.
    fn all_regressors(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.regressors.iter().chain(&self.derived)
    }

    fn evaluate(
        &self,
        plant: &Plant,
        weight: usize,
        shapes: &[f64],
        count: usize,
        set: impl Fn(usize, f64, &mut Point),
    ) -> Arc<[f64]> {
        let mut point = Point {
            time_s: 0.0,
            interval_s: 1.0,
            regressors: vec![0.0; self.all_regressors().count()],
            covariates: vec![0.0; self.covariates.len()],
        };
        let mut weights = vec![0.0; plant.weight_count];
        let mut values = Vec::with_capacity(count);
        for rows in self.records() {
            let first_s = self.time_s.get(rows.start).copied().unwrap_or(0.0);
            let own = self.shapes_in(plant, shapes, &rows);
            for index in rows.start..rows.end.min(count) {
                set(index, first_s, &mut point);
                let inputs = WeightInputs {
                    time_s: point.time_s,
                    interval_s: point.interval_s,
                    regressors: &point.regressors,
                    covariates: &point.covariates,
                    shapes: &own,
                };
                (plant.weights)(&inputs, &mut weights);
                values.push(weights[weight]);
            }
        }
        values.into()
    }

    /// The shapes as one of the records has them: an onset on its own clock, and after its end if the onset
    /// lies in another record.
    #[must_use]
    pub fn shapes_in(&self, plant: &Plant, shapes: &[f64], record: &Range<usize>) -> Vec<f64> {
        let mut own = shapes.to_vec();
        let (Some(first_s), Some(last_s)) = (
            self.time_s.get(record.start),
            record
                .end
                .checked_sub(1)
                .and_then(|row| self.time_s.get(row)),
        ) else {
            return own;
        };
        if self.starts.is_empty() {
            return own;
        }
        let start_s = first_s - self.first_s();
        let is_last = record.end == self.len();
        let effects = plant.effects.iter().flat_map(|effect| effect.parameters);
        for parameter in effects {
            let Role::Onset(Some(index)) = parameter.role else {
                continue;
            };
            let Some(onset_s) = shapes.get(index) else {
                continue;
            };
            let since_start_s = onset_s - start_s;
            let length_s = last_s - first_s;
            let is_inside = (since_start_s >= 0.0 || record.start == 0)
                && (since_start_s <= length_s || is_last);
            own[index] = if is_inside {
                since_start_s
            } else {
                length_s + AFTER_END_S
            };
        }
        own
    }
}

/// Inputs of the weights that change from row to row.
struct Point {
    time_s: f64,
    interval_s: f64,
    regressors: Vec<f64>,
    covariates: Vec<f64>,
}
