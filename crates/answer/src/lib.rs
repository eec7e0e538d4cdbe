//! The answer of a diagnosis as plain data, which is also its JSON contract.
//!
//! # What it is
//!
//! [`Answer`] holds all that a user is told: of a platform, of a strapdown unit, of several records, and of any
//! plant. It is what `gyrocal diagnose --json` and `gyrocal plant diagnose --json` write, key by key, and what
//! [`read`] reads back; screens, pages and Python are views of it. Keys of one schema version keep their meaning; a
//! version may gain keys. `docs/formats.md` describes each key, `docs/schema/diagnosis.schema.json` is the committed
//! copy of the JSON Schema.
//!
//! A number that a record is too short for, or that was not computed, is `None`; no number is not finite.
//! [`write_text`] refuses an answer that does not read back.
//!
//! [`PlantFit`] is the answer of a fit alone, without a search: `gyrocal plant fit --json`.
//!
//! # Example
//!
//! ```no_run
//! use gyrocal_answer::{AlternativeKind, read};
//!
//! let answer = read("result.json".as_ref())?;
//! for finding in &answer.findings {
//!     let others = finding.of_kind(AlternativeKind::NotExcluded).count();
//!     println!("{}: {:.1} sigma, {others} not excluded", finding.effect, finding.z);
//! }
//! # Ok::<(), gyrocal_record::Error>(())
//! ```
//!
//! # Features
//!
//! - `schema`: the JSON Schema of the answer.
//!
//! # What it does not do
//!
//! It estimates nothing, and has no series over the rows of a record: those are with the engines.

mod allan;
mod answer;
mod audit;
mod coefficients;
mod filter;
mod finding;
mod fit;
mod gain;
mod limits;
mod magnitude;
mod next_run;
mod path;
mod read;
mod records;
mod residual_test;
mod residuals;
#[cfg(feature = "schema")]
mod schema;
mod tables;
mod written;

pub use allan::{AllanCourse, AllanPoint, AllanTest};
pub use answer::{Answer, FalseAlarmShares, RecordResult, SCHEMA_VERSION, Subject, Verdict};
pub use audit::{
    Estimated, Gaps, ModelNoise, NoiseAuditSummary, NoiseKind, NoiseLevel, RecordSummary,
    UndeclaredNoise,
};
pub use coefficients::{CoefficientEstimate, CoefficientInterval, Coefficients, SetMember};
pub use filter::FilterTest;
pub use finding::{
    Alternative, AlternativeKind, Experiment, ExperimentKind, Finding, FindingKind, Parameter,
    Separation,
};
pub use fit::{
    ComparedFit, Correlation, LaterFit, OutputFit, PlantComparison, PlantFit, SimulationError,
};
pub use gain::{
    CoefficientShift, Compensation, FreeRun, Gain, OutputError, Prediction, Validation,
};
pub use gyrocal_record::SetupProblem;
pub use limits::{
    NotTested, NotTestedReason, NullDirection, NullPart, Power, RankedEffect, SetUps, Starts,
};
pub use magnitude::MagnitudeTest;
pub use next_run::{NextRun, NextSigma, ToldApart};
pub use path::{PathError, PathStep, Refusal};
pub use read::{read, read_fit, read_platform, read_platform_text, read_text};
pub use records::{RecordSize, SizeChoice, SizesByRecord};
pub use residual_test::{
    OutputTest, ResidualCorrelation, ResidualLine, ResidualTest, ResidualVerdict,
    UnmodelledPattern, UnmodelledTerm,
};
pub use residuals::{Against, Autocorrelation, Line, Nis, Residuals};
#[cfg(feature = "schema")]
pub use schema::schema;
pub use written::{NotWritable, write_text};
