//! Dead times that a fit starts from.
//!
//! A fit moves a dead time by its derivative, which leads to the nearest maximum of the likelihood: where an input is
//! rough there are many. The best of a grid of whole rows leads to the highest.

use gyrocal_hypothesis::Column;
use gyrocal_statistics::median_interval_s;

use crate::solve::Solver;

/// Rows of the grid: each up to the first number, each second one beyond, and no more than this part of the longest record.
const EACH: usize = 32;
const MOST: usize = 64;
const PART: usize = 8;

impl Solver<'_> {
    /// Values with the dead times of these unknowns where the model, linear about a simulation, promises the least
    /// residuals; those that are better as they are stay.
    pub(crate) fn with_dead_times(&self, values: &[f64], unknowns: &[usize]) -> Vec<f64> {
        let record = &*self.problem.record;
        let row_s = median_interval_s(&record.time_s);
        let longest = record.records().map(|rows| rows.len()).max().unwrap_or(0);
        let most = MOST.min(longest / PART);
        let grid = (0..=most).filter(|rows| *rows <= EACH || rows % 2 == 0);
        let grid: Vec<f64> = grid.map(|rows| rows as f64 * row_s).collect();
        let mut best = values.to_vec();
        // A simulation that runs away by itself judges nothing.
        let Some(mut least) = self.promised(&best) else {
            return best;
        };
        for unknown in unknowns {
            let Some(Column::Parameter { parameter }) = self.lines.get(*unknown) else {
                continue;
            };
            let declared = self.base.constant[*parameter];
            for time_s in &grid {
                let mut tried = best.clone();
                tried[*unknown] = time_s - declared;
                if let Some(promised) = self.promised(&tried)
                    && promised < least
                {
                    (best, least) = (tried, promised);
                }
            }
        }
        best
    }

    /// The places of dead times among the unknowns.
    pub(crate) fn dead_times(&self) -> Vec<usize> {
        let delays = &self.problem.plant.description.delays;
        let lines = self.lines.iter().enumerate();
        let own = lines.filter(|(_, line)| match line {
            Column::Parameter { parameter } => delays.iter().any(|one| one.time == *parameter),
            _ => false,
        });
        own.map(|(place, _)| place).collect()
    }
}
