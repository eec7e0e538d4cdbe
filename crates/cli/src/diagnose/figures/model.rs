//! Effects by test statistic, and the gain of the extended model.

use gyrocal_answer::{CoefficientEstimate, Gain, Prediction};
use gyrocal_pages::Ranked;
use gyrocal_report::page::Tint;
use gyrocal_report::{
    ComparedEstimate, ComparedQuantity, Comparison, CrossValidation, PredictionError, Ranking,
};

use super::{DiagnosisRun, causes, subtitle};

/// All effects of the first search by their statistic; `None` if nothing could be searched.
pub(super) fn ranking(found: &DiagnosisRun<'_>) -> Option<Ranking> {
    let ranked = Ranked::of(&found.diagnosis.result)?;
    Some(ranked.picture(&subtitle(found)))
}

/// Gain of the extended model in cross-validation, and its prediction of a later record.
pub(super) fn gain(found: &DiagnosisRun<'_>, gain: &Gain) -> CrossValidation {
    let compensation = found.diagnosis.later.as_ref().map(|later| &later.attitude);
    let blocks = &gain.block_log_score_nats;
    let better = blocks.iter().flatten().filter(|nats| **nats > 0.0).count();
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
                Prediction::CrossValidated => "blocked cross-validation",
                Prediction::Forward => "each block predicted from those before it",
            },
            subtitle(found)
        ),
        block_gain_nats: blocks.iter().map(|nats| nats.unwrap_or(0.0)).collect(),
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
    let compared = |one: &CoefficientEstimate| ComparedEstimate {
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
