//! Diagnosis of a record against its model: detection, identification and gain of model errors.
//!
//! # What it is
//!
//! [`diagnose`] takes a record and its bench description, and returns a [`Diagnosis`]: the answer
//! ([`gyrocal_answer::Answer`], plain data that is also the JSON contract) with the fits behind it.
//!
//! 0. *Set-up* ([`gyrocal_setup`]): gross errors of record and bench description, before any fit. What
//!    can be mended is left out; one that leaves nothing sound ends the diagnosis.
//! 1. *Noise audit* ([`audit_noise`]): quantisation, outliers, variance and correlation of the
//!    accelerometer noise on time scales below an hour.
//! 2. *Search* (`gyrocal_hypothesis`): score tests of all effects of the catalogue, one family-wise error rate,
//!    one accepted effect after the other, each with a confidence set of alternatives and its exact
//!    equivalents.
//! 3. *Validation*: blocked cross-validation decides which effects are in the extended model;
//!    [`Diagnosis::validate`] predicts a later record.
//! 4. *Residual test*: whiteness of the innovations, lines and curves outside the catalogue.
//!
//! The [`magnitude_test`] and the residuals of the nominal model are reported beside these and make
//! no finding. `gyrocal_design` designs the next run, [`error_budget`] lists all false-alarm shares and
//! decision constants; `gyrocal-words` makes the sentences of an answer from the result alone.
//!
//! # The statistics in brief
//!
//! Letters are those of `docs/glossary.md`; `docs/method.md` has all equations, and code refers to
//! them by number. The fit leaves whitened innovations r and their derivatives C by the parameters
//! (signatures), n for the nuisance parameters of the fitted model, t for those of a hypothesis:
//!
//! ```text
//! s = −Cᵀ r,   J = Cᵀ C                                     score, Fisher information      (3)
//! s_t·n = s_t − J_tn J_nn⁻¹ s_n                             projection                     (4)
//! J_t·n = J_tt − J_tn J_nn⁻¹ J_nt                                                          (5)
//! l = s_t·nᵀ J_t·n⁻¹ s_t·n   ~ χ²_k without the effect      score test                     (6)
//! l_h = max_v l_h,v                                         over onsets or time constants  (9)
//! c_h = Q_0.99(l_h) − χ²_1;0.99                             search penalty                (12)
//! M = max_h (l_h − 0.6 c_h) > T,   P_0(M > T) = α_s         detection: maximum statistic  (13)
//! m_h = l_h − c_h                                           ranking                       (14)
//! {h : m_h* − m_h < 3.5}                                    confidence set of the cause   (15)
//! ```
//!
//! The null distribution P_0 of all statistics together is drawn from the joint normal distribution
//! of the scores.
//!
//! # Example
//!
//! ```no_run
//! use gyrocal_answer::Verdict;
//! use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
//! use gyrocal_record::{Bench, Record};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let record = Record::read("record.csv".as_ref())?;
//! let bench = Bench::read("bench.toml".as_ref())?;
//! let diagnosis = diagnose(&record, &bench, &DiagnoseOptions::default())?;
//! if diagnosis.result.verdict != Verdict::Clean {
//!     for finding in &diagnosis.result.findings {
//!         println!("{}: {:.1} sigma", finding.effect, finding.z);
//!     }
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # Features
//!
//! - `schema`: the JSON Schemas of results.
//!
//! # What it does not do
//!
//! It reads no records and prints nothing; [`gyrocal_answer::read`] reads a written answer. It tests effects
//! of the catalogue, sinusoids and functions of specific force, on a static base only.

mod blocks;
mod calibration_report;
mod calibration_verdict;
mod diagnose;
mod distinguishability;
mod error;
pub mod error_budget;
mod extension;
mod filter_test;
mod gate;
mod magnitude;
mod magnitude_test;
mod noise;
mod open_loop;
mod plot_data;
mod power;
mod request;
mod residual_test;
mod residuals;
mod series;
pub mod set_coverage;
mod stage;
mod uncertainty;
mod untested;
mod validation;
mod watch;

pub use blocks::Blocks;
pub use calibration_report::{
    CalibratedRecord, CalibrationRequest, CalibrationStep, calibrate_and_diagnose,
};
pub use diagnose::{
    DiagnoseOptions, Diagnosis, RecordToDiagnose, RecordsDiagnosis, diagnose, diagnose_gated,
    diagnose_records, diagnose_together, diagnose_watched, fit_effects, manifest, predict_later,
    problems_of, record_summary, records_summary,
};
pub use error::DiagnosisError;
pub use extension::{
    ExtensionError, ModelExtension, extension_by, extension_of, known_effects, with_members,
};
pub use filter_test::{FILTER_EFFECT, TestedFilter};
pub use gate::Gate;
pub use magnitude::{MagnitudeChannel, magnitude_channel};
pub use magnitude_test::{MagnitudeTest, magnitude_test};
pub use noise::{
    AuditOptions, Cleaned, DeclaredNoise, Estimate, NoiseAudit, NoiseFinding, Outlier, Shares,
    audit_noise,
};
pub use open_loop::OpenLoopSimulation;
pub use plot_data::{ChannelCorrelation, ChannelSpectrum, ModelVersion};
pub use request::{missing_input, selection};

pub use series::Innovations;
pub use stage::Stage;
#[cfg(feature = "schema")]
pub use uncertainty::uncertainty_schema;
pub use uncertainty::{
    CoefficientScatter, CoefficientUncertainty, ContributionLine, EvaluationType, NOT_STATED,
    OpenModel, RecordUncertainty, RunSpread, TestConditions, UNCERTAINTY_SCHEMA_VERSION,
    UncertaintyResult, by_source, record_uncertainty,
};
pub use validation::{AttitudeErrors, LaterPrediction};
pub use watch::{WatchAlarm, WatchCause, WatchOptions, WatchReplay, WatchResult, watch_record};

/// Number of drift coefficients of the nominal model.
const COEFFICIENTS: usize = gyrocal::Platform::PARAMETERS;
