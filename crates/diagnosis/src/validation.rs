//! Gain of an extended model: cross-validation, open-loop simulation, change of the coefficients, and
//! validation on a later record.

mod block_scores;
mod continued_parameters;
mod cross_validation;
mod later_record;

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::{CalibrationError, FittedPlatform, NoiseModel};
use gyrocal_record::Record;

pub(crate) use cross_validation::{CrossValidated, KeepDecision, cross_validate};
pub(crate) use later_record::predict;
pub use later_record::{AttitudeErrors, LaterPrediction};

use crate::open_loop::OpenLoopSimulation;
use gyrocal_answer::{CoefficientShift, FreeRun, Gain, Prediction};

/// Gain of the second model over the first, the nominal one, on the record both were fitted to with
/// the same noise, of which `accel_noise_g` is declared. `scores` are the log scores of its blocks
/// with each, and `effects` the causes that the second has.
///
/// # Errors
/// As [`OpenLoopSimulation::new`].
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
            before: OpenLoopSimulation::new(nominal, record)?.rms_g,
            after: OpenLoopSimulation::new(extended, record)?.rms_g,
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
