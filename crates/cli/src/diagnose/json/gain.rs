//! What the extended model gains.

use gyrocal_diagnosis::{Compensation, Diagnosis, Validation};
use gyrocal_record::{
    CompensationReport, FreeRunReport, GainReport, ShiftReport, ValidationReport,
};

pub(super) fn report(
    diagnosis: &Diagnosis<'_>,
    validation: Option<&Validation>,
) -> Option<GainReport> {
    let gain = diagnosis.gain.as_ref()?;
    let [before, after] = gain.free_run_rms_g;
    let causes = diagnosis.findings.iter().zip(&diagnosis.acceptances);
    let none = diagnosis.extended.is_none();
    Some(GainReport {
        effects: causes
            .filter(|(_, acceptance)| acceptance.accepted || none)
            .map(|(finding, _)| finding.effect.to_owned())
            .collect(),
        cross_validated_log_score_nats: gain.log_score_nats(),
        block_log_score_nats: gain.block_log_score_nats.clone(),
        free_run_rms_g: FreeRunReport {
            before,
            after,
            noise: gain.noise_rms_g,
        },
        coefficient_shift: gain
            .coefficient_shift
            .iter()
            .map(|shift| ShiftReport {
                coefficient: shift.coefficient.to_owned(),
                shift: shift.shift,
                interval: shift.interval(),
                in_sigmas: shift.in_sigmas,
                in_sigmas_interval: shift.interval_in_sigmas(),
                unit: shift.unit.to_owned(),
            })
            .collect(),
        validation: validation.map(|validation| ValidationReport {
            log_score_nats: validation.gain_nats(),
            compensation: compensation(&validation.compensation),
        }),
    })
}

fn compensation(found: &Compensation) -> CompensationReport {
    let [nominal_arcmin, extended_arcmin, expected_arcmin] = found.at_end_arcmin();
    CompensationReport {
        starts: found.starts,
        after_h: found.time_s.last().copied().unwrap_or(0.0) / 3600.0,
        nominal_arcmin,
        extended_arcmin,
        expected_arcmin,
    }
}
