//! The answer of a diagnosis, as data.

use serde::Serialize;

use crate::identifiability::NullDirection;
use crate::starts::Starts;

/// A 95 % interval.
pub type Interval95 = [f64; 2];

/// The answer of a diagnosis.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Diagnosis {
    /// Name of the plant.
    pub plant: String,
    /// Rows of the record.
    pub rows: usize,
    /// Its duration, s.
    pub duration_s: f64,
    /// Effects that were tested.
    pub tested: usize,
    /// Probability that anything of the catalogue is found in a record without effects.
    pub false_alarm_probability: f64,
    /// Statistic from which on an effect is detected in the first search.
    pub threshold: f64,
    /// Statistics of the first search, the largest first.
    pub ranking: Vec<RankedEffect>,
    /// Inputs that never move.
    pub still_inputs: Vec<String>,
    /// Starts of the fit.
    pub starts: Starts,
    /// What the record does not determine.
    pub undetermined: Vec<NullDirection>,
    /// Detected effects with their sets.
    pub findings: Vec<Found>,
    /// Detected terms that no effect of the catalogue explains.
    pub unexplained: Vec<Unexplained>,
    /// Effects of the catalogue that the record cannot show.
    pub left_out: Vec<LeftOut>,
    /// Parameters, and the initial states of a record that is alone.
    pub parameters: Vec<Estimate>,
    /// The records, if there are several.
    pub records: Vec<RecordAnswer>,
    /// Estimated noise.
    pub noise: Vec<NoiseLevel>,
    /// Errors of simulations of this record.
    pub errors: Vec<OutputError>,
    /// Horizon of these simulations, s.
    pub horizon_s: f64,
    /// What is left.
    pub remainder: Vec<Remainder>,
    /// Gain within the records; `None` where nothing was found.
    pub cross_validation: Option<CrossValidation>,
    /// Gain on a later record.
    pub later_record: Option<Comparison>,
    /// Runs that could be made next, the one that tells most first.
    pub next_runs: Vec<NextRun>,
}

/// The statistic of an effect.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RankedEffect {
    /// Id of the effect.
    pub effect: String,
    /// Chi-square of its score, less the penalty of its search.
    pub statistic: f64,
}

/// One of several records.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RecordAnswer {
    /// Its name.
    pub name: String,
    /// Its rows.
    pub rows: usize,
    /// Its duration, s.
    pub duration_s: f64,
    /// Its initial states.
    pub initial: Vec<Estimate>,
    /// Errors of simulations of it with the models of all records.
    pub errors: Vec<OutputError>,
    /// The diagnosis of it alone.
    pub alone: Alone,
}

/// The diagnosis of a record alone.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Alone {
    /// Its verdict, a sentence; the reason if it cannot be diagnosed alone.
    pub verdict: String,
    /// Detected effects with their sets.
    pub findings: Vec<Found>,
}

/// A detected effect.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Found {
    /// The record in which a sudden change happens, from one, if there are several.
    pub record: Option<usize>,
    /// Id of the effect that is named.
    pub effect: String,
    /// Its meaning.
    pub name: String,
    /// Its term.
    pub formula: String,
    /// Its size, and its onset if it has one.
    pub sizes: Vec<Size>,
    /// Its size in standard deviations.
    pub z: f64,
    /// Family-wise p-value.
    pub p_value: f64,
    /// The other effects of the set with what their log-likelihood lacks, nats.
    pub rivals: Vec<(String, f64)>,
    /// Effects that no record tells from it.
    pub equivalents: Vec<String>,
    /// Probability that nothing of the catalogue is the cause.
    pub none_of_these: Option<f64>,
}

/// An estimated parameter of an effect.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Size {
    /// `size` or `onset_s`.
    pub name: String,
    /// The estimate.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: Option<f64>,
    /// 95 % interval of an onset, in pieces.
    pub interval: Option<Vec<Interval95>>,
    /// Unit.
    pub unit: String,
}

/// A detected term outside of the catalogue.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Unexplained {
    /// The rate, output or parameter.
    pub channel: String,
    /// Its form.
    pub form: String,
    /// Its size.
    pub size: f64,
    /// Unit of the size.
    pub unit: String,
    /// Natural logarithm of its p-value.
    pub ln_p_value: f64,
}

/// An effect that was not tested.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LeftOut {
    /// Its id.
    pub effect: String,
    /// The reason.
    pub why: String,
}

/// An estimated parameter or initial state.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Estimate {
    /// Its name.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Declared value.
    pub declared: f64,
    /// Estimate of the nominal model.
    pub nominal: f64,
    /// Standard deviation of that estimate.
    pub nominal_sigma: f64,
    /// Estimate of the model with all findings.
    pub value: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

/// An estimated noise.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NoiseLevel {
    /// The output or rate.
    pub of: String,
    /// Standard deviation over the declared one.
    pub ratio: f64,
    /// Its 95 % interval.
    pub interval: Interval95,
}

/// Root mean square error of an output in simulations.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OutputError {
    /// The output.
    pub output: String,
    /// Unit.
    pub unit: String,
    /// With the nominal model.
    pub nominal: f64,
    /// With all findings.
    pub extended: f64,
}

/// Test of what the extended model leaves of an output.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Remainder {
    /// The output.
    pub output: String,
    /// p-value of white innovations.
    pub p_value: f64,
}

/// Gain of what was found in parts of the record that are predicted from the others; of several records each is
/// a part.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CrossValidation {
    /// Logarithm of the density of each part with the findings over that without; `None` of a part without which
    /// the others do not determine the findings.
    pub gains_nats: Vec<Option<f64>>,
}

/// What a run that has not been made would tell.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NextRun {
    /// Its name.
    pub name: String,
    /// Its rows.
    pub rows: usize,
    /// Its duration, s.
    pub duration_s: f64,
    /// Standard deviations of parameters and sizes.
    pub sigmas: Vec<NextSigma>,
    /// Named effects beside the rivals of their sets.
    pub told_apart: Vec<ToldApart>,
}

/// A standard deviation before and after a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NextSigma {
    /// The parameter, or the effect with the name of its size.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// From the records.
    pub now: f64,
    /// From the records and the run.
    pub after: f64,
}

/// A named effect and a rival before and after a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ToldApart {
    /// The named effect.
    pub effect: String,
    /// The rival.
    pub rival: String,
    /// What the rival leaves of the named effect at its size, in standard deviations, from the records.
    pub now: f64,
    /// The same from the records and the run.
    pub after: f64,
    /// Probability that the rival leaves the set with the run, if the named effect is the cause.
    pub probability: f64,
}

/// Both models on a later record, with the parameters of the first.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Comparison {
    /// Rows of the later record.
    pub rows: usize,
    /// Logarithm of the density of the record with the findings over that without.
    pub gain_nats: f64,
    /// Horizon of the simulations, s.
    pub horizon_s: f64,
    /// Errors of the simulations.
    pub errors: Vec<OutputError>,
}
