//! Parameters that change as random walks, and their joint covariance with the moving states.

use alloc::vec;
use alloc::vec::Vec;

use super::step::sandwich;

/// A parameter that changes as a random walk along the record. No output depends on it directly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Walk {
    /// Index of the parameter; it is an active one.
    pub parameter: usize,
    /// Variance of its change, unit squared over seconds.
    pub density: f64,
}

/// The random walks of a pass.
#[derive(Clone, Copy, Debug, Default)]
pub struct Walks<'a> {
    /// The parameters that walk.
    pub walks: &'a [Walk],
    /// Change of each of them since the first row at each row of the trajectory, by rows; empty if
    /// all are zero.
    pub changes: &'a [f64],
}

impl Walks<'_> {
    /// The same walks over the first `rows` rows of the trajectory.
    #[must_use]
    pub fn over_first(self, rows: usize) -> Self {
        let count = (rows * self.walks.len()).min(self.changes.len());
        Self {
            changes: &self.changes[..count],
            ..self
        }
    }

    /// The change of a walk at a row.
    pub(crate) fn change(&self, row: usize, walk: usize) -> f64 {
        let place = row * self.walks.len() + walk;
        self.changes.get(place).copied().unwrap_or(0.0)
    }
}

/// Effect of one walk in a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WalkStep<const M: usize> {
    /// Change of the moving states over the step for a unit of the parameter.
    pub(crate) effect: [f64; M],
    /// Variance of the change of the parameter over the step.
    pub(crate) variance: f64,
}

/// Share of the variance of a walk over a step that its integral over the step has.
const INTEGRAL: f64 = 1.0 / 3.0;

/// Covariance of a walk over a step with its integral, over its variance.
const WITH_INTEGRAL: f64 = 0.5;

/// Variance of the integral given the change over the step, over the variance of the change.
pub(crate) const GIVEN_CHANGE: f64 = INTEGRAL - WITH_INTEGRAL * WITH_INTEGRAL;

/// Mean of the integral for a unit of change over the step.
pub(crate) const MEAN_INTEGRAL: f64 = WITH_INTEGRAL;

/// Covariance, or a derivative of it, of the moving states and the walks.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Joint<const M: usize> {
    pub(crate) moving: [[f64; M]; M],
    /// Covariance of the moving states with each walk.
    pub(crate) cross: Vec<[f64; M]>,
    /// Covariance of the walks, by rows.
    pub(crate) walks: Vec<f64>,
}

impl<const M: usize> Joint<M> {
    pub(crate) fn new(moving: [[f64; M]; M], walks: usize) -> Self {
        Self {
            moving,
            cross: vec![[0.0; M]; walks],
            walks: vec![0.0; walks * walks],
        }
    }

    /// Φ P Φᵀ, with Φ that of the moving states and of the walks, which stay.
    pub(crate) fn predict(&mut self, transition: &[[f64; M]; M], steps: &[WalkStep<M>]) {
        self.moving = sandwich(transition, &self.moving);
        let count = self.cross.len();
        for (w, step) in steps.iter().enumerate() {
            let mut moved = [0.0; M];
            for i in 0..M {
                for j in 0..M {
                    moved[i] += transition[i][j] * self.cross[w][j];
                }
            }
            for i in 0..M {
                for j in 0..=i {
                    let mut sum = moved[i] * step.effect[j] + step.effect[i] * moved[j];
                    for (v, other) in steps.iter().enumerate() {
                        sum += step.effect[i] * self.walks[w * count + v] * other.effect[j];
                    }
                    self.moving[i][j] += sum;
                    if j < i {
                        self.moving[j][i] = self.moving[i][j];
                    }
                }
            }
            self.cross[w] = moved;
        }
        for w in 0..count {
            for (v, step) in steps.iter().enumerate() {
                for i in 0..M {
                    self.cross[w][i] += step.effect[i] * self.walks[v * count + w];
                }
            }
        }
    }

    /// Adds what one walk adds over a step of constant effect: the change of the parameter and its
    /// integral (Bar-Shalom, Li, Kirubarajan, *Estimation with Applications to Tracking and
    /// Navigation*, 2001, section 6.2.2).
    pub(crate) fn add_walk(&mut self, walk: usize, step: &WalkStep<M>) {
        let count = self.cross.len();
        for i in 0..M {
            for j in 0..M {
                self.moving[i][j] += INTEGRAL * step.variance * (step.effect[i] * step.effect[j]);
            }
            self.cross[walk][i] += WITH_INTEGRAL * step.variance * step.effect[i];
        }
        self.walks[walk * count + walk] += step.variance;
    }

    /// P Hᵀ of an output: the part of the moving states; that of the walks goes into `walks`.
    pub(crate) fn with_output(&self, jacobian: &[f64; M], walks: &mut [f64]) -> [f64; M] {
        let mut moving = [0.0; M];
        for i in 0..M {
            for j in 0..M {
                moving[i] += self.moving[i][j] * jacobian[j];
            }
        }
        for (walk, cross) in walks.iter_mut().zip(&self.cross) {
            *walk = dot(cross, jacobian);
        }
        moving
    }

    /// The whole matrix by rows, moving states first.
    pub(crate) fn whole(&self, i: usize, j: usize) -> f64 {
        match (i.checked_sub(M), j.checked_sub(M)) {
            (None, None) => self.moving[i][j],
            (None, Some(walk)) => self.cross[walk][i],
            (Some(walk), None) => self.cross[walk][j],
            (Some(one), Some(other)) => self.walks[one * self.cross.len() + other],
        }
    }
}

pub(crate) fn dot<const M: usize>(a: &[f64; M], b: &[f64; M]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Transposed transition times a vector of moving states and walks.
pub(crate) fn transposed<const M: usize>(
    transition: &[[f64; M]; M],
    steps: &[WalkStep<M>],
    vector: &mut [f64],
) {
    let mut moving = [0.0; M];
    for i in 0..M {
        for j in 0..M {
            moving[i] += transition[j][i] * vector[j];
        }
    }
    for (w, step) in steps.iter().enumerate() {
        for i in 0..M {
            vector[M + w] += step.effect[i] * vector[i];
        }
    }
    vector[..M].copy_from_slice(&moving);
}
