//! One step of the chain: from a point to the next row, with all derivatives.

use alloc::vec;
use alloc::vec::Vec;

use super::{Corrected, Manifold, Series};
use crate::error::EstimationError;
use crate::transition::{Integration, Integrator};

/// What a step does to the moving states, to first order.
#[derive(Clone, Copy)]
pub(crate) struct Step<const M: usize> {
    /// Moving columns of the transition.
    pub(crate) moving: [[f64; M]; M],
    /// Covariance of what each noise input adds over the step.
    pub(crate) shares: [[[f64; M]; M]; M],
}

impl<const M: usize> Step<M> {
    /// Covariance of what all noise adds over the step.
    pub(crate) fn noise(&self) -> [[f64; M]; M] {
        let mut noise = [[0.0; M]; M];
        for share in &self.shares {
            add(&mut noise, share);
        }
        noise
    }

    /// What was predicted as corrections of another point: the one that a correction of the
    /// prediction, which the noise made, leads to.
    pub(crate) fn correct(&mut self, corrected: &Corrected<M>) {
        self.moving = product(&corrected.point, &self.moving);
        for share in &mut self.shares {
            *share = sandwich(&corrected.correction, share);
        }
    }
}

/// Carries points over steps; owns the numbers that a step works on.
pub(crate) struct Stepper<'a, D, I, const M: usize, const Y: usize> {
    pub(crate) model: &'a D,
    pub(crate) inputs: I,
    pub(crate) integration: Integration,
    pub(crate) longest_step_s: f64,
    pub(crate) noise_density: [f64; M],
    /// Parameter columns of the last step, one row for each moving state.
    pub(crate) columns: Vec<f64>,
    part: Vec<f64>,
    stages: Vec<f64>,
}

impl<'a, D, const M: usize, const Y: usize> Stepper<'a, D, D::Inputs, M, Y>
where
    D: Manifold<M, Y>,
{
    pub(crate) fn new(
        model: &'a D,
        inputs: D::Inputs,
        integration: Integration,
        longest_step_s: f64,
        noise_density: [f64; M],
    ) -> Self {
        let p = model.parameters();
        Self {
            model,
            inputs,
            integration,
            longest_step_s,
            noise_density,
            columns: vec![0.0; M * p],
            part: vec![0.0; M * p],
            stages: vec![0.0; 4 * M * p],
        }
    }

    /// From `point` at `row` to the next row, and where the model goes; leaves the parameter
    /// columns in [`Self::columns`].
    pub(crate) fn advance(
        &mut self,
        series: &impl Series<D::Inputs, Y>,
        row: usize,
        point: &D::Point,
        parameters: &[f64],
    ) -> Result<(Step<M>, D::Point), EstimationError> {
        let p = parameters.len();
        let (start_s, end_s) = (series.time_s(row), series.time_s(row + 1));
        let interval_s = end_s - start_s;
        if !(interval_s > 0.0 && interval_s.is_finite()) {
            return Err(EstimationError::InvalidArgument {
                expected: "times that rise",
            });
        }
        let parts = interval_s / self.longest_step_s;
        if parts > MOST_PARTS {
            return Err(EstimationError::InvalidArgument {
                expected: "an interval of at most a million longest steps",
            });
        }
        let whole = parts as usize;
        let count = (whole + usize::from(parts > whole as f64)).max(1);
        let part_s = interval_s / count as f64;
        let mut moving = [0.0; M];
        self.model.place(point, &mut moving, &mut self.inputs);
        let mut step = Step {
            moving: identity(),
            shares: [[[0.0; M]; M]; M],
        };
        for index in 0..count {
            let from_s = start_s + part_s * index as f64;
            series.over(row, from_s, from_s + part_s, &mut self.inputs);
            let target = if index == 0 {
                &mut self.columns
            } else {
                &mut self.part
            };
            let mut transition = Integrator {
                model: self.model,
                inputs: &self.inputs,
                parameters,
                columns: target,
                stages: &mut self.stages,
                at_origin: self.model.has_chart(),
            }
            .integrate(self.integration, part_s, &mut moving);
            if !moving.iter().all(|state| state.is_finite()) {
                return Err(EstimationError::NotFinite {
                    quantity: "a predicted moving state",
                });
            }
            if let Some(map) = self.model.recentre(&mut moving, &mut self.inputs) {
                transition.moving = product(&map, &transition.moving);
                transition.noise = product(&map, &transition.noise);
                map_columns(&map, target, p);
            }
            if let Some(same) = self.model.noise_parameters() {
                for (i, row) in transition.noise.iter_mut().enumerate() {
                    for (noise, parameter) in row.iter_mut().zip(same) {
                        *noise = target[i * p + parameter];
                    }
                }
            }
            if index > 0 {
                map_columns(&transition.moving, &mut self.columns, p);
                for (sum, value) in self.columns.iter_mut().zip(&self.part) {
                    *sum += value;
                }
                step.moving = product(&transition.moving, &step.moving);
                for share in &mut step.shares {
                    *share = sandwich(&transition.moving, share);
                }
            } else {
                step.moving = transition.moving;
            }
            for (input, share) in step.shares.iter_mut().enumerate() {
                let variance = self.noise_density[input] / part_s;
                for i in 0..M {
                    for j in 0..M {
                        share[i][j] +=
                            transition.noise[i][input] * variance * transition.noise[j][input];
                    }
                }
            }
        }
        Ok((step, self.model.point(&moving, &self.inputs)))
    }
}

/// More parts of one interval than this are a mistake in the times or in the longest step.
const MOST_PARTS: f64 = 1e6;

fn identity<const M: usize>() -> [[f64; M]; M] {
    let mut matrix = [[0.0; M]; M];
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    matrix
}

pub(crate) fn product<const M: usize>(a: &[[f64; M]; M], b: &[[f64; M]; M]) -> [[f64; M]; M] {
    let mut result = [[0.0; M]; M];
    for i in 0..M {
        for l in 0..M {
            for j in 0..M {
                result[i][j] += a[i][l] * b[l][j];
            }
        }
    }
    result
}

/// a b aᵀ of a symmetric b, symmetric to the last bit.
pub(crate) fn sandwich<const M: usize>(a: &[[f64; M]; M], b: &[[f64; M]; M]) -> [[f64; M]; M] {
    let left = product(a, b);
    let mut result = [[0.0; M]; M];
    for i in 0..M {
        for j in 0..=i {
            let mut sum = 0.0;
            for l in 0..M {
                sum += left[i][l] * a[j][l];
            }
            (result[i][j], result[j][i]) = (sum, sum);
        }
    }
    result
}

/// a += b.
pub(crate) fn add<const M: usize>(a: &mut [[f64; M]; M], b: &[[f64; M]; M]) {
    for (sum, value) in a.as_flattened_mut().iter_mut().zip(b.as_flattened()) {
        *sum += value;
    }
}

/// Replaces the M rows of `columns` by their product with `map` from the left.
pub(crate) fn map_columns<const M: usize>(map: &[[f64; M]; M], columns: &mut [f64], stride: usize) {
    for column in 0..stride {
        let mut old = [0.0; M];
        for (i, value) in old.iter_mut().enumerate() {
            *value = columns[i * stride + column];
        }
        for (i, weights) in map.iter().enumerate() {
            let mut sum = 0.0;
            for (value, weight) in old.iter().zip(weights) {
                sum += value * weight;
            }
            columns[i * stride + column] = sum;
        }
    }
}
