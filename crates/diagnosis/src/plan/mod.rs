//! Which next run says most, given a record and what was found in it.
//!
//! # How it works
//!
//! A record leaves information on the coefficients and on the sizes of all effects in question.
//! What another run from some attitude would add is the information of that run along the
//! trajectory that the fitted model foretells, its own attitude eliminated; turn-ons differ by
//! what the bench declares. The sum gives the standard deviations to come. Whether the members of a
//! named set will be told apart follows from the same sums: the next run is drawn many times from
//! what each member, if it is the cause, predicts, and the members are compared on both runs
//! by the rule that made the set.
//!
//! # What is taken for granted
//!
//! What goes with specific force, the field or an accelerometer is the same in the next run. A
//! warm-up comes again with every switching on, a diurnal drift at the same time of day; a ramp and
//! a step go on from where the record ends; a knock and a wrong first attitude belong to their run.

mod attitude;
mod compare;
mod evaluate;
mod expected;
mod goal;
mod named;
mod options;
mod piece;
mod present;
mod proposal;
mod prose;
mod result;
mod said;
mod set;
mod sigma;
mod signature;
mod universe;

pub use compare::{Compared, ComparedMember, compare};
pub use goal::Goal;
pub use named::{Named, noise_of};
pub use options::PlanOptions;
pub use proposal::plan;
pub use prose::prose;
#[cfg(feature = "schema")]
pub use result::schema;
pub use result::{
    Aim, Forecast, Outlook, PlanResult, Proposal, Reached, SCHEMA_VERSION, SetForecast, SetMember,
};
