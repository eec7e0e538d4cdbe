//! What an extended model gains.

mod accepted;
mod carried;
mod later;
mod score;

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::{CalibrationError, Extended, NoiseModel};
use gyrocal_record::Record;
use gyrocal_statistics::{NORMAL_97_5, rms_of_present};

pub use accepted::Acceptance;
pub(crate) use accepted::judge;
pub use later::{Compensation, Validation, validate};
use score::BLOCKS;

/// What the extended model is better by.
#[derive(Clone, Debug, PartialEq)]
pub struct Gain {
    /// Predictive log score of the blocks of a record, each given the others: extended less
    /// nominal, nats, block by block.
    pub block_log_score_nats: Vec<f64>,
    /// Root mean square of measured minus simulated specific force, the simulation running by
    /// itself from the first attitude, g: nominal, extended. Values that the noise audit left
    /// out are left out.
    pub free_run_rms_g: [f64; 2],
    /// What the noise of the accelerometers alone leaves of it, g. The gyros' noise adds to the
    /// drift as time goes on, and no model takes that away.
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
    /// Its standard deviation: the nominal estimate is wrong by the shift, which the record knows
    /// as well as it knows the extension.
    pub sigma: f64,
    /// The shift over the standard deviation that the nominal fit claimed.
    pub in_sigmas: f64,
    /// Unit of the shift.
    pub unit: &'static str,
    /// Standard deviation that the nominal fit claimed.
    pub claimed_sigma: f64,
}

impl CoefficientShift {
    /// 95 % interval of the shift.
    #[must_use]
    pub fn interval(&self) -> [f64; 2] {
        [-1.0, 1.0].map(|side| self.shift + side * NORMAL_97_5 * self.sigma)
    }

    /// The same over the standard deviation that the nominal fit claimed.
    #[must_use]
    pub fn interval_in_sigmas(&self) -> [f64; 2] {
        self.interval().map(|end| end / self.claimed_sigma)
    }
}

impl Gain {
    /// The log score of all blocks together, nats.
    #[must_use]
    pub fn log_score_nats(&self) -> f64 {
        self.block_log_score_nats.iter().sum()
    }
}

/// Measures what the second model gains over the first, the nominal one, on the record both were
/// fitted to with the same noise, of which `accel_noise_g` is declared; `scores` are the log scores
/// of its blocks with each.
///
/// # Errors
/// As [`Extended::log_evidence_without`].
pub(crate) fn gain(
    [nominal, extended]: [&Extended<'_>; 2],
    [before, after]: [[f64; BLOCKS]; 2],
    record: &Record,
    noise: &NoiseModel,
    accel_noise_g: f64,
) -> Result<Gain, CalibrationError> {
    let scores = after.iter().zip(before);
    let squares = noise.accel_ratio.iter().map(|ratio| ratio * ratio);
    Ok(Gain {
        block_log_score_nats: scores.map(|(after, before)| after - before).collect(),
        free_run_rms_g: [
            rms(record, noise, &nominal.free_run_g()?),
            rms(record, noise, &extended.free_run_g()?),
        ],
        noise_rms_g: accel_noise_g * (squares.sum::<f64>() / 3.0).sqrt(),
        coefficient_shift: DRIFT
            .iter()
            .enumerate()
            .map(|(i, element)| {
                let shift = extended.values()[i] - nominal.values()[i];
                let [before, after] = [nominal, extended].map(|fit| fit.covariance()[(i, i)]);
                CoefficientShift {
                    coefficient: element.id,
                    shift,
                    // Extended = nominal + shift, the two independent. An extension that does not
                    // touch a coefficient changes its variance by rounding only.
                    sigma: (after - before).max(0.0).sqrt(),
                    in_sigmas: shift / before.sqrt(),
                    unit: element.unit,
                    claimed_sigma: before.sqrt(),
                }
            })
            .collect(),
    })
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
