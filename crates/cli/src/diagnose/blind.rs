//! Which effects a short record could not show.

use gyrocal::effect::Role;
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::CalibrationError;
use gyrocal_diagnosis::Diagnosis;
use gyrocal_diagnosis::cause::information;
use gyrocal_record::{NotSearchedReport, Record};

/// A record of a turn of the Earth shows effects of typical size; one pass for each effect is
/// made over shorter ones only.
const TURN_S: f64 = 86_164.1;

/// Rows beyond which these passes would take longer than the diagnosis.
const MOST_ROWS: usize = 6000;

/// Standard deviations beyond the threshold at which an effect is seen five times in six.
const MARGIN: f64 = 1.0;

/// Why they are not to be thought absent.
const WHY: &str = "the record is too short: an effect of typical size would pass unseen";

/// Effects of the search that, at their typical size, the record would not have shown.
pub(super) fn blind(
    diagnosis: &Diagnosis<'_>,
    record: &Record,
) -> Result<Vec<NotSearchedReport>, CalibrationError> {
    let mut blind = Vec::new();
    if record.duration_s() >= TURN_S || record.len() > MOST_ROWS {
        return Ok(blind);
    }
    let needed = diagnosis.threshold.max(0.0).sqrt() + MARGIN;
    for ranked in &diagnosis.ranking {
        let Some(effect) = EFFECTS.iter().find(|effect| effect.id == ranked.effect) else {
            continue;
        };
        let found = diagnosis.findings.iter().any(|f| f.effect == effect.id);
        let bound = information(&diagnosis.nominal, record, effect.id, shape(effect, record))?;
        let sigma = bound
            .and_then(|information| information.try_inverse())
            .map_or(f64::INFINITY, |covariance| covariance[(0, 0)].sqrt());
        if found || needed * sigma < effect.typical_size {
            continue;
        }
        blind.push(NotSearchedReport {
            effect: effect.id.to_owned(),
            why: WHY.to_owned(),
        });
    }
    Ok(blind)
}

/// An onset in the middle, a time constant of a quarter of the record.
fn shape(effect: &Effect, record: &Record) -> Option<f64> {
    let duration_s = record.duration_s();
    match effect.shape()?.role {
        Role::TimeConstant(_) => Some(0.25 * duration_s / 3600.0),
        _ => Some(0.5 * duration_s),
    }
}

/// Whether an entry is of this kind.
pub(super) fn is_blind(entry: &NotSearchedReport) -> bool {
    entry.why == WHY
}
