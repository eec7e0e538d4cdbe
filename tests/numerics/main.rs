//! Numerical accuracy of the filter: against extended precision, over a year, from badly scaled
//! priors, near gimbal lock, with a poisoned workspace.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod accuracy;
mod definiteness;
mod extension;
mod gimbal_lock;
mod poisoning;
mod truth;
