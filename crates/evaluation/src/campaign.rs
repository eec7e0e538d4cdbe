//! Campaigns: one job over a range of seeds, in parallel and resumable.

mod fingerprint;
mod store;

use std::collections::BTreeMap;
use std::error::Error;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use gyrocal_hypothesis::Stop;
use rayon::ThreadPoolBuilder;
use rayon::prelude::*;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

pub use fingerprint::{Fingerprint, program};

use crate::error::EvaluationError;
use store::{Finished, Store, encode};

/// A range of seeds, the fingerprint of the job, and the file that keeps the results.
#[derive(Debug, Clone)]
pub struct Campaign {
    /// Seeds that the job runs over.
    pub seeds: Range<u64>,
    /// Everything but the seed that the results depend on.
    pub fingerprint: Fingerprint,
    /// File of the results; `None` keeps them in memory only.
    pub results: Option<PathBuf>,
    /// Number of threads; `None` for one on each core.
    pub threads: Option<NonZeroUsize>,
}

/// Progress of a campaign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Number of seeds with a result, those of earlier runs included.
    pub done: u64,
    /// Number of seeds of the campaign.
    pub total: u64,
    /// Number of seeds whose results were in the file at the start.
    pub resumed: u64,
    /// Number of seeds whose job failed.
    pub failed: u64,
    /// Estimated time left, from the finished seeds of this run; `None` before the first.
    pub left: Option<Duration>,
}

/// Results of all seeds, in the order of the seeds.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome<T> {
    results: BTreeMap<u64, Finished<T>>,
    resumed: u64,
}

/// A seed whose job failed.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Failure {
    /// The seed.
    pub seed: u64,
    /// The error and its sources, in one line.
    pub message: String,
}

impl Campaign {
    /// A campaign over these seeds, in memory, on all cores.
    ///
    /// The fingerprint must name everything but the seed that the results depend on.
    #[must_use]
    pub fn new(seeds: Range<u64>, fingerprint: Fingerprint) -> Self {
        Self {
            seeds,
            fingerprint,
            results: None,
            threads: None,
        }
    }

    /// Keeps results in this file and resumes from those in it. The file may hold more seeds or
    /// fewer than this campaign.
    #[must_use]
    pub fn results(mut self, path: impl Into<PathBuf>) -> Self {
        self.results = Some(path.into());
        self
    }

    /// Uses this many threads.
    #[must_use]
    pub fn threads(mut self, threads: NonZeroUsize) -> Self {
        self.threads = Some(threads);
        self
    }

    /// Runs the job for each seed that has no result yet.
    ///
    /// A result is in the file before `progress` is called with it. An error of the job is kept as
    /// its message with those of its sources.
    ///
    /// # Errors
    /// [`EvaluationError::File`], [`EvaluationError::Busy`], [`EvaluationError::NoResults`],
    /// [`EvaluationError::OtherCampaign`] and [`EvaluationError::Line`] for the file of results;
    /// [`EvaluationError::Unstorable`] for a result that JSON cannot hold; [`EvaluationError::Threads`];
    /// [`EvaluationError::Stopped`] if the job of this thread was asked to end: seeds that were finished are in the
    /// file, those at work are not.
    ///
    /// # Panics
    /// If the job or `progress` does.
    pub fn run<T, E>(
        &self,
        job: impl Fn(u64) -> Result<T, E> + Sync,
        progress: impl FnMut(Progress) + Send,
    ) -> Result<Outcome<T>, EvaluationError>
    where
        T: Serialize + DeserializeOwned + Send,
        E: Into<Box<dyn Error + Send + Sync>>,
    {
        let threads = self.threads.map_or(0, NonZeroUsize::get);
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| EvaluationError::Threads {
            reason: error.to_string(),
        })?;
        let (store, mut results) = match &self.results {
            Some(path) => {
                let (store, known) = Store::open(path, &self.fingerprint)?;
                (Some(store), known)
            }
            None => (None, BTreeMap::new()),
        };
        results.retain(|seed, _| self.seeds.contains(seed));
        let mut missing: Vec<u64> = self.seeds.clone().collect();
        missing.retain(|seed| !results.contains_key(seed));
        let resumed = results.len() as u64;
        let state = Progress {
            done: resumed,
            total: resumed + missing.len() as u64,
            resumed,
            failed: results.values().filter(|result| result.is_err()).count() as u64,
            left: None,
        };
        let collector = Mutex::new(Collector::new(store, progress, state));
        let stop = Stop::here();
        let one = |seed: u64| {
            stop.check()?;
            let finished = stop.over(|| job(seed));
            // What a job says that was stopped is not its own.
            stop.check()?;
            let finished = finished.map_err(|error| one_line(&*error.into()));
            let (line, finished) = encode(seed, &finished)?;
            #[expect(
                clippy::unwrap_used,
                reason = "only a panic poisons it, and rayon carries a panic on to the caller"
            )]
            collector.lock().unwrap().accept(&line, finished.is_err())?;
            Ok((seed, finished))
        };
        // One seed a task: run times of seeds may differ by any factor.
        let tasks = missing.into_par_iter().with_max_len(1).map(one);
        let fresh: Result<Vec<_>, EvaluationError> = pool.install(|| tasks.collect());
        let store = collector.into_inner().map(|collector| collector.store);
        let kept = store.ok().flatten().map_or(Ok(()), Store::finish);
        results.extend(fresh?);
        kept?;
        Ok(Outcome { results, resumed })
    }
}

/// The state that all threads share: the file of results and the progress.
struct Collector<P> {
    store: Option<Store>,
    started: Instant,
    state: Progress,
    progress: P,
}

impl<P: FnMut(Progress)> Collector<P> {
    fn new(store: Option<Store>, mut progress: P, state: Progress) -> Self {
        progress(state);
        Self {
            store,
            started: Instant::now(),
            state,
            progress,
        }
    }

    fn accept(&mut self, line: &[u8], failed: bool) -> Result<(), EvaluationError> {
        if let Some(store) = &mut self.store {
            store.append(line)?;
        }
        self.state.done += 1;
        self.state.failed += u64::from(failed);
        let fresh = self.state.done - self.state.resumed;
        let ahead = self.state.total - self.state.done;
        let pace = self.started.elapsed().as_secs_f64() / fresh as f64;
        self.state.left = Duration::try_from_secs_f64(pace * ahead as f64).ok();
        (self.progress)(self.state);
        Ok(())
    }
}

/// An error and its sources in one line.
fn one_line(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(error) = source {
        text = format!("{text}: {error}");
        source = error.source();
    }
    text
}

impl<T> Outcome<T> {
    /// Successful seeds with the result of their job.
    pub fn successes(&self) -> impl Iterator<Item = (u64, &T)> {
        self.results
            .iter()
            .filter_map(|(seed, result)| Some((*seed, result.as_ref().ok()?)))
    }

    /// The same by value.
    pub fn into_successes(self) -> impl Iterator<Item = (u64, T)> {
        let results = self.results.into_iter();
        results.filter_map(|(seed, result)| Some((seed, result.ok()?)))
    }

    /// Seeds whose job failed, with the message.
    pub fn failures(&self) -> impl Iterator<Item = Failure> {
        self.results.iter().filter_map(|(&seed, result)| {
            let message = result.as_ref().err()?.clone();
            Some(Failure { seed, message })
        })
    }

    /// Number of seeds whose results were in the file at the start.
    #[must_use]
    pub fn resumed(&self) -> u64 {
        self.resumed
    }
}
