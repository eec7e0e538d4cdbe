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
    /// Γ: effect of noise held over the step.
    pub(crate) noise: [[T; M]; M],
}

/// Integrates the moving states over `dt` and their derivatives with them.
///
/// `parameter_columns` receives the parameter columns of Φ (M × p, by rows); `stages` is
/// workspace of 4 × M × p numbers whose structural zeros are zero.
#[inline(always)]
pub(crate) fn integrate<T, D, const M: usize, const Y: usize>(
    model: &D,
    inputs: &D::Inputs,
    integration: Integration,
    dt: T,
    moving: &mut [T; M],
    parameters: &[T],
    parameter_columns: &mut [T],
    stages: &mut [T],
) -> Transition<T, M>
where
    T: Scalar,
    D: Model<T, M, Y>,
{
    let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
    let p = parameters.len();
    let own_noise = model.noise_parameters().is_none();
    let mut transition = Transition { moving: [[zero; M]; M], noise: [[zero; M]; M] };
    for (i, row) in transition.moving.iter_mut().enumerate() {
        row[i] = one;
    }
    parameter_columns[..M * p].fill(zero);
    let (order, nodes, weights): (usize, [f64; 4], [f64; 4]) = match integration {
        Integration::Euler { .. } => (1, [0.0; 4], [1.0, 0.0, 0.0, 0.0]),
        Integration::Rk4 { .. } => {
            (4, [0.0, 0.5, 0.5, 1.0], [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0])
        }
    };
    let count = integration.substeps();
    let h = if count == 1 { dt } else { dt / T::from_f64(f64::from(count)) };
    let nodes = nodes.map(|node| T::from_f64(node) * h);
    let weights = weights.map(|weight| T::from_f64(weight) * h);
    for _ in 0..count {
        // The stage points do not depend on the sensitivities: all stages first, then every
        // column of the sensitivity in one pass.
        let start = *moving;
        let mut jacobians = [[[zero; M]; M]; 4];
        let mut noises = [[[zero; M]; M]; 4];
        let mut rates = [zero; M];
        for stage in 0..order {
            let mut at = start;
            if stage > 0 {
                for i in 0..M {
                    at[i] = rates[i].mul_add(nodes[stage], start[i]);
                }
            }
            let mut jacobian = RatesJacobian {
                moving: [[zero; M]; M],
                noise: [[zero; M]; M],
                parameters: &mut stages[stage * M * p..(stage + 1) * M * p],
            };
            rates = model.rates_jacobian(&at, parameters, inputs, &mut jacobian);
            jacobians[stage] = jacobian.moving;
            noises[stage] = jacobian.noise;
            for i in 0..M {
                moving[i] = rates[i].mul_add(weights[stage], moving[i]);
            }
        }
        let scheme = Scheme { order, jacobians: &jacobians, nodes: &nodes, weights: &weights };
        advance_small(&scheme, None, &mut transition.moving);
        if own_noise {
            advance_small(&scheme, Some(&noises), &mut transition.noise);
        }
        let mut column = 0;
        while column + 4 <= p {
            advance_columns::<T, M, 4>(&scheme, stages, parameter_columns, p, column);
            column += 4;
        }
        while column < p {
            advance_columns::<T, M, 1>(&scheme, stages, parameter_columns, p, column);
            column += 1;
        }
    }
    if let Some(same) = model.noise_parameters() {
        for (i, row) in transition.noise.iter_mut().enumerate() {
            for (noise, parameter) in row.iter_mut().zip(same) {
                *noise = parameter_columns[i * p + parameter];
            }
        }
    }
    transition
}

/// A Runge-Kutta scheme on one step, with the rates' Jacobian at its stages.
struct Scheme<'a, T, const M: usize> {
    order: usize,
    jacobians: &'a [[[T; M]; M]; 4],
    nodes: &'a [T; 4],
    weights: &'a [T; 4],
}

impl<T: Scalar, const M: usize> Scheme<'_, T, M> {
    /// Advances `W` columns of the sensitivity; `drive(stage, i)` is row i of the inhomogeneous
    /// term at a stage.
    #[inline(always)]
    fn advance<const W: usize>(
        &self,
        sensitivity: &mut [[T; W]; M],
        drive: impl Fn(usize, usize) -> [T; W],
    ) {
        let start = *sensitivity;
        let mut rate = [[T::from_f64(0.0); W]; M];
        for stage in 0..self.order {
            let mut at = start;
            if stage > 0 {
                for i in 0..M {
                    at[i] = mul_add(rate[i], self.nodes[stage], start[i]);
                }
            }
            for i in 0..M {
                let mut sum = drive(stage, i);
                for (l, row) in at.iter().enumerate() {
                    sum = mul_add(*row, self.jacobians[stage][i][l], sum);
                }
                rate[i] = sum;
                sensitivity[i] = mul_add(sum, self.weights[stage], sensitivity[i]);
            }
        }
    }
}

#[inline(always)]
fn advance_small<T: Scalar, const M: usize>(
    scheme: &Scheme<'_, T, M>,
    drive: Option<&[[[T; M]; M]; 4]>,
    sensitivity: &mut [[T; M]; M],
) {
    scheme.advance(sensitivity, |stage, i| match drive {
        Some(drive) => drive[stage][i],
        None => [T::from_f64(0.0); M],
    });
}

#[inline(always)]
fn advance_columns<T: Scalar, const M: usize, const W: usize>(
    scheme: &Scheme<'_, T, M>,
    stages: &[T],
    columns: &mut [T],
    stride: usize,
    column: usize,
) {
    let mut sensitivity = [[T::from_f64(0.0); W]; M];
    for (i, row) in sensitivity.iter_mut().enumerate() {
        *row = load(columns, i * stride + column);
    }
    scheme.advance(&mut sensitivity, |stage, i| {
        load(stages, (stage * M + i) * stride + column)
    });
    for (i, row) in sensitivity.iter().enumerate() {
        store(columns, i * stride + column, *row);
    }
}
