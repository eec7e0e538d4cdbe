//! What a fleet shows, as plain data.

use gyrocal_record::Manifest;
use serde::{Deserialize, Serialize};

/// Version of the JSON contract; it rises when a key changes its meaning or goes away.
pub const SCHEMA_VERSION: u32 = 1;

/// What a fleet shows and no record by itself. What does not apply is `None`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FleetResult {
    /// Version of this contract.
    pub schema_version: u32,
    /// Program and model that made the result.
    pub manifest: Manifest,
    /// Number of units.
    pub units: usize,
    /// Number of records that are in the answer.
    pub records: usize,
    /// Records whose causes are not settled: the search was cut, or what the named effects leave is not white.
    pub not_settled: usize,
    /// Records that are left out, and why.
    pub problems: Vec<RecordProblem>,
    /// False discovery rate of `recurring`.
    pub false_discovery_rate: f64,
    /// Family-wise probability that a fleet without differences shows a batch or site that differs.
    pub group_probability: f64,
    /// Family-wise probability that a coefficient of a fleet without outliers shows one.
    pub outlier_probability: f64,
    /// Each coefficient over the units.
    pub coefficients: Vec<FleetCoefficient>,
    /// Batches and sites that differ.
    pub groups: Vec<GroupFinding>,
    /// Causes that recur below what the units show by themselves.
    pub recurring: Vec<RecurringCause>,
    /// Causes that units show by themselves.
    pub found_in_units: Vec<FoundCause>,
}

/// A record that is left out.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RecordProblem {
    /// The unit.
    pub unit: String,
    /// The record.
    pub record: String,
    /// What is wrong.
    pub problem: String,
}

/// A quantity with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WithInterval {
    /// The estimate.
    pub estimate: f64,
    /// Its 95 % interval.
    pub interval: [f64; 2],
}

/// A drift coefficient over the units of a fleet.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FleetCoefficient {
    /// Its id.
    pub name: String,
    /// The unit of all values.
    pub unit: String,
    /// Mean over the units, of those outside of batches and sites that differ; `None` with one unit.
    pub mean: Option<WithInterval>,
    /// Standard deviation of the units about it, without the errors of their estimates.
    pub spread: Option<WithInterval>,
    /// Standard deviation from record to record of a unit, beyond the errors of its estimates; `None` if no
    /// unit has records to spare.
    pub repeatability: Option<WithInterval>,
    /// Mean change in a year; `None` without units that have records at enough dates.
    pub ageing: Option<WithInterval>,
    /// Standard deviation of the units' changes in a year.
    pub ageing_spread: Option<WithInterval>,
    /// Units whose level lies outside of the others', the farthest first.
    pub outliers: Vec<OutlierUnit>,
    /// Units whose change in a year lies outside of the others'.
    pub ageing_outliers: Vec<OutlierUnit>,
    /// The coefficient of each unit.
    pub levels: Vec<UnitLevel>,
}

/// A unit outside of the others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OutlierUnit {
    /// The unit.
    pub unit: String,
    /// Its estimate.
    pub estimate: f64,
    /// Its distance from the mean of the others, in their standard deviations with the error of its estimate.
    pub t: f64,
    /// P-value of the distance, for all units together.
    pub p_value: f64,
}

/// A coefficient of one unit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UnitLevel {
    /// The unit.
    pub unit: String,
    /// Mean over its records.
    pub estimate: f64,
    /// Standard deviation, with that from record to record.
    pub sigma: f64,
    /// Change in a year.
    pub slope: Option<f64>,
    /// Standard deviation of the change.
    pub slope_sigma: Option<f64>,
}

/// Kind of a group of units.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum GroupKind {
    /// Units that were made together.
    Batch,
    /// Units that were recorded at one place.
    Site,
}

/// A group of units.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Group {
    /// Its kind.
    pub kind: GroupKind,
    /// Its name.
    pub name: String,
}

/// A batch or site that differs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroupFinding {
    /// The group.
    pub group: Group,
    /// Its units.
    pub units: usize,
    /// The coefficient.
    pub coefficient: String,
    /// Unit of the offset.
    pub unit: String,
    /// Offset from the other units.
    pub offset: WithInterval,
    /// Family-wise p-value, for all coefficients, batches and sites together.
    pub p_value: f64,
    /// Groups that explain the offset as well, the likeliest first: the fleet does not tell them apart.
    pub alternatives: Vec<GroupAlternative>,
}

/// Another explanation of an offset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroupAlternative {
    /// The group.
    pub group: Group,
    /// Its units.
    pub units: usize,
    /// Units that are in both.
    pub shared: usize,
}

/// A cause that recurs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RecurringCause {
    /// Id of the effect.
    pub effect: String,
    /// Natural logarithm of its evidence, an e-value.
    pub ln_evidence: f64,
    /// P-value of the evidence.
    pub p_value: f64,
    /// Whether the evidence alone keeps the false discovery rate, whatever the dependence of the tests.
    pub by_e_value: bool,
    /// Share of the units that have it.
    pub share: f64,
    /// Strength in them, standard deviations of a unit's own estimate.
    pub strength: f64,
    /// Whether one size in all units explains it better than sizes of their own.
    pub is_common: bool,
    /// Mean size over all units, of an effect of one size.
    pub size: Option<f64>,
    /// Its standard deviation.
    pub size_sigma: Option<f64>,
    /// Unit of the size.
    pub unit: String,
    /// Units that are likely to have it, the likeliest first.
    pub units: Vec<LikelyUnit>,
    /// Effects that the fleet does not tell from it.
    pub alternatives: Vec<String>,
}

/// A unit that is likely to have a cause.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LikelyUnit {
    /// The unit.
    pub unit: String,
    /// Probability that it has it, given that some have.
    pub probability: f64,
}

/// A cause that units show by themselves.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FoundCause {
    /// Id of the effect.
    pub effect: String,
    /// The units, by name.
    pub units: Vec<String>,
}
