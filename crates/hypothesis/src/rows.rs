//! Rows of a record as signatures need them: times, regressors and covariates.

use std::sync::Arc;

use crate::plant::{Plant, WeightInputs};

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

/// Rows of one record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    /// Time of each row, s.
    pub time_s: Vec<f64>,
    /// Logged regressors about their means, in the order of the plant's; empty if not logged.
    pub regressors: Vec<Vec<f64>>,
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
        let first_s = self.first_s();
        self.evaluate(
            plant,
            weight,
            shapes,
            self.len().saturating_sub(1),
            |step, inputs| {
                inputs.time_s = 0.5 * (self.time_s[step] + self.time_s[step + 1]) - first_s;
                inputs.interval_s = self.time_s[step + 1] - self.time_s[step];
                for (target, values) in inputs.regressors.iter_mut().zip(&self.regressors) {
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
        self.evaluate(plant, weight, shapes, self.len(), |row, inputs| {
            inputs.time_s = self.since_first_s(row);
            inputs.interval_s = 1.0;
            for (target, values) in inputs.regressors.iter_mut().zip(&self.regressors) {
                *target = values[row];
            }
            for (target, covariate) in inputs.covariates.iter_mut().zip(&self.covariates) {
                *target = covariate.values[row];
            }
        })
    }

    fn evaluate(
        &self,
        plant: &Plant,
        weight: usize,
        shapes: &[f64],
        count: usize,
        set: impl Fn(usize, &mut Point),
    ) -> Arc<[f64]> {
        let mut point = Point {
            time_s: 0.0,
            interval_s: 1.0,
            regressors: vec![0.0; self.regressors.len()],
            covariates: vec![0.0; self.covariates.len()],
        };
        let mut weights = vec![0.0; plant.weight_count];
        (0..count)
            .map(|index| {
                set(index, &mut point);
                let inputs = WeightInputs {
                    time_s: point.time_s,
                    interval_s: point.interval_s,
                    regressors: &point.regressors,
                    covariates: &point.covariates,
                    shapes,
                };
                (plant.weights)(&inputs, &mut weights);
                weights[weight]
            })
            .collect()
    }
}

/// Inputs of the weights that change from row to row.
struct Point {
    time_s: f64,
    interval_s: f64,
    regressors: Vec<f64>,
    covariates: Vec<f64>,
}
