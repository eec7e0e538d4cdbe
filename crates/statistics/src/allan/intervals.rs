//! Intervals of the variances of the parts of a noise: the values that a test does not reject.

use nalgebra::DVector;

use super::draws::Draws;
use super::fit::{COEFFICIENT_CONFIDENCE, Fit, Scales};
use super::least_squares::Conditions;
use super::parts::NoisePart;

/// Size of the test.
const SIZE: f64 = 1.0 - COEFFICIENT_CONFIDENCE;

/// Halvings of the logarithm of a factor of two: a hundredth of it is enough.
const HALVINGS: usize = 7;

/// Most doublings in search of an end.
const DOUBLINGS: usize = 60;

/// Interval of the variance of one part; `None` if a fit on the way is not possible.
pub(super) fn interval(scales: &Scales, part: usize, fit: &Fit, signed: bool) -> Option<[f64; 2]> {
    let estimate = fit.parts[part];
    let rejected = |variance: f64| is_rejected(scales, part, variance, signed);
    // The smallest variance that would show anywhere: a thousandth of the sum at its largest share.
    let least = scales
        .averaging
        .iter()
        .zip(scales.variances.iter())
        .map(|(averaging, sum)| sum / NoisePart::ALL[part].variance(*averaging as f64))
        .fold(f64::INFINITY, f64::min)
        * 1e-3;
    let low = match rejected(0.0)? {
        false => 0.0,
        true => {
            let mut inside = estimate.max(least);
            let mut outside = inside / 2.0;
            while !rejected(outside)? && outside > least * 1e-3 {
                inside = outside;
                outside /= 2.0;
            }
            bisect(outside, inside, rejected)?
        }
    };
    let mut inside = estimate.max(least);
    let mut outside = 2.0 * inside;
    for _ in 0..DOUBLINGS {
        if rejected(outside)? {
            break;
        }
        inside = outside;
        outside *= 2.0;
    }
    let high = bisect(outside, inside, rejected)?;
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

/// `true` if a test of the size rejects a variance of the part, the others being as fitted with it: if the
/// estimate is rarely as large, or rarely as small. Where an estimate of zero is not rare the lower tail can reject
/// nothing, and the upper one has the whole size (as in the ordering of G. J. Feldman and R. D. Cousins,
/// Physical Review D 57, 1998).
fn is_rejected(scales: &Scales, part: usize, variance: f64, signed: bool) -> Option<bool> {
    let free = Conditions {
        signed,
        fixed: None,
    };
    let fixed = Conditions {
        fixed: Some((part, variance)),
        ..free
    };
    let fit = scales.fit(fixed)?;
    let estimate = |variances: &DVector<f64>| {
        let parts = fit.weighted.solve(&fit.weighted.whiten(variances), free);
        parts[part]
    };
    let found = estimate(&scales.variances);
    let drawn = Draws::of(scales, &fit)?.map(estimate);
    let share = |is: &dyn Fn(f64) -> bool| {
        drawn.iter().filter(|value| is(**value)).count() as f64 / drawn.len() as f64
    };
    let above = share(&|value| value >= found);
    if share(&|value| value <= 0.0) > 0.5 * SIZE {
        return Some(above < SIZE);
    }
    let below = share(&|value| value <= found);
    Some(above.min(below) < 0.5 * SIZE)
}
