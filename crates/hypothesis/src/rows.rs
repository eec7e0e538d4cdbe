//! Rows of a record as signatures need them: times, regressors and covariates.

use core::ops::Range;
use std::sync::Arc;

use gyrocal_scalar::effect::Role;
use gyrocal_statistics::median_interval_s;

use crate::plant::{Plant, WeightInputs};

/// Onset of an effect that does not act in a record, after its end, s.
const AFTER_END_S: f64 = 1.0;

/// Length of a step over the typical one of its record beyond which it is a gap: between one step and two.
const GAP: f64 = 1.5;

/// Most parts of a gap: each of a day is then shorter than six minutes.
const MOST_PARTS: usize = 256;

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

    /// A weight of a plant in each step: in its middle, regressors and covariates interpolated. Over a gap,
    /// in which a weight may change as no straight line does, its mean.
    #[must_use]
    pub fn step_weights(&self, plant: &Plant, weight: usize, shapes: &[f64]) -> Arc<[f64]> {
        let parts_of_steps = self.parts_of_steps();
        let parts = |step: usize| parts_of_steps[step];
        let set = |step: usize, first_s: f64, part: f64, inputs: &mut Point| {
            let interval_s = self.time_s[step + 1] - self.time_s[step];
            let within = |values: &[f64]| (1.0 - part) * values[step] + part * values[step + 1];
            inputs.time_s = self.time_s[step] + part * interval_s - first_s;
            inputs.interval_s = interval_s / parts(step) as f64;
            for (target, values) in inputs.regressors.iter_mut().zip(self.all_regressors()) {
                *target = within(values);
            }
            for (target, covariate) in inputs.covariates.iter_mut().zip(&self.covariates) {
                *target = within(&covariate.values);
            }
        };
        let steps = self.len().saturating_sub(1);
        self.evaluate(plant, weight, shapes, steps, parts, set)
    }

    /// A weight of a plant at each row.
    #[must_use]
    pub fn row_weights(&self, plant: &Plant, weight: usize, shapes: &[f64]) -> Arc<[f64]> {
        let set = |row: usize, first_s: f64, _: f64, inputs: &mut Point| {
            inputs.time_s = self.time_s[row] - first_s;
            inputs.interval_s = 1.0;
            for (target, values) in inputs.regressors.iter_mut().zip(self.all_regressors()) {
                *target = values[row];
            }
            for (target, covariate) in inputs.covariates.iter_mut().zip(&self.covariates) {
                *target = covariate.values[row];
            }
        };
        self.evaluate(plant, weight, shapes, self.len(), |_| 1, set)
    }

    /// Parts over which the mean of a weight is taken in each step: several in a gap.
    fn parts_of_steps(&self) -> Vec<usize> {
        let mut all = Vec::with_capacity(self.len());
        for rows in self.records() {
            let time_s = &self.time_s[rows];
            let typical_s = median_interval_s(time_s);
            all.extend(time_s.windows(2).map(|step| {
                let parts = (step[1] - step[0]) / typical_s;
                if parts > GAP {
                    (parts as usize).min(MOST_PARTS - 1) + 1
                } else {
                    1
                }
            }));
            // From the last row of a record to the next record.
            all.push(1);
        }
        all
    }

    /// The regressors, then what derives from them.
    fn all_regressors(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.regressors.iter().chain(&self.derived)
    }

    /// Means of a weight over the parts of each row or step; `set` sets the point of a place in one.
    fn evaluate(
        &self,
        plant: &Plant,
        weight: usize,
        shapes: &[f64],
        count: usize,
        parts: impl Fn(usize) -> usize,
        set: impl Fn(usize, f64, f64, &mut Point),
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
                let parts = parts(index);
                let mut sum = 0.0;
                for part in 0..parts {
                    set(
                        index,
                        first_s,
                        (part as f64 + 0.5) / parts as f64,
                        &mut point,
                    );
                    let inputs = WeightInputs {
                        time_s: point.time_s,
                        interval_s: point.interval_s,
                        regressors: &point.regressors,
                        covariates: &point.covariates,
                        shapes: &own,
                    };
                    (plant.weights)(&inputs, &mut weights);
                    sum += weights[weight];
                }
                values.push(sum / parts as f64);
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

#[cfg(test)]
mod tests {
    use gyrocal_statistics::math::exp;

    use super::*;

    const TAU_S: f64 = 3600.0;
    const ONSET_S: f64 = 20_000.0;

    /// A warm-up and a step.
    fn write(inputs: &WeightInputs<'_>, weights: &mut [f64]) {
        weights[0] = exp(-inputs.time_s / TAU_S);
        weights[1] = ((inputs.time_s - ONSET_S) / inputs.interval_s + 0.5).clamp(0.0, 1.0);
    }

    const PLANT: Plant = Plant {
        effects: &[],
        parameters: &[],
        nominal_parameters: 0,
        shapes: &[],
        rates: &[],
        rate_states: &[],
        outputs: &[],
        moving_states: 0,
        weight_count: 2,
        weights: write,
        natural_periods_s: &[],
    };

    #[test]
    fn a_weight_over_a_gap_is_its_mean() {
        // Rows a minute apart with a gap of five hours, after which a warm-up has nearly ended.
        let gap_s = [6_000.0, 24_000.0];
        let time_s: Vec<f64> = (0..=600)
            .map(|row| 60.0 * f64::from(row))
            .filter(|t| *t <= gap_s[0] || *t >= gap_s[1])
            .collect();
        let gap = time_s.partition_point(|t| *t < gap_s[1]) - 1;
        let rows = Rows {
            time_s,
            ..Rows::default()
        };
        let mean = |[first_s, last_s]: [f64; 2]| {
            TAU_S * (exp(-first_s / TAU_S) - exp(-last_s / TAU_S)) / (last_s - first_s)
        };
        let warmup = rows.step_weights(&PLANT, 0, &[]);
        let step = rows.step_weights(&PLANT, 1, &[]);
        for (index, weight) in warmup.iter().enumerate() {
            let ends = [rows.time_s[index], rows.time_s[index + 1]];
            // The rule of midpoints is off by h²/24τ² of the value: 2e-5 of parts of 70 s.
            assert!((weight / mean(ends) - 1.0).abs() < 2e-5, "step {index}");
        }
        // The weight is linear in the part that holds the onset, where the mean is exact.
        let expected = (gap_s[1] - ONSET_S) / (gap_s[1] - gap_s[0]);
        assert!((step[gap] - expected).abs() < 1e-12);
    }

    #[test]
    fn a_step_is_as_long_as_the_others_of_its_record() {
        // Rows of one and of four minutes, each record with a gap.
        let first = [0.0, 60.0, 120.0, 720.0, 780.0];
        let second = [0.0, 240.0, 480.0, 1_200.0, 1_440.0, 1_680.0].map(|t| 10_000.0 + t);
        let rows = Rows {
            time_s: [first.as_slice(), &second].concat(),
            starts: vec![first.len()],
            ..Rows::default()
        };
        assert_eq!(rows.parts_of_steps(), [1, 1, 11, 1, 1, 1, 1, 4, 1, 1, 1]);
    }
}
