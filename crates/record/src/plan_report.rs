//! The JSON result of `gyrocal plan`.

use serde::{Deserialize, Serialize};

use crate::manifest::Manifest;

/// Which next run says most, given the records so far.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PlanReport {
    /// [`crate::SCHEMA_VERSION`] at the time of writing.
    pub schema_version: u32,
    /// Where the result comes from.
    pub manifest: Manifest,
    /// What proposals are ranked by.
    pub aim: PlanAim,
    /// What the record so far leaves.
    pub now: OutlookReport,
    /// What going on in the present attitude would leave, for each duration.
    pub going_on: Vec<ProposalReport>,
    /// Next runs, for each duration the best first.
    pub proposals: Vec<ProposalReport>,
    /// The run that reaches the wished goal; `None` if none was wished for.
    pub goal: Option<GoalReport>,
    /// Effects that no run tells apart, the named one first.
    pub inseparable: Vec<Vec<String>>,
}

/// What proposals are ranked by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum PlanAim {
    /// By what is left of the named sets, then by the sigmas of the coefficients.
    Set,
    /// By the sigmas of the coefficients.
    Sigmas,
}

/// A next run and what it would leave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProposalReport {
    /// Platform angles about x, then y, then z at its first row; `None` if the record goes on.
    pub initial_angles_deg: Option<[f64; 3]>,
    /// How long it takes \[s\].
    pub duration_s: f64,
    /// What record and run leave together.
    pub outlook: OutlookReport,
}

/// What records leave.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OutlookReport {
    /// Geometric mean over the nine coefficients of sigma over that of the record so far.
    pub sigma_ratio: f64,
    /// Standard deviations of the coefficients, with what was found in the model.
    pub coefficients: Vec<SigmaReport>,
    /// Standard deviations of the sizes of what was found.
    pub sizes: Vec<SigmaReport>,
    /// The named sets.
    pub sets: Vec<SetReport>,
}

/// A standard deviation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SigmaReport {
    /// Id of a coefficient, or of an effect with the name of its parameter: `gyro_y.g_z size`.
    pub name: String,
    /// The standard deviation, in `unit`.
    pub sigma: f64,
    /// The unit.
    pub unit: String,
}

/// A named set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SetReport {
    /// The effect that is named now.
    pub effect: String,
    /// How many members are left on average, effects that no run tells apart counted as one.
    pub mean_size: f64,
    /// Probability that one is left.
    pub one_left: f64,
    /// All members, the named one first.
    pub members: Vec<SetMemberReport>,
}

/// A member of a named set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SetMemberReport {
    /// Its id.
    pub effect: String,
    /// Effects that no run tells from it.
    pub equivalents: Vec<String>,
    /// Probability that it and the named one do not both stay in the set; 1 of the named one.
    pub told_apart: f64,
}

/// The run that reaches a goal.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct GoalReport {
    /// The goal in words.
    pub wish: String,
    /// The shortest run that was found to reach it; `None` if none does.
    pub run: Option<ProposalReport>,
    /// The longest run that was looked at \[s\].
    pub longest_s: f64,
}
