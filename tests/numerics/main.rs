//! Numerical accuracy of the filter: against extended precision, over a year, from badly scaled
//! priors, near gimbal lock, with a poisoned workspace.
#![cfg(test)]

mod accuracy;
mod definiteness;
mod extension;
mod gimbal_lock;
mod poisoning;
mod truth;
