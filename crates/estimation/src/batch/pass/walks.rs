//! Walks of parameters in a pass.

use alloc::vec::Vec;

use super::{Pass, squared};
use crate::batch::linearisation::Linearisation;
use crate::batch::walk::{GIVEN_CHANGE, MEAN_INTEGRAL, WalkStep};
use crate::batch::{Columns, Manifold, Series};
use crate::error::EstimationError;

impl<'a, D, S, C, const M: usize, const Y: usize> Pass<'a, D, S, C, M, Y>
where
    D: Manifold<M, Y>,
    S: Series<D::Inputs, Y>,
    C: Columns<M, Y>,
{
    /// Place of the parameter of each walk among the active ones.
    pub(super) fn walk_places(
        of: &Linearisation<'a, D, S, C, M, Y>,
    ) -> Result<Vec<usize>, EstimationError> {
        let walks = of.walks.walks;
        let place = |parameter: usize| of.active.iter().position(|active| *active == parameter);
        let places: Vec<usize> = walks
            .iter()
            .filter_map(|walk| place(walk.parameter))
            .collect();
        let changes = of.walks.changes.len();
        let density = |density: f64| density > 0.0 && density.is_finite();
        if places.len() < walks.len()
            || !walks.iter().all(|walk| density(walk.density))
            || !(changes == 0 || changes == walks.len() * of.points.len())
        {
            return Err(EstimationError::InvalidArgument {
                expected: "walks of active parameters with a positive density and one change a row",
            });
        }
        Ok(places)
    }

    /// Whether an output depends directly on a parameter that walks.
    pub(super) fn walk_is_seen(&self, output: usize) -> bool {
        let q = self.of.model.output_parameters();
        let direct = &self.d_parameters[output * q..(output + 1) * q];
        let mut walks = self.of.walks.walks.iter();
        walks.any(|walk| direct.get(walk.parameter).is_some_and(|own| *own != 0.0))
    }

    /// Sets [`Self::walk_steps`] to those of the step just made after `row`.
    pub(super) fn set_walk_steps(&mut self, row: usize) {
        self.walk_steps.clear();
        let of = self.of;
        if of.walks.walks.is_empty() {
            return;
        }
        let duration_s = of.series.time_s(row + 1) - of.series.time_s(row);
        let active = of.active.len();
        for (index, walk) in of.walks.walks.iter().enumerate() {
            let place = self.walk_places[index];
            self.walk_steps.push(WalkStep {
                effect: core::array::from_fn(|i| self.own[i * active + place]),
                variance: walk.density * self.walk_factors[index] * duration_s,
            });
        }
    }

    /// The cost of the noise of a step: of the changes of walks, and of the jump given these. Takes
    /// the changes of walks from the mean.
    pub(super) fn step_cost(
        &mut self,
        row: usize,
        mut noise: [[f64; M]; M],
        mut jump: [f64; M],
    ) -> Option<f64> {
        let mut cost = 0.0;
        for index in 0..self.walk_steps.len() {
            let walks = &self.of.walks;
            let change = walks.change(row + 1, index) - walks.change(row, index);
            self.filter.row_mut(M + index)[0] -= change;
            let WalkStep { effect, variance } = self.walk_steps[index];
            cost += change * change / variance;
            for i in 0..M {
                jump[i] -= MEAN_INTEGRAL * effect[i] * change;
                for j in 0..M {
                    noise[i][j] += GIVEN_CHANGE * variance * (effect[i] * effect[j]);
                }
            }
        }
        Some(cost + squared(&noise, &jump)?)
    }
}
