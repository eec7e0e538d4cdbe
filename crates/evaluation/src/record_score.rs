//! Score of one record: a line in the file of results.

use serde::{Deserialize, Serialize};

use crate::baseline::BaselineResult;
use crate::catalogue::same_or_equivalent;
use crate::coefficient_score::CoefficientScore;

/// Two signatures are of one class if the cosine of the angle between them is at least this.
pub const SAME_CLASS_COSINE: f64 = 0.9;

/// Injected effects and findings of one record.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct RecordScore {
    /// Injected effects.
    pub hidden: Vec<InjectedScore>,
    /// `clean`, `effects-found`, `unexplained`, `not-settled` or `setup`.
    pub verdict: String,
    /// Findings of the diagnosis, strongest first.
    pub findings: Vec<FindingScore>,
    /// Effects of noise that the diagnosis found.
    pub noise: Vec<String>,
    /// Description of the unexplained residuals; `None` if the residuals are white.
    pub unexplained: Option<String>,
    /// Size of the first confidence set if the noise is known; `None` without a finding.
    pub oracle_set_size: Option<usize>,
    /// Whether a set of a search that knows that no rate walks holds the effect; `None` where it was not made.
    pub oracle_in_set: Option<bool>,
    /// Hypotheses next to the best in the first search, each with twice its log-likelihood deficit,
    /// search penalties included; without exact equivalents of the best and of each other.
    pub nearest: Vec<(String, f64)>,
    /// Drift coefficients of the diagnosis against the true ones; `None` where they were not compared.
    pub coefficients: Option<CoefficientScore>,
    /// Log score that the extended model gains in cross-validation, nats; `None` without one.
    pub gain_nats: Option<f64>,
    /// Results of the baseline methods.
    pub methods: Vec<BaselineScore>,
}

/// An injected effect and its recovery.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct InjectedScore {
    /// Id of the effect.
    pub effect: String,
    /// Strength in sigmas of its own bound; of an effect that is not in the catalogue, given the
    /// findings.
    pub strength: f64,
    /// `true` if the confidence set of some finding contains it.
    pub in_set: bool,
    /// Closeness of the first finding: 1 for this effect or an exact equivalent, else the cosine of
    /// the angle between the two signatures; 0 without a finding.
    pub first_cosine: f64,
    /// `true` if the 95 % intervals of the sizes cover the true ones; `None` if the effect was not
    /// found.
    pub covered: Option<bool>,
    /// Error of the onset over the duration of the record; `None` if the effect was not found.
    pub onset_error: Option<f64>,
    /// Twice its log-likelihood deficit to the best hypothesis of the first search.
    pub deficit: Option<f64>,
}

/// A finding of the diagnosis.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct FindingScore {
    /// Id of the effect.
    pub effect: String,
    /// All other members of the confidence set.
    pub alternatives: Vec<String>,
    /// `true` if the effect has exact equivalents and the finding lists none.
    pub lacks_equivalents: bool,
    /// Probability that the cause is not in the catalogue; `None` if the search was cut.
    pub none_of_these: Option<f64>,
    /// Log score that it gains in cross-validation, nats; `None` where that was not asked for.
    pub gain_nats: Option<f64>,
    /// Whether the extended model has it; `None` where there was no cross-validation.
    pub accepted: Option<bool>,
}

/// Result of a baseline method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BaselineScore {
    /// Name of the method.
    pub method: String,
    /// Its result.
    pub result: BaselineResult,
    /// As [`InjectedScore::first_cosine`], of the first injected effect.
    pub first_cosine: f64,
    /// Drift coefficients of the model with the selected effects, those of the nominal model for a test;
    /// `None` if the record does not determine them.
    pub coefficients: Option<CoefficientScore>,
}

impl RecordScore {
    /// `true` if the diagnosis has a finding.
    #[must_use]
    pub fn detected(&self) -> bool {
        !self.findings.is_empty()
    }

    /// Size of the first confidence set, exact equivalents not counted; 0 without a finding.
    #[must_use]
    pub fn set_size(&self) -> usize {
        self.findings
            .first()
            .map_or(0, |finding| 1 + finding.alternatives.len())
    }

    /// `true` if the diagnosis says that its findings are not the whole answer: the remainder is unexplained,
    /// or a cause outside of the catalogue is likelier than all that could be in the place of each finding.
    #[must_use]
    pub fn tells_of_another(&self) -> bool {
        let stated = self.findings.iter().filter_map(|one| one.none_of_these);
        self.unexplained.is_some() || stated.reduce(f64::min).is_some_and(|none| none > 0.5)
    }

    /// `true` if each injected effect is in the confidence set of a finding of its own.
    #[must_use]
    pub fn each_in_its_set(&self) -> bool {
        let holds = |finding: &FindingScore, hidden: &InjectedScore| finding.holds(&hidden.effect);
        match self.hidden.as_slice() {
            [one, other] => (0..self.findings.len()).any(|i| {
                holds(&self.findings[i], one)
                    && (0..self.findings.len()).any(|j| j != i && holds(&self.findings[j], other))
            }),
            hidden => hidden.iter().all(|hidden| hidden.in_set),
        }
    }
}

impl FindingScore {
    /// `true` if the confidence set contains an effect or an exact equivalent of it.
    #[must_use]
    pub fn holds(&self, effect: &str) -> bool {
        let mut set = core::iter::once(&self.effect).chain(&self.alternatives);
        set.any(|member| same_or_equivalent(member, effect))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    pub(crate) fn found(effect: &str, alternatives: &[&str]) -> FindingScore {
        FindingScore {
            effect: effect.to_owned(),
            alternatives: alternatives.iter().map(|&other| other.to_owned()).collect(),
            ..FindingScore::default()
        }
    }

    fn hidden(effect: &str) -> InjectedScore {
        InjectedScore {
            effect: effect.to_owned(),
            in_set: true,
            first_cosine: 1.0,
            ..InjectedScore::default()
        }
    }

    pub(crate) fn pair(findings: Vec<FindingScore>) -> RecordScore {
        RecordScore {
            hidden: vec![hidden("gyro_x.g_y"), hidden("gyro_y.ramp")],
            verdict: "effects-found".to_owned(),
            findings,
            ..RecordScore::default()
        }
    }

    #[test]
    fn the_likeliest_name_tells_whether_there_is_another_cause() {
        let stated = |none_of_these: Option<f64>| FindingScore {
            none_of_these,
            ..found("gyro_x.g_y", &[])
        };
        let tells = |findings: Vec<FindingScore>| pair(findings).tells_of_another();
        assert!(tells(vec![stated(Some(0.9)), stated(Some(0.6))]));
        assert!(!tells(vec![stated(Some(0.9)), stated(Some(0.4))]));
        // Of a search that was cut nothing is known.
        assert!(!tells(vec![stated(None)]));
        let unexplained = RecordScore {
            unexplained: Some("a line".to_owned()),
            ..pair(Vec::new())
        };
        assert!(unexplained.tells_of_another());
    }

    #[test]
    fn two_effects_need_a_finding_each() {
        // One finding whose set holds both is not enough.
        let both = found("gyro_x.g_y", &["gyro_y.ramp"]);
        assert!(!pair(vec![both.clone()]).each_in_its_set());
        assert!(!pair(vec![both.clone(), found("accel_x.bias", &[])]).each_in_its_set());
        assert!(pair(vec![found("gyro_y.step", &["gyro_y.ramp"]), both.clone()]).each_in_its_set());
        assert_eq!(pair(vec![both]).set_size(), 2);
    }
}
