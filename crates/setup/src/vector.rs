//! Vectors of three components.

/// Components along x, y, z.
pub(crate) type Vector = [f64; 3];

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

pub(crate) fn norm(a: Vector) -> f64 {
    dot(a, a).sqrt()
}

/// `a + scale b`.
pub(crate) fn plus(a: Vector, scale: f64, b: Vector) -> Vector {
    core::array::from_fn(|i| a[i] + scale * b[i])
}

/// `a - b`.
pub(crate) fn minus(a: Vector, b: Vector) -> Vector {
    plus(a, -1.0, b)
}

/// With length 1; zero stays zero.
pub(crate) fn unit(a: Vector) -> Vector {
    let length = norm(a);
    if length > 0.0 {
        a.map(|component| component / length)
    } else {
        a
    }
}

/// Angle between two vectors, rad.
pub(crate) fn angle(a: Vector, b: Vector) -> f64 {
    norm(cross(a, b)).atan2(dot(a, b))
}

/// Part of `a` at right angles to the unit vector `up`.
pub(crate) fn across(a: Vector, up: Vector) -> Vector {
    plus(a, -dot(a, up), up)
}

/// `a` turned by a rotation vector, rad (Rodrigues).
pub(crate) fn turned(a: Vector, rotation: Vector) -> Vector {
    let angle = norm(rotation);
    if angle == 0.0 {
        return a;
    }
    let axis = unit(rotation);
    let (sine, cosine) = angle.sin_cos();
    let along = (1.0 - cosine) * dot(axis, a);
    plus(
        plus(a.map(|x| x * cosine), sine, cross(axis, a)),
        along,
        axis,
    )
}

/// Median of each component; `None` of nothing.
pub(crate) fn median(vectors: &[Vector]) -> Option<Vector> {
    let of = |axis: usize| {
        let mut values: Vec<f64> = vectors.iter().map(|vector| vector[axis]).collect();
        gyrocal_statistics::upper_median(&mut values)
    };
    Some([of(0)?, of(1)?, of(2)?])
}
