//! The uncertainty of calibrated records: the budget of each coefficient as plain data, with the conditions
//! of the test and the scatter over runs.

mod contribution;

use gyrocal_calibration::{
    ModelEstimate, Options, Run, Spread, UncertaintyBudget, calibrate_with_budget, spread,
};
use gyrocal_record::{Bench, Manifest, Record};
use serde::{Deserialize, Serialize};

use crate::diagnose::Diagnosis;
use crate::error::DiagnosisError;
use contribution::finite;
pub use contribution::{ContributionLine, EvaluationType};
use gyrocal_answer::{Answer, SetMember};

/// Version of the JSON contract of an uncertainty budget; it rises when a key changes its meaning or goes
/// away.
pub const UNCERTAINTY_SCHEMA_VERSION: u32 = 1;

/// Probability that an expanded uncertainty holds.
const COVERAGE: f64 = 0.95;

/// Terms of the drift law of each gyro, in the order of the coefficients: letters of IEEE Std 517.
const TERMS: [&str; 3] = ["D_F", "D_I", "D_II"];

/// What a report of a laboratory says beyond this one.
pub const NOT_STATED: &str = "Only a laboratory certifies. The texts of IEEE Std 517 and 1293 are not at hand: \
    no conformity to their layout, test conditions or number of runs is claimed.";

/// Uncertainty budgets of the calibrations of one platform.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct UncertaintyResult {
    /// Version of this contract.
    pub schema_version: u32,
    /// Program, inputs and command that made the result.
    pub manifest: Manifest,
    /// The records, each a run.
    pub records: Vec<RecordUncertainty>,
    /// Scatter over the runs; `None` of one.
    pub spread: Option<RunSpread>,
    /// What this result does not state.
    pub not_stated: String,
}

impl UncertaintyResult {
    /// Budgets of the runs of one platform, and their scatter.
    #[must_use]
    pub fn new(manifest: Manifest, runs: Vec<(RecordUncertainty, UncertaintyBudget)>) -> Self {
        let (records, budgets): (Vec<_>, Vec<_>) = runs.into_iter().unzip();
        Self {
            schema_version: UNCERTAINTY_SCHEMA_VERSION,
            manifest,
            records,
            spread: spread(&budgets).map(RunSpread::from),
            not_stated: NOT_STATED.to_owned(),
        }
    }
}

/// Uncertainty of the coefficients by one record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RecordUncertainty {
    /// The record.
    pub name: String,
    /// Conditions of the test.
    pub conditions: TestConditions,
    /// Models that the record leaves open, the likeliest first; one is no choice.
    pub models: Vec<OpenModel>,
    /// Number of accelerometer values used.
    pub accelerometer_values: usize,
    /// Mean normalised innovation squared of a value; 1 is expected.
    pub nis_of_value: f64,
    /// The coefficients.
    pub coefficients: Vec<CoefficientUncertainty>,
}

/// Conditions of a test, as bench and record state them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct TestConditions {
    /// The bench description.
    pub bench: String,
    /// Astronomic latitude, deg.
    pub latitude_deg: f64,
    /// Specific force at rest, in the unit of the record.
    pub specific_force_at_rest_g: f64,
    /// Declared angles of the platform at the first row, deg; `None` where they are unknown.
    pub initial_angles_deg: Option<[f64; 3]>,
    /// Length of the record, h.
    pub duration_h: f64,
    /// Number of rows.
    pub rows: usize,
    /// Declared noise of a sample of an accelerometer, g.
    pub accel_noise_g: f64,
    /// Declared noise of the gyros as held over a minute, deg/h.
    pub gyro_noise_deg_per_h: f64,
    /// Least and largest temperature logged, °C; `None` without a log.
    pub temperature_c: Option<[f64; 2]>,
}

