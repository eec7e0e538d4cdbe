//! Gain of an extended model: cross-validation, open-loop simulation, change of the coefficients, and
//! validation on a later record.

mod block_scores;
mod continued_parameters;
mod cross_validation;
mod later_record;

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::{CalibrationError, FittedPlatform, NoiseModel};
use gyrocal_record::Record;
use gyrocal_statistics::rms_of_present;

pub(crate) use cross_validation::{CrossValidated, KeepDecision, cross_validate};
pub(crate) use later_record::predict;
pub use later_record::{AttitudeErrors, LaterPrediction};

use gyrocal_answer::{CoefficientShift, FreeRun, Gain, Prediction};

/// Gain of the second model over the first, the nominal one, on the record both were fitted to with
/// the same noise, of which `accel_noise_g` is declared. `scores` are the log scores of its blocks
/// with each, and `effects` the causes that the second has.
///
/// # Errors
/// As [`FittedPlatform::free_run_g`].
pub(crate) fn gain(
    [nominal, extended]: [&FittedPlatform<'_>; 2],
    ([before, after], prediction): ([Vec<f64>; 2], Prediction),
    record: &Record,
    noise: &NoiseModel,
    accel_noise_g: f64,
    effects: Vec<String>,
) -> Result<Gain, CalibrationError> {
    let scores = after.iter().zip(before);
    let block_log_score_nats: Vec<f64> = scores.map(|(after, before)| after - before).collect();
    let squares = noise.accel_ratio.iter().map(|ratio| ratio * ratio);
    Ok(Gain {
        effects,
        prediction,
        cross_validated_log_score_nats: block_log_score_nats.iter().sum(),
        block_log_score_nats: block_log_score_nats.into_iter().map(Some).collect(),
        free_run_rms_g: Some(FreeRun {
            before: rms(record, noise, &nominal.free_run_g()?),
            after: rms(record, noise, &extended.free_run_g()?),
            noise: accel_noise_g * (squares.sum::<f64>() / 3.0).sqrt(),
        }),
        coefficient_shift: shifts(nominal, extended),
        validation: None,
    })
}

/// Changes of the coefficients from the nominal estimates, over the standard deviations of these.
fn shifts(nominal: &FittedPlatform<'_>, extended: &FittedPlatform<'_>) -> Vec<CoefficientShift> {
    let each = DRIFT.iter().enumerate();
    each.map(|(index, element)| {
        let shift = extended.values()[index] - nominal.values()[index];
        CoefficientShift {
            coefficient: element.id.to_owned(),
            shift,
            in_sigmas: shift / nominal.covariance()[(index, index)].sqrt(),
            unit: element.unit.to_owned(),
        }
    })
    .collect()
}

fn rms(record: &Record, noise: &NoiseModel, simulated_g: &[[f64; 3]]) -> f64 {
    let used = |row: usize, axis: usize| {
        let weight = noise.weights.as_ref().map_or(1.0, |w| w[row][axis]);
        weight > 0.0
    };
    let rows = record.accel_g.iter().zip(simulated_g).enumerate();
    let residuals = rows.flat_map(|(row, (measured, simulated))| {
        let there = (0..3).filter(move |axis| used(row, *axis));
        there.map(|axis| measured[axis] - simulated[axis])
    });
    rms_of_present(residuals).0
}
