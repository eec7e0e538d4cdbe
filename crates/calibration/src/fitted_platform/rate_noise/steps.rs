//! Steps towards the largest likelihood of the gyros' noise.
//!
//! The unknowns of a step are the logarithms of the variances of white noise, and the sizes of walks over those that
//! the search starts from. The likelihood is even in a size, so that a walk that is not there is found where
//! its size is zero, and not at the end of a long way down in its logarithm.

use nalgebra::DVector;

use crate::fitted_platform::AXES;

/// Largest step in the logarithm of one variance.
const LARGEST_STEP: f64 = 2.5;

/// Smallest share of a walk's size that a step leaves: a hundredth of its variance.
const SMALLEST_SHARE: f64 = 0.1;

/// Derivatives of the logarithms by the unknowns.
pub(super) fn scale(logarithms: &DVector<f64>) -> DVector<f64> {
    DVector::from_fn(logarithms.len(), |index, _| match index < AXES {
        true => 1.0,
        false => 2.0 / size(logarithms[index]),
    })
}

/// Size of a walk over that where the logarithm of its variance is zero.
fn size(logarithm: f64) -> f64 {
    (0.5 * logarithm).exp()
}

/// A step in the unknowns, of bounded length.
pub(super) fn bounded(step: DVector<f64>, logarithms: &DVector<f64>) -> DVector<f64> {
    DVector::from_fn(step.len(), |index, _| {
        if index < AXES {
            return step[index].clamp(-LARGEST_STEP, LARGEST_STEP);
        }
        let size = size(logarithms[index]);
        let most = (0.5 * LARGEST_STEP).exp();
        step[index].clamp((SMALLEST_SHARE - 1.0) * size, (most - 1.0) * size)
    })
}

/// The logarithms after a step in the unknowns.
pub(super) fn moved(logarithms: &DVector<f64>, step: &DVector<f64>) -> DVector<f64> {
    DVector::from_fn(step.len(), |index, _| {
        if index < AXES {
            return logarithms[index] + step[index];
        }
        2.0 * (size(logarithms[index]) + step[index]).ln()
    })
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::{AXES, bounded, moved, scale};

    /// One Newton step of a likelihood that falls with the square of a size ends at the bound.
    #[test]
    fn a_walk_that_is_not_there_vanishes_in_one_step() {
        let logarithms = DVector::from_row_slice(&[0.0, 0.0, 0.0, 1.0]);
        assert_eq!(logarithms.len(), AXES + 1);
        let own = (0.5_f64).exp();
        // l = -c σ²: the derivative by the logarithm of σ² is -c σ², the curvature by σ is 2 c.
        let gradient = -own * own * scale(&logarithms)[AXES];
        let step = DVector::from_row_slice(&[0.0, 0.0, 0.0, gradient / 2.0]);
        let next = moved(&logarithms, &bounded(step, &logarithms));
        let fallen = logarithms[AXES] - next[AXES];
        assert!((fallen - 100.0_f64.ln()).abs() < 1e-12, "{fallen}");
    }
}
