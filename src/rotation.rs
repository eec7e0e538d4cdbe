//! Small rotations and attitude matrices.

use gyrocal_scalar::Scalar;

/// `a` × `b`.
#[inline(always)]
pub(crate) fn cross<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> [T; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `a` · `b`.
#[inline(always)]
pub(crate) fn dot<T: Scalar>(a: &[T; 3], b: &[T; 3]) -> T {
    a[0].mul_add(b[0], a[1].mul_add(b[1], a[2] * b[2]))
}

/// `matrix` times `vector`.
#[inline(always)]
pub(crate) fn rotate<T: Scalar>(matrix: &[[T; 3]; 3], vector: &[T; 3]) -> [T; 3] {
    [
        dot(&matrix[0], vector),
        dot(&matrix[1], vector),
        dot(&matrix[2], vector),
    ]
}

/// exp(-[φ]×), the matrix of new from old components when the axes turn by the vector φ.
///
/// Below a hundredth of a radian, where corrections are, sine and cosine are series in |φ|² to
/// the last bit: no root, and no division by a small angle. Beyond, (1 - cos|φ|) / |φ|² cancels
/// to 2^-52 / |φ|², which |φ|² takes back.
#[inline(always)]
pub(crate) fn turned_by<T: Scalar + PartialOrd>(phi: &[T; 3]) -> [[T; 3]; 3] {
    let one = T::from_f64(1.0);
    let square = dot(phi, phi);
    // sin|φ| / |φ| and (1 - cos|φ|) / |φ|²
    let (s, c) = if square < T::from_f64(1e-4) {
        let constant = T::from_f64;
        let s = one - square * (constant(1.0 / 6.0) - square * constant(1.0 / 120.0));
        let c = constant(0.5) - square * (constant(1.0 / 24.0) - square * constant(1.0 / 720.0));
        (s, c)
    } else {
        let angle = square.sqrt();
        let (sine, cosine) = angle.sin_cos();
        (sine / angle, (one - cosine) / square)
    };
    let [x, y, z] = *phi;
    let (sx, sy, sz) = (s * x, s * y, s * z);
    let (cx, cy) = (c * x, c * y);
    let (xy, xz, yz) = (cx * y, cx * z, cy * z);
    let (xx, yy, zz) = (cx * x, cy * y, c * z * z);
    [
        [one - yy - zz, xy + sz, xz - sy],
        [xy - sz, one - xx - zz, yz + sx],
        [xz + sy, yz - sx, one - xx - yy],
    ]
}

/// The mean of exp(-s [φ]×) over s from 0 to 1: to first order, turning by φ + δ is turning by φ
/// and then by this times δ (the left Jacobian of the rotation group at -φ).
#[cfg(any(test, feature = "batch"))]
#[inline]
pub(crate) fn mean_turn<T: Scalar + PartialOrd>(phi: &[T; 3]) -> [[T; 3]; 3] {
    let one = T::from_f64(1.0);
    let square = dot(phi, phi);
    // (1 - cos|φ|) / |φ|² and (|φ| - sin|φ|) / |φ|³; below a hundredth of a radian their series,
    // to the last bit.
    let (b, c) = if square < T::from_f64(1e-4) {
        let constant = T::from_f64;
        let b = constant(0.5) - square * (constant(1.0 / 24.0) - square * constant(1.0 / 720.0));
        let c = constant(1.0 / 6.0)
            - square * (constant(1.0 / 120.0) - square * constant(1.0 / 5040.0));
        (b, c)
    } else {
        let angle = square.sqrt();
        let (sine, cosine) = angle.sin_cos();
        ((one - cosine) / square, (angle - sine) / (square * angle))
    };
    let [x, y, z] = *phi;
    // I - b [φ]× + c [φ]×²
    [
        [
            one - c * (y * y + z * z),
            b * z + c * x * y,
            c * x * z - b * y,
        ],
        [
            c * x * y - b * z,
            one - c * (x * x + z * z),
            b * x + c * y * z,
        ],
        [
            b * y + c * x * z,
            c * y * z - b * x,
            one - c * (x * x + y * y),
        ],
    ]
}

/// The vector φ of at most half a turn with exp(-[φ]×) = `matrix`: the inverse of [`turned_by`].
#[cfg(any(test, feature = "batch"))]
#[inline]
pub(crate) fn rotation_vector<T: Scalar + PartialOrd>(matrix: &[[T; 3]; 3]) -> [T; 3] {
    let (one, half) = (T::from_f64(1.0), T::from_f64(0.5));
    let c = matrix;
    // sin|φ| φ / |φ|
    let v = [
        half * (c[1][2] - c[2][1]),
        half * (c[2][0] - c[0][2]),
        half * (c[0][1] - c[1][0]),
    ];
    let cosine = half * (c[0][0] + c[1][1] + c[2][2] - one);
    let square = dot(&v, &v);
    if cosine > T::from_f64(0.0) && square < T::from_f64(1e-6) {
        // asin(s) / s; the next term is below the last bit.
        let scale = one + square * (T::from_f64(1.0 / 6.0) + square * T::from_f64(3.0 / 40.0));
        return v.map(|component| component * scale);
    }
    let sine = square.sqrt();
    let angle = sine.atan2(cosine);
    if cosine > T::from_f64(-0.9) {
        return v.map(|component| component * angle / sine);
    }
    // Near half a turn the antisymmetric part vanishes; the axis is in the symmetric part
    // cos|φ| I + (1 - cos|φ|) n nᵀ, whose largest column is the safest.
    let mut largest = 0;
    for i in 1..3 {
        if c[i][i] > c[largest][largest] {
            largest = i;
        }
    }
    let mut axis = [T::from_f64(0.0); 3];
    for (i, component) in axis.iter_mut().enumerate() {
        *component = half * (c[i][largest] + c[largest][i]);
    }
    axis[largest] = axis[largest] - cosine;
    let length = dot(&axis, &axis).sqrt();
    let direction = if dot(&axis, &v) < T::from_f64(0.0) {
        -angle / length
    } else {
        angle / length
    };
    axis.map(|component| component * direction)
}

// emit: off
/// Platform angles of equation (4) from the direction cosine matrix: rotations about x, then
/// y, then z. At theta_y = ±90° only a combination of x and z is determined.
#[inline]
pub(crate) fn angles<T: Scalar>(platform_c_enu: &[[T; 3]; 3]) -> [T; 3] {
    let one = T::from_f64(1.0);
    let c = platform_c_enu;
    [
        (-c[2][1]).atan2(c[2][2]),
        c[2][0].min(one).max(-one).asin(),
        (-c[1][0]).atan2(c[0][0]),
    ]
}
// emit: on

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generated::platform::reanchor;

    fn largest_difference(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> f64 {
        let pairs = a.iter().flatten().zip(b.iter().flatten());
        pairs.fold(0.0, |worst: f64, (x, y)| worst.max((x - y).abs()))
    }

    #[test]
    fn a_rotation_vector_comes_back_from_its_matrix() {
        let direction = [0.36, -0.48, 0.8];
        for angle in [
            0.0,
            1e-9,
            9e-4,
            1.1e-3,
            0.3,
            1.5,
            2.6,
            2.8,
            3.1,
            core::f64::consts::PI - 1e-4,
        ] {
            let phi = direction.map(|component| component * angle);
            let back = rotation_vector(&turned_by(&phi));
            for (back, phi) in back.iter().zip(phi) {
                // Near half a turn the angle comes from its sine and the axis from a column that
                // cosines are subtracted from: some units of the last place of 3.
                assert!(
                    (back - phi).abs() < 4e-15 * (1.0 + angle),
                    "{angle}: {back} {phi}"
                );
            }
        }
    }

    #[test]
    fn a_turn_about_one_axis_is_the_elementary_rotation_on_both_branches() {
        for angle in [1e-9, 0.009, 0.0099, 0.0101, 0.1, 2.0] {
            for axis in 0..3 {
                let mut phi = [0.0; 3];
                phi[axis] = angle;
                let expected = reanchor(&phi).platform_c_chart;
                // Two formulas of a handful of operations each.
                assert!(
                    largest_difference(&turned_by(&phi), &expected) < 4e-16,
                    "{axis} {angle}"
                );
            }
        }
    }

    #[test]
    fn turning_by_parts_about_one_axis_adds_up() {
        let phi = [0.11, -0.07, 0.2];
        let third = phi.map(|component| component / 3.0);
        let part = turned_by(&third);
        let whole = turned_by(&phi);
        for axis in 0..3 {
            let mut vector = [0.0; 3];
            vector[axis] = 1.0;
            let stepwise = rotate(&part, &rotate(&part, &rotate(&part, &vector)));
            let direct = rotate(&whole, &vector);
            for i in 0..3 {
                assert!((stepwise[i] - direct[i]).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn turning_by_a_sum_is_turning_by_the_first_and_then_by_the_mean_turn_of_the_other() {
        let change = [3e-6, -2e-6, 5e-6];
        for phi in [
            [0.0; 3],
            [2e-3, 9e-3, -3e-3],
            [2e-3, 1e-2, -3e-3],
            [0.4, -1.3, 0.8],
        ] {
            let sum = core::array::from_fn(|i| phi[i] + change[i]);
            let after = rotate(&mean_turn(&phi), &change);
            let columns: [[f64; 3]; 3] = core::array::from_fn(|j| {
                let first = turned_by(&phi);
                rotate(&turned_by(&after), &core::array::from_fn(|i| first[i][j]))
            });
            let expected = turned_by(&sum);
            for i in 0..3 {
                for j in 0..3 {
                    // The square of the change.
                    assert!((columns[j][i] - expected[i][j]).abs() < 4e-11, "{phi:?}");
                }
            }
            // The vector itself is mapped to itself.
            for (own, phi) in rotate(&mean_turn(&phi), &phi).iter().zip(phi) {
                assert!((own - phi).abs() < 1e-15);
            }
        }
    }

    #[test]
    fn angles_invert_the_generated_matrix() {
        for theta in [[0.3, -1.2, 2.9], [-3.0, 0.01, -0.4], [1.0, 1.5, -2.0]] {
            let recovered = angles(&reanchor(&theta).platform_c_chart);
            for i in 0..3 {
                // asin loses accuracy like 1 / cos(theta_y), 14 at 1.5 rad.
                assert!((recovered[i] - theta[i]).abs() < 1e-14);
            }
        }
    }
}
