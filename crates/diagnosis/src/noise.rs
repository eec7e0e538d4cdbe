//! The noise audit: is the noise as declared, and if not, in what way.
//!
//! It comes before any physical cause is looked for, and works on what no physical cause reaches:
//! the values themselves, single samples against their neighbours, and cosines within an hour.

mod audit;
mod block;
mod decision;
mod finding;
mod lattice;
mod likelihood;
mod open_loop;
mod outlier;
mod spectrum;

pub use audit::{AuditOptions, DeclaredNoise, audit_noise};
pub use finding::{Cleaned, Estimate, Gaps, NoiseAudit, NoiseFinding, Shares};
pub use outlier::Outlier;

pub(crate) use open_loop::{median_interval_s, runs};
