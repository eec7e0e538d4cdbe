//! The noise audit: tests of the declared noise, before the search for physical effects.
//!
//! It uses features that no slow physical effect changes: the values themselves (quantisation),
//! single samples against their neighbours (outliers), and the spectrum on time scales below an
//! hour (variance and correlation of the accelerometer noise). The noise of the gyros, a random
//! walk there, is a free nuisance parameter.

mod audit;
mod block;
mod decision;
mod finding;
pub(crate) mod lattice;
mod likelihood;
mod open_loop;
mod outlier;
mod readings;
mod spectrum;

pub use audit::{AuditOptions, DeclaredNoise, audit_noise};
pub use finding::{Cleaned, Estimate, NoiseAudit, NoiseFinding, Shares};
pub use outlier::Outlier;

pub(crate) use audit::gaps;
pub(crate) use open_loop::runs;
