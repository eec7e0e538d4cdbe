//! Causes: which effects of the catalogue a record shows, and which it cannot tell apart.
//!
//! # How it works
//!
//! Every effect has a *signature*: what a small amount of it does to the whitened innovations of
//! the fitted model. All signatures come from one pass over the record (`bank`), with what the
//! fit would take up of them projected out, so an effect is judged by what the nine coefficients
//! and the initial attitude cannot imitate. Effects whose onset or time constant is unknown are
//! *families* of signatures; those with several parameters are judged jointly.
//!
//! The search has one probability of a false alarm for all families together: what the largest
//! of these correlated statistics exceeds under the nominal model is found by drawing from their
//! joint distribution (`null`). Families are compared after subtracting what each would reach
//! by searching alone. An effect that is found is put into the model, which is fitted again, and
//! the search goes on (`forward`). At its end names are compared once more, each beside all others
//! (`settle`).

mod bank;
mod bound;
mod curve;
mod family;
mod finding;
mod forward;
mod knock;
mod line;
mod null;
mod refine;
mod score;
mod search;
mod settle;
mod unnamed;
mod walk;

pub(crate) use bound::bounds;
pub use bound::information;
pub use family::{Candidate, Family, Plan, Unavailable};
pub(crate) use family::{extend, jump, missing, parameter, warm_up};
pub(crate) use finding::SET_CONSTANT;
pub use finding::{Finding, FoundParameter, Rival};
pub(crate) use null::DETECTION_PENALTY_FRACTION;
pub(crate) use score::RICHER;
pub use score::Ranked;
pub use search::{SearchOptions, Searched, search};
pub use unnamed::{Channel, Pattern, Unnamed};
pub(crate) use walk::Walk;
