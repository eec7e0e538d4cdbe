//! What an error of the declared latitude would do to the coefficients.

use gyrocal_calibration::{Calibration, CalibrationError, Options, calibrate};
use gyrocal_record::{Bench, Record};

const ARC_SECOND_DEG: f64 = 1.0 / 3600.0;

/// How an error of latitude moves the coefficients that stand for mass unbalance.
///
/// No sigma includes it: Earth rate is known so well that the record cannot tell a latitude
/// error from a common part of the three D_I (docs/model.md, "What the data cannot tell").
#[derive(Debug, Clone, Copy)]
pub(crate) struct LatitudeEffect {
    /// Change of the mean of the three D_I for each arc second of latitude, without sign.
    pub(crate) mean_d_i_deg_per_h_per_g: f64,
    /// The largest change of one of them.
    pub(crate) largest_d_i_deg_per_h_per_g: f64,
}

impl LatitudeEffect {
    /// Filters the record again with latitude one arc second nearer to the equator.
    pub(crate) fn of(
        calibration: &Calibration,
        record: &Record,
        bench: &Bench,
        options: &Options,
        progress: impl FnMut(usize),
    ) -> Result<Self, CalibrationError> {
        let bench = Bench {
            latitude_deg: bench.latitude_deg - ARC_SECOND_DEG.copysign(bench.latitude_deg),
            ..bench.clone()
        };
        let shifted = calibrate(record, &bench, options, progress)?;
        let [before, after] = [calibration, &shifted].map(|calibration| {
            let drift = &calibration.drift;
            [drift.gyro_x_g_x, drift.gyro_y_g_y, drift.gyro_z_g_z]
        });
        let shifts: [f64; 3] = core::array::from_fn(|gyro| after[gyro] - before[gyro]);
        Ok(Self {
            mean_d_i_deg_per_h_per_g: (shifts.iter().sum::<f64>() / 3.0).abs(),
            largest_d_i_deg_per_h_per_g: shifts.into_iter().map(f64::abs).fold(0.0, f64::max),
        })
    }
}
