//! How much is measured, on which seeds, and where results are kept.

use std::any::Any;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use gyrocal_evaluation::{Campaign, Fingerprint, Outcome};

use super::population::{Kept, Population, Records, Timed};
use super::row::Row;
use crate::cost::on_one_core;
use crate::error::Error;
use crate::figure::Figure;

/// Records that are begun without a look at the clock.
const BLOCK: u64 = 32;

/// Which seeds are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Seeds {
    /// Those that constants may be tuned on.
    Development,
    /// Those that pages report.
    Report,
}

impl Seeds {
    /// Distance between the two.
    pub(crate) const REPORT: u64 = 1_000_000_000;

    fn first(self, first: u64) -> u64 {
        match self {
            Self::Development => first,
            Self::Report => first + Self::REPORT,
        }
    }
}

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Size {
    /// A few records, and nothing that builds copies of the workspace: what continuous integration runs.
    Small,
    /// At most so many records of each population.
    Most(u64),
    /// A tenth of each population.
    Tenth,
    /// All that targets ask for.
    Full,
}

impl Size {
    /// Number of records, from those of the full and of the small version.
    pub(crate) fn records(self, full: u64, small: u64) -> u64 {
        match self {
            Self::Small => small,
            Self::Most(most) => most.min(full),
            Self::Tenth => full.div_ceil(10),
            Self::Full => full,
        }
    }
}

/// What a part of a topic is measured with.
pub(crate) struct Context {
    pub(crate) size: Size,
    pub(crate) seeds: Seeds,
    /// Whether documents and committed measurements are renewed instead of compared.
    pub(crate) write: bool,
    /// Names of the records that a part with a table of records is limited to; all without a name.
    pub(crate) named: Vec<String>,
    /// Folder of results, where they are found again; `None` keeps them in memory.
    pub(crate) store: Option<PathBuf>,
    /// No record is begun after this.
    pub(crate) deadline: Option<Instant>,
    /// Populations that were measured in this process.
    pub(crate) known: Known,
}

/// Populations by name, first seed and number of records.
#[derive(Default)]
pub(crate) struct Known {
    records: Mutex<BTreeMap<String, Arc<dyn Any + Send + Sync>>>,
    /// Processor time that the full size of each takes by its records here, s.
    full_s: Mutex<Vec<(String, f64)>>,
}

/// A population is not finished before the deadline.
#[derive(Debug)]
pub(crate) struct Unfinished {
    name: String,
    done: u64,
    of: u64,
}

impl core::fmt::Display for Unfinished {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { name, done, of } = self;
        write!(
            f,
            "{name}: {done} of {of} records; the same command goes on from there"
        )
    }
}

impl core::error::Error for Unfinished {}

impl Context {
    pub(crate) fn new(size: Size, seeds: Seeds) -> Self {
        Self {
            size,
            seeds,
            write: false,
            named: Vec::new(),
            store: None,
            deadline: None,
            known: Known::default(),
        }
    }

    pub(crate) fn is_small(&self) -> bool {
        self.size == Size::Small
    }

    /// Whether the deadline has passed.
    pub(super) fn is_over(&self) -> bool {
        self.deadline.is_some_and(|end| Instant::now() > end)
    }

    /// The populations so far with the processor time of their full size, s, the dearest first.
    pub(crate) fn dearest(&self) -> Vec<(String, f64)> {
        let mut all = locked(&self.known.full_s).clone();
        all.sort_by(|one, other| other.1.total_cmp(&one.1));
        all
    }

    /// The figures of rows over a population; none if this size leaves the population out.
    pub(crate) fn measure<R: Kept>(
        &self,
        population: &Population<'_, R>,
        rows: &[Row<'_, R>],
    ) -> Result<Vec<Figure>, Error> {
        let records = self.records(population)?;
        if records.records.is_empty() && records.failures.is_empty() {
            return Ok(Vec::new());
        }
        let figures = rows.iter().map(|row| row.figure(&records));
        Ok(figures
            .chain(failures(&population.name, &records))
            .collect())
    }

    /// The results of a population: measured once in a process, and kept in the store beyond it.
    ///
    /// # Errors
    /// [`Unfinished`] at the deadline, and those of the file of results.
    pub(crate) fn records<R: Kept>(
        &self,
        population: &Population<'_, R>,
    ) -> Result<Arc<Records<R>>, Error> {
        let count = self.size.records(population.full, population.small);
        let first = self.seeds.first(population.first);
        let key = format!("{} {first} {count}", population.name);
        let found = locked(&self.known.records).get(&key).cloned();
        if let Some(found) = found.and_then(|found| found.downcast::<Records<R>>().ok()) {
            return Ok(found);
        }
        let outcome = self.outcome(population, first, count)?;
        let here_s: f64 = outcome.successes().map(|(_, timed)| timed.s).sum();
        let full_s = here_s * population.full as f64 / count.max(1) as f64;
        locked(&self.known.full_s).push((population.name.clone(), full_s));
        let failures = outcome.failures().collect();
        let records = outcome.into_successes().map(|(_, timed)| timed.result);
        let records = Arc::new(Records {
            records: records.collect(),
            failures,
            seeds: format!("{first}..{}", first + count),
            full: count >= population.full,
        });
        locked(&self.known.records).insert(key, records.clone());
        Ok(records)
    }

    fn outcome<R: Kept>(
        &self,
        population: &Population<'_, R>,
        first: u64,
        count: u64,
    ) -> Result<Outcome<Timed<R>>, Error> {
        let Population {
            name, sources, job, ..
        } = population;
        let timed = |seed: u64| {
            let (result, s) = on_one_core(|| job(seed));
            result.map(|result| Timed { s, result })
        };
        let hash = sources.hash()?;
        let mut campaign =
            Campaign::new(first..first, Fingerprint::new(name).with("sources", &hash));
        if let Some(store) = &self.store {
            std::fs::create_dir_all(store)?;
            campaign = campaign.results(store.join(format!("{}-{hash}.jsonl", file_name(name))));
        }
        // In memory nothing is found again: one run of all seeds.
        let block = self.store.as_ref().map_or(count.max(1), |_| BLOCK);
        let mut done = 0;
        loop {
            done = (done + block).min(count);
            campaign.seeds = first..first + done;
            let outcome = campaign.run(timed, |_| ())?;
            if done == count {
                return Ok(outcome);
            }
            if done.is_multiple_of(8 * BLOCK) {
                eprintln!("{name}: {done} of {count}");
            }
            if self.is_over() {
                let (name, of) = (name.clone(), count);
                return Err(Unfinished { name, done, of }.into());
            }
        }
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Records that could not be measured, if there are any: there must be none.
fn failures<R>(population: &str, of: &Records<R>) -> Option<Figure> {
    let (first, count) = (of.failures.first()?, of.failures.len());
    let name = format!("{population}: records that could not be measured");
    let measured = format!("{count} (seed {}: {})", first.seed, first.message);
    let figure = Figure::told(&name, "0", measured, false);
    Some(figure.over(of.records.len() + count, of.seeds.as_str()))
}

/// The name with nothing but letters, digits and dashes.
fn file_name(name: &str) -> String {
    let plain = |letter: char| match letter {
        letter if letter.is_alphanumeric() => letter,
        _ => '-',
    };
    name.chars().map(plain).collect()
}
