//! The answer of a diagnosis.

use gyrocal_record::{Input, Manifest, SetupProblem};
use serde::{Deserialize, Serialize};

use crate::{
    AllanTest, Coefficients, Estimated, FilterTest, Finding, FindingKind, Gain, MagnitudeTest,
    ModelNoise, NextRun, NoiseAuditSummary, NoiseLevel, NotTested, NotTestedReason, NullDirection,
    OutputError, PathStep, Power, RankedEffect, RecordSummary, ResidualTest, ResidualVerdict,
    Residuals, SetUps, Starts, UndeclaredNoise,
};

/// Version of the JSON contract of a diagnosis; it rises when a key changes its meaning or goes
/// away.
pub const SCHEMA_VERSION: u32 = 3;

/// The answer of a diagnosis. What does not apply, or what a record is too short for, is `None` or empty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Answer {
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
    /// What the coefficients and the effects are of.
    pub subject: Subject,
    /// Size of the later record, if one was given.
    pub later_record: Option<RecordSummary>,
    /// The answer in one word.
    pub verdict: Verdict,
    /// Family-wise probability of any finding on a record of the nominal model with the declared
    /// noise.
    pub false_alarm_probability: f64,
    /// Part of it that each test may spend; `None` of a plant, of which the search is the only test.
    pub false_alarm_shares: Option<FalseAlarmShares>,
    /// Gross errors of the set-up. One that stops the diagnosis makes the verdict `setup`.
    pub setup: Vec<SetupProblem>,
    /// Test of the magnitude of specific force, which no gyro and no attitude enters; it makes no
    /// finding. `None` with too few complete rows.
    pub norm: Option<MagnitudeTest>,
    /// Residuals of the nominal model; they make no finding.
    pub residuals: Option<Residuals>,
    /// Detected effects: noise first, then causes in falling strength, then the filter.
    pub findings: Vec<Finding>,
    /// The coefficients with and without the accepted effects: of a plant its parameters, and the initial
    /// states of a record that is alone; `None` without a fit.
    pub coefficients: Option<Coefficients>,
    /// Errors of simulations of a plant's outputs.
    pub open_loop: Vec<OutputError>,
    /// Time over which these go on \[s\]; `None` of a platform.
    pub horizon_s: Option<f64>,
    /// Gain of the extended model over the nominal one; `None` without a cause.
    pub gain: Option<Gain>,
    /// Test of the residuals with all causes in the model.
    pub remainder: ResidualTest,
    /// Set-ups that fit as well as the declared one; `None` if there are none.
    pub set_ups: Option<SetUps>,
    /// Inputs of a plant that never move.
    pub still_inputs: Vec<String>,
    /// Directions that the record does not determine.
    pub undetermined: Vec<NullDirection>,
    /// Starts of the fit of a plant; `None` of a platform.
    pub starts: Option<Starts>,
    /// All hypotheses of the first search, largest statistic first.
    pub ranking: Vec<RankedEffect>,
    /// Detection threshold of the largest statistic of `ranking`; `None` if nothing was searched.
    pub threshold: Option<f64>,
    /// Power of the search for each effect of `ranking` at its typical size.
    pub power: Vec<Power>,
    /// Maximum-likelihood noise over the declared noise, with all causes in the model; none without a fit.
    pub noise: Vec<NoiseLevel>,
    /// Noise that a plant does not declare, with all findings in the model; none of a platform.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub undeclared_noise: Vec<UndeclaredNoise>,
    /// Effects of a plant that a search in white noise named, and that are not detected beside that noise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub only_in_white_noise: Vec<String>,
    /// The way from the nominal model of a plant to that with all findings, with the errors of both in parts of the
    /// record that were left out of the fit. Empty where what is left is white: the likelihood then judges alone.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub path: Vec<PathStep>,
    /// Noise of the model that the coefficients are of; `None` without a fit, and of a plant.
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
    pub search_complete: bool,
    /// Consistency test of another filter, if one was asked for.
    pub filter: Option<FilterTest>,
    /// What runs that could be made next would tell, the one that tells most first.
    pub next_runs: Vec<NextRun>,
}

/// One of several records that were diagnosed together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RecordResult {
    /// Its name: that of its file.
    pub name: String,
    /// Size of the record.
    pub record: RecordSummary,
    /// Offsets of the constant drifts of its turn-on from those of the mean turn-on \[deg/h\], by axis;
    /// `None` where the bench files do not declare that turn-ons differ.
    pub turn_on_deg_per_h: Option<[Estimated; 3]>,
    /// Its initial states, of a plant.
    pub initial: Option<Coefficients>,
    /// Errors of simulations of its outputs with the models of all records, of a plant.
    pub open_loop: Vec<OutputError>,
    /// The answer of this record alone; `None` if it determines too little for one.
    pub alone: Option<Answer>,
    /// Why it has none; empty if it has.
    pub why_not_alone: String,
}

