//! Attitude as a unit quaternion, and its three angles.

use libm::{atan2, cos, hypot, sin};

/// The attitude of frame `t` against frame `s`: it resolves vectors of `s` in `t`.
///
/// A unit quaternion `(w, x, y, z)`; [`Attitude::matrix`] is `t_c_s`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attitude {
    w: f64,
    vector: [f64; 3],
}

impl Attitude {
    /// Both frames are the same.
    pub const IDENTITY: Self = Self {
        w: 1.0,
        vector: [0.0; 3],
    };

    /// The frame that `s` becomes when it is turned by a rotation vector \[rad\].
    #[must_use]
    pub fn turned_by(rotation_rad: [f64; 3]) -> Self {
        let angle = norm(rotation_rad);
        let half = 0.5 * angle;
        let scale = if angle > 0.0 { sin(half) / angle } else { 0.5 };
        Self::from_axis(rotation_rad, cos(half), scale)
    }

    /// The frame that `s` becomes when it is turned about a unit axis by an angle, given by cosine
    /// and sine of its half.
    pub(crate) fn from_axis(axis: [f64; 3], cos_half: f64, sin_half: f64) -> Self {
        Self {
            w: cos_half,
            vector: axis.map(|component| component * sin_half),
        }
    }

    /// From the angles about x, then y, then z: the frame is turned about its own x axis
    /// first, about the y axis that results, and about the z axis that results from both.
    #[must_use]
    pub fn from_angles_rad([x, y, z]: [f64; 3]) -> Self {
        let about_x = Self::turned_by([x, 0.0, 0.0]);
        let about_y = Self::turned_by([0.0, y, 0.0]);
        let about_z = Self::turned_by([0.0, 0.0, z]);
        about_z.after(about_y).after(about_x)
    }

    /// From four numbers that are normalised here; the identity if all are zero.
    #[must_use]
    pub fn from_quaternion(w: f64, vector: [f64; 3]) -> Self {
        if w == 0.0 && vector == [0.0; 3] {
            return Self::IDENTITY;
        }
        Self { w, vector }.normalised()
    }

    /// The angles about x, then y, then z \[rad\]; that about y within a quarter turn.
    ///
    /// At an angle about y of a quarter turn only the sum or the difference of the other two is
    /// determined.
    #[must_use]
    pub fn angles_rad(self) -> [f64; 3] {
        let t_c_s = self.matrix();
        [
            atan2(-t_c_s[2][1], t_c_s[2][2]),
            atan2(t_c_s[2][0], hypot(t_c_s[2][1], t_c_s[2][2])),
            atan2(-t_c_s[1][0], t_c_s[0][0]),
        ]
    }

    /// The same in degrees.
    #[must_use]
    pub fn angles_deg(self) -> [f64; 3] {
        self.angles_rad().map(f64::to_degrees)
    }

    /// The matrix `t_c_s`, row by row: its columns are the axes of `s` resolved in `t`.
    #[must_use]
    pub fn matrix(self) -> [[f64; 3]; 3] {
        let columns = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let columns = columns.map(|axis| self.resolve(axis));
        core::array::from_fn(|row| columns.map(|column| column[row]))
    }

    /// A vector given in `s`, resolved in `t`.
    #[must_use]
    pub fn resolve(self, in_s: [f64; 3]) -> [f64; 3] {
        // The frame turns, so the components of a fixed vector turn the other way.
        let twice = cross(self.vector, in_s).map(|component| 2.0 * component);
        let again = cross(self.vector, twice);
        core::array::from_fn(|i| in_s[i] - self.w * twice[i] + again[i])
    }

    /// The attitude of `s` against `t`.
    #[must_use]
    pub fn inverse(self) -> Self {
        let vector = self.vector.map(|component| -component);
        Self { vector, ..self }
    }

    /// With `self` as `t` against `s` and `first` as `s` against `r`: `t` against `r`.
    #[must_use]
    pub fn after(self, first: Self) -> Self {
        let (a, b) = (first, self);
        let cross = cross(a.vector, b.vector);
        Self {
            w: a.w * b.w - dot(a.vector, b.vector),
            vector: core::array::from_fn(|i| a.w * b.vector[i] + b.w * a.vector[i] + cross[i]),
        }
    }

