//! The answer of a plan as plain data, which is also its JSON contract.

use std::borrow::Cow;

use gyrocal_record::{Manifest, SetupProblem};
use serde::{Deserialize, Serialize};

use gyrocal_answer::RecordSummary;

/// Version of the JSON contract of a plan.
pub const SCHEMA_VERSION: u32 = 1;

/// Public id of an effect or coefficient, or a unit.
type Id = Cow<'static, str>;

/// The answer of a plan. What does not apply is `None`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct PlanResult {
    /// Version of this contract.
    pub schema_version: u32,
    /// Program, inputs and command that made the result.
    pub manifest: Manifest,
    /// Size of the record so far; of several records that of all together.
    pub record: RecordSummary,
    /// Sizes of the records, if the run is planned from several, in the order of the inputs.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub records: Vec<RecordSummary>,
    /// Gross errors of its set-up that were mended.
    #[serde(default)]
    pub setup: Vec<SetupProblem>,
    /// The body that the angles of the runs are of.
    #[serde(default)]
    pub attitude_of: AttitudeOf,
    /// Criterion that proposals are ranked by.
    pub aim: Aim,
    /// Forecast from the record so far.
    pub now: Outlook,
    /// Forecasts for continuing in the present attitude, one for each duration.
    pub going_on: Vec<Proposal>,
    /// Next runs, for each duration the best first.
    pub proposals: Vec<Proposal>,
    /// The run that reaches the wished goal; `None` if none was wished for.
    pub goal: Option<Reached>,
    /// Exact equivalents among the effects in question, which no run distinguishes; the reported
    /// one first.
    pub inseparable: Vec<Vec<Id>>,
}

/// The body whose attitude is planned. Its angles against local east, north, up are rotations about x, then y, then
/// z.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum AttitudeOf {
    /// The stabilised platform, at the first row: the Earth turns under it from there on.
    #[default]
    Platform,
    /// The axes of the instruments of a strapdown unit, which rests on the Earth for the whole run. The platform that
    /// is computed from its log begins along them.
    Unit,
}

/// Criterion that proposals are ranked by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Aim {
    /// Expected size of the confidence sets, then the standard deviations.
    Set,
    /// The standard deviations of the nine coefficients: their geometric mean.
    Sigmas,
}

/// A next run and its forecast.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Proposal {
    /// Angles about x, then y, then z at its first row \[deg\], of [`PlanResult::attitude_of`]; `None` if the
    /// record continues.
    #[serde(rename = "initial_angles_deg")]
    pub angles_deg: Option<[f64; 3]>,
    /// Its duration \[s\].
    pub duration_s: f64,
    /// Forecast from record and run together.
    pub outlook: Outlook,
}

/// Forecast of standard deviations and confidence sets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Outlook {
    /// Geometric mean over the nine coefficients of sigma over that of the record so far.
    pub sigma_ratio: f64,
    /// Standard deviations of the nine coefficients, with the reported effects in the model.
    pub coefficients: Vec<Forecast>,
    /// Standard deviations of the sizes of the reported effects.
    pub sizes: Vec<Forecast>,
    /// The confidence sets.
    pub sets: Vec<SetForecast>,
}

/// A standard deviation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Forecast {
    /// Id of a coefficient, or of an effect with the name of its parameter: `gyro_y.g_z size`.
    pub name: Id,
    /// The standard deviation, in `unit`.
    pub sigma: f64,
    /// The unit.
    pub unit: Id,
}

/// Forecast of a confidence set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SetForecast {
    /// The effect that is reported now.
    pub effect: Id,
    /// Mean number of members that stay, exact equivalents counted as one.
    pub mean_size: f64,
    /// Probability that one stays.
    pub one_left: f64,
    /// All members, the reported one first.
    pub members: Vec<SetMember>,
}

/// A member of a confidence set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SetMember {
    /// Id of the effect.
    pub effect: Id,
    /// Its exact equivalents.
    pub equivalents: Vec<Id>,
    /// Probability that it and the reported one do not both stay in the set, whichever of the two
    /// is the cause; 1 of the reported one.
    pub told_apart: f64,
}

/// The run that reaches a goal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Reached {
    /// The goal in words.
    pub wish: String,
    /// Whether the record so far reaches it.
    pub already: bool,
    /// The shortest run that was found to reach it; `None` if none is needed or none does.
    pub run: Option<Proposal>,
    /// The longest run that was looked at \[s\].
    pub longest_s: f64,
}

impl Outlook {
    /// Members that are left on average beyond one for each set.
    #[must_use]
    pub fn surplus(&self) -> f64 {
        self.sets.iter().map(|set| set.mean_size - 1.0).sum()
    }

    /// The worse of two forecasts in each of their figures; `before` are the standard deviations of the
    /// coefficients so far.
    pub(crate) fn worse(mut self, other: Self, before: &[Forecast]) -> Self {
        let own = self.coefficients.iter_mut().chain(&mut self.sizes);
        for (own, other) in own.zip(other.coefficients.iter().chain(&other.sizes)) {
            own.sigma = own.sigma.max(other.sigma);
        }
        for (own, other) in self.sets.iter_mut().zip(other.sets) {
            if other.mean_size > own.mean_size {
                *own = other;
            }
        }
        self.sigma_ratio = ratio(&self.coefficients, before);
        self
    }
}

/// Geometric mean of ratios.
pub(crate) fn ratio(after: &[Forecast], before: &[Forecast]) -> f64 {
    let logarithms = after
        .iter()
        .zip(before)
        .map(|(after, before)| (after.sigma / before.sigma).ln());
    (logarithms.sum::<f64>() / before.len() as f64).exp()
}

/// JSON Schema (draft 2020-12) of a written [`PlanResult`].
#[cfg(feature = "schema")]
#[must_use]
pub fn schema() -> schemars::Schema {
    gyrocal_record::written_schema::<PlanResult>()
}
