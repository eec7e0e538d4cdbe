//! Detected effects.

use serde::{Deserialize, Serialize};

use crate::SizesByRecord;

/// One detected effect: estimates, significance, and all that it may also be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Finding {
    /// Id of the effect; of exact equivalents the first of the catalogue.
    pub effect: String,
    /// Its physical name.
    pub name: String,
    /// Test that detected it.
    pub kind: FindingKind,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// Its statistic in standard deviations; negative where noise is smaller than declared.
    pub z: f64,
    /// Family-wise p-value: probability of as large a statistic anywhere in the search by chance. `None` where it
    /// was not computed for the final model, the one that `z` is of.
    pub p_value: Option<f64>,
    /// Coverage of the confidence set: share of sets that held the cause, as measured of causes of that kind
    /// (of a set with several kinds the least). `None` where it was not measured: of findings below seven
    /// sigma, of noise, of random walks, of a filter and of a plant.
    pub coverage: Option<f64>,
    /// All effects that it may also be: its exact equivalents, the other members of the confidence set, nearest
    /// first, and effects that look like it in this record and were not searched.
    pub alternatives: Vec<Alternative>,
    /// What would tell it from its alternatives, for each kind of them.
    pub separations: Vec<Separation>,
    /// Probability that a cause outside of the catalogue leaves eight standard deviations or more beside
    /// what is named, at prior odds of one to one; `None` where it was not estimated.
    pub none_of_these: Option<f64>,
    /// Natural logarithm of the likelihood of such a cause over that of the named effect and its set
    /// \[nats\]; `None` where it was not estimated.
    pub none_of_these_log_likelihood_ratio: Option<f64>,
    /// Sizes in each of several records; `None` of one record, of noise, and of an effect that lies in one
    /// record by its nature.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by_record: Option<SizesByRecord>,
    /// The record in which a sudden change happens, from one, if there are several; `None` of others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub in_record: Option<usize>,
    /// Its term in the equations of a plant; `None` of a platform.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub formula: Option<String>,
    /// Gain in the log score of cross-validation with the effect in the model, given the other
    /// causes \[nats\]; `None` of noise and of a filter, and where it was not judged: of a plant, and of one of
    /// many causes of a record that takes too much work.
    pub gain_nats: Option<f64>,
    /// Whether it is in the extended model: whether that gain is positive, or was not judged. `None` of noise and of a
    /// filter.
    pub accepted: Option<bool>,
}

/// Test that detected an effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum FindingKind {
    /// The noise audit, or the likelihood of the gyro noise.
    Noise,
    /// The search over the catalogue: a term of the model, or a random walk of a drift.
    Cause,
    /// The consistency test of a filter.
    Filter,
}

/// One parameter of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Parameter {
    /// Its name: `size`, `onset_s`, `time_constant_h`, `sine`, `cosine`, `ratio`, `fraction`, ….
    pub name: String,
    /// The estimate, in `unit`.
    pub estimate: f64,
    /// Its standard deviation; `None` where the likelihood is not quadratic, as of the size of a
    /// random walk and of the onset of an attitude jump.
    pub sigma: Option<f64>,
    /// 95 % interval of an onset, of a time constant or of the size of a random walk: ranges, as its
    /// profile may be in pieces. `None` of other parameters, and where it was not computed.
    pub interval: Option<Vec<[f64; 2]>>,
    /// The unit; `1` of plain numbers.
    pub unit: String,
}

/// An effect that a finding may also be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Alternative {
    /// Id of the effect.
    pub effect: String,
    /// How it stands to the finding.
    pub kind: AlternativeKind,
    /// Log-likelihood of the named effect less that of this one \[nats\], after both are penalised for their
    /// searches, and an effect in which the named one is nested for its freedom; never negative. Where what is left of
    /// a plant is correlated from row to row, it is that of as many independent rows as these are worth. Zero of an
    /// exact equivalent, `None` of an effect that was not searched.
    pub log_likelihood_deficit: Option<f64>,
    /// Values that the parameters of an exact equivalent would have to have; empty of others, and where they were
    /// not computed.
    pub parameters: Vec<Parameter>,
}

/// How an alternative stands to the finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum AlternativeKind {
    /// Exact equivalent: the same samples in any record.
    ExactEquivalent,
    /// Member of the confidence set: the search did not exclude it.
    NotExcluded,
    /// Not separable in this record, and not searched.
    NotSearched,
}

/// What would tell a finding from its alternatives of one kind.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Separation {
    /// The kind.
    pub from: AlternativeKind,
    /// Why this record does not tell them apart.
    pub why: String,
    /// Alternatives that `--effects` can add to the search.
    pub testable: Vec<String>,
    /// Experiments that would.
    pub experiments: Vec<Experiment>,
    /// The experiments in words.
    pub words: String,
}

/// An experiment that distinguishes effects.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Experiment {
    /// The kind of experiment.
    pub kind: ExperimentKind,
    /// Quantity to control, change or measure, or what to do; `None` where the kind says it all.
    pub what: Option<String>,
}

/// Kind of an experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ExperimentKind {
    /// A second run from another initial attitude.
    OtherAttitude,
    /// A second run from another initial attitude, or started at another time of day.
    OtherStart,
    /// An independent measurement of the attitude at the first row.
    MeasureAttitude,
    /// A run with a logged quantity held or stepped on purpose.
    ControlRegressor,
    /// A run with an input changed on purpose.
    ChangeInput,
    /// An independent measurement of something of the site.
    MeasureInput,
    /// A run that starts long after switching on.
    StartLate,
    /// An experiment in words.
    Other,
}

impl Finding {
    /// The parameter of a name.
    #[must_use]
    pub fn parameter(&self, name: &str) -> Option<&Parameter> {
        let mut all = self.parameters.iter();
        all.find(|parameter| parameter.name == name)
    }

    /// Its alternatives of one kind.
    pub fn of_kind(&self, kind: AlternativeKind) -> impl Iterator<Item = &Alternative> {
        let all = self.alternatives.iter();
        all.filter(move |other| other.kind == kind)
    }

    /// Ids of its confidence set, the named effect first.
    pub fn set(&self) -> impl Iterator<Item = &str> {
        let others = self.of_kind(AlternativeKind::NotExcluded);
        core::iter::once(&*self.effect).chain(others.map(|other| &*other.effect))
    }

    /// Ids of its exact equivalents.
    pub fn equivalents(&self) -> impl Iterator<Item = &str> {
        let all = self.of_kind(AlternativeKind::ExactEquivalent);
        all.map(|other| &*other.effect)
    }
}
