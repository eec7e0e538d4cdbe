//! From rates to a discrete transition: Φ and Γ are the exact derivatives of the discrete
//! map: the variational equation Ṡ = F S + F_p under the same Runge-Kutta scheme, summed from the
//! last stage back, so that each stage costs one product a column.

use gyrocal_scalar::{Model, RatesJacobian, Real, Scalar};

use crate::unrolled::{load, load_rows, mul_add, small_product, store};

/// Integration rule of the rates over a step.
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
/// which are in [`Integrator::columns`].
#[derive(Clone, Copy, Debug)]
pub struct Derivatives<T, const M: usize> {
    /// Moving columns of Φ.
    pub moving: [[T; M]; M],
    /// Γ: effect of noise held over the step. Zero for a model whose noise enters as parameters
    /// do: Γ then consists of their columns.
    pub noise: [[T; M]; M],
}

/// Model, inputs and workspace of an integration.
#[derive(Debug)]
pub struct Integrator<'a, T, D, I, const M: usize, const Y: usize> {
    /// The model.
    pub model: &'a D,
    /// Its inputs, held over the step.
    pub inputs: &'a I,
    /// Its parameters, p of them.
    pub parameters: &'a [T],
    /// Receives the parameter columns of Φ: M × p, by rows.
    pub columns: &'a mut [T],
    /// Workspace of 4 × M × p numbers whose structural zeros are zero.
    pub stages: &'a mut [T],
    /// True if the moving states start at zero, where models have a shorter Jacobian.
    pub at_origin: bool,
}

impl<T, D, const M: usize, const Y: usize> Integrator<'_, T, D, D::Inputs, M, Y>
where
    T: Real,
    D: Model<T, M, Y>,
{
    /// Integrates the moving states over `dt` and their derivatives with them.
    ///
    /// # Panics
    /// If columns and stages have other lengths than [`Self`] says.
    #[inline(always)]
    pub fn integrate(
        &mut self,
        integration: Integration,
        dt: T,
        moving: &mut [T; M],
    ) -> Derivatives<T, M> {
        let count = integration.substeps();
        let h = if count == 1 {
            dt
        } else {
            dt / T::from_u32(count)
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
    ) -> Derivatives<T, M> {
        let zero = [[T::from_f64(0.0); M]; M];
        let mut transition = Derivatives {
            moving: zero,
            noise: zero,
        };
        self.substep(true, nodes, weights, moving, &mut transition);
        if count > 1 {
            (*moving, transition) =
                self.further_substeps(count - 1, nodes, weights, *moving, transition);
        }
        transition
    }

    /// The substeps after the first. Arrays go by value: with their addresses taken here, the
    /// caller would keep them in memory for steps of one part too.
    #[inline(never)]
    fn further_substeps<const ORDER: usize>(
        &mut self,
        count: u32,
        nodes: &[T; ORDER],
        weights: &[T; ORDER],
        mut moving: [T; M],
        mut transition: Derivatives<T, M>,
    ) -> ([T; M], Derivatives<T, M>) {
        // Lengths that a caller has checked already; here the compiler learns them again, so that
        // nothing that follows can panic.
        let p = self.model.parameters();
        let (stages, columns) = (&mut *self.stages, &mut *self.columns);
        let (Some(parameters), Some(stages), Some(columns)) = (
            self.parameters.get(..p),
            stages.get_mut(..4 * M * p),
            columns.get_mut(..M * p),
        ) else {
            return (moving, transition);
        };
        let mut own = Integrator {
            model: self.model,
            inputs: self.inputs,
            parameters,
            columns,
            stages,
            at_origin: self.at_origin,
        };
        for _ in 0..count {
            own.substep(false, nodes, weights, &mut moving, &mut transition);
        }
        (moving, transition)
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
        transition: &mut Derivatives<T, M>,
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
            if self.model.noise_parameters().is_none() {
                noises[stage] = jacobian.noise;
            }
            *moving = mul_add(rates, weights[stage], *moving);
        }
        let adjoint = Adjoint::new(&jacobians, nodes, weights);
        let before = (!first).then_some(&adjoint.moving);
        if self.model.noise_parameters().is_none() {
            let noises = noises.as_flattened().as_flattened();
            let columns = transition.noise.as_flattened_mut();
            adjoint.advance::<M>(before, noises, columns, M, 0);
        }
        let mut column = 0;
        while column + 4 <= p {
            adjoint.advance::<4>(before, self.stages, self.columns, p, column);
            column += 4;
        }
        while column < p {
            adjoint.advance::<1>(before, self.stages, self.columns, p, column);
            column += 1;
        }
        transition.moving = if first {
            adjoint.moving
        } else {
            small_product(&adjoint.moving, &transition.moving)
        };
    }
}

