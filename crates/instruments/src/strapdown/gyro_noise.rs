//! White noise of the gyros from the motion of gravity in the virtual platform.

use gyrocal_statistics::allan::{allan_deviation, octaves};

use super::integrate::PlatformRow;
use super::rotation_fit::RotationFit;
use crate::earth_rate::deg_per_h;
use crate::error::InstrumentError;

/// Upper limit of the white noise of the gyros about horizontal axes, as held over one minute
/// \[deg/h\]: the least product of Allan deviation and root averaging time over the motion of gravity in
/// the virtual platform about its uniform rotation. The outputs of the gyros themselves would count
/// true rocking as noise.
pub(super) fn gyro_noise_deg_per_h(
    rows: &[PlatformRow],
    norm_g: f64,
    fit: &RotationFit,
    averaging_s: f64,
) -> Result<f64, InstrumentError> {
    const CONFIDENCE: f64 = 0.683;
    const FEWEST_DEGREES_OF_FREEDOM: f64 = 4.0;
    let start_s = rows[0].time_s;
    let residuals: Vec<[f64; 2]> = rows
        .iter()
        .map(|row| {
            let force = row.force_g.map(|component| component / norm_g);
            fit.horizontal_residual(row.time_s - start_s, force)
        })
        .collect();
    let mut largest = 0.0_f64;
    for axis in 0..2 {
        let rates: Vec<f64> = residuals
            .windows(2)
            .map(|pair| deg_per_h((pair[1][axis] - pair[0][axis]) / averaging_s))
            .collect();
        let points = allan_deviation(&rates, averaging_s, &octaves(rates.len()), CONFIDENCE)?;
        let lowest = points
            .iter()
            .filter(|point| point.degrees_of_freedom >= FEWEST_DEGREES_OF_FREEDOM)
            .map(|point| point.deviation * (point.tau_s / 60.0).sqrt())
            .fold(f64::INFINITY, f64::min);
        largest = largest.max(lowest);
    }
    Ok(largest)
}
