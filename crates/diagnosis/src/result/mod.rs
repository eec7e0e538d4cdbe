//! The answer of a diagnosis as plain data, which is also its JSON contract.
//!
//! [`DiagnosisResult`] holds all that a user is told. It is what `gyrocal diagnose --json` writes,
//! key by key, what [`read`] reads back, and all that [`crate::prose`] makes sentences from. Keys of
//! one schema version keep their meaning; a version may gain keys. With the feature `schema` every
//! type has its JSON Schema (feature `schema`); `docs/schema/diagnosis.schema.json` is the committed copy.
//!
//! Series over the rows of a record, which pictures need in addition, are fields of
//! [`crate::Diagnosis`].

mod allan;
mod audit;
mod coefficients;
mod filter;
mod finding;
mod gain;
mod limits;
mod magnitude;
mod read;
mod records;
mod residual_test;
mod residuals;
#[cfg(feature = "schema")]
mod schema;
mod tables;

pub use gyrocal_record::SetupProblem;
use gyrocal_record::{Input, Manifest, NoiseReport};
use serde::{Deserialize, Serialize};

pub use allan::{AllanCourse, AllanPoint, AllanTest};
pub use audit::{Estimated, Gaps, ModelNoise, NoiseAuditSummary, RecordSummary};
pub use coefficients::{CoefficientEstimate, CoefficientInterval, Coefficients, SetMember};
pub use filter::FilterTest;
pub use finding::{Alternative, Equivalent, Finding, FindingKind, Parameter};
pub use gain::{CoefficientShift, Compensation, FreeRun, Gain, Prediction, Validation};
pub use limits::{
    Experiment, ExperimentKind, Indistinguishable, NotTested, NotTestedReason, Power, RankedEffect,
    Relation,
};
pub use magnitude::MagnitudeTest;
pub use read::{read, read_text};
pub use records::{RecordResult, RecordSize, SizeChoice, SizesByRecord};
pub use residual_test::{
    ResidualCorrelation, ResidualLine, ResidualTest, ResidualVerdict, UnmodelledPattern,
    UnmodelledTerm,
};
pub use residuals::{Against, Autocorrelation, Line, Nis, Residuals};
#[cfg(feature = "schema")]
pub use schema::schema;

/// Version of the JSON contract of a diagnosis; it rises when a key changes its meaning or goes
/// away.
pub const SCHEMA_VERSION: u32 = 2;

/// The answer of a diagnosis. What does not apply, or what a record is too short for, is `None`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DiagnosisResult {
    /// Version of this contract.
    pub schema_version: u32,
    /// Program, inputs and command that made the result: record and bench file first, then the
    /// later record and its bench file.
    pub manifest: Manifest,
    /// Size of the record; of several records that of all together.
    pub record: RecordSummary,
    /// The records, if several were diagnosed together; rows and times of this answer then are on one clock,
    /// on which each record follows the one before.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub records: Vec<RecordResult>,
    /// Whether coefficients and effects are those of gyros and accelerometers that are fixed to a body, in
    /// their own axes: of a platform that was computed from a strapdown unit.
    #[serde(default, skip_serializing_if = "is_false")]
    pub strapdown: bool,
    /// Size of the later record, if one was given.
    pub later_record: Option<RecordSummary>,
    /// The answer in one word.
    pub verdict: Verdict,
    /// Family-wise probability of any finding on a record of the nominal model with the declared
    /// noise.
    pub false_alarm_probability: f64,
    /// Part of it that each test may spend.
    pub false_alarm_shares: FalseAlarmShares,
    /// Gross errors of the set-up. One that stops the diagnosis makes the verdict `setup`.
    pub setup: Vec<SetupProblem>,
    /// Test of the magnitude of specific force, which no gyro and no attitude enters; it makes no
    /// finding. `None` with too few complete rows.
    pub norm: Option<MagnitudeTest>,
    /// Residuals of the nominal model; they make no finding.
    pub residuals: Option<Residuals>,
    /// Detected effects: noise first, then causes in falling strength, then the filter.
    pub findings: Vec<Finding>,
    /// The drift coefficients with and without the accepted effects; `None` without a fit.
    pub coefficients: Option<Coefficients>,
    /// Gain of the extended model over the nominal one; `None` without a cause.
    pub gain: Option<Gain>,
    /// Test of the residuals with all causes in the model.
    pub remainder: ResidualTest,
    /// Groups of effects that this record does not distinguish.
    pub cannot_tell: Vec<Indistinguishable>,
    /// All hypotheses of the first search, largest statistic first.
    pub ranking: Vec<RankedEffect>,
    /// Detection threshold of the largest statistic of `ranking`; `None` if nothing was searched.
    pub threshold: Option<f64>,
    /// Power of the search for each effect of `ranking` at its typical size.
    pub power: Vec<Power>,
    /// Maximum-likelihood noise over the declared noise, with all causes in the model; `None`
    /// without a fit.
    pub noise: Option<NoiseReport>,
    /// Noise of the model that the coefficients are of; `None` without a fit.
    #[serde(default)]
    pub model_noise: Option<ModelNoise>,
    /// Noise audit of the accelerometers; `None` without a fit.
    pub noise_audit: Option<NoiseAuditSummary>,
    /// Allan deviation of the innovations with all causes in the model; it makes no finding.
    /// `None` without a stretch of equally spaced rows that is long enough.
    pub allan: Option<AllanTest>,
    /// Effects that were not tested, and those that so short a record could not show.
    pub not_searched: Vec<NotTested>,
    /// Whether the search ended by itself, and not at its budget of work: then there may be more in the
    /// record than the findings, and effects that they were not compared with.
    #[serde(default = "is_complete")]
    pub search_complete: bool,
    /// Consistency test of another filter, if one was asked for.
    pub filter: Option<FilterTest>,
}

