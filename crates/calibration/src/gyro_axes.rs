//! Axes of strapdown gyros in the platform that is computed from their outputs.

use gyrocal::trajectory::Orientation;
use gyrocal_record::Record;

/// Rotation from the gyros' axes to those of the platform at each row of a record.
#[derive(Clone, Debug, PartialEq)]
pub struct GyroAxes {
    /// Unit quaternions (w, x, y, z), of which neighbours lie in one half-space.
    platform_q_gyros: Vec<[f64; 4]>,
}

impl GyroAxes {
    /// From quaternions (w, x, y, z), one for each row, of any length but zero: `q` takes
    /// components along the gyros' axes to components along the platform's.
    #[must_use]
    pub fn new(platform_q_gyros: &[[f64; 4]]) -> Self {
        let mut before = [1.0, 0.0, 0.0, 0.0];
        let unit = platform_q_gyros.iter().map(|q| {
            // Both signs are one rotation, but interpolation needs neighbours of one sign.
            let sign = if dot(q, &before) < 0.0 { -1.0 } else { 1.0 };
            let scale = sign / dot(q, q).sqrt();
            before = q.map(|component| scale * component);
            before
        });
        Self {
            platform_q_gyros: unit.collect(),
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.platform_q_gyros.len()
    }

    /// True if there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.platform_q_gyros.is_empty()
    }

    /// The first of them.
    pub(crate) fn first(&self) -> Option<[f64; 4]> {
        self.platform_q_gyros.first().copied()
    }

    /// The attitudes at the rows of a record that has all or some of the rows of another, at the times of
    /// whose rows these are; `None` if it has others.
    #[must_use]
    pub fn of_rows(&self, times_s: &[f64], rows_s: &[f64]) -> Option<Self> {
        let chosen = rows_s.iter().map(|time_s| {
            let row = times_s.partition_point(|other| other < time_s);
            (times_s.get(row) == Some(time_s)).then(|| self.platform_q_gyros.get(row).copied())?
        });
        let platform_q_gyros = chosen.collect::<Option<_>>()?;
        Some(Self { platform_q_gyros })
    }

    /// Attitudes of the platform at the rows if the gyros' axes rest on the Earth, from about `first`: the mean
    /// specific force along these axes is up. The first that is given, turned, where no row has all components.
    pub(crate) fn trajectory(&self, record: &Record, first: &Orientation) -> Vec<Orientation> {
        let [north, up] = first.map(|vector| self.along_gyros(0, &vector));
        let mut sum = [0.0; 3];
        for (row, force) in record.accel_g.iter().enumerate().take(self.len()) {
            if force.iter().all(|value| value.is_finite()) {
                let along = self.along_gyros(row, force);
                sum = core::array::from_fn(|axis| sum[axis] + along[axis]);
            }
        }
        let up = unit(&sum).unwrap_or(up);
        let along_up: f64 = (0..3).map(|axis| north[axis] * up[axis]).sum();
        let level = core::array::from_fn(|axis| north[axis] - along_up * up[axis]);
        let north = unit(&level).unwrap_or(north);
        (0..self.len())
            .map(|row| {
                let matrix = self.between(row, 0.0);
                [north, up].map(|vector| {
                    core::array::from_fn(|axis| {
                        (0..3)
                            .map(|gyro| matrix[3 * axis + gyro] * vector[gyro])
                            .sum()
                    })
                })
            })
            .collect()
    }

    /// Components along the gyros' axes of a vector along those of the platform, at a row.
    pub(crate) fn along_gyros(&self, row: usize, vector: &[f64; 3]) -> [f64; 3] {
        let matrix = self.between(row, 0.0);
        core::array::from_fn(|gyro| {
            (0..3)
                .map(|axis| matrix[3 * axis + gyro] * vector[axis])
                .sum()
        })
    }

