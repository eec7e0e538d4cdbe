//! One job over a range of seeds.

use std::collections::BTreeMap;
use std::error::Error;
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::{Duration, Instant};

use rayon::ThreadPoolBuilder;
use rayon::prelude::*;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::error::CampaignError;
use crate::fingerprint::Fingerprint;
use crate::store::{Finished, Store, encode};

/// What is run, and where its results are kept.
#[derive(Debug, Clone)]
pub struct Campaign {
    seeds: Range<u64>,
    fingerprint: Fingerprint,
    results: Option<PathBuf>,
    threads: Option<NonZeroUsize>,
}

/// How far a campaign is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Progress {
    /// Seeds with a result, those of earlier runs included.
    pub done: u64,
    /// Seeds of the campaign.
    pub total: u64,
    /// Seeds whose results were in the file at the start.
    pub resumed: u64,
    /// Seeds that failed.
    pub failed: u64,
    /// Time left at the pace of this run; `None` until a seed was finished in it.
    pub left: Option<Duration>,
}

/// The results of all seeds, in their order.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome<T> {
    results: BTreeMap<u64, Finished<T>>,
    resumed: u64,
}

impl Campaign {
    /// A campaign over these seeds, in memory, on all cores.
    ///
    /// The fingerprint has to name all that the results depend on beside the seed.
    #[must_use]
    pub fn new(seeds: Range<u64>, fingerprint: Fingerprint) -> Self {
        Self {
            seeds,
            fingerprint,
            results: None,
            threads: None,
        }
    }

    /// Keeps results in this file and goes on from those that are in it. They may be of more
    /// seeds or of fewer than this campaign's.
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
    /// A result is in the file before `progress` hears of it. An error of the job is kept as its
    /// message, that of its sources included.
    ///
    /// # Errors
    /// [`CampaignError::File`], [`CampaignError::Busy`], [`CampaignError::NoResults`],
    /// [`CampaignError::OtherCampaign`] and [`CampaignError::Line`] of the file of results;
    /// [`CampaignError::Unstorable`] of a result that is no JSON; [`CampaignError::Threads`].
    ///
    /// # Panics
    /// If the job or `progress` does.
    pub fn run<T, E>(
        &self,
        job: impl Fn(u64) -> Result<T, E> + Sync,
        progress: impl FnMut(Progress) + Send,
    ) -> Result<Outcome<T>, CampaignError>
    where
        T: Serialize + DeserializeOwned + Send,
        E: Into<Box<dyn Error + Send + Sync>>,
    {
        let pool = ThreadPoolBuilder::new()
            .num_threads(self.threads.map_or(0, NonZeroUsize::get))
            .build()
            .map_err(|error| CampaignError::Threads {
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
        let missing: Vec<u64> = self
            .seeds
            .clone()
            .filter(|seed| !results.contains_key(seed))
            .collect();
        let resumed = results.len() as u64;
        let failed = results.values().filter(|result| result.is_err()).count() as u64;
        let desk = Mutex::new(Desk::new(
            store,
            progress,
            Progress {
                done: resumed,
                total: resumed + missing.len() as u64,
                resumed,
                failed,
                left: None,
            },
        ));
        let one = |seed: u64| {
            let finished = job(seed).map_err(|error| told(&*error.into()));
            let (line, finished) = encode(seed, &finished)?;
            // It is only poisoned by a panic, which goes on in every thread.
            #[allow(clippy::unwrap_used)]
            desk.lock().unwrap().accept(&line, finished.is_err())?;
            Ok((seed, finished))
        };
        // One seed a task: they may differ in length by any factor.
        let fresh: Vec<(u64, Finished<T>)> = pool.install(|| {
            missing
                .into_par_iter()
                .with_max_len(1)
                .map(one)
                .collect::<Result<_, CampaignError>>()
        })?;
        results.extend(fresh);
        if let Ok(desk) = desk.into_inner()
            && let Some(store) = desk.store
        {
            store.finish()?;
        }
        Ok(Outcome { results, resumed })
    }
}

/// Where the threads hand in their results.
struct Desk<P> {
    store: Option<Store>,
    started: Instant,
    state: Progress,
    progress: P,
}

impl<P: FnMut(Progress)> Desk<P> {
    fn new(store: Option<Store>, mut progress: P, state: Progress) -> Self {
        progress(state);
        Self {
            store,
            started: Instant::now(),
            state,
            progress,
        }
    }

    fn accept(&mut self, line: &[u8], failed: bool) -> Result<(), CampaignError> {
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
fn told(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(error) = source {
        text = format!("{text}: {error}");
        source = error.source();
    }
    text
}

impl<T> Outcome<T> {
    /// Seeds that ended well, with what their job returned.
    pub fn successes(&self) -> impl Iterator<Item = (u64, &T)> {
        self.results
            .iter()
            .filter_map(|(seed, result)| Some((*seed, result.as_ref().ok()?)))
    }

    /// Seeds that failed, with the message.
    pub fn failures(&self) -> impl Iterator<Item = (u64, &str)> {
        self.results
            .iter()
            .filter_map(|(seed, result)| Some((*seed, result.as_ref().err()?.as_str())))
    }

    /// Seeds whose results were in the file at the start.
    #[must_use]
    pub fn resumed(&self) -> u64 {
        self.resumed
    }
}
