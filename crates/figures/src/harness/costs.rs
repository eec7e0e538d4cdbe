//! Processor time of populations, and what their full size takes by it.

use std::sync::{Mutex, PoisonError};

/// What the records of a population took.
#[derive(Clone, Debug)]
pub(super) struct Cost {
    pub(super) population: String,
    /// Processor time of the records, s.
    pub(super) seconds: f64,
    pub(super) records: u64,
    /// Number of records that the targets ask for.
    pub(super) full: u64,
}

/// Costs of all populations that were measured.
#[derive(Default)]
pub(crate) struct Costs(Mutex<Vec<Cost>>);

impl Costs {
    pub(super) fn add(&self, cost: Cost) {
        self.all(|all| all.push(cost));
    }

    /// Processor time so far, and that of the full size, s.
    pub(crate) fn totals(&self) -> [f64; 2] {
        self.all(|all| {
            all.iter().fold([0.0; 2], |[here, full], cost| {
                let each = cost.seconds / cost.records.max(1) as f64;
                [here + cost.seconds, full + each * cost.full as f64]
            })
        })
    }

    /// The populations whose full size takes most, with that time, s.
    pub(crate) fn dearest(&self, count: usize) -> Vec<(String, f64)> {
        let mut all: Vec<(String, f64)> = self.all(|all| {
            let of = |cost: &Cost| cost.seconds * cost.full as f64 / cost.records.max(1) as f64;
            all.iter()
                .map(|cost| (cost.population.clone(), of(cost)))
                .collect()
        });
        all.sort_by(|one, other| other.1.total_cmp(&one.1));
        all.truncate(count);
        all
    }

    fn all<T>(&self, job: impl FnOnce(&mut Vec<Cost>) -> T) -> T {
        job(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}