    /// Direction cosine matrix, by rows, at a share of the interval from a row to the next. The
    /// interpolated rotation is uniform to (angle)²/24 of it.
    pub(crate) fn between(&self, row: usize, share: f64) -> [f64; 9] {
        let from = &self.platform_q_gyros[row];
        let to = self.platform_q_gyros.get(row + 1).unwrap_or(from);
        let mean: [f64; 4] = core::array::from_fn(|i| (1.0 - share) * from[i] + share * to[i]);
        let scale = 1.0 / dot(&mean, &mean);
        let [w, x, y, z] = mean;
        [
            w * w + x * x - y * y - z * z,
            2.0 * (x * y - w * z),
            2.0 * (x * z + w * y),
            2.0 * (x * y + w * z),
            w * w - x * x + y * y - z * z,
            2.0 * (y * z - w * x),
            2.0 * (x * z - w * y),
            2.0 * (y * z + w * x),
            w * w - x * x - y * y + z * z,
        ]
        .map(|element| scale * element)
    }
}

fn unit(vector: &[f64; 3]) -> Option<[f64; 3]> {
    let norm = vector.iter().map(|x| x * x).sum::<f64>().sqrt();
    (norm > 0.0).then(|| vector.map(|component| component / norm))
}

fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_at_rest_turns_in_the_platform() {
        let turned = |angle: f64| [(0.5 * angle).cos(), (0.5 * angle).sin(), 0.0, 0.0];
        let axes = GyroAxes::new(&[0.0, 0.5].map(turned));
        let up = |angle: f64| [0.0, -angle.sin(), angle.cos()];
        let record = Record {
            time_s: vec![0.0, 60.0],
            accel_g: vec![up(0.0), up(0.5)],
            temperature_c: None,
        };
        // The first attitude is off by some degrees about east, which the rows correct.
        let first = [[0.0, 0.05_f64.cos(), 0.05_f64.sin()], up(0.05)];
        let points = axes.trajectory(&record, &first);
        for (point, angle) in points.iter().zip([0.0, 0.5_f64]) {
            let expected = [[0.0, angle.cos(), angle.sin()], up(angle)];
            for (found, expected) in point.as_flattened().iter().zip(expected.as_flattened()) {
                // Some roundings of numbers up to one.
                assert!((found - expected).abs() < 1e-14, "{point:?}");
            }
        }
    }

    #[test]
    fn rows_that_are_left_have_their_attitudes() {
        let turned = |angle: f64| [(0.5 * angle).cos(), 0.0, 0.0, (0.5 * angle).sin()];
        let axes = GyroAxes::new(&[0.0, 0.1, 0.2, 0.3].map(turned));
        let times_s = [0.0, 60.0, 120.0, 180.0];
        let some = axes.of_rows(&times_s, &[60.0, 180.0]);
        assert_eq!(some, Some(GyroAxes::new(&[0.1, 0.3].map(turned))));
        assert_eq!(axes.of_rows(&times_s, &[60.0, 90.0]), None);
    }

    #[test]
    fn a_quarter_turn_about_z_takes_x_to_y_whatever_the_sign() {
        let half = core::f64::consts::FRAC_PI_4;
        for sign in [1.0, -1.0] {
            let quarter = [half.cos(), 0.0, 0.0, half.sin()].map(|q| 3.0 * sign * q);
            let axes = GyroAxes::new(&[[1.0, 0.0, 0.0, 0.0], quarter]);
            let matrix = axes.between(1, 0.0);
            // Columns are the gyros' axes: rounding of some products.
            assert!((matrix[3] - 1.0).abs() < 1e-15 && (matrix[1] + 1.0).abs() < 1e-15);
            let along = axes.along_gyros(1, &[0.0, 1.0, 0.5]);
            assert!((along[0] - 1.0).abs() < 1e-15 && (along[2] - 0.5).abs() < 1e-15);
            // Halfway is an eighth.
            let between = axes.between(0, 0.5);
            assert!((between[3] - half.sin()).abs() < 1e-15, "{between:?}");
        }
    }
}
