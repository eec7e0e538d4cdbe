//! What only a fleet shows: coefficients over units and calendar time, causes that recur in many units below
//! what each shows by itself, batches and sites that differ.
//!
//! # What it is
//!
//! [`summarise`] takes the diagnosed records of many units, each with its name, its coefficients, its findings
//! and its scores ([`FleetRecord`]), and gives a [`FleetResult`]; [`prose`] has its sentences. What a
//! record needs to send is its result and its scores as [`to_bytes`] makes them, and not its samples.
//!
//! # The domain in brief
//!
//! A coefficient of a unit is estimated with a known error in every record. Beyond it, the coefficient
//! differs from record to record (repeatability), changes with the years (ageing) and differs from unit to
//! unit (spread). Mean, spread and their intervals are right for few units too, see `random_effects.rs`.
//!
//! A cause may be too weak for a diagnosis to find in one record and yet be in many. Its signs and onsets
//! differ from unit to unit, so that scores do not add up; `recurrence` weighs the evidence of all units
//! for some share of them having it, at each onset and in each direction. A size that is the same in all
//! units is the one case in which scores and informations simply add up.
//!
//! # Example
//!
//! ```
//! use gyrocal_fleet::{Coefficient, FleetOptions, FleetRecord, RecordName, summarise};
//!
//! # fn main() -> Result<(), gyrocal_fleet::FleetError> {
//! let record = |(index, estimate): (usize, f64)| FleetRecord {
//!     name: RecordName {
//!         unit: format!("unit-{index}"),
//!         record: "acceptance".to_owned(),
//!         ..RecordName::default()
//!     },
//!     coefficients: vec![Coefficient {
//!         name: "gyro_x.bias".to_owned(),
//!         estimate,
//!         sigma: 0.01,
//!         unit: "deg/h".to_owned(),
//!     }],
//!     causes: Vec::new(),
//!     is_settled: true,
//!     scores: None,
//! };
//! let records: Vec<FleetRecord> = [0.4, 0.5, 0.3, 0.4].into_iter().enumerate().map(record).collect();
//! let fleet = summarise(&records, &FleetOptions::default())?;
//! let mean = fleet.coefficients[0].mean.expect("four units");
//! assert!((mean.estimate - 0.4).abs() < 1e-9);
//! assert!(mean.interval[0] < 0.3 && mean.interval[1] > 0.4);
//! # Ok(())
//! # }
//! ```
//!
//! # What it does not do
//!
//! It diagnoses no record and reads no file. Jumps of the attitude and random walks are causes that units
//! show by themselves; no evidence of them is pooled. Units' dates enter their ageing alone: levels are
//! compared at the mean date of each unit's records.

mod answer;
mod course;
mod error;
mod groups;
mod level;
pub mod prose;
mod random_effects;
mod record;
pub mod recurrence;
mod score_bytes;
mod summarise;

pub use answer::{
    FleetCoefficient, FleetResult, FoundCause, Group, GroupAlternative, GroupFinding, GroupKind,
    LikelyUnit, OutlierUnit, RecordProblem, RecurringCause, SCHEMA_VERSION, UnitLevel,
    WithInterval,
};
pub use error::FleetError;

pub use gyrocal_answer::CoefficientEstimate as Coefficient;
pub use record::{FleetRecord, RecordName};
pub use score_bytes::{from_bytes, to_bytes};
pub use summarise::{FleetOptions, summarise};
