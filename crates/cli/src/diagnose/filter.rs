//! What the paper's own filter makes of a record.

use gyrocal_calibration::{CalibrationError, Options, calibrate};
use gyrocal_record::{Bench, FilterReport, FindingReport, Record};
use gyrocal_statistics::{chi_square_z, two_sided_p};

/// The effect that is named if the filter's rule is too coarse.
pub(super) const EFFECT: &str = "filter.discretisation";

/// Innovations that are less likely than this from a filter that fits: it adds nothing to the
/// probability of a false alarm.
const FAR: f64 = 1e-6;

/// What noise and causes do to innovations they do to those of both filters; a rule that is too
/// coarse makes its own larger by at least this factor.
const LARGER: f64 = 1.5;

/// A filter that was judged.
pub(super) struct Judged {
    pub(super) report: FilterReport,
    pub(super) finding: Option<FindingReport>,
}

/// Filters the record as the paper does, and as this program does.
pub(super) fn judge(record: &Record, bench: &Bench) -> Result<Judged, CalibrationError> {
    let own = calibrate(record, bench, &Options::streaming(), |_| ())?.fit;
    let mut report = FilterReport {
        name: "euler".to_owned(),
        nis_mean: None,
        nis_band: own.nis_band(),
        reference_nis_mean: own.nis_mean(),
        stopped: None,
    };
    let paper = match calibrate(record, bench, &Options::paper_baseline(), |_| ()) {
        Ok(calibration) => calibration.fit,
        Err(CalibrationError::Filter {
            row,
            time_s,
            source,
        }) => {
            report.stopped = Some(format!("at row {row} (t = {time_s} s): {source}"));
            return Ok(Judged {
                report,
                finding: None,
            });
        }
        Err(other) => return Err(other),
    };
    report.nis_mean = Some(paper.nis_mean());
    let z = chi_square_z(paper.nis_sum(), paper.values() as f64).unwrap_or(0.0);
    let p_value = two_sided_p(z);
    let named = z > 0.0 && p_value < FAR && paper.nis_mean() > LARGER * own.nis_mean();
    let finding = named.then(|| FindingReport {
        effect: EFFECT.to_owned(),
        parameters: Vec::new(),
        z,
        p_value,
        coverage: super::json::COVERAGE,
        rivals: Vec::new(),
        equivalents: Vec::new(),
        gain_nats: None,
        accepted: None,
    });
    Ok(Judged { report, finding })
}
