//! The result for programs.

mod gain;

use gyrocal::effect::{EffectKind, Enters, NoiseProperty};
use gyrocal::{EFFECTS, Effect};
use gyrocal_diagnosis::cause::{Finding, FoundParameter, SearchOptions};
use gyrocal_diagnosis::{Acceptance, Diagnosis, NoiseFinding, Remainder, Validation, Verdict};
use gyrocal_record::{
    Bench, DiagnosisReport, DiagnosisVerdict, EquivalentReport, FindingReport, Manifest,
    NotSearchedReport, ParameterReport, RankedReport, RemainderReport, RemainderVerdict,
    ResidualsReport, RivalReport, SCHEMA_VERSION,
};

use super::filter::Judged;
use super::{apart, channels};
use crate::noise;

/// Probability that a named set holds its cause; what [`SearchOptions`] has by default.
pub(super) const COVERAGE: f64 = 0.95;

pub(super) fn report(
    diagnosis: &Diagnosis<'_>,
    validation: Option<&Validation>,
    judged: Option<Judged>,
    blind: Vec<NotSearchedReport>,
    bench: &Bench,
    residuals: ResidualsReport,
    manifest: Manifest,
) -> DiagnosisReport {
    let coverage = SearchOptions::default().coverage;
    debug_assert!(coverage == COVERAGE);
    let (filter, of_filter) = match judged {
        Some(judged) => (Some(judged.report), judged.finding),
        None => (None, None),
    };
    let noise = diagnosis.noise_findings.iter().map(of_noise);
    let causes = diagnosis.findings.iter().zip(&diagnosis.acceptances);
    let causes = causes.map(|(finding, acceptance)| of_cause(finding, *acceptance));
    let findings: Vec<FindingReport> = noise.chain(causes).chain(of_filter).collect();
    let field_is_known = bench.magnetic_field_gauss.is_some();
    let searched: Vec<&str> = diagnosis.ranking.iter().map(|r| r.effect).collect();
    DiagnosisReport {
        schema_version: SCHEMA_VERSION,
        manifest,
        verdict: match diagnosis.verdict {
            _ if !findings.is_empty() => DiagnosisVerdict::EffectsFound,
            Verdict::EffectsFound => DiagnosisVerdict::EffectsFound,
            Verdict::Unexplained => DiagnosisVerdict::Unexplained,
            Verdict::Clean => DiagnosisVerdict::Clean,
        },
        false_alarm_probability: diagnosis.false_alarm_probability,
        residuals: Some(residuals),
        norm: diagnosis.norm.as_ref().map(channels::norm),
        allan: diagnosis.stability.as_ref().map(channels::allan),
        gain: gain::report(diagnosis, validation),
        remainder: remainder(&diagnosis.remainder),
        cannot_tell: findings
            .iter()
            .flat_map(|finding| apart::cannot_tell(finding, &searched, field_is_known))
            .collect(),
        ranking: diagnosis
            .ranking
            .iter()
            .map(|ranked| RankedReport {
                effect: ranked.effect.to_owned(),
                statistic: ranked.statistic,
            })
            .collect(),
        threshold: Some(diagnosis.threshold).filter(|threshold| threshold.is_finite()),
        noise: noise::report(&diagnosis.noise),
        not_searched: blind
            .into_iter()
            .chain(not_searched(diagnosis, filter.is_some()))
            .collect(),
        findings,
        filter,
    }
}

fn of_noise(finding: &NoiseFinding) -> FindingReport {
    FindingReport {
        effect: finding.effect.to_owned(),
        parameters: finding
            .parameters
            .iter()
            .map(|found| ParameterReport {
                name: found.name.to_owned(),
                estimate: found.estimate,
                sigma: Some(found.sigma),
                unit: found.unit.to_owned(),
            })
            .collect(),
        z: finding.z,
        p_value: finding.p_value,
        coverage: COVERAGE,
        rivals: Vec::new(),
        equivalents: Vec::new(),
        gain_nats: None,
        accepted: None,
    }
}

fn of_cause(finding: &Finding, acceptance: Acceptance) -> FindingReport {
    FindingReport {
        effect: finding.effect.to_owned(),
        parameters: parameters(&finding.parameters),
        z: finding.z,
        p_value: finding.p_value,
        coverage: COVERAGE,
        rivals: finding
            .rivals
            .iter()
            .map(|rival| RivalReport {
                effect: rival.effect.to_owned(),
                log_likelihood_deficit: rival.log_likelihood_deficit,
            })
            .collect(),
        equivalents: finding
            .equivalents
            .iter()
            .map(|(effect, found)| EquivalentReport {
                effect: (*effect).to_owned(),
                parameters: parameters(found),
            })
            .collect(),
        gain_nats: Some(acceptance.gain_nats),
        accepted: Some(acceptance.accepted),
    }
}

fn parameters(found: &[FoundParameter]) -> Vec<ParameterReport> {
    found
        .iter()
        .map(|parameter| ParameterReport {
            name: parameter.name.to_owned(),
            estimate: parameter.estimate,
            sigma: parameter.sigma,
            unit: parameter.unit.to_owned(),
        })
        .collect()
}

fn remainder(remainder: &Remainder) -> RemainderReport {
    let (verdict, description) = if remainder.unexplained {
        (RemainderVerdict::Unexplained, remainder.description.clone())
    } else if remainder.untested.is_empty() {
        (RemainderVerdict::White, String::new())
    } else {
        let untested = remainder.untested.join(" and ");
        (RemainderVerdict::NotTested, untested)
    };
    RemainderReport {
        verdict,
        p_value: remainder.p_value,
        description,
    }
}

/// Effects of the catalogue that neither the search nor the audit looked at, and why. A filter was
/// judged or not.
fn not_searched(diagnosis: &Diagnosis<'_>, filter_judged: bool) -> Vec<NotSearchedReport> {
    let audited = diagnosis.audit.accel_ratio.is_some();
    let correlated = diagnosis.audit.cleaned.correlation != 0.0;
    EFFECTS
        .iter()
        .filter_map(|effect| {
            let id = effect.id;
            let unavailable = diagnosis.unavailable.iter().find(|u| u.effect == id);
            let enters_rates = matches!(effect.enters, Enters::Rates(_));
            let is_level = effect.kind == EffectKind::Noise(NoiseProperty::Level);
            let ranked = diagnosis.ranking.iter().any(|r| r.effect == id);
            let noise = effect.is_noise();
            let why = if let Some(unavailable) = unavailable {
                unavailable.why.clone()
            } else if ranked || effect.is_nominal || (id == super::filter::EFFECT && filter_judged)
            {
                return None;
            } else if id == super::filter::EFFECT {
                "an error of a filter: --filter euler".to_owned()
            } else if correlated && is_level && enters_rates {
                "correlated noise of the accelerometers hides it".to_owned()
            } else if noise && (audited || enters_rates || tested_value_by_value(effect)) {
                return None;
            } else if noise {
                "the record is too short for a spectrum of its noise".to_owned()
            } else if !effect.default_search {
                "only if asked for: --effects".to_owned()
            } else {
                "the fit of the nine coefficients leaves nothing of it in so short a record, or \
                 so small a part of the circle"
                    .to_owned()
            };
            Some(NotSearchedReport {
                effect: id.to_owned(),
                why,
            })
        })
        .collect()
}

/// Outliers and quantisation need no spectrum.
fn tested_value_by_value(effect: &Effect) -> bool {
    matches!(
        effect.kind,
        EffectKind::Noise(NoiseProperty::Outliers | NoiseProperty::Quantisation)
    )
}