/// What an answer is of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Subject {
    /// An inertially stabilised platform.
    Platform,
    /// A platform that was computed from a strapdown unit: coefficients and effects are those of instruments
    /// that are fixed to a body, in their own axes.
    Strapdown,
    /// A plant of this name.
    Plant(String),
}

impl Answer {
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

    /// Whether it is of a strapdown unit.
    #[must_use]
    pub fn is_strapdown(&self) -> bool {
        self.subject == Subject::Strapdown
    }

    /// Whether the search came to its end, and what the named effects leave is white: names and what is excluded
    /// hold only then.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        self.verdict != Verdict::NotSettled
    }

    /// Whether something is found that the model lacks, in the catalogue or outside of it.
    #[must_use]
    pub fn has_findings(&self) -> bool {
        !(self.findings.is_empty() && self.remainder.unmodelled.is_empty())
    }

    /// The verdict that findings, residual test and search lead to. Names are settled only if the search ended by
    /// itself, and if what they leave is white.
    #[must_use]
    pub fn judged(
        findings: &[Finding],
        remainder: &ResidualTest,
        search_complete: bool,
    ) -> Verdict {
        let is_unexplained = remainder.verdict == ResidualVerdict::Unexplained;
        match (findings.is_empty(), is_unexplained, search_complete) {
            (_, _, false) | (false, true, true) => Verdict::NotSettled,
            (true, true, true) => Verdict::Unexplained,
            (false, false, true) => Verdict::EffectsFound,
            (true, false, true) => Verdict::Clean,
        }
    }

    /// Files of the axes of the instruments, one for each record, if it is of a strapdown unit. That of a later
    /// record may follow, and other inputs.
    #[must_use]
    pub fn axes_inputs(&self) -> &[Input] {
        if !self.is_strapdown() {
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

/// A diagnosis in one word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// No model mismatch was detected.
    Clean,
    /// At least one effect was detected, effects of noise and filter among them, and nothing contradicts the
    /// model with it.
    EffectsFound,
    /// The residuals are not white, and no effect of the catalogue explains them.
    Unexplained,
    /// Names are not settled: the search ended at its budget of work, or what the named effects leave is not
    /// white.
    NotSettled,
    /// A gross error of the set-up stopped the diagnosis.
    Setup,
}

impl Verdict {
    /// Its word in the JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Clean => "clean",
            Self::EffectsFound => "effects-found",
            Self::Unexplained => "unexplained",
            Self::NotSettled => "not-settled",
            Self::Setup => "setup",
        }
    }
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
    pub random_walk: f64,
    /// Test of the residuals, and search for terms that the catalogue does not hold.
    pub residual_test: f64,
    /// Magnitude test of specific force, which makes no finding and is not part of the sum.
    pub magnitude_test: f64,
    /// Allan test, which makes no finding and is not part of the sum.
    pub allan_test: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Finding;

    #[test]
    fn names_are_settled_by_a_whole_search_and_a_white_rest_alone() {
        let finding = Finding {
            effect: "gyro_x.ramp".to_owned(),
            name: String::new(),
            kind: FindingKind::Cause,
            parameters: Vec::new(),
            z: 9.0,
            p_value: None,
            coverage: None,
            alternatives: Vec::new(),
            separations: Vec::new(),
            none_of_these: None,
            none_of_these_log_likelihood_ratio: None,
            by_record: None,
            in_record: None,
            formula: None,
            gain_nats: None,
            accepted: None,
        };
        let judged = |findings: &[Finding], verdict, search_complete| {
            let remainder = ResidualTest {
                verdict,
                p_value: None,
                description: String::new(),
                line: None,
                correlation: None,
                outputs: Vec::new(),
                unmodelled: Vec::new(),
            };
            Answer::judged(findings, &remainder, search_complete)
        };
        use ResidualVerdict::{NotTested, Unexplained, White};
        let named = [finding];
        assert_eq!(judged(&[], White, true), Verdict::Clean);
        assert_eq!(judged(&[], NotTested, true), Verdict::Clean);
        assert_eq!(judged(&[], Unexplained, true), Verdict::Unexplained);
        assert_eq!(judged(&named, White, true), Verdict::EffectsFound);
        assert_eq!(judged(&named, Unexplained, true), Verdict::NotSettled);
        for findings in [&named[..], &[]] {
            for verdict in [White, NotTested, Unexplained] {
                assert_eq!(judged(findings, verdict, false), Verdict::NotSettled);
            }
        }
    }
}
