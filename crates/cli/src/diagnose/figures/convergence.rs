//! The nine coefficients while the record goes on, with and without the causes.

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::{CalibrationError, Estimates, Extended};
use gyrocal_report::{Convergence, ConvergingCoefficient};

use super::{Found, causes, subtitle};

/// Points of a curve, evenly over the record.
const POINTS: usize = 240;

/// `None` without an extended model.
pub(super) fn convergence(found: &Found<'_>) -> Result<Option<Convergence>, CalibrationError> {
    let diagnosis = &found.diagnosis;
    let Some(extended) = &diagnosis.extended else {
        return Ok(None);
    };
    let all = found.record.len();
    let mut rows: Vec<usize> = (1..=POINTS)
        .map(|point| point * (all - 1) / POINTS)
        .collect();
    rows.dedup();
    let of = |fit: &Extended<'_>| fit.convergence(&rows);
    let (nominal, extended) = (of(&diagnosis.nominal)?, of(extended)?);
    Ok(Some(Convergence {
        title: format!(
            "With {} the coefficients settle elsewhere",
            causes(found).unwrap_or_default()
        ),
        subtitle: format!(
            "estimates from the record up to each time; {}",
            subtitle(found)
        ),
        time_s: rows.iter().map(|row| found.record.time_s[*row]).collect(),
        coefficients: DRIFT
            .iter()
            .enumerate()
            .map(|(index, element)| {
                let [estimate, sigma] = curves(&extended, index);
                ConvergingCoefficient {
                    name: element.id.to_owned(),
                    unit: element.unit.to_owned(),
                    estimate,
                    sigma,
                    reference: None,
                    rival: Some(curves(&nominal, index)),
                }
            })
            .collect(),
        columns: 3,
        reference_label: String::new(),
        estimate_label: "extended model".to_owned(),
        rival_label: "nominal model".to_owned(),
    }))
}

/// Estimate and sigma of a coefficient.
fn curves(estimates: &[Option<Estimates>], index: usize) -> [Vec<f64>; 2] {
    let of = |value: fn(&Estimates) -> &[f64; 9]| {
        estimates
            .iter()
            .map(|estimates| estimates.as_ref().map_or(f64::NAN, |e| value(e)[index]))
            .collect()
    };
    [of(|e| &e.coefficients), of(|e| &e.sigmas)]
}
