//! Covariances of slow noise averaged over intervals of time.

/// Mean of -ln of the distance of two points, one of each of two intervals: the covariance of the means of flicker, but
/// for a constant and its density.
pub(crate) fn flicker(one: [f64; 2], other: [f64; 2]) -> f64 {
    /// Distance in durations from which the distance of the middles serves: the integral would lose its digits.
    const FAR: f64 = 1e3;
    let [long, other_long] = [one, other].map(|[from, to]| to - from);
    let distance = 0.5 * (other[0] + other[1] - one[0] - one[1]).abs();
    if distance > FAR * long.max(other_long) {
        return -distance.ln();
    }
    let twice = |x: f64| match x.abs() {
        0.0 => 0.0,
        x => 0.5 * x * x * x.ln() - 0.75 * x * x,
    };
    let integral = twice(other[1] - one[0]) - twice(other[1] - one[1]) - twice(other[0] - one[0])
        + twice(other[0] - one[1]);
    -integral / (long * other_long)
}

/// Covariance of the means of a walk of one unit a unit of time over two intervals, the same or one after the other.
pub(crate) fn walk(one: [f64; 2], other: [f64; 2]) -> f64 {
    let first = if one[0] <= other[0] { one } else { other };
    if one == other {
        first[0] + (first[1] - first[0]) / 3.0
    } else {
        0.5 * (first[0] + first[1])
    }
}
