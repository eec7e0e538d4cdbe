//! Values that a fit begins with of what it moves by a derivative: dead times of inputs, and knees of effects.
//!
//! The derivative leads to the nearest maximum of the likelihood, and of a rough input or of a model that bends there are
//! many. The best of a grid leads to the highest.

use gyrocal_hypothesis::Column;
use gyrocal_statistics::median_interval_s;

use crate::solve::Solver;

/// Rows of the grid of a dead time: each up to the first number, each second one beyond, and no more than this part of
/// the longest record.
const EACH: usize = 32;
const MOST: usize = 64;
const PART: usize = 8;

/// The grid of a knee, over where it is declared.
pub(crate) const KNEES: [f64; 7] = [1.0, 0.25, 0.5, 0.75, 1.25, 1.5, 2.0];

impl Solver<'_> {
    /// Values with these unknowns where the model, linear about a simulation, promises the least residuals; those that
    /// are better as they are stay.
    pub(crate) fn with_first_values(&self, values: &[f64], unknowns: &[usize]) -> Vec<f64> {
        let mut best = values.to_vec();
        if unknowns.is_empty() {
            return best;
        }
        // A simulation that runs away by itself judges nothing.
        let Some(mut least) = self.promised(&best) else {
            return best;
        };
        for unknown in unknowns {
            for value in self.grid(*unknown) {
                let mut tried = best.clone();
                tried[*unknown] = value;
                if let Some(promised) = self.promised(&tried)
                    && promised < least
                {
                    (best, least) = (tried, promised);
                }
            }
        }
        best
    }

    /// The places of dead times and knees among the unknowns.
    pub(crate) fn searched(&self) -> Vec<usize> {
        let places = 0..self.lines.len();
        places
            .filter(|place| !self.grid(*place).is_empty())
            .collect()
    }

    /// Values of an unknown to try; none of one that is linear.
    fn grid(&self, unknown: usize) -> Vec<f64> {
        let Some(Column::Parameter { parameter }) = self.lines.get(unknown) else {
            return Vec::new();
        };
        let description = &self.problem.plant.description;
        let mut knees = description.knees.iter();
        if let Some(knee) = knees.find(|one| one.constant == *parameter) {
            return KNEES.map(|share| (share - 1.0) * knee.value).to_vec();
        }
        if !description.delays.iter().any(|one| one.time == *parameter) {
            return Vec::new();
        }
        let record = &*self.problem.record;
        let row_s = median_interval_s(&record.time_s);
        let longest = record.records().map(|rows| rows.len()).max().unwrap_or(0);
        let rows = 0..=MOST.min(longest / PART);
        let rows = rows.filter(|rows| *rows <= EACH || rows % 2 == 0);
        let declared = self.base.constant[*parameter];
        rows.map(|rows| rows as f64 * row_s - declared).collect()
    }
}
