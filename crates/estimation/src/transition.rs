//! From rates to a discrete transition: Φ and Γ are the exact derivatives of the discrete
//! map, integrated beside the state by the variational equation Ṡ = F S + F_p.

use gyrocal_scalar::{Model, RatesJacobian, Scalar};

use crate::lanes4::{load, mul_add, store};

/// How the rates are integrated over a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Integration {
    /// Explicit Euler, `substeps` times a step: first order.
    Euler {
        /// Number of equal parts of a step; at least 1.
        substeps: u32,
    },
    /// Classical Runge-Kutta, `substeps` times a step: fourth order.
    Rk4 {
        /// Number of equal parts of a step; at least 1.
        substeps: u32,
    },
}

impl Integration {
    /// One explicit Euler step.
    pub const EULER: Self = Self::Euler { substeps: 1 };
    /// One Runge-Kutta step.
    pub const RK4: Self = Self::Rk4 { substeps: 1 };

    pub(crate) fn substeps(self) -> u32 {
        match self {
            Self::Euler { substeps } | Self::Rk4 { substeps } => substeps,
        }
    }
}

/// Derivatives of the moving states at the end of a step, except the parameter columns of Φ,
/// which are in [`crate::Buffers::transition`].
#[derive(Clone, Copy, Debug)]
pub(crate) struct Transition<T, const M: usize> {
    /// Moving columns of Φ.
    pub(crate) moving: [[T; M]; M],
    /// Γ: effect of noise held over the step. Zero for a model whose noise enters as parameters
    /// do: Γ then consists of their columns.
    pub(crate) noise: [[T; M]; M],
}

/// What integration starts from and works on.
pub(crate) struct Integrator<'a, T, D, I, const M: usize, const Y: usize> {
    pub(crate) model: &'a D,
    pub(crate) inputs: &'a I,
    pub(crate) parameters: &'a [T],
    /// Receives the parameter columns of Φ: M × p, by rows.
    pub(crate) columns: &'a mut [T],
    /// Workspace of 4 × M × p numbers whose structural zeros are zero.
    pub(crate) stages: &'a mut [T],
    /// Whether the moving states start at zero, where models have a shorter Jacobian.
    pub(crate) at_origin: bool,
}

/// Where a column of the sensitivity starts from.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Start {
    /// Zero: a parameter's column at the beginning of a step.
    Zero,
    /// The unit matrix, without inhomogeneous term: the moving columns at the beginning of a step.
    Identity,
    /// What earlier sub-steps left.
    Given,
}

impl<T, D, const M: usize, const Y: usize> Integrator<'_, T, D, D::Inputs, M, Y>
where
    T: Scalar,
    D: Model<T, M, Y>,
{
    /// Integrates the moving states over `dt` and their derivatives with them.
    #[inline(always)]
    pub(crate) fn integrate(
        &mut self,
        integration: Integration,
        dt: T,
        moving: &mut [T; M],
    ) -> Transition<T, M> {
        let count = integration.substeps();
        let h = if count == 1 {
            dt
        } else {
            dt / T::from_f64(f64::from(count))
        };
        match integration {
            Integration::Euler { .. } => {
                self.substeps::<1>(count, &[T::from_f64(0.0)], &[h], moving)
            }
            Integration::Rk4 { .. } => {
                let scaled = |factors: [f64; 4]| factors.map(|factor| T::from_f64(factor) * h);
                let nodes = scaled([0.0, 0.5, 0.5, 1.0]);
                let weights = scaled([1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0]);
                self.substeps::<4>(count, &nodes, &weights, moving)
            }
        }
    }

    #[inline(always)]
    fn substeps<const ORDER: usize>(
        &mut self,
        count: u32,
        nodes: &[T; ORDER],
        weights: &[T; ORDER],
        moving: &mut [T; M],
    ) -> Transition<T, M> {
        let zero = [[T::from_f64(0.0); M]; M];
        let mut transition = Transition {
            moving: zero,
            noise: zero,
        };
        self.substep(true, nodes, weights, moving, &mut transition);
        for _ in 1..count {
            self.substep(false, nodes, weights, moving, &mut transition);
        }
        transition
    }

    /// One Runge-Kutta step of `ORDER` stages. The stage points do not depend on the
    /// sensitivities: all stages first, then every column of the sensitivity in one pass.
    #[inline(always)]
    fn substep<const ORDER: usize>(
        &mut self,
        first: bool,
        nodes: &[T; ORDER],
        weights: &[T; ORDER],
        moving: &mut [T; M],
        transition: &mut Transition<T, M>,
    ) {
        let p = self.parameters.len();
        let zero = T::from_f64(0.0);
        let start = *moving;
        let mut jacobians = [[[zero; M]; M]; ORDER];
        let mut noises = [[[zero; M]; M]; ORDER];
        let mut rates = [zero; M];
        for stage in 0..ORDER {
            let mut jacobian = RatesJacobian {
                moving: [[zero; M]; M],
                noise: [[zero; M]; M],
                parameters: &mut self.stages[stage * M * p..(stage + 1) * M * p],
            };
            let (model, parameters, inputs) = (self.model, self.parameters, self.inputs);
            rates = if stage == 0 && first && self.at_origin {
                model.rates_jacobian_at_origin(parameters, inputs, &mut jacobian)
            } else {
                let at = if stage == 0 {
                    start
                } else {
                    mul_add(rates, nodes[stage], start)
                };
                model.rates_jacobian(&at, parameters, inputs, &mut jacobian)
            };
            jacobians[stage] = jacobian.moving;
            noises[stage] = jacobian.noise;
            *moving = mul_add(rates, weights[stage], *moving);
        }
        let scheme = Scheme::new(&jacobians, nodes, weights);
        let (moving_start, parameter_start) = if first {
            (Start::Identity, Start::Zero)
        } else {
            (Start::Given, Start::Given)
        };
        scheme.advance(moving_start, &mut transition.moving, |_, _| [zero; M]);
        if self.model.noise_parameters().is_none() {
            let drive = |stage: usize, i: usize| noises[stage][i];
            scheme.advance(parameter_start, &mut transition.noise, drive);
        }
        let mut column = 0;
        while column + 4 <= p {
            scheme.advance_columns::<4>(parameter_start, self.stages, self.columns, p, column);
            column += 4;
        }
        while column < p {
            scheme.advance_columns::<1>(parameter_start, self.stages, self.columns, p, column);
            column += 1;
        }
    }
}

