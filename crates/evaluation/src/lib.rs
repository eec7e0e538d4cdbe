//! Operating characteristics of calibration and diagnosis over populations of simulated records.
//!
//! # What it is
//!
//! A [`Campaign`] runs one job over a range of seeds on all cores, keeps the results in a file if it
//! is given one, and resumes from that file after a kill. The results depend on the job and the seeds
//! alone: not on the number of threads, and not on how often the campaign was stopped. A seed whose
//! job fails is a result, too: it is kept with its message, counted, and never run again.
//!
//! These jobs are measured with it:
//!
//! - A [`CalibrationTrial`] simulates a scenario, calibrates the record and compares estimate and
//!   truth; a [`CalibrationSummary`] has bias, RMSE, NEES, NIS and coverage over all trials. It is
//!   the job of `gyrocal monte-carlo`.
//! - [`PopulationCell::evaluate`] draws a record with injected effects, diagnoses it, applies
//!   [`BaselineMethod`]s to it, and compares the results with the truth in a [`RecordScore`].
//!   [`cell_report`] has the operating characteristics of a cell: [`Characteristic`]s with their
//!   targets, detection by family of effects, and the methods side by side. It is the job of
//!   `gyrocal characterise`.
//!
//! With the feature `field`, each `FieldPopulation` has a job that judges the diagnosis of records that a user could
//! have and the simulator does not make: clean ones with one wrong number in the bench file, kinds from irregular
//! rows to records of two platforms, and kinds of records of a servo. The right answers are data.
//!
//! # Strength of an effect
//!
//! The strength d of an injected effect is its length in sigmas of its own Cramér–Rao bound:
//! d² = δᵀ J δ with the sizes δ and the information J of the record on them, the nine coefficients,
//! the initial attitude and all other injected effects projected out, white noise of the gyros
//! included. [`inject`] draws sizes of a given strength. [`Signature`] and [`ProjectedScores`], which
//! it needs for J, are written apart from the search of `gyrocal-hypothesis`: an error there would
//! otherwise scale the effects that are to reveal it, and cancel.
//!
//! # Example
//!
//! ```
//! use gyrocal_evaluation::{Campaign, Fingerprint};
//! use gyrocal_statistics::Proportion;
//!
//! let campaign = Campaign::new(0..100, Fingerprint::new("coin").with("sides", 2));
//! let outcome = campaign.run(
//!     |seed| if seed == 13 { Err("lost") } else { Ok(seed.is_multiple_of(2)) },
//!     |_| (),
//! )?;
//! assert_eq!(outcome.failures().map(|failure| failure.seed).collect::<Vec<_>>(), [13]);
//! let heads = Proportion::of(outcome.successes().map(|(_, heads)| *heads));
//! assert_eq!((heads.hits, heads.trials), (50, 99));
//! let [low, high] = heads.interval(0.95);
//! assert!(low < 0.5 && 0.5 < high);
//! # Ok::<(), gyrocal_evaluation::EvaluationError>(())
//! ```
//!
//! The operating characteristics of the diagnosis for single effects of 8 sigmas:
//!
//! ```no_run
//! use gyrocal_evaluation::{PopulationCell, cell_campaign, cell_report};
//!
//! let (cell, seeds) = (PopulationCell::Single(8), 0..100);
//! let outcome = cell_campaign(cell, seeds.clone(), &[])
//!     .results("d8.jsonl")
//!     .run(|seed| cell.evaluate(seed, &[]), |_| ())?;
//! for figure in cell_report(cell, &outcome, &seeds).characteristics {
//!     println!("{}: {:?}", figure.figure, figure.measured);
//! }
//! # Ok::<(), gyrocal_evaluation::EvaluationError>(())
//! ```
//!
//! # What it does not do
//!
//! It prints nothing. It does not catch panics of a job: results of finished seeds are in the file.
//! Noise in its populations is as declared: effects of noise are not injected.

mod baseline;
mod calibration_summary;
mod calibration_trial;
mod campaign;
mod catalogue;
mod cell_characteristics;
mod characterise_report;
mod characteristic;
mod coefficient_score;
mod comparison;
mod error;
#[cfg(feature = "field")]
mod field;
mod injection;
mod oracle;
mod out_of_catalogue;
mod population;
mod projection;
mod record_score;
mod scenario;
mod score;
mod signature;
mod statistic;

pub use baseline::{BaselineMethod, BaselineResult};
pub use calibration_summary::{
    BandedMean, CalibrationSummary, CoefficientSummary, MeasuredValue, MonteCarloReport,
};
pub use calibration_trial::CalibrationTrial;
pub use campaign::{Campaign, Failure, Fingerprint, Outcome, Progress, program};
pub use catalogue::{constant_of_channel, effect_family, effect_of, same_or_equivalent, set_holds};
pub use cell_characteristics::{characteristics, measures};
pub use characterise_report::{CellReport, CharacteriseReport, cell_campaign, cell_report};
pub use characteristic::{Characteristic, Measure};
pub use coefficient_score::CoefficientScore;
pub use comparison::{Answer, ComparisonRow, FamilyRow, OWN_METHOD, comparison, families};
pub use error::EvaluationError;
#[cfg(feature = "field")]
pub use field::{FieldOutcome, FieldPopulation, Judgement, diagnosed_together};
pub use injection::{
    InjectedEffect, diagnosed, draw_shape, inject, inject_any, inject_into, inject_one_of,
    nominal_fit, run_of, testable_effects,
};
pub use oracle::sets_without_walks;
pub use out_of_catalogue::UnlistedRecord;
pub use population::PopulationCell;
pub use projection::ProjectedScores;
pub use record_score::{
    BaselineScore, FindingScore, InjectedScore, RecordScore, SAME_CLASS_COSINE,
};
pub use scenario::scenario;
pub use signature::{Signature, SignatureColumns};
pub use statistic::{Statistic, Target};
