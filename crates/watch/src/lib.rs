//! A sequential test for named effects beside a running Kalman filter.
//!
//! # What it is
//!
//! A filter whose model is right has innovations that are independent and of unit variance. An effect
//! that the model lacks shifts them along a known course, its *signature*. [`Watch`] carries the
//! signatures of a table of effects through the closed loop of the filter, for onsets that begin anew
//! all the time, and tests each with an e-process: a number that begins at one, and whose mean stays
//! one for as long as the model is right. Their weighted sum bounds false alarms over any stretch of
//! time. The derivation is in `docs/watch.md`.
//!
//! Any weights that do not depend on the innovation they are multiplied with keep that bound. So the
//! signatures may be approximate, which costs power only.
//!
//! Nothing here allocates, panics or needs the standard library, and nothing knows of gyros.
//!
//! # Glossary
//!
//! | letter | meaning |
//! |---|---|
//! | N, M, Y | states, moving states, outputs |
//! | D | columns for what is no unit of a state: slopes, and what enters outputs |
//! | E | effects |
//! | O | onsets that live at a time |
//! | Φ, H, K | transition, output Jacobian and gain of the filter |
//! | X, W | deviation of the filter's state, and of its whitened innovation, for each column |
//! | δ, I, S | deviation, information and score of an onset and an effect |
//! | E | value of an e-process |
//!
//! # Parts
//!
//! [`Signatures`] and [`Jumps`] depend on the filter alone, [`Scores`] and [`JumpScores`] on its
//! innovations. [`Watch`] has one of each. A simulation of many platforms that differ by their noise
//! has one of the former and many of the latter.

#![no_std]
#![expect(
    clippy::needless_range_loop,
    reason = "loops over several matrices by one index read like the equations"
)]

mod block;
mod calendar;
mod evidence;
mod jumps;
mod scores;
mod signatures;
mod step;
mod table;
mod watch;

pub use calendar::Calendar;
pub use evidence::{Budget, Evidence, least_of_set};
pub use jumps::{JumpCell, JumpScores, Jumps};
pub use scores::Scores;
pub use signatures::{Cell, Direction, Signatures};
pub use step::{Observed, Step, Whitened};
pub use table::{Course, Driven, Entry, Value};
pub use watch::{Candidate, Counters, Grid, Settings, Watch};