/// A Runge-Kutta scheme on one step, with the rates' Jacobian at its stages.
struct Scheme<'a, T, const M: usize, const ORDER: usize> {
    jacobians: &'a [[[T; M]; M]; ORDER],
    /// The Jacobians times the stages' nodes: what the rate of the stage before adds.
    scaled: [[[T; M]; M]; ORDER],
    weights: &'a [T; ORDER],
}

impl<'a, T: Scalar, const M: usize, const ORDER: usize> Scheme<'a, T, M, ORDER> {
    #[inline(always)]
    fn new(
        jacobians: &'a [[[T; M]; M]; ORDER],
        nodes: &[T; ORDER],
        weights: &'a [T; ORDER],
    ) -> Self {
        let mut scaled = *jacobians;
        for (jacobian, node) in scaled.iter_mut().zip(nodes) {
            for element in jacobian.as_flattened_mut() {
                *element = *element * *node;
            }
        }
        Self {
            jacobians,
            scaled,
            weights,
        }
    }

    /// Advances `W` columns of the sensitivity; `drive(stage, i)` is row i of the inhomogeneous
    /// term at a stage.
    #[inline(always)]
    fn advance<const W: usize>(
        &self,
        start: Start,
        sensitivity: &mut [[T; W]; M],
        drive: impl Fn(usize, usize) -> [T; W],
    ) {
        let zero = T::from_f64(0.0);
        match start {
            Start::Zero => *sensitivity = [[zero; W]; M],
            Start::Identity => {
                *sensitivity = [[zero; W]; M];
                for (i, row) in sensitivity.iter_mut().enumerate() {
                    row[i] = T::from_f64(1.0);
                }
            }
            Start::Given => {}
        }
        let begin = *sensitivity;
        let mut rate = [[zero; W]; M];
        for stage in 0..ORDER {
            let before = rate;
            for i in 0..M {
                let mut sum = drive(stage, i);
                match start {
                    Start::Zero => {}
                    Start::Identity => {
                        for (sum, coefficient) in sum.iter_mut().zip(self.jacobians[stage][i]) {
                            *sum = coefficient;
                        }
                    }
                    Start::Given => {
                        for (row, coefficient) in begin.iter().zip(self.jacobians[stage][i]) {
                            sum = mul_add(*row, coefficient, sum);
                        }
                    }
                }
                if stage > 0 {
                    for (row, coefficient) in before.iter().zip(self.scaled[stage][i]) {
                        sum = mul_add(*row, coefficient, sum);
                    }
                }
                rate[i] = sum;
            }
            for i in 0..M {
                sensitivity[i] = if start == Start::Zero && stage == 0 {
                    rate[i].map(|rate| rate * self.weights[stage])
                } else {
                    mul_add(rate[i], self.weights[stage], sensitivity[i])
                };
            }
        }
    }

    #[inline(always)]
    fn advance_columns<const W: usize>(
        &self,
        start: Start,
        stages: &[T],
        columns: &mut [T],
        stride: usize,
        column: usize,
    ) {
        let mut sensitivity = [[T::from_f64(0.0); W]; M];
        if start == Start::Given {
            for (i, row) in sensitivity.iter_mut().enumerate() {
                *row = load(columns, i * stride + column);
            }
        }
        self.advance(start, &mut sensitivity, |stage, i| {
            load(stages, (stage * M + i) * stride + column)
        });
        for (i, row) in sensitivity.iter().enumerate() {
            store(columns, i * stride + column, *row);
        }
    }
}
