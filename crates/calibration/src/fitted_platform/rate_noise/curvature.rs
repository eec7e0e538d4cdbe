//! Steps towards the largest likelihood of the gyros' noise.
//!
//! The unknowns are the logarithms of the variances of white noise, and the sizes of walks over those that
//! the search starts from. The likelihood is even in a size, so that a walk that is not there is found where
//! its size is zero, and not at the end of a long way down in its logarithm.

use std::collections::VecDeque;

use nalgebra::{DMatrix, DVector};

use crate::fitted_platform::AXES;

/// Largest step in the logarithm of one variance.
const LARGEST_STEP: f64 = 2.5;

/// Smallest share of a walk's size that a step leaves: a hundredth of its variance.
const SMALLEST_SHARE: f64 = 0.1;

/// Steps that the curvature is corrected by: the last ones. Earlier ones saw another curvature.
const REMEMBERED: usize = 2;

/// Curvature along a step over that of the information, below which it is not believed: so flat a
/// likelihood has no maximum near.
const FLATTEST: f64 = 0.01;

/// How the gradient changed over the last steps. The expected information with all columns known is
/// corrected by it (Broyden, Fletcher, Goldfarb, Shanno; Nocedal, Wright, *Numerical Optimization*, 2006,
/// section 6.1): the restricted likelihood can be much flatter or steeper than the information.
#[derive(Default)]
pub(super) struct Curvature {
    /// Steps, and the fall of the gradient over each.
    steps: VecDeque<(DVector<f64>, DVector<f64>)>,
}

impl Curvature {
    pub(super) fn add(&mut self, step: DVector<f64>, fall: DVector<f64>) {
        if self.steps.len() == REMEMBERED {
            self.steps.pop_front();
        }
        self.steps.push_back((step, fall));
    }

    /// Forgets all steps; whether there were any.
    pub(super) fn forget(&mut self) -> bool {
        let were_any = !self.steps.is_empty();
        self.steps.clear();
        were_any
    }

    /// The curvature where the logarithms have this information, and the derivatives `by` by the unknowns.
    pub(super) fn beside(&self, information: &DMatrix<f64>, by: &DVector<f64>) -> DMatrix<f64> {
        let mut curvature = information.component_mul(&(by * by.transpose()));
        for (step, fall) in &self.steps {
            let expected = &curvature * step;
            let (along, found) = (step.dot(&expected), step.dot(fall));
            if found > FLATTEST * along {
                curvature.ger(-along.recip(), &expected, &expected, 1.0);
                curvature.ger(found.recip(), fall, fall, 1.0);
            }
        }
        curvature
    }
}

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
    use nalgebra::{DMatrix, DVector};

    use super::{AXES, Curvature, bounded, moved, scale};

    /// Two steps of a quadratic likelihood show its curvature along both, whatever the information is.
    #[test]
    fn steps_show_the_curvature() {
        let curvature =
            DMatrix::from_row_slice(3, 3, &[4.0, 1.0, 0.5, 1.0, 3.0, 0.2, 0.5, 0.2, 0.3]);
        let mut seen = Curvature::default();
        let steps = [[1.0, 0.0, 0.0], [0.0, 1.0, -2.0]].map(|step| DVector::from_row_slice(&step));
        for step in &steps {
            seen.add(step.clone(), &curvature * step);
        }
        let found = seen.beside(&DMatrix::identity(3, 3), &DVector::repeat(3, 1.0));
        // The last secant holds exactly: its correction is the last.
        let difference = (&found * &steps[1] - &curvature * &steps[1]).amax();
        assert!(difference < 1e-12, "{difference}");
        assert!(found.cholesky().is_some());
    }

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
