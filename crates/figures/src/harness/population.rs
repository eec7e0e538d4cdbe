//! A population: a job over seeds, whose results every statistic reads.

use gyrocal_evaluation::Failure;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::sources::Sources;
use crate::error::Error;

/// A job over seeds.
pub(crate) struct Population<'a, R> {
    /// Its name, unique in all topics: that of its file of results.
    pub(crate) name: String,
    /// First of its development seeds, below [`Seeds::REPORT`](super::Seeds::REPORT).
    pub(crate) first: u64,
    /// Number of records that its targets ask for.
    pub(crate) full: u64,
    /// Number of records of the small version; zero leaves the population out of it.
    pub(crate) small: u64,
    /// What can move its results.
    pub(crate) sources: Sources,
    /// Draws the record of a seed and says what is found in it.
    pub(crate) job: Box<dyn Fn(u64) -> Result<R, Error> + Sync + 'a>,
}

impl<'a, R> Population<'a, R> {
    /// A population of a first seed and a number of records: of the full and of the small version.
    pub(crate) fn new(
        name: impl Into<String>,
        [first, full, small]: [u64; 3],
        sources: Sources,
        job: impl Fn(u64) -> Result<R, Error> + Sync + 'a,
    ) -> Self {
        Self {
            name: name.into(),
            first,
            full,
            small,
            sources,
            job: Box::new(job),
        }
    }
}

/// What can be kept of a record.
pub(crate) trait Kept: Serialize + DeserializeOwned + Send + Sync + 'static {}
impl<R: Serialize + DeserializeOwned + Send + Sync + 'static> Kept for R {}

/// A result with the processor time that it took.
#[derive(Serialize, Deserialize)]
pub(super) struct Timed<R> {
    /// Processor time, s.
    pub(super) s: f64,
    pub(super) result: R,
}

/// The results of a population.
pub(crate) struct Records<R> {
    /// In the order of the seeds, failures left out.
    pub(crate) records: Vec<R>,
    /// Seeds whose record could not be measured.
    pub(crate) failures: Vec<Failure>,
    /// The seeds, as printed.
    pub(crate) seeds: String,
    /// `true` if there are as many records as the targets ask for.
    pub(crate) full: bool,
}
