//! Where a platform may lie when the first row is taken.

use gyrocal::generated::platform::reanchor;
use gyrocal::trajectory::{Orientation, orientation, turned};
use gyrocal_record::{Bench, Record};
use nalgebra::{Matrix3, Vector3};

use crate::error::CalibrationError;

/// Azimuths that are tried when none is given: a filter finds its way from 8° beside the truth.
/// From 15° one record of two days at latitude 70° in five leads all of them astray.
const AZIMUTHS: usize = 24;

/// Standard deviation about a trial azimuth for the pass that ranks the trials, rad.
const TRIAL_AZIMUTH_SIGMA_RAD: f64 = 0.26;

/// Standard deviation of an unknown azimuth, rad: that of a uniform one is 1.81.
const UNKNOWN_AZIMUTH_SIGMA_RAD: f64 = 1.81;

/// Standard deviation of a tilt that the first samples have to tell, rad.
const UNKNOWN_TILT_SIGMA_RAD: f64 = 0.1;

/// An attitude before the record, with the covariance of its error as a rotation vector in
/// platform axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct InitialAttitude {
    pub(crate) orientation: Orientation,
    pub(crate) covariance: [[f64; 3]; 3],
}

/// What there is to try: what the joint solution takes as prior, and what the filter starts from.
pub(crate) struct Trial {
    pub(crate) prior: InitialAttitude,
    pub(crate) start: InitialAttitude,
}

/// The declared attitude, or the azimuths to try above a level found from the first samples.
pub(crate) fn trials(record: &Record, bench: &Bench) -> Result<Vec<Trial>, CalibrationError> {
    if let Some(angles_deg) = bench.initial_angles_deg {
        let prior = declared(angles_deg, bench.initial_angles_sigma_deg);
        return Ok(vec![Trial {
            prior,
            start: prior,
        }]);
    }
    let up = level(record).ok_or(CalibrationError::NotLevelled)?;
    // Any horizontal direction will do as the first azimuth.
    let smallest = (0..3).min_by(|a, b| up[*a].abs().total_cmp(&up[*b].abs()));
    let mut north = [0.0; 3];
    north[smallest.unwrap_or(0)] = 1.0;
    let along: f64 = (0..3).map(|i| north[i] * up[i]).sum();
    for i in 0..3 {
        north[i] -= along * up[i];
    }
    let length = north.iter().map(|x| x * x).sum::<f64>().sqrt();
    let first = [north.map(|component| component / length), up];
    Ok((0..AZIMUTHS)
        .map(|index| {
            let angle = core::f64::consts::TAU * index as f64 / AZIMUTHS as f64;
            let orientation = turned(&first, &up.map(|component| component * angle));
            Trial {
                prior: about(orientation, UNKNOWN_AZIMUTH_SIGMA_RAD),
                start: about(orientation, TRIAL_AZIMUTH_SIGMA_RAD),
            }
        })
        .collect())
}

/// Angles against East-North-Up and their independent standard deviations.
///
/// As the second angle goes to 90 degrees, the other two become angles about one axis, and their sigmas
/// leave a direction without any error. About no axis, therefore, does the attitude count as better known
/// than the best known angle.
fn declared(angles_deg: [f64; 3], sigma_deg: [f64; 3]) -> InitialAttitude {
    let at = reanchor(&angles_deg.map(f64::to_radians));
    let map = Matrix3::from(at.rotation_d_theta_dense()).transpose();
    let variance = Vector3::from(sigma_deg.map(|sigma| sigma.to_radians().powi(2)));
    let of_angles = map * Matrix3::from_diagonal(&variance) * map.transpose();
    let mut eigen = of_angles.symmetric_eigen();
    eigen
        .eigenvalues
        .apply(|value| *value = value.max(variance.min()));
    let covariance = eigen.recompose();
    InitialAttitude {
        orientation: orientation(&at.platform_c_chart),
        covariance: core::array::from_fn(|i| {
            core::array::from_fn(|j| covariance[(i.max(j), i.min(j))])
        }),
    }
}

/// An attitude whose tilt is nearly unknown and whose azimuth is known to some sigma.
fn about(orientation: Orientation, azimuth_sigma_rad: f64) -> InitialAttitude {
    let up = orientation[1];
    let tilt = UNKNOWN_TILT_SIGMA_RAD.powi(2);
    let excess = azimuth_sigma_rad.powi(2) - tilt;
    InitialAttitude {
        orientation,
        covariance: core::array::from_fn(|i| {
            core::array::from_fn(|j| excess * up[i] * up[j] + if i == j { tilt } else { 0.0 })
        }),
    }
}

/// Direction of specific force in platform axes, from the first row that has all components.
fn level(record: &Record) -> Option<[f64; 3]> {
    // A platform turns with a degree in four minutes at most: rows soon after the first tell its
    // tilt well within the sigma that is given to it.
    let first_s = *record.time_s.first()?;
    let row = record
        .accel_g
        .iter()
        .zip(&record.time_s)
        .find(|(row, time_s)| {
            row.iter().all(|component| component.is_finite()) && **time_s - first_s < 1200.0
        })?;
    let length = row.0.iter().map(|x| x * x).sum::<f64>().sqrt();
    (length > 0.0).then(|| row.0.map(|component| component / length))
}
