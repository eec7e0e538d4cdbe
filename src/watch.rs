//! The watch: sequential diagnosis beside the filter, on a controller as on a host.
//!
//! [`WatchedFilter`] is the filter of a controller with the test of `gyrocal-watch` beside it. The
//! effects are entries of the catalogue ([`WatchedEffect`]); how each enters rates and outputs, the
//! generated model of the catalogue says. `docs/watch.md` has the derivation.

mod courses;
mod effects;
mod filter;
mod linearised;
mod saved;
mod settings;

pub use courses::Courses;
pub use effects::{EFFECTS_BY_DEFAULT, WatchedEffect, columns};
pub use filter::{PlatformWatch, WatchedFilter, WatchedStep};
pub use gyrocal_watch::{
    Budget, Calendar, Candidate, Course, Driven, Entry, Evidence, Grid, Settings,
};
pub use linearised::Linearised;
pub use settings::WatchSettings;
