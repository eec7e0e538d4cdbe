//! skeleton
mod course;
mod error;
mod random_effects;
