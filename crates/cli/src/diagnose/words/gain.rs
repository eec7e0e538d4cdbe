//! What the extended model gains, in words.

use gyrocal_record::{FindingReport, GainReport, ShiftReport};

use crate::diagnose::Found;

/// Shifts of coefficients that are told in words.
const SHIFTS_TOLD: usize = 3;

/// Why a finding is not in the extended model.
pub(super) fn refused(finding: &FindingReport) -> Option<String> {
    let nats = finding.gain_nats?;
    (finding.accepted == Some(false)).then(|| {
        format!(
            "Significant, but with it in the model the sixths of the record are predicted no better \
             from the others ({nats:+.1} nats in all): it is not in the extended model."
        )
    })
}

/// The record's own verdict on the extended model.
pub(super) fn gained(gain: &GainReport) -> String {
    let nats = gain.cross_validated_log_score_nats;
    let rms = gain.free_run_rms_g;
    let mut shifts: Vec<_> = gain.coefficient_shift.iter().collect();
    shifts.sort_by(|a, b| b.in_sigmas.abs().total_cmp(&a.in_sigmas.abs()));
    let shifts: Vec<String> = shifts.into_iter().take(SHIFTS_TOLD).map(shifted).collect();
    let effects = gain.effects.join(", ");
    let predicts = if nats > 0.0 {
        format!(
            "With {effects} in the model it predicts each sixth of the record from the others \
             better, by {nats:.1} nats in all."
        )
    } else {
        format!(
            "There is no extended model: with {effects} it would predict a sixth of the record from \
             the others no better ({nats:.1} nats). What follows is of that model."
        )
    };
    format!(
        "{predicts} Running freely from the first row it misses the record by {:.2e} g rms instead \
         of {:.2e} g; the accelerometers' noise alone is {:.2e} g, to which that of the gyros adds \
         with time. In it the coefficients are others than without the effect, most of all {}.",
        rms.after,
        rms.before,
        rms.noise,
        shifts.join(", ")
    )
}

fn shifted(shift: &ShiftReport) -> String {
    let [low, high] = shift.in_sigmas_interval;
    let [low, high] = if shift.in_sigmas < 0.0 {
        [-high, -low]
    } else {
        [low, high]
    };
    format!(
        "{} by {:+.2e} {} ({:.1} sigma, {low:.1} to {high:.1})",
        shift.coefficient,
        shift.shift,
        shift.unit,
        shift.in_sigmas.abs()
    )
}

/// What the later record says, if one was given.
pub(super) fn later(found: &Found<'_>) -> Option<String> {
    let path = found.later?.display();
    let gain = found.report.gain.as_ref();
    let Some(validation) = gain.and_then(|gain| gain.validation.as_ref()) else {
        return Some(format!(
            "{path} is predicted by the nominal model alone: no effect is in an extended one."
        ));
    };
    let nats = validation.log_score_nats;
    let left = &validation.compensation;
    let scores = if nats > 0.0 {
        format!("{path} is predicted better too, by {nats:.1} nats.")
    } else {
        format!("{path} is not predicted better ({nats:.1} nats).")
    };
    Some(format!(
        "{scores} A platform compensated by the coefficients of {} would there be off by {:.2} arc \
         minutes after {:.1} h with the extended model and by {:.2} with the nominal one; {:.2} are \
         to be expected of coefficients and attitudes as well known and gyros as noisy as these.",
        found.path.display(),
        left.extended_arcmin,
        left.after_h,
        left.nominal_arcmin,
        left.expected_arcmin
    ))
}