    /// The rotation vector that turns `other` into `self`, in axes of `other` \[rad\].
    #[must_use]
    pub fn rotation_from_rad(self, other: Self) -> [f64; 3] {
        let mut step = self.after(other.inverse());
        if step.w < 0.0 {
            // The same attitude.
            step = step.inverse();
            step.w = -step.w;
        }
        let sine = norm(step.vector);
        let scale = match sine > 0.0 {
            true => 2.0 * atan2(sine, step.w) / sine,
            false => 2.0,
        };
        step.vector.map(|component| component * scale)
    }

    /// Its length, 1 but for rounding.
    #[must_use]
    pub fn length(self) -> f64 {
        (self.w * self.w + dot(self.vector, self.vector)).sqrt()
    }

    /// Rate of change of the four numbers when `t` turns at a rate given in its own axes.
    pub(crate) fn derivative(self, rate_rad_per_s: [f64; 3]) -> [f64; 4] {
        let cross = cross(self.vector, rate_rad_per_s);
        let [x, y, z] = core::array::from_fn(|i| 0.5 * (self.w * rate_rad_per_s[i] + cross[i]));
        [-0.5 * dot(self.vector, rate_rad_per_s), x, y, z]
    }

    /// The four numbers moved by `scale` times their rates of change, not normalised.
    pub(crate) fn moved(self, scale: f64, rates: [f64; 4]) -> Self {
        Self {
            w: self.w + scale * rates[0],
            vector: core::array::from_fn(|i| self.vector[i] + scale * rates[i + 1]),
        }
    }

    /// With length 1.
    pub(crate) fn normalised(self) -> Self {
        let scale = 1.0 / self.length();
        Self::from_axis(self.vector, self.w * scale, scale)
    }
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn norm(a: [f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `Rz Ry Rx` of the elementary passive rotations, multiplied out by hand.
    fn by_matrices([x, y, z]: [f64; 3]) -> [[f64; 3]; 3] {
        let rx = [
            [1.0, 0.0, 0.0],
            [0.0, cos(x), sin(x)],
            [0.0, -sin(x), cos(x)],
        ];
        let ry = [
            [cos(y), 0.0, -sin(y)],
            [0.0, 1.0, 0.0],
            [sin(y), 0.0, cos(y)],
        ];
        let rz = [
            [cos(z), sin(z), 0.0],
            [-sin(z), cos(z), 0.0],
            [0.0, 0.0, 1.0],
        ];
        product(rz, product(ry, rx))
    }

    fn product(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
        a.map(|row| core::array::from_fn(|j| (0..3).map(|k| row[k] * b[k][j]).sum()))
    }

    fn worst(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> f64 {
        let pairs = a.into_iter().flatten().zip(b.into_iter().flatten());
        let off = pairs.map(|(a, b): (f64, f64)| (a - b).abs());
        off.fold(0.0, f64::max)
    }

    /// Three turns of a few roundings each.
    const ROUNDING: f64 = 1e-15;

    const ANGLES_RAD: [[f64; 3]; 5] = [
        [0.3, -0.5, 1.1],
        [-2.9, 1.2, 3.0],
        [1.7, -1.4, -0.2],
        [0.0, 0.0, 0.0],
        [3.1, 0.01, -3.1],
    ];

    #[test]
    fn the_angles_are_those_of_the_elementary_rotations() {
        for angles_rad in ANGLES_RAD {
            let attitude = Attitude::from_angles_rad(angles_rad);
            assert!(worst(attitude.matrix(), by_matrices(angles_rad)) < ROUNDING);
            for (again, angle) in attitude.angles_rad().into_iter().zip(angles_rad) {
                assert!((again - angle).abs() < 4.0 * ROUNDING, "{again} {angle}");
            }
        }
    }

    #[test]
    fn attitudes_compose_as_matrices_do() {
        let b = Attitude::from_angles_rad(ANGLES_RAD[0]);
        let a = Attitude::from_angles_rad(ANGLES_RAD[1]);
        assert!(worst(a.after(b).matrix(), product(a.matrix(), b.matrix())) < ROUNDING);
        let identity = a.after(a.inverse()).matrix();
        assert!(worst(identity, Attitude::IDENTITY.matrix()) < ROUNDING);
    }

    #[test]
    fn the_rotation_vector_between_two_attitudes_turns_one_into_the_other() {
        let from = Attitude::from_angles_rad(ANGLES_RAD[1]);
        let to = Attitude::from_angles_rad(ANGLES_RAD[2]);
        let again = Attitude::turned_by(to.rotation_from_rad(from)).after(from);
        assert!(worst(again.matrix(), to.matrix()) < 2.0 * ROUNDING);
    }
}
