//! Findings of the tests as entries of the answer.

use gyrocal::{EFFECTS, Effect};
use gyrocal_hypothesis::{self as hypothesis, EffectEstimate};

use crate::filter_test::FILTER_EFFECT;
use crate::noise::NoiseFinding;
use crate::set_coverage;
use crate::validation::KeepDecision;
use gyrocal_answer::{Alternative, AlternativeKind, Finding, FindingKind, Parameter};

/// A finding of the noise audit or of the gyro noise.
pub(super) fn of_noise(finding: &NoiseFinding) -> Finding {
    let parameters = finding.parameters.iter().map(|found| Parameter {
        name: found.name.to_owned(),
        estimate: found.estimate,
        sigma: Some(found.sigma),
        interval: None,
        unit: found.unit.to_owned(),
    });
    Finding {
        parameters: parameters.collect(),
        ..bare(
            finding.effect,
            FindingKind::Noise,
            finding.z,
            Some(finding.p_value),
        )
    }
}

/// A finding of the search, with its gain in cross-validation.
pub(super) fn of_cause(finding: &hypothesis::Finding, decision: &KeepDecision) -> Finding {
    let equivalents = finding.exact_equivalents.iter().map(|other| Alternative {
        effect: other.effect.to_owned(),
        kind: AlternativeKind::ExactEquivalent,
        log_likelihood_deficit: Some(0.0),
        parameters: parameters(&other.parameters),
    });
    let set = finding.alternatives.iter().map(|other| Alternative {
        effect: other.effect.to_owned(),
        kind: AlternativeKind::NotExcluded,
        log_likelihood_deficit: Some(other.log_likelihood_deficit),
        parameters: Vec::new(),
    });
    let none = finding.none_of_these;
    let others = finding.alternatives.iter().map(|other| other.effect);
    Finding {
        parameters: parameters(&finding.parameters),
        coverage: set_coverage::of_set(finding.effect, others, finding.z),
        alternatives: equivalents.chain(set).collect(),
        none_of_these: none.map(|none| none.probability()),
        none_of_these_log_likelihood_ratio: none.map(|none| none.log_likelihood_ratio),
        gain_nats: decision.gain_nats,
        accepted: Some(decision.accepted),
        ..bare(
            finding.effect,
            FindingKind::Cause,
            finding.z,
            finding.p_value,
        )
    }
}

/// The finding of an inconsistent filter.
pub(super) fn of_filter([z, p_value]: [f64; 2]) -> Finding {
    bare(FILTER_EFFECT, FindingKind::Filter, z, Some(p_value))
}

fn bare(effect: &str, kind: FindingKind, z: f64, p_value: Option<f64>) -> Finding {
    Finding {
        effect: effect.to_owned(),
        name: row(effect).map_or("", |row| row.name).to_owned(),
        kind,
        parameters: Vec::new(),
        z,
        p_value,
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
    }
}

fn row(effect: &str) -> Option<&'static Effect> {
    EFFECTS.iter().find(|row| row.id == effect)
}

fn parameters(found: &[EffectEstimate]) -> Vec<Parameter> {
    let parameter = |found: &EffectEstimate| Parameter {
        name: found.name.to_owned(),
        estimate: found.estimate,
        sigma: found.sigma,
        interval: found.interval.clone(),
        unit: found.unit.to_owned(),
    };
    found.iter().map(parameter).collect()
}
