//! Gravity turning uniformly in the axes of the virtual platform.

use nalgebra::{DMatrix, DVector, Matrix3, UnitQuaternion, Vector3};

use crate::least_squares::minimise;

/// A uniform rotation of gravity, fitted to specific force in platform axes.
///
/// On a static base the rate is that of the Earth less the platform's drift, both of them
/// constant in the platform's axes (the drift -R δω turns with the body, whose own rate is the
/// one it is added to). Its vertical part and the size of its horizontal part do not depend on
/// the heading, its direction is the heading.
#[derive(Debug, Clone, PartialEq)]
pub struct RotationFit {
    /// Up in platform axes at the time zero of the points.
    pub up: [f64; 3],
    /// The rate in platform axes \[rad/s\].
    pub rate: [f64; 3],
    /// Its covariance \[rad²/s²\].
    pub rate_covariance: [[f64; 3]; 3],
    /// Size of its horizontal part, and its standard deviation \[rad/s\].
    pub horizontal_rate_rad_per_s: [f64; 2],
    /// Its vertical part, and its standard deviation \[rad/s\].
    pub vertical_rate_rad_per_s: [f64; 2],
    /// Residuals, rms a component.
    pub residual_rms_g: f64,
    /// Correlation of residuals of successive points.
    pub residual_correlation: f64,
}

const UNKNOWNS: usize = 6;

/// Fits points (time \[s\], specific force of norm one), from a first guess of the rate \[rad/s\].
///
/// Standard deviations take correlated residuals into account as a first-order process.
#[must_use]
pub fn fit_rotation(points: &[(f64, [f64; 3])], first_guess: [f64; 3]) -> RotationFit {
    let duration_s = points.last().map_or(1.0, |(time_s, _)| time_s.max(1.0));
    // Unknowns: gravity at time zero, and the angles turned in the whole time.
    let residuals = |unknowns: &[f64]| -> Vec<f64> {
        let start = Vector3::new(unknowns[0], unknowns[1], unknowns[2]);
        let turn = Vector3::new(unknowns[3], unknowns[4], unknowns[5]);
        let residual = |(time_s, force): &(f64, [f64; 3])| {
            let rotation = UnitQuaternion::from_scaled_axis(turn * (time_s / duration_s));
            let residual = rotation * start - Vector3::from(*force);
            [residual.x, residual.y, residual.z]
        };
        points.iter().flat_map(residual).collect()
    };
    let mut start = [0.0; UNKNOWNS];
    start[..3].copy_from_slice(&points[0].1);
    for axis in 0..3 {
        start[3 + axis] = first_guess[axis] * duration_s;
    }
    let minimum = minimise(&start, &[1e-6; UNKNOWNS], residuals);
    let u = &minimum.unknowns;
    let up = Vector3::new(u[0], u[1], u[2]).normalize();
    let rate = Vector3::new(u[3], u[4], u[5]) / duration_s;
    let freedom = (3 * points.len()).saturating_sub(UNKNOWNS).max(1) as f64;
    let variance = minimum.cost() / freedom;
    let correlation = correlation(&minimum.residuals);
    // A first-order process of correlation r has (1 + r) / (1 - r) of the white variance in means.
    let inflation = ((1.0 + correlation) / (1.0 - correlation)).clamp(1.0, 1e3);
    let residual_rms_g = variance.sqrt();
    let cofactors = minimum
        .cofactors
        .unwrap_or_else(|| DMatrix::from_diagonal(&DVector::from_element(UNKNOWNS, f64::NAN)));
    let rate_covariance: Matrix3<f64> =
        cofactors.fixed_view::<3, 3>(3, 3) * (variance * inflation / (duration_s * duration_s));
    let vertical = rate.dot(&up);
    let across = rate - up * vertical;
    let sigma = |direction: Vector3<f64>| direction.dot(&(rate_covariance * direction)).sqrt();
    RotationFit {
        up: up.into(),
        rate: rate.into(),
        horizontal_rate_rad_per_s: [across.norm(), sigma(across.normalize())],
        vertical_rate_rad_per_s: [vertical, sigma(up)],
        residual_rms_g,
        residual_correlation: correlation,
        rate_covariance: core::array::from_fn(|row| {
            core::array::from_fn(|column| rate_covariance[(row, column)])
        }),
    }
}

impl RotationFit {
    /// Specific force of norm one at a time, less gravity as it turns uniformly, along two
    /// horizontal axes that turn with it.
    #[must_use]
    pub fn horizontal_residual(&self, time_s: f64, force: [f64; 3]) -> [f64; 2] {
        let turned = UnitQuaternion::from_scaled_axis(Vector3::from(self.rate) * time_s);
        let residual = turned.inverse() * Vector3::from(force) - Vector3::from(self.up);
        let along = |column: usize| {
            let axes = self.platform_c_enu();
            (0..3).map(|axis| axes[axis][column] * residual[axis]).sum()
        };
        [along(0), along(1)]
    }

    /// Platform from east, north, up at time zero, north being where the rate's horizontal part
    /// points.
    #[must_use]
    pub fn platform_c_enu(&self) -> [[f64; 3]; 3] {
        self.turned_platform_c_enu(0.0)
    }

    /// The same for a platform turned clockwise from there about the vertical \[rad\].
    #[must_use]
    pub fn turned_platform_c_enu(&self, clockwise_rad: f64) -> [[f64; 3]; 3] {
        let up = Vector3::from(self.up);
        let rate = Vector3::from(self.rate);
        let north = (rate - up * rate.dot(&up)).normalize();
        let east = north.cross(&up);
        // A platform turned clockwise sees north turned counterclockwise.
        let (sine, cosine) = clockwise_rad.sin_cos();
        let (north, east) = (north * cosine - east * sine, east * cosine + north * sine);
        core::array::from_fn(|axis| [east[axis], north[axis], up[axis]])
    }
}

/// Lag 1 correlation of residuals that come by three.
fn correlation(residuals: &[f64]) -> f64 {
    let products = residuals.iter().zip(&residuals[3..]).map(|(a, b)| a * b);
    let squares = residuals.iter().map(|residual| residual * residual);
    products.sum::<f64>() / squares.sum::<f64>().max(f64::MIN_POSITIVE)
}
