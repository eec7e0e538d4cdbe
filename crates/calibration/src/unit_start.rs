//! How a record of a strapdown unit begins, and the axes of its instruments along a trajectory of the platform.

use gyrocal::trajectory::{Orientation, platform_c_enu};
use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use crate::gyro_axes::GyroAxes;

/// How a record of a strapdown unit begins that rests on the Earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnitStart {
    /// Unit quaternion (w, x, y, z) that takes components along the axes of the instruments to components along
    /// those of the platform, at the first row.
    pub platform_q_gyros: [f64; 4],
    /// Covariance of the error of the first attitude, a rotation vector along East, North and Up, rad².
    pub covariance_enu_rad2: [[f64; 3]; 3],
}

impl UnitStart {
    /// From the axes at the first row, and a prior of the platform's attitude there with its covariance along the
    /// platform's axes, rad².
    pub(crate) fn new(
        platform_q_gyros: [f64; 4],
        prior: &Orientation,
        covariance_rad2: &[[f64; 3]; 3],
    ) -> Self {
        let enu_c_platform = matrix(prior).transpose();
        Self {
            platform_q_gyros,
            covariance_enu_rad2: turned(covariance_rad2, &enu_c_platform),
        }
    }

    /// The start of another record of the unit: its platform begins along the axes of the instruments, as that of
    /// `gyrocal import strapdown` does. The attitude is known as well about East, North and Up.
    #[must_use]
    pub fn along_instruments(&self) -> Self {
        Self {
            platform_q_gyros: [1.0, 0.0, 0.0, 0.0],
            ..*self
        }
    }

    /// Standard deviation of the heading where the level is known, rad.
    #[must_use]
    pub fn heading_sigma_rad(&self) -> f64 {
        let covariance = &self.covariance_enu_rad2;
        let all = Matrix3::from_fn(|row, column| covariance[row][column]);
        // A level that is known to the last bit leaves the heading by itself.
        let information = all.try_inverse().map(|inverse| inverse[(2, 2)]);
        let known = information.filter(|information| *information > 0.0);
        known.map_or(covariance[2][2], f64::recip).sqrt()
    }

    /// Covariance of the error of the first attitude of the platform, a rotation vector along its axes, rad².
    pub(crate) fn covariance_rad2(&self, platform: &Orientation) -> [[f64; 3]; 3] {
        turned(&self.covariance_enu_rad2, &matrix(platform))
    }

    /// The rotation of [`Self::platform_q_gyros`].
    pub(crate) fn rotation(&self) -> UnitQuaternion<f64> {
        let [w, x, y, z] = self.platform_q_gyros;
        UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z))
    }

    /// Attitude of the unit, North and Up along the axes of its instruments, from that of the platform at the
    /// first row.
    pub(crate) fn attitude(&self, platform: &Orientation) -> Orientation {
        let gyros_c_platform = self.rotation().inverse();
        platform.map(|vector| (gyros_c_platform * Vector3::from(vector)).into())
    }

    /// Axes of the instruments of the unit at rest where its platform has these attitudes, from the first row on.
    pub(crate) fn axes(&self, points: &[Orientation]) -> GyroAxes {
        let Some(first) = points.first() else {
            return GyroAxes::new(&[]);
        };
        let enu_c_gyros = matrix(first).transpose() * self.rotation().to_rotation_matrix();
        let quaternion = |point: &Orientation| {
            let rotation = Rotation3::from_matrix_unchecked(matrix(point) * enu_c_gyros);
            let q = UnitQuaternion::from_rotation_matrix(&rotation);
            [q.w, q.i, q.j, q.k]
        };
        GyroAxes::new(&points.iter().map(quaternion).collect::<Vec<_>>())
    }
}

/// Components along the platform from components along East, North, Up.
fn matrix(platform: &Orientation) -> Matrix3<f64> {
    let rows = platform_c_enu(platform);
    Matrix3::from_fn(|row, column| rows[row][column])
}

/// A covariance along other axes.
fn turned(covariance: &[[f64; 3]; 3], to_c_from: &Matrix3<f64>) -> [[f64; 3]; 3] {
    let covariance = Matrix3::from_fn(|row, column| covariance[row][column]);
    let turned = to_c_from * covariance * to_c_from.transpose();
    // Equal to the last bit on both sides of the diagonal.
    core::array::from_fn(|i| core::array::from_fn(|j| turned[(i.max(j), i.min(j))]))
}

#[cfg(test)]
mod tests {
    use gyrocal::generated::platform::reanchor;
    use gyrocal::trajectory::orientation;

    use super::*;

    fn of_angles(angles_deg: [f64; 3]) -> Orientation {
        orientation(&reanchor(&angles_deg.map(f64::to_radians)).platform_c_chart)
    }

    #[test]
    fn a_heading_that_is_poorly_known_is_so_in_every_attitude() {
        let level = of_angles([0.0; 3]);
        // About the platform's z axis, which is up.
        let known = [[1e-8, 0.0, 0.0], [0.0, 1e-8, 0.0], [0.0, 0.0, 1e-2]];
        let start = UnitStart::new([1.0, 0.0, 0.0, 0.0], &level, &known);
        // The square root of the last variance, to rounding.
        assert!((start.heading_sigma_rad() - 0.1).abs() < 1e-12);
        for angles_deg in [[90.0, 0.0, 0.0], [20.0, -70.0, 130.0]] {
            let there = of_angles(angles_deg);
            let covariance = start.covariance_rad2(&there);
            for (index, vector) in there.iter().enumerate() {
                let along: f64 = (0..3)
                    .flat_map(|i| (0..3).map(move |j| (i, j)))
                    .map(|(i, j)| vector[i] * covariance[i][j] * vector[j])
                    .sum();
                // North is a level, up is the heading: some roundings of the largest element.
                let expected = [1e-8, 1e-2][index];
                assert!((along - expected).abs() < 1e-15, "{angles_deg:?} {along}");
            }
        }
    }

    #[test]
    fn axes_of_a_unit_at_rest_keep_north_and_up_along_themselves() {
        let half = 0.3_f64;
        let start = UnitStart {
            platform_q_gyros: [half.cos(), 0.0, half.sin(), 0.0],
            covariance_enu_rad2: [[0.0; 3]; 3],
        };
        let points = [[10.0, 20.0, 30.0], [40.0, 10.0, -60.0]].map(of_angles);
        let attitude = start.attitude(&points[0]);
        let axes = start.axes(&points);
        for (row, point) in points.iter().enumerate() {
            for (vector, expected) in point.iter().zip(&attitude) {
                let found = axes.along_gyros(row, vector);
                // Some roundings of numbers up to one.
                let far = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
                assert!(far.fold(0.0, f64::max) < 1e-14, "{row}: {found:?}");
            }
        }
    }
}
