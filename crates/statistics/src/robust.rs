//! Robust scale and line: a few wild values move them little.

use crate::descriptive::upper_median;

/// Median absolute deviation of normal noise of unit variance.
pub const NORMAL_MAD: f64 = 0.674_489_750_196_081_7;

/// Robust standard deviation of normal deviates of zero mean with a few outliers, from their absolute
/// values, which are reordered: root mean square of the values within four sigmas by the median. Half
/// as uncertain as the median itself; zero of nothing.
#[must_use]
pub fn robust_sigma(sizes: &mut [f64]) -> f64 {
    /// Variance of a standard normal variable truncated at 4.
    const WITHIN_FOUR: f64 = 0.998_929;
    let rough = upper_median(sizes).unwrap_or(0.0) / NORMAL_MAD;
    let (count, sum) = sizes
        .iter()
        .filter(|size| **size <= 4.0 * rough)
        .fold((0.0, 0.0), |(count, sum), size| {
            (count + 1.0, sum + size * size)
        });
    if count > 0.0 {
        (sum / (count * WITHIN_FOUR)).sqrt()
    } else {
        0.0
    }
}

/// Theil-Sen line at abscissa zero, and the standard deviation of the difference of another value
/// there, of noise of unit variance; robust against two of eight values. `near` holds abscissa and
/// value. `None` of fewer than two points.
#[must_use]
pub fn theil_sen_at_zero(near: &[(f64, f64)]) -> Option<(f64, f64)> {
    let later = |i: usize| near[i + 1..].iter();
    let pairs = near
        .iter()
        .enumerate()
        .flat_map(|(i, a)| later(i).map(move |b| (b.1 - a.1) / (b.0 - a.0)));
    let slope = upper_median(&mut pairs.collect::<Vec<f64>>())?;
    let line = upper_median(
        &mut near
            .iter()
            .map(|(at, value)| value - slope * at)
            .collect::<Vec<f64>>(),
    )?;
    let count = near.len() as f64;
    let middle = near.iter().map(|(at, _)| at).sum::<f64>() / count;
    let width: f64 = near.iter().map(|(at, _)| (at - middle).powi(2)).sum();
    Some((line, (1.0 + 1.0 / count + middle * middle / width).sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_wild_values_move_neither_scale_nor_line() {
        let mut points: Vec<(f64, f64)> = (1..=8)
            .map(|k| (f64::from(k), 2.0 + 0.5 * f64::from(k)))
            .collect();
        points[1].1 += 100.0;
        points[6].1 -= 70.0;
        let (line, spread) = theil_sen_at_zero(&points).unwrap_or_default();
        assert!((line - 2.0).abs() < 1e-12, "{line}");
        // 1 + 1/n + x² / Σ(x - x)², with n = 8, x = 4.5, 42.
        assert!((spread * spread - (1.0 + 0.125 + 20.25 / 42.0)).abs() < 1e-12);
        assert_eq!(theil_sen_at_zero(&points[..1]), None);
        // Quantiles of a normal variable stand for a sample of it.
        let of = |k: u32| crate::probability::normal_quantile((f64::from(k) + 0.5) / 1000.0).abs();
        let mut sizes: Vec<f64> = (0..1000).map(of).collect();
        sizes[0] = 1e6;
        sizes[999] = 1e6;
        // The two largest of a thousand are 3.3, and hold 2 % of the variance.
        assert!((robust_sigma(&mut sizes) - 1.0).abs() < 0.02);
        assert_eq!(robust_sigma(&mut []), 0.0);
    }
}
