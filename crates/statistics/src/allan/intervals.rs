//! Intervals of the variances of the parts of a noise: the values that a test does not reject.

use super::draws::Draws;
use super::fit::{COEFFICIENT_CONFIDENCE, Fit, Scales};
use super::least_squares::Conditions;
use super::parts::PARTS;

/// Probability of each tail.
const TAIL: f64 = 0.5 * (1.0 - COEFFICIENT_CONFIDENCE);

/// Halvings of the logarithm of a factor of two: a hundredth of it is enough.
const HALVINGS: usize = 7;

/// Most doublings in search of an end.
const DOUBLINGS: usize = 60;

/// Interval of the variance of one part; `None` if a fit on the way is not possible.
pub(super) fn interval(scales: &Scales, part: usize, fit: &Fit, signed: bool) -> Option<[f64; 2]> {
    let estimate = fit.parts[part];
    let test = |variance: f64| tails(scales, part, variance, signed);
    // The smallest variance that would show anywhere: a thousandth of the sum at its largest share.
    let least = scales
        .averaging
        .iter()
        .zip(scales.variances.iter())
        .map(|(averaging, sum)| {
            sum / super::parts::NoisePart::ALL[part].variance(*averaging as f64)
        })
        .fold(f64::INFINITY, f64::min)
        * 1e-3;
    let low = match test(0.0)? {
        [above, _] if above >= TAIL => 0.0,
        _ => {
            // Rejected at `outside`, not at `inside`.
            let mut inside = estimate.max(least);
            let mut outside = inside / 2.0;
            let mut found = false;
            for _ in 0..DOUBLINGS {
                if test(outside)?[0] < TAIL {
                    found = true;
                    break;
                }
                inside = outside;
                outside /= 2.0;
                if inside < least * 1e-3 {
                    break;
                }
            }
            if found {
                bisect(outside, inside, |variance| Some(test(variance)?[0] < TAIL))?
            } else {
                0.0
            }
        }
    };
    let mut inside = estimate.max(least);
    let mut outside = 2.0 * inside;
    for _ in 0..DOUBLINGS {
        if test(outside)?[1] < TAIL {
            break;
        }
        inside = outside;
        outside *= 2.0;
    }
    let high = bisect(outside, inside, |variance| Some(test(variance)?[1] < TAIL))?;
    Some([low, high])
}

/// End of an interval between a rejected value and one that is not.
fn bisect(
    mut outside: f64,
    mut inside: f64,
    rejected: impl Fn(f64) -> Option<bool>,
) -> Option<f64> {
    for _ in 0..HALVINGS {
        let middle = (outside * inside).sqrt();
        if rejected(middle)? {
            outside = middle;
        } else {
            inside = middle;
        }
    }
    Some((outside * inside).sqrt())
}

/// Probabilities of an estimate at least as large, and at most as large, as the one found, if the
/// variance of the part is `variance` and the others are as fitted with it.
fn tails(scales: &Scales, part: usize, variance: f64, signed: bool) -> Option<[f64; 2]> {
    let free = Conditions {
        signed,
        fixed: None,
    };
    let fixed = Conditions {
        fixed: Some((part, variance)),
        ..free
    };
    let fit = scales.fit(fixed)?;
    let estimate = |variances: &nalgebra::DVector<f64>| -> f64 {
        let found: [f64; PARTS] = fit.weighted.solve(&fit.weighted.whiten(variances), free);
        found[part]
    };
    let found = estimate(&scales.variances);
    let draws = Draws::of(scales, &fit)?;
    let above = draws.share(|drawn| estimate(drawn) >= found);
    let below = draws.share(|drawn| estimate(drawn) <= found);
    Some([above, below])
}
