//! Intervals of a bias to which Earth rate in an unknown direction adds.

use core::f64::consts::PI;

use gyrocal_statistics::normal_probability;

/// Half the width of the 95 % interval of an error `horizontal` cos ψ + `sigma` z, with ψ uniform and z
/// standard normal.
pub(super) fn half_width(horizontal: f64, sigma: f64) -> f64 {
    const PROBABILITY: f64 = 0.95;
    const HEADINGS: usize = 180;
    const HALVINGS: usize = 50;
    if sigma <= 0.0 {
        // Quantile of |cos ψ|.
        return horizontal.abs() * (0.5 * PI * PROBABILITY).sin();
    }
    let inside = |width: f64| {
        let share = |step: usize| {
            let error = horizontal * ((step as f64 + 0.5) * PI / HEADINGS as f64).cos();
            normal_probability((width - error) / sigma)
                - normal_probability((-width - error) / sigma)
        };
        (0..HEADINGS).map(share).sum::<f64>() / HEADINGS as f64
    };
    let (mut low, mut high) = (0.0, horizontal.abs() + 5.0 * sigma);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        *(if inside(middle) < PROBABILITY {
            &mut low
        } else {
            &mut high
        }) = middle;
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_statistics::NORMAL_97_5;

    #[test]
    fn the_limits_are_a_normal_error_and_a_cosine() {
        assert!((half_width(0.0, 2.0) - 2.0 * NORMAL_97_5).abs() < 1e-6);
        // Headings are summed 1 degree apart.
        assert!((half_width(1.0, 1e-2) - half_width(1.0, 0.0)).abs() < 0.01);
    }
}
