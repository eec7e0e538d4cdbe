//! Prior of the attitude at the first row.

use gyrocal::generated::platform::reanchor;
use gyrocal::trajectory::{Orientation, orientation, turned};
use gyrocal_record::{Bench, Record};
use nalgebra::{Matrix3, Vector3};

use crate::error::CalibrationError;

/// Number of azimuths tried when none is declared, one every 15°. A filter converges from 8° off the
/// truth; with 15° all of them diverge in one of five records of two days at latitude 70°.
const AZIMUTHS: usize = 24;

/// Standard deviation of the azimuth for the filters that rank the hypotheses, rad.
const HYPOTHESIS_AZIMUTH_SIGMA_RAD: f64 = 0.26;

/// Standard deviation of an unknown azimuth, rad: that of a uniform one is 1.81.
const UNKNOWN_AZIMUTH_SIGMA_RAD: f64 = 1.81;

/// Standard deviation of a tilt that is estimated from the first samples, rad.
const UNKNOWN_TILT_SIGMA_RAD: f64 = 0.1;

/// Prior of the first attitude: its mean, and the covariance of its error as a rotation vector in
/// platform axes, rad².
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct AttitudePrior {
    pub(crate) orientation: Orientation,
    pub(crate) covariance: [[f64; 3]; 3],
}

/// A hypothesis on the first attitude.
#[derive(Clone, Copy)]
pub(crate) struct AttitudeHypothesis {
    /// Prior of the joint solution.
    pub(crate) prior: AttitudePrior,
    /// Prior of the filter that gives the initial trajectory.
    pub(crate) start: AttitudePrior,
}

/// The declared attitude, or one hypothesis for each azimuth tried, levelled by the first samples.
pub(crate) fn attitude_hypotheses(
    record: &Record,
    bench: &Bench,
) -> Result<Vec<AttitudeHypothesis>, CalibrationError> {
    if let Some(angles_deg) = bench.initial_angles_deg {
        let prior = declared(angles_deg, bench.initial_angles_sigma_deg);
        return Ok(vec![AttitudeHypothesis {
            prior,
            start: prior,
        }]);
    }
    let up = level(record).ok_or(CalibrationError::NotLevelled)?;
    // The first azimuth is arbitrary.
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
            AttitudeHypothesis {
                prior: levelled_prior(orientation, UNKNOWN_AZIMUTH_SIGMA_RAD),
                start: levelled_prior(orientation, HYPOTHESIS_AZIMUTH_SIGMA_RAD),
            }
        })
        .collect())
}

/// Prior from angles against East-North-Up and their independent standard deviations.
///
/// As the second angle tends to 90 degrees, the other two become angles about one axis and their
/// sigmas leave a direction without error. The variance about every axis is therefore at least that
/// of the best known angle.
fn declared(angles_deg: [f64; 3], sigma_deg: [f64; 3]) -> AttitudePrior {
    let at = reanchor(&angles_deg.map(f64::to_radians));
    let map = Matrix3::from(at.rotation_d_theta_dense()).transpose();
    let variance = Vector3::from(sigma_deg.map(|sigma| sigma.to_radians().powi(2)));
    let of_angles = map * Matrix3::from_diagonal(&variance) * map.transpose();
    let mut eigen = of_angles.symmetric_eigen();
    eigen
        .eigenvalues
        .apply(|value| *value = value.max(variance.min()));
    let covariance = eigen.recompose();
    AttitudePrior {
        orientation: orientation(&at.platform_c_chart),
        covariance: core::array::from_fn(|i| {
            core::array::from_fn(|j| covariance[(i.max(j), i.min(j))])
        }),
    }
}

/// Prior with the tilt's sigma of an estimated level and a given sigma of the azimuth.
fn levelled_prior(orientation: Orientation, azimuth_sigma_rad: f64) -> AttitudePrior {
    let up = orientation[1];
    let tilt = UNKNOWN_TILT_SIGMA_RAD.powi(2);
    let excess = azimuth_sigma_rad.powi(2) - tilt;
    AttitudePrior {
        orientation,
        covariance: core::array::from_fn(|i| {
            core::array::from_fn(|j| excess * up[i] * up[j] + if i == j { tilt } else { 0.0 })
        }),
    }
}

/// Direction of specific force in platform axes, from the first row that has all components.
fn level(record: &Record) -> Option<[f64; 3]> {
    // A platform turns by a degree in four minutes at most: a row of the first 20 minutes gives the
    // tilt well within its sigma.
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
