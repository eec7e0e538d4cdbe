//! What a calibrated record says against its model.
//!
//! # What it is
//!
//! Statistics of residuals and an audit of the noise, as pure functions of plain data: a record
//! ([`gyrocal_record::Record`]) and the [`Innovations`] that a filter made of it.
//!
//! - [`residuals`]: the usual tests of innovations, by `gyrocal-statistics`.
//! - [`magnitude_channel`]: |E|², which sees accelerometer errors only, without any filter;
//!   [`magnitude_test`] says which side it speaks for.
//! - [`audit_noise`]: is the noise as declared? Robust, with one false-alarm probability for all.
//!
//! # The audit
//!
//! Physical causes are slow: hours and days. The audit looks at what is fast, so that neither
//! takes the other for itself: at the values themselves (a lattice is the converter's), at
//! samples against their neighbours (outliers), and at the spectrum within an hour (variance,
//! correlation). It undoes the filter's feedback first, so that the noise of a sample stands at
//! that sample alone. The gyros' noise, a random walk there, is left free and blamed on nobody.
//!
//! # What it does not do
//!
//! It runs no filter, reads and writes no files and prints nothing.

pub mod cause;
mod continuation;
mod diagnose;
mod distinguishability;
mod error;
pub mod error_budget;
mod filter_test;
mod gain;
mod magnitude;
mod magnitude_test;
mod noise;
pub mod plan;
mod power;
pub mod prose;
mod request;
mod residual_test;
mod residuals;
pub mod result;
mod series;
mod untested;

pub use diagnose::{DiagnoseOptions, Diagnosis, diagnose, predict_later};
pub use error::DiagnosisError;
pub use filter_test::{FILTER_EFFECT, TestedFilter};
pub use gain::{AttitudeErrors, LaterPrediction};
pub use magnitude::{MagnitudeChannel, magnitude_channel};
pub use magnitude_test::{MagnitudeTest, magnitude_test};
pub use noise::{
    AuditOptions, Cleaned, DeclaredNoise, Estimate, NoiseAudit, NoiseFinding, Outlier, Shares,
    audit_noise,
};
pub use result::{DiagnosisResult, Verdict};
pub use series::Innovations;

/// Number of drift coefficients of the nominal model.
const COEFFICIENTS: usize = gyrocal::Platform::PARAMETERS;