impl TestConditions {
    fn new(bench_name: &str, bench: &Bench, record: &Record) -> Self {
        let logged = record.temperature_c.as_ref().map(|all| {
            let ends = [f64::INFINITY, f64::NEG_INFINITY];
            let wider = |[low, high]: [f64; 2], one: &f64| [low.min(*one), high.max(*one)];
            all.iter().fold(ends, wider)
        });
        Self {
            bench: bench_name.to_owned(),
            latitude_deg: bench.latitude_deg,
            specific_force_at_rest_g: bench.specific_force_at_rest(),
            initial_angles_deg: bench.initial_angles_deg,
            duration_h: record.duration_s() / 3600.0,
            rows: record.len(),
            accel_noise_g: bench.accel_noise_g,
            gyro_noise_deg_per_h: bench.gyro_noise_deg_per_h,
            temperature_c: logged.filter(|[low, high]| low <= high),
        }
    }
}

/// A model that a record leaves open.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct OpenModel {
    /// Its effects; none of the nominal model.
    pub effects: Vec<String>,
    /// Its share of the likelihood of all.
    pub weight: f64,
}

/// The budget of one coefficient.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CoefficientUncertainty {
    /// Id of the coefficient.
    pub name: String,
    /// Its letter in IEEE Std 517: `D_F`, `D_I`, `D_II`.
    pub term: String,
    /// Unit of estimate, contributions and uncertainties.
    pub unit: String,
    /// The estimate, in `unit`.
    pub estimate: f64,
    /// Contributions, those of zero included.
    pub contributions: Vec<ContributionLine>,
    /// Combined standard uncertainty, in `unit`.
    pub combined: f64,
    /// Effective degrees of freedom by Welch and Satterthwaite; `None` if nothing limits them.
    pub effective_degrees_of_freedom: Option<f64>,
    /// Coverage factor.
    pub coverage_factor: f64,
    /// Expanded uncertainty: coverage factor times combined standard uncertainty, in `unit`.
    pub expanded: f64,
    /// Probability that the expanded uncertainty is not exceeded.
    pub coverage_probability: f64,
}

/// Scatter of the coefficients over runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RunSpread {
    /// Number of runs.
    pub runs: usize,
    /// The coefficients.
    pub coefficients: Vec<CoefficientScatter>,
}

impl From<Spread> for RunSpread {
    fn from(found: Spread) -> Self {
        let all = found.coefficients.into_iter().enumerate();
        Self {
            runs: found.runs,
            coefficients: all
                .map(|(index, one)| CoefficientScatter {
                    name: one.id.to_owned(),
                    term: TERMS[index % TERMS.len()].to_owned(),
                    unit: one.unit.to_owned(),
                    mean: one.mean,
                    standard_deviation: one.standard_deviation,
                    expected: one.expected,
                    p_value: one.p_value,
                    is_larger: one.is_larger,
                })
                .collect(),
        }
    }
}

/// Scatter of one coefficient over runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CoefficientScatter {
    /// Id of the coefficient.
    pub name: String,
    /// Its letter in IEEE Std 517.
    pub term: String,
    /// Unit of mean and deviations.
    pub unit: String,
    /// Mean of the estimates.
    pub mean: f64,
    /// Standard deviation between runs.
    pub standard_deviation: f64,
    /// Standard deviation between runs that the uncertainties make one expect.
    pub expected: f64,
    /// Probability of so large a scatter where those uncertainties are its only reason.
    pub p_value: f64,
    /// The scatter is larger than those uncertainties explain.
    pub is_larger: bool,
}

impl CoefficientScatter {
    /// The answer of the test in words.
    #[must_use]
    pub fn answer(&self) -> &'static str {
        match self.is_larger {
            true => "larger",
            false => "consistent",
        }
    }
}

