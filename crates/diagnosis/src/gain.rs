//! What an extended model gains.

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::{CalibrationError, Extended};
use gyrocal_record::Record;

/// Contiguous blocks that are left out in turn. A last-block hold-out would misjudge effects at
/// the start of a record.
const BLOCKS: usize = 6;

/// What the extended model is better by.
#[derive(Clone, Debug, PartialEq)]
pub struct Gain {
    /// Predictive log score of the blocks of a record, each given the others: extended less
    /// nominal, nats, block by block.
    pub block_log_score_nats: Vec<f64>,
    /// Root mean square of measured minus simulated specific force, the simulation running by
    /// itself from the first attitude, g: nominal, extended.
    pub free_run_rms_g: [f64; 2],
    /// What noise alone leaves of it, g: the accelerometers'.
    pub noise_rms_g: f64,
    /// What the extension changes of each coefficient.
    pub coefficient_shift: Vec<CoefficientShift>,
}

/// A coefficient that an extension changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoefficientShift {
    /// Public id, such as `gyro_x.bias`.
    pub coefficient: &'static str,
    /// Extended less nominal estimate.
    pub shift: f64,
    /// Over the standard deviation that the nominal fit claimed.
    pub in_sigmas: f64,
    /// Unit of the shift.
    pub unit: &'static str,
}

impl Gain {
    /// The log score of all blocks together, nats.
    #[must_use]
    pub fn log_score_nats(&self) -> f64 {
        self.block_log_score_nats.iter().sum()
    }
}

/// Measures what `extended` gains over `nominal` on the record both were fitted to.
///
/// # Errors
/// As [`Extended::log_evidence_without`].
pub fn gain(
    nominal: &Extended<'_>,
    extended: &Extended<'_>,
    record: &Record,
    noise_g: [f64; 3],
) -> Result<Gain, CalibrationError> {
    let rows = record.len();
    let whole = [nominal, extended].map(|fit| fit.log_evidence_without(0..0));
    let [nominal_whole, extended_whole] = whole;
    let whole = extended_whole? - nominal_whole?;
    let mut block_log_score_nats = Vec::with_capacity(BLOCKS);
    for block in 0..BLOCKS {
        let left_out = block * rows / BLOCKS..(block + 1) * rows / BLOCKS;
        let without = extended.log_evidence_without(left_out.clone())?
            - nominal.log_evidence_without(left_out)?;
        block_log_score_nats.push(whole - without);
    }
    Ok(Gain {
        block_log_score_nats,
        free_run_rms_g: [
            rms(record, &nominal.free_run_g()?),
            rms(record, &extended.free_run_g()?),
        ],
        noise_rms_g: (noise_g.iter().map(|sigma| sigma * sigma).sum::<f64>() / 3.0).sqrt(),
        coefficient_shift: DRIFT
            .iter()
            .enumerate()
            .map(|(i, element)| {
                let shift = extended.values()[i] - nominal.values()[i];
                CoefficientShift {
                    coefficient: element.id,
                    shift,
                    in_sigmas: shift / nominal.covariance()[(i, i)].sqrt(),
                    unit: element.unit,
                }
            })
            .collect(),
    })
}

fn rms(record: &Record, simulated_g: &[[f64; 3]]) -> f64 {
    let squares = record
        .accel_g
        .iter()
        .zip(simulated_g)
        .flat_map(|(measured, simulated)| (0..3).map(move |i| measured[i] - simulated[i]))
        .filter(|residual| !residual.is_nan())
        .map(|residual| residual * residual);
    let (count, sum) = squares.fold((0.0, 0.0), |(count, sum), square| {
        (count + 1.0, sum + square)
    });
    (sum / f64::max(count, 1.0)).sqrt()
}
