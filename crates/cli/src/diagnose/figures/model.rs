//! Effects by test statistic, and the gain of the extended model.

use gyrocal_diagnosis::{prose, result};
use gyrocal_report::page::Tint;
use gyrocal_report::{
    ComparedEstimate, ComparedQuantity, Comparison, CrossValidation, Omitted, PredictionError,
    RankedEffect, Ranking, RankingGroup, Role,
};

use super::{DiagnosisRun, causes, named, subtitle};

/// Number of effects shown that are neither reported nor alternatives.
const OTHERS_SHOWN: usize = 10;

/// All effects of the first search by their statistic; `None` if nothing could be searched.
pub(super) fn ranking(found: &DiagnosisRun<'_>) -> Option<Ranking> {
    let report = &found.diagnosis.result;
    let threshold = report.threshold.filter(|threshold| *threshold > 0.0)?;
    let largest = report.ranking.first()?;
    let statistic = |effect: &str| {
        let ranked = report.ranking.iter().find(|r| r.effect == effect);
        ranked.map_or(f64::NAN, |ranked| ranked.statistic)
    };
    let mut groups = Vec::new();
    let mut shown: Vec<&str> = Vec::new();
    for finding in report.causes() {
        let mut effects = vec![RankedEffect {
            effect: finding.effect.clone(),
            statistic: statistic(&finding.effect),
            role: Role::Reported,
            note: String::new(),
        }];
        let equal = finding.equivalents.iter().map(|equivalent| RankedEffect {
            effect: equivalent.effect.clone(),
            statistic: statistic(&equivalent.effect),
            role: Role::Alternative,
            note: "exact equivalent".to_owned(),
        });
        effects.extend(equal.filter(|effect| effect.statistic.is_finite()));
        effects.extend(finding.alternatives.iter().map(|rival| RankedEffect {
            effect: rival.effect.clone(),
            statistic: statistic(&rival.effect),
            role: Role::Alternative,
            note: prose::likelihood(rival),
        }));
        let label = if effects.len() == 1 {
            format!("{}, no alternatives", finding.effect)
        } else {
            format!("{} and its alternatives", finding.effect)
        };
        shown.push(&finding.effect);
        shown.extend(finding.alternatives.iter().map(|r| r.effect.as_str()));
        shown.extend(finding.equivalents.iter().map(|e| e.effect.as_str()));
        groups.push(RankingGroup { label, effects });
    }
    let rest: Vec<_> = report
        .ranking
        .iter()
        .filter(|ranked| !shown.contains(&ranked.effect.as_str()))
        .collect();
    let others = rest.iter().take(OTHERS_SHOWN).map(|ranked| RankedEffect {
        effect: ranked.effect.clone(),
        statistic: ranked.statistic.max(0.0),
        role: Role::Other,
        note: String::new(),
    });
    groups.push(RankingGroup {
        label: "not reported".to_owned(),
        effects: others.collect(),
    });
    let title = match named(found) {
        Some(causes) => format!(
            "{causes} detected among {} effects tested",
            report.ranking.len()
        ),
        None => format!(
            "None of {} effects exceeds the detection threshold; the largest statistic is that of {}",
            report.ranking.len(),
            largest.effect
        ),
    };
    Some(Ranking {
        title,
        subtitle: format!("first search, nominal model; {}", subtitle(found)),
        statistic: "score statistic (chi-square, penalised for search)".to_owned(),
        threshold,
        false_alarm_probability: report.false_alarm_shares.search,
        tested: report.ranking.len(),
        groups,
        omitted: rest.get(OTHERS_SHOWN).map(|next| Omitted {
            effects: rest.len() - OTHERS_SHOWN,
            largest: next.statistic,
        }),
    })
}

/// Gain of the extended model in cross-validation, and its prediction of a later record.
pub(super) fn gain(found: &DiagnosisRun<'_>, gain: &result::Gain) -> CrossValidation {
    let compensation = found.diagnosis.later.as_ref().map(|later| &later.attitude);
    let blocks = &gain.block_log_score_nats;
    let better = blocks.iter().filter(|nats| **nats > 0.0).count();
    CrossValidation {
        title: format!(
            "{} improves the predictive log score by {:.1} nats, in {better} of {} blocks",
            gain.effects.join(", "),
            gain.cross_validated_log_score_nats,
            blocks.len()
        ),
        subtitle: format!(
            "{}; {}",
            match gain.prediction {
                result::Prediction::CrossValidated => "blocked cross-validation",
                result::Prediction::Forward => "each block predicted from those before it",
            },
            subtitle(found)
        ),
        block_gain_nats: blocks.clone(),
        prediction: compensation.map(|found| PredictionError {
            name: "Later record".to_owned(),
            quantity: "drift prediction error".to_owned(),
            unit: "arcmin".to_owned(),
            time_s: found.time_s.clone(),
            nominal: found.nominal_arcmin.clone(),
            extended: found.extended_arcmin.clone(),
            expected: Some(found.expected_arcmin.clone()),
        }),
    }
}

/// The coefficients of the nominal and of the extended model.
pub(super) fn coefficients(found: &DiagnosisRun<'_>) -> Option<Comparison> {
    let coefficients = found.diagnosis.result.coefficients.as_ref()?;
    let extended = coefficients.extended.as_ref()?;
    let shifts = &found.diagnosis.result.gain.as_ref()?.coefficient_shift;
    let largest = shifts
        .iter()
        .max_by(|a, b| a.in_sigmas.abs().total_cmp(&b.in_sigmas.abs()))?;
    let compared = |one: &result::CoefficientEstimate| ComparedEstimate {
        value: one.estimate,
        sigma: one.sigma,
    };
    Some(Comparison {
        title: format!(
            "Adding {} changes the coefficients by up to {:.0} sigma ({})",
            causes(found).unwrap_or_default(),
            largest.in_sigmas.abs(),
            largest.coefficient
        ),
        subtitle: subtitle(found),
        estimators: vec!["nominal".to_owned(), "extended".to_owned()],
        tints: vec![Tint::Nominal, Tint::Extended],
        quantities: coefficients
            .nominal
            .iter()
            .zip(extended)
            .map(|(nominal, extended)| ComparedQuantity {
                name: nominal.name.clone(),
                unit: nominal.unit.clone(),
                reference: None,
                estimates: vec![compared(nominal), compared(extended)],
            })
            .collect(),
        columns: 3,
        reference_label: String::new(),
    })
}