/// The uncertainty of the coefficients by a diagnosed record. Without an accepted effect it is that of the
/// calibration with the nominal model; else that of the mean over the models that the record leaves open.
///
/// # Errors
/// [`DiagnosisError::Calibration`].
pub fn record_uncertainty(
    [name, bench_name]: [&str; 2],
    diagnosis: &Diagnosis<'_>,
    bench: &Bench,
    options: &Options,
) -> Result<(RecordUncertainty, UncertaintyBudget), DiagnosisError> {
    let record: &Record = &diagnosis.record;
    let budget = match &diagnosis.extended {
        Some(extended) => {
            let members = members(&diagnosis.result);
            let models: Vec<ModelEstimate> = members.iter().map(estimate).collect();
            extended.uncertainty_budget()?.over_models(&models)
        }
        None => {
            let bench: &Bench = &diagnosis.bench;
            calibrate_with_budget(&[Run { record, bench }], options)?.1
        }
    };
    let found = RecordUncertainty {
        name: name.to_owned(),
        conditions: TestConditions::new(bench_name, bench, record),
        models: open_models(diagnosis),
        accelerometer_values: budget.values,
        nis_of_value: budget.nis_of_value,
        coefficients: lines(&budget),
    };
    Ok((found, budget))
}

fn members(result: &Answer) -> &[SetMember] {
    result
        .coefficients
        .as_ref()
        .map_or(&[], |found| &found.members)
}

fn estimate(member: &SetMember) -> ModelEstimate {
    let all = member.coefficients.iter();
    ModelEstimate {
        weight: member.weight,
        coefficients: all.map(|one| [one.estimate, one.sigma]).collect(),
    }
}

fn open_models(diagnosis: &Diagnosis<'_>) -> Vec<OpenModel> {
    let members = members(&diagnosis.result);
    if diagnosis.extended.is_some() && !members.is_empty() {
        let all = members.iter().map(|member| OpenModel {
            effects: member.effects.clone(),
            weight: member.weight,
        });
        return all.collect();
    }
    let causes = diagnosis
        .result
        .causes()
        .filter(|_| diagnosis.extended.is_some());
    vec![OpenModel {
        effects: causes.map(|cause| cause.effect.clone()).collect(),
        weight: 1.0,
    }]
}

fn lines(budget: &UncertaintyBudget) -> Vec<CoefficientUncertainty> {
    let all = budget.coefficients.iter().enumerate();
    all.map(|(index, one)| CoefficientUncertainty {
        name: one.id.to_owned(),
        term: TERMS[index % TERMS.len()].to_owned(),
        unit: one.unit.to_owned(),
        estimate: one.estimate,
        contributions: one
            .contributions
            .iter()
            .map(ContributionLine::from)
            .collect(),
        combined: one.combined,
        effective_degrees_of_freedom: finite(one.degrees_of_freedom),
        coverage_factor: one.coverage_factor,
        expanded: one.expanded(),
        coverage_probability: COVERAGE,
    })
    .collect()
}

/// Contributions of a coefficient by their sources: those of one source, such as the priors of all
/// coefficients, are one. Source, type, distribution, contribution.
#[must_use]
pub fn by_source(one: &CoefficientUncertainty) -> Vec<(&str, EvaluationType, &str, f64)> {
    let mut sources: Vec<(&str, EvaluationType, &str, f64)> = Vec::new();
    for line in &one.contributions {
        let mut found = sources.iter_mut();
        match found.find(|(source, ..)| *source == line.source) {
            Some((.., sum)) => *sum = sum.hypot(line.contribution),
            None => sources.push((
                &line.source,
                line.evaluation,
                &line.distribution,
                line.contribution,
            )),
        }
    }
    sources
}

/// JSON Schema (draft 2020-12) of a written [`UncertaintyResult`].
#[cfg(feature = "schema")]
#[must_use]
pub fn uncertainty_schema() -> schemars::Schema {
    schemars::generate::SchemaSettings::draft2020_12()
        .for_serialize()
        .into_generator()
        .into_root_schema_for::<UncertaintyResult>()
}