fn is_false(value: &bool) -> bool {
    !*value
}

/// Searches of earlier versions had no budget.
fn is_complete() -> bool {
    true
}

impl DiagnosisResult {
    /// Findings of one kind.
    pub fn of_kind(&self, kind: FindingKind) -> impl Iterator<Item = &Finding> {
        let findings = self.findings.iter();
        findings.filter(move |finding| finding.kind == kind)
    }

    /// Effects that would go undetected at their typical size.
    #[must_use]
    pub fn low_power(&self) -> Vec<&str> {
        let low = self.not_searched.iter();
        low.filter(|effect| effect.reason == NotTestedReason::LowPower)
            .map(|effect| &*effect.effect)
            .collect()
    }

    /// Whether most effects would: that nothing was found then says little.
    #[must_use]
    pub fn hides_most(&self) -> bool {
        2 * self.low_power().len() > self.ranking.len()
    }

    /// Causes: findings of the search.
    pub fn causes(&self) -> impl Iterator<Item = &Finding> {
        self.of_kind(FindingKind::Cause)
    }

    /// Files of the axes of the instruments, one for each record, if it is of a strapdown unit. That of a later
    /// record may follow, and other inputs.
    #[must_use]
    pub fn axes_inputs(&self) -> &[Input] {
        if !self.strapdown {
            return &[];
        }
        // They follow the pairs of record and bench, of which a later record is the last.
        let pairs = self.records.len().max(1) + usize::from(self.later_record.is_some());
        self.manifest.inputs.get(2 * pairs..).unwrap_or_default()
    }

    /// Whether the residual test failed.
    #[must_use]
    pub fn is_unexplained(&self) -> bool {
        self.remainder.verdict == ResidualVerdict::Unexplained
    }
}

impl Finding {
    /// The parameter of a name.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<&Parameter> {
        self.parameters
            .iter()
            .find(|parameter| parameter.name == name)
    }

    /// Ids of its confidence set, the named effect first.
    pub fn set(&self) -> impl Iterator<Item = &str> {
        let others = self.alternatives.iter().map(|other| &*other.effect);
        core::iter::once(&*self.effect).chain(others)
    }
}

/// A diagnosis in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Verdict {
    /// No model mismatch was detected.
    Clean,
    /// At least one effect was detected; effects of noise and filter count.
    EffectsFound,
    /// The residuals are not white, and no effect of the catalogue explains them; or the search ended at its
    /// budget with nothing named (`search_complete` is false).
    Unexplained,
    /// A gross error of the set-up stopped the diagnosis.
    Setup,
}

/// Probabilities of a false alarm that the tests of one diagnosis may spend.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FalseAlarmShares {
    /// Noise audit of the accelerometers.
    pub noise_audit: f64,
    /// Noise of the gyros over the declared one.
    pub gyro_noise: f64,
    /// Search over the effects of the catalogue.
    pub search: f64,
    /// Random walks of the gyros.
    #[serde(default)]
    pub random_walk: f64,
    /// Test of the residuals, and search for terms that the catalogue does not hold.
    pub residual_test: f64,
    /// Magnitude test of specific force, which makes no finding and is not part of the sum.
    pub magnitude_test: f64,
    /// Allan test, which makes no finding and is not part of the sum.
    pub allan_test: f64,
}
