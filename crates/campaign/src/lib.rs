//! Many simulated runs, in parallel and resumable, and what they say of an estimator.
//!
//! # What it is
//!
//! A *campaign* runs one job over a range of seeds. [`Campaign::run`] does it on all cores, keeps
//! the results in a file if it is given one, and goes on from there after a kill. What comes out
//! depends on the job and the seeds alone: not on the number of threads, and not on how often the
//! campaign was stopped. A seed that fails is a result like any other: it is kept with its
//! message, counted, and never run again.
//!
//! [`Trial`] is the job of `gyrocal monte-carlo`, one simulated record calibrated and held
//! against its truth, and [`Summary`] is what many of them say.
//!
//! # Example
//!
//! ```
//! use gyrocal_campaign::{Campaign, Fingerprint};
//! use gyrocal_statistics::Proportion;
//!
//! let campaign = Campaign::new(0..100, Fingerprint::new("coin").with("sides", 2));
//! let outcome = campaign.run(
//!     |seed| if seed == 13 { Err("lost") } else { Ok(seed.is_multiple_of(2)) },
//!     |_| (),
//! )?;
//! assert_eq!(outcome.failures().collect::<Vec<_>>(), [(13, "lost")]);
//! let heads = Proportion::of(outcome.successes().map(|(_, heads)| *heads));
//! assert_eq!((heads.hits, heads.trials), (50, 99));
//! let [low, high] = heads.interval(0.95);
//! assert!(low < 0.5 && 0.5 < high);
//! # Ok::<(), gyrocal_campaign::CampaignError>(())
//! ```
//!
//! # What it does not do
//!
//! It prints nothing. It does not catch panics of a job: what was finished before is in the file.

mod campaign;
mod error;
mod fingerprint;
mod program;
mod report;
mod store;
mod summary;
mod trial;

pub use campaign::{Campaign, Outcome, Progress};
pub use error::CampaignError;
pub use fingerprint::Fingerprint;
pub use program::program;
pub use report::MonteCarloReport;
pub use summary::{Banded, CoefficientSummary, Failure, Measured, Summary};
pub use trial::Trial;
