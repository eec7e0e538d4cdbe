//! Gain of the extended model.

use gyrocal_record::printable_line;

use super::catalogue::has_random_walk;
use gyrocal_answer::{Answer, CoefficientShift, Gain, Prediction};

/// Coefficient changes that a paragraph names; the table shows all of them.
const SHIFTS_SHOWN: usize = 3;

/// Gain on the record itself, and on a later one if there is one.
pub(super) fn paragraphs(result: &Answer) -> impl Iterator<Item = String> {
    let gain = result.gain.as_ref();
    gain.map(|gain| on_the_record(result, gain))
        .into_iter()
        .chain(later(result))
}

fn on_the_record(result: &Answer, gain: &Gain) -> String {
    let nats = gain.cross_validated_log_score_nats;
    let folds = gain.block_log_score_nats.len();
    let effects = gain.effects.join(", ");
    let how = match gain.prediction {
        Prediction::CrossValidated => format!("{folds}-fold blocked cross-validation"),
        Prediction::Forward => format!("Each of {folds} blocks predicted from those before it"),
    };
    let validated = if nats > 0.0 {
        let improves = if gain.effects.len() == 1 {
            "improves"
        } else {
            "improve"
        };
        format!(
            "{how}: {effects} {improves} the predictive log score \
             by {nats:.1} nats."
        )
    } else {
        format!(
            "{how}: no extended model, as {effects} would not \
             improve the predictive log score ({nats:.1} nats). The following figures are of that \
             model."
        )
    };
    let mut shifts: Vec<_> = gain.coefficient_shift.iter().collect();
    shifts.sort_by(|a, b| b.in_sigmas.abs().total_cmp(&a.in_sigmas.abs()));
    let shifts: Vec<String> = shifts.into_iter().take(SHIFTS_SHOWN).map(shifted).collect();
    let shown = gain.free_run_rms_g.filter(|_| !has_random_walk(result));
    let simulation = match shown {
        None => String::new(),
        Some(rms) => format!(
            " Open-loop simulation error (no measurement updates): {:.2e} g rms, was {:.2e} g; \
             accelerometer noise {:.2e} g.",
            rms.after, rms.before, rms.noise
        ),
    };
    format!(
        "{validated}{simulation} Largest coefficient changes: {}.",
        shifts.join(", ")
    )
}

fn shifted(shift: &CoefficientShift) -> String {
    format!(
        "{} {:+.2e} {} ({:.1} sigma)",
        shift.coefficient,
        shift.shift,
        shift.unit,
        shift.in_sigmas.abs()
    )
}

/// Validation on a later record, if one was given.
fn later(result: &Answer) -> Option<String> {
    result.later_record.as_ref()?;
    let input = |place: usize, otherwise: &'static str| {
        let input = result.manifest.inputs.get(place);
        input.map_or(otherwise.into(), |input| printable_line(&input.path))
    };
    // The record, its bench file, the later record.
    let (first, later) = (input(0, "the first record"), input(2, "the later record"));
    let gain = result.gain.as_ref();
    let Some(validation) = gain.and_then(|gain| gain.validation.as_ref()) else {
        return Some(format!(
            "Validation on {later}: nominal model only, as no effect is in an extended one."
        ));
    };
    let nats = validation.log_score_nats;
    let score = if nats > 0.0 {
        format!("the extended model improves the predictive log score by {nats:.1} nats")
    } else {
        format!("the extended model does not improve the predictive log score ({nats:.1} nats)")
    };
    let Some(error) = &validation.compensation else {
        return Some(format!("Validation on {later}: {score}."));
    };
    Some(format!(
        "Validation on {later}: {score}. Attitude error after {:.1} h of compensation with the \
         coefficients of {first}: {:.2} arcmin with the extended model, {:.2} arcmin with the nominal \
         one; {:.2} arcmin are expected from the uncertainty of coefficients and attitudes and the \
         noise of the gyros.",
        error.after_h, error.extended_arcmin, error.nominal_arcmin, error.expected_arcmin
    ))
}
