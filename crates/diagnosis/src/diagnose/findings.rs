//! Findings of the tests as entries of the answer.

use gyrocal::{EFFECTS, Effect};
use gyrocal_hypothesis::{self as hypothesis, EffectEstimate};

use crate::filter_test::FILTER_EFFECT;
use crate::noise::NoiseFinding;
use crate::result::{Alternative, Equivalent, Finding, FindingKind, Parameter};
use crate::set_coverage;
use crate::validation::KeepDecision;

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
            finding.p_value,
        )
    }
}

/// A finding of the search, with its gain in cross-validation.
pub(super) fn of_cause(finding: &hypothesis::Finding, decision: &KeepDecision) -> Finding {
    let alternatives: Vec<Alternative> = finding
        .alternatives
        .iter()
        .map(|other| Alternative {
            effect: other.effect.to_owned(),
            log_likelihood_deficit: other.log_likelihood_deficit,
        })
        .collect();
    let equivalents = finding.exact_equivalents.iter().map(|other| Equivalent {
        effect: other.effect.to_owned(),
        parameters: parameters(&other.parameters),
    });
    let none = finding.none_of_these;
    let others = finding.alternatives.iter().map(|other| other.effect);
    Finding {
        parameters: parameters(&finding.parameters),
        coverage: set_coverage::of_set(finding.effect, others, finding.z),
        rivals: alternatives.clone(),
        alternatives,
        none_of_these: none.map(|none| none.probability()),
        none_of_these_log_likelihood_ratio: none.map(|none| none.log_likelihood_ratio),
        equivalents: equivalents.collect(),
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
    bare(FILTER_EFFECT, FindingKind::Filter, z, p_value)
}

fn bare(effect: &str, kind: FindingKind, z: f64, p_value: f64) -> Finding {
    Finding {
        effect: effect.to_owned(),
        name: row(effect).map_or("", |row| row.name).to_owned(),
        kind,
        parameters: Vec::new(),
        z,
        p_value,
        coverage: None,
        rivals: Vec::new(),
        alternatives: Vec::new(),
        none_of_these: None,
        none_of_these_log_likelihood_ratio: None,
        by_record: None,
        equivalents: Vec::new(),
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
