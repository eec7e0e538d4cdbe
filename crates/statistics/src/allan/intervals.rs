//! Intervals of the variances of the parts of a noise: the values that a test does not reject.

use nalgebra::DVector;

use super::draws::Draws;
use super::fit::{COEFFICIENT_CONFIDENCE, Fit, Scales};
use super::least_squares::Conditions;
use super::parts::NoisePart;

/// Size of the test.
const SIZE: f64 = 1.0 - COEFFICIENT_CONFIDENCE;

/// Probability of an estimate that is very rarely as small.
const RARE: f64 = 0.01;

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

/// `true` if a test rejects a variance of the part, the others being as fitted with it: if the sum of
/// squares falls more than it rarely does when the part is freed. Where the part may not be negative this test
/// keeps its size (G. J. Feldman and R. D. Cousins, Physical Review D 57, 1998). With few degrees of freedom the
/// fall is bounded, so that it would reject no large variance: an estimate that is very rarely as small does.
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
    // The fall, and the estimate.
    let of = |variances: &DVector<f64>| {
        let white = fit.weighted.whiten(variances);
        let parts = fit.weighted.solve(&white, free);
        let held = fit.weighted.solve(&white, fixed);
        let fall = fit.weighted.chi_square(&white, &held) - fit.weighted.chi_square(&white, &parts);
        [fall, parts[part]]
    };
    let [fall, estimate] = of(&scales.variances);
    let drawn = Draws::of(scales, &fit)?.map(of);
    let share = |is: &dyn Fn(&[f64; 2]) -> bool| {
        drawn.iter().filter(|values| is(values)).count() as f64 / drawn.len() as f64
    };
    Some(share(&|values| values[0] >= fall) < SIZE || share(&|values| values[1] <= estimate) < RARE)
}
