//! Experiment design: attitude and duration of the next run of a platform or of a strapdown unit.
//!
//! # What it is
//!
//! [`plan`] takes a fitted model, the causes that a diagnosis named in its record ([`NamedCause`]) and
//! [`PlanOptions`], and returns a [`PlanResult`]: next runs with the standard deviations of the
//! coefficients and the expected sizes of the confidence sets after them. [`compare`] evaluates the
//! sets on a second record that has been made.
//!
//! # The equations
//!
//! Let x be all unknowns: coefficients, errors of the site, turn-on offsets of each run, and sizes of
//! every member of the confidence sets. A run is linear in them through its design columns; with
//! J₁ the information of the record, J₂(a, T) that of a run of duration T from attitude a along the
//! trajectory that the fitted model predicts, both with the attitudes eliminated, and W the
//! inverse of the prior covariance,
//!
//! ```text
//! P(a, T) = (W + J₁ + J₂(a, T))⁻¹                                                (1)
//! ```
//!
//! holds the predicted variances. The expected size of a set is that of the confidence set of
//! [`gyrocal_hypothesis`] (its equation (6)) on both runs, averaged over draws of the next run from the
//! prediction of each member, weighted by the likelihood of the member in the record:
//!
//! ```text
//! E|S| = Σ_m w_m E_{y₂|m} |S(y₁, y₂)|                                            (2)
//! ```
//!
//! Attitudes are searched on a grid and by steps from the best of it; equation (2), or the mean ratio
//! of standard deviations, is what the search minimises (D-optimal and T-optimal designs are
//! relatives: Atkinson, Donev, Tobias, *Optimum Experimental Designs*, 2007).
//!
//! # Assumptions
//!
//! Terms of specific force, of the magnetic field and of the accelerometers are the same in the next
//! run. All other effects continue as the table of effects declares: a warm-up begins anew, a ramp and
//! a step go on, a knock and an error of the first attitude belong to their run.
//!
//! Of several records J₁ is the sum of their information, each with its attitudes, its clock and its turn-on.
//! The next run is one more of them: an effect is in it as it is in each record, and what began in one
//! record stays there. A cause that a joint diagnosis gives a size for each turn-on has another size in the
//! next run, of which only the scale over the records is known.
//!
//! Of a strapdown unit a run is a log of the unit at rest in another attitude. The platform is the one that
//! `gyrocal import strapdown` computes from it: it begins along the axes of the instruments, and turns against them
//! at Earth rate and at what the fitted model says that the gyros err by. The first attitude is known as well about
//! East, North and Up as in the last record: the level from the accelerometers, the heading as it was.
//!
//! # Features
//!
//! - `schema`: the JSON Schema of the results.
//!
//! # What it does not do
//!
//! It reads no files and plans runs on a base at rest only.

mod attitude;
mod candidates;
mod compare;
mod design_column;
mod effect_columns;
mod error;
mod evaluator;
mod expected_sets;
mod first_screen;
mod goal;
mod joint_unknowns;
mod known;
mod named_cause;
mod options;
mod past;
mod plan;
mod planner;
mod prose;
mod result;
mod run_information;
mod set_comparison;
mod shortest_run;
mod sigma;
mod walk_score;

pub use compare::{Compared, ComparedMember, compare};
pub use error::DesignError;
pub use first_screen::first_screen;
pub use goal::Goal;
pub use known::{Known, NotKnown};
pub use named_cause::{NamedCause, fitted_to_records, noise_of};
pub use options::PlanOptions;
pub use plan::plan;
pub use prose::{prose, tables};
#[cfg(feature = "schema")]
pub use result::schema;
pub use result::{
    Aim, AttitudeOf, Forecast, Outlook, PlanResult, Proposal, Reached, SCHEMA_VERSION, SetForecast,
    SetMember,
};

/// Number of drift coefficients of the nominal model.
const COEFFICIENTS: usize = gyrocal::Platform::PARAMETERS;