/// A Runge-Kutta scheme on one step, differentiated from its end: derivatives of the state at the
/// end of the step by the rates at each stage.
struct Adjoint<T, const M: usize, const ORDER: usize> {
    /// Derivative of the step with respect to the state that it starts from.
    moving: [[T; M]; M],
    /// Derivative with respect to the rates of each stage.
    stages: [[[T; M]; M]; ORDER],
    /// Weight of the last stage, whose derivative is that times the unit matrix.
    last: T,
}

impl<T: Scalar, const M: usize, const ORDER: usize> Adjoint<T, M, ORDER> {
    #[inline(always)]
    fn new(jacobians: &[[[T; M]; M]; ORDER], nodes: &[T; ORDER], weights: &[T; ORDER]) -> Self {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let mut stages = [[[zero; M]; M]; ORDER];
        let mut through = [[zero; M]; M];
        let mut moving = [[zero; M]; M];
        for stage in (0..ORDER).rev() {
            if stage + 1 == ORDER {
                for i in 0..M {
                    through[i] = jacobians[stage][i].map(|element| element * weights[stage]);
                    moving[i] = through[i];
                }
            } else {
                let mut derivative = [[zero; M]; M];
                for i in 0..M {
                    derivative[i] = through[i].map(|element| element * nodes[stage + 1]);
                    derivative[i][i] = derivative[i][i] + weights[stage];
                }
                through = small_product(&derivative, &jacobians[stage]);
                for i in 0..M {
                    moving[i] = mul_add(through[i], one, moving[i]);
                }
                stages[stage] = derivative;
            }
        }
        for (i, row) in moving.iter_mut().enumerate() {
            row[i] = row[i] + one;
        }
        Self {
            moving,
            stages,
            last: weights[ORDER - 1],
        }
    }

    /// Advances `W` columns of the sensitivity, from zero or with what they were `before`.
    /// `stages` are the derivatives of the rates, M rows a stage.
    #[inline(always)]
    fn advance<const W: usize>(
        &self,
        before: Option<&[[T; M]; M]>,
        stages: &[T],
        columns: &mut [T],
        stride: usize,
        column: usize,
    ) {
        let mut sums = [[T::from_f64(0.0); W]; M];
        if let Some(before) = before {
            let old: [[T; W]; M] = load_rows(columns, stride, column);
            for i in 0..M {
                for j in 0..M {
                    sums[i] = mul_add(old[j], before[i][j], sums[i]);
                }
            }
        }
        for stage in 0..ORDER {
            for j in 0..M {
                // A slice as long as the stride, which bounds the column.
                let row = &stages[(stage * M + j) * stride..][..stride];
                let rate: [T; W] = load(row, column);
                if stage + 1 == ORDER {
                    sums[j] = mul_add(rate, self.last, sums[j]);
                } else {
                    for i in 0..M {
                        sums[i] = mul_add(rate, self.stages[stage][i][j], sums[i]);
                    }
                }
            }
        }
        for (i, sum) in sums.iter().enumerate() {
            store(&mut columns[i * stride..][..stride], column, *sum);
        }
    }
}
