//! Estimates of the coefficients against record length, nominal and extended model.

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::{CalibrationError, Estimates, FittedPlatform};
use gyrocal_report::{Convergence, EstimateHistory, ParameterHistory};

use super::{DiagnosisRun, causes, subtitle};

/// Points of a curve, evenly over the record.
const POINTS: usize = 240;

/// `None` without an extended model.
pub(super) fn convergence(
    found: &DiagnosisRun<'_>,
) -> Result<Option<Convergence>, CalibrationError> {
    let diagnosis = &found.diagnosis;
    let Some(extended) = &diagnosis.extended else {
        return Ok(None);
    };
    let all = found.diagnosis.record.len();
    let mut rows: Vec<usize> = (1..=POINTS)
        .map(|point| point * (all - 1) / POINTS)
        .collect();
    rows.dedup();
    let of = |fit: &FittedPlatform<'_>| fit.convergence(&rows);
    let (nominal, extended) = (of(&diagnosis.nominal)?, of(extended)?);
    Ok(Some(Convergence {
        title: format!(
            "Coefficients against record length, without and with {}",
            causes(found).unwrap_or_default()
        ),
        subtitle: format!(
            "estimates from the record up to each time; {}",
            subtitle(found)
        ),
        time_s: rows
            .iter()
            .map(|row| found.diagnosis.record.time_s[*row])
            .collect(),
        parameters: DRIFT
            .iter()
            .enumerate()
            .map(|(index, element)| ParameterHistory {
                name: element.id.to_owned(),
                unit: element.unit.to_owned(),
                estimates: history(&extended, index),
                reference: None,
                second: Some(history(&nominal, index)),
            })
            .collect(),
        columns: 3,
        reference_label: String::new(),
        estimate_label: "extended model".to_owned(),
        second_label: "nominal model".to_owned(),
    }))
}

/// Estimates of a coefficient.
fn history(estimates: &[Option<Estimates>], index: usize) -> EstimateHistory {
    let of = |value: fn(&Estimates) -> &[f64; 9]| {
        estimates
            .iter()
            .map(|estimates| estimates.as_ref().map_or(f64::NAN, |e| value(e)[index]))
            .collect()
    };
    EstimateHistory {
        estimate: of(|e| &e.coefficients),
        sigma: of(|e| &e.sigmas),
    }
}
