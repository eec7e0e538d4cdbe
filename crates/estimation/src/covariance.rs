//! The covariance step on the structure of the model: moving states first, parameters after.
//!
//! P is one n × n array by rows. Rows of moving states are complete; of the rows of parameters
//! only the parameter columns are kept, so the symmetric cross block is stored once. Of the
//! parameter block what lies left of the diagonal is computed and put to its other side, in
//! vectors as wide as four: there both triangles come from the same operations in the same order.
//! So it is symmetric to the last bit without being made so.
//!
//! - Prediction: Φ is the identity on the parameters, so the parameter block does not change;
//!   the moving rows become Φ_mm P_mp + Φ_mp P_pp.
//! - Update: with S = L diag(α) Lᵀ the whitened gain is V = diag(α)^-1/2 L⁻¹ H P, and
//!   P ← P - Vᵀ V. Where a measurement removes nearly all of a wide prior, the moving block is
//!   updated in Joseph form, which cannot lose definiteness by cancellation.
//!
//! What the model knows to be zero in Φ, H and the map to the next chart is left out: see
//! [`Zeros`].
//!
//! A variance that is not positive afterwards is an error; nothing is repaired.

use gyrocal_scalar::Real;

use crate::error::EstimationError;
use crate::form::{Form, Numbers, Observation, Transition, Zeros};
use crate::innovation::Innovation;
use crate::lanes4::{load, load_rows, mul_add, multiply_add, store};
use crate::projection::{Projection, is_variance, not_positive};
use crate::zeros::{add_product, product};

/// P itself: the fast form. It needs double precision, and a prior that is not wider against
/// the noise than that holds: what an update would cancel to nothing but rounding is
/// [`EstimationError::LostPrecision`]. After each step every variance must be positive and
/// finite; that P has no negative eigenvalue in between is not checked in the step, but held by
/// tests over a year of steps and from badly scaled priors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Covariance;

impl<T: Real> Form<T> for Covariance {
    const USES_ZEROS: bool = true;

    #[inline]
    fn start(numbers: &mut Numbers<'_, T>, variances: impl Iterator<Item = T>) {
        let n = numbers.pivots.len();
        numbers.matrix.fill(T::from_f64(0.0));
        for (j, variance) in variances.enumerate() {
            numbers.matrix[j * n + j] = variance;
        }
    }

    #[inline]
    fn element(matrix: &[T], pivots: &[T], moving: usize, i: usize, j: usize) -> T {
        let n = pivots.len();
        if i < moving || j >= moving {
            matrix[i * n + j]
        } else {
            matrix[j * n + i]
        }
    }

    #[inline(always)]
    fn predict<const M: usize, const SPARSE: bool>(
        numbers: &mut Numbers<'_, T>,
        transition: &Transition<'_, T, M>,
        zeros: &impl Zeros,
    ) -> Result<(), EstimationError> {
        let n = numbers.pivots.len();
        predict::<_, _, M, SPARSE>(numbers.matrix, n, transition, numbers.cross, zeros)
    }

    #[inline(always)]
    fn innovation<const M: usize, const Y: usize>(
        numbers: &mut Numbers<'_, T>,
        observation: &Observation<'_, T, M, Y>,
    ) -> Result<Innovation<T, Y>, EstimationError> {
        let projection = Projection::new(numbers.matrix, numbers.pivots.len(), observation, &());
        projection.check()?;
        let innovation = projection.innovation();
        innovation.check()?;
        Ok(innovation)
    }

    #[inline(always)]
    fn update<const M: usize, const Y: usize>(
        numbers: &mut Numbers<'_, T>,
        parameters: &mut [T],
        observation: &Observation<'_, T, M, Y>,
        zeros: &impl Zeros,
        correct: impl FnOnce(&[T; M]),
    ) -> Result<Innovation<T, Y>, EstimationError> {
        let n = numbers.pivots.len();
        // Needs nothing of S, and fills the time in which the divisions of its factors wait for
        // each other.
        project_parameters(numbers.matrix, n, observation, zeros, numbers.gain);
        let projection = Projection::new(numbers.matrix, n, observation, zeros);
        projection.check()?;
        let innovation = projection.innovation();
        innovation.check()?;
        let mut head = projection.moving;
        projection.reduce(&mut head);
        let mut correction = [T::from_f64(0.0); M];
        for k in 0..Y {
            correction = mul_add(head[k], innovation.weights[k], correction);
        }
        correct(&correction);
        let pass = Pass::new(&projection, &innovation, head);
        pass.run(numbers.matrix, n, parameters, numbers.gain)?;
        Ok(innovation)
    }
}

/// P ← W (Φ P Φᵀ + Γ diag(variance) Γᵀ) Wᵀ. W, which waits for the end of the step and for its
/// sines and cosines, comes last.
#[inline(always)]
fn predict<T: Real, Z: Zeros, const M: usize, const SPARSE: bool>(
    p: &mut [T],
    n: usize,
    transition: &Transition<'_, T, M>,
    workspace: &mut [T],
    zeros: &Z,
) -> Result<(), EstimationError> {
    let count = n - M;
    let half = T::from_f64(0.5);
    let Transition {
        moving,
        noise,
        variance,
        map,
        ..
    } = transition;
    let mut column = 0;
    while column + 4 <= count {
        predict_columns::<_, _, M, 4, SPARSE>(p, n, transition, zeros, workspace, column);
        column += 4;
    }
    while column < count {
        predict_columns::<_, _, M, 1, SPARSE>(p, n, transition, zeros, workspace, column);
        column += 1;
    }
    let added = added::<_, _, M, SPARSE>(transition.parameters, count, workspace, zeros);
    let old: [[T; M]; M] = load_rows(p, n, 0);
    let mapped = product(moving, |i, j| zeros.moves(i, j), &old);
    let mut corner = [[T::from_f64(0.0); M]; M];
    for i in 0..M {
        for j in 0..=i {
            let mut sum = half * (added[i][j] + added[j][i]);
            for k in 0..M {
                sum = add_product(mapped[i][k], moving[j][k], zeros.moves(j, k), j == k, sum);
                if zeros.drives(i, k) && zeros.drives(j, k) {
                    sum = (noise[i][k] * variance[k]).mul_add(noise[j][k], sum);
                }
            }
            corner[i][j] = sum;
            corner[j][i] = sum;
        }
    }
    if let Some(map) = map {
        let rows = product(map, |i, j| zeros.maps(i, j), &corner);
        for i in 0..M {
            for j in 0..=i {
                let mut sum = T::from_f64(0.0);
                for k in 0..M {
                    sum = add_product(rows[i][k], map[j][k], zeros.maps(j, k), j == k, sum);
                }
                corner[i][j] = sum;
                corner[j][i] = sum;
            }
        }
    }
    for (i, row) in corner.iter().enumerate() {
        store(p, i * n, *row);
    }
    check_diagonal(p, n, M)
}

/// The moving rows W (Φ_mm P_mp + Φ_mp P_pp), for `W` columns. C = Φ_mp P_pp + 2 Φ_mm P_mp is left
/// in `workspace`.
#[inline(always)]
fn predict_columns<T: Real, Z: Zeros, const M: usize, const W: usize, const SPARSE: bool>(
    p: &mut [T],
    n: usize,
    transition: &Transition<'_, T, M>,
    zeros: &Z,
    workspace: &mut [T],
    column: usize,
) {
    let (count, at) = (n - M, M + column);
    let columns = transition.parameters;
    let old: [[T; W]; M] = load_rows(p, n, at);
    let mapped = product(&transition.moving, |i, j| zeros.moves(i, j), &old);
    let mut sums = mapped;
    for l in 0..count {
        let row: [T; W] = load(p, (M + l) * n + at);
        for i in 0..M {
            if !SPARSE || zeros.enters(i, l) {
                sums[i] = mul_add(row, columns[i * count + l], sums[i]);
            }
        }
    }
    for i in 0..M {
        let both = mul_add(mapped[i], T::from_f64(1.0), sums[i]);
        store(workspace, i * count + column, both);
    }
    if let Some(map) = &transition.map {
        sums = product(map, |i, j| zeros.maps(i, j), &sums);
    }
    for (i, row) in sums.iter().enumerate() {
        store(p, i * n + at, *row);
    }
}

/// C Φ_mpᵀ, whose symmetric part is all that the parameters add to the moving block. C (M × p, by
/// rows) is in `workspace`.
#[inline(always)]
fn added<T: Real, Z: Zeros, const M: usize, const SPARSE: bool>(
    columns: &[T],
    count: usize,
    workspace: &[T],
    zeros: &Z,
) -> [[T; M]; M] {
    let mut added = [[T::from_f64(0.0); M]; M];
    let mut rest = 0;
    if !SPARSE {
        rest = count / 4 * 4;
        for i in 0..M {
            let mut lanes = [[T::from_f64(0.0); 4]; M];
            for column in (0..rest).step_by(4) {
                let row: [T; 4] = load(workspace, i * count + column);
                for j in 0..M {
                    lanes[j] = multiply_add(row, load(columns, j * count + column), lanes[j]);
                }
            }
            for j in 0..M {
                let [a, b, c, d] = lanes[j];
                added[i][j] = (a + b) + (c + d);
            }
        }
    }
    for l in rest..count {
        for j in 0..M {
            if !SPARSE || zeros.enters(j, l) {
                let phi = columns[j * count + l];
                for i in 0..M {
                    added[i][j] = workspace[i * count + l].mul_add(phi, added[i][j]);
                }
            }
        }
    }
    added
}

/// What the pass over P needs.
struct Pass<'a, T, const M: usize, const Y: usize> {
    projection: &'a Projection<'a, T, M, Y>,
    /// diag(α)^-1/2.
    root: [T; Y],
    /// Weights of the rows of L⁻¹ H P in the correction of the state.
    weights: [T; Y],
    /// Moving columns of V.
    head: [[T; M]; Y],
}

impl<'a, T: Real, const M: usize, const Y: usize> Pass<'a, T, M, Y> {
    /// `head` are the moving columns of L⁻¹ H P.
    #[inline(always)]
    fn new(
        projection: &'a Projection<'a, T, M, Y>,
        innovation: &Innovation<T, Y>,
        mut head: [[T; M]; Y],
    ) -> Self {
        let root = projection.reciprocal.map(T::sqrt);
        for k in 0..Y {
            head[k] = head[k].map(|value| value * root[k]);
        }
        Self {
            projection,
            root,
            weights: innovation.weights,
            head,
        }
    }

    /// P ← (I - K H) P and the parameters' correction; V (Y × n) is left in `gain`.
    #[inline(always)]
    fn run(
        &self,
        p: &mut [T],
        n: usize,
        parameters: &mut [T],
        gain: &mut [T],
    ) -> Result<(), EstimationError> {
        let count = n - M;
        for (k, head) in self.head.iter().enumerate() {
            store(gain, k * n, *head);
        }
        let mut column = 0;
        while column + 4 <= count {
            self.columns::<4>(p, n, parameters, gain, column);
            column += 4;
        }
        while column < count {
            self.columns::<1>(p, n, parameters, gain, column);
            column += 1;
        }
        self.projection.update_corner(p, n, &self.head);
        for i in 0..count {
            let weights: [[T; 1]; Y] = load_rows(gain, n, M + i);
            let mut column = 0;
            while column + 4 <= count && column <= i {
                downdate::<T, M, Y, 4>(p, n, gain, &weights, i, column);
                column += 4;
            }
            while column <= i {
                downdate::<T, M, Y, 1>(p, n, gain, &weights, i, column);
                column += 1;
            }
        }
        check_diagonal(p, n, n)
    }

    /// V, the cross block and the parameters, for `W` columns.
    #[inline(always)]
    fn columns<const W: usize>(
        &self,
        p: &mut [T],
        n: usize,
        parameters: &mut [T],
        gain: &mut [T],
        column: usize,
    ) {
        let at = M + column;
        let mut cross: [[T; W]; M] = load_rows(p, n, at);
        let mut v: [[T; W]; Y] = load_rows(gain, n, at);
        self.projection.reduce(&mut v);
        let mut corrected: [T; W] = load(parameters, column);
        for k in 0..Y {
            corrected = mul_add(v[k], self.weights[k], corrected);
            v[k] = v[k].map(|value| value * self.root[k]);
            for i in 0..M {
                cross[i] = mul_add(v[k], -self.head[k][i], cross[i]);
            }
            store(gain, k * n + at, v[k]);
        }
        store(parameters, column, corrected);
        for (i, row) in cross.iter().enumerate() {
            store(p, i * n + at, *row);
        }
    }
}

/// Leaves the parameter columns of H P in `products` (Y × n).
#[inline(always)]
fn project_parameters<T: Real, Z: Zeros, const M: usize, const Y: usize>(
    p: &[T],
    n: usize,
    observation: &Observation<'_, T, M, Y>,
    zeros: &Z,
    products: &mut [T],
) {
    let count = n - M;
    let mut column = 0;
    while column + 4 <= count {
        project_columns::<_, _, M, Y, 4>(p, n, observation, zeros, products, M + column);
        column += 4;
    }
    while column < count {
        project_columns::<_, _, M, Y, 1>(p, n, observation, zeros, products, M + column);
        column += 1;
    }
}

#[inline(always)]
fn project_columns<T: Real, Z: Zeros, const M: usize, const Y: usize, const W: usize>(
    p: &[T],
    n: usize,
    observation: &Observation<'_, T, M, Y>,
    zeros: &Z,
    products: &mut [T],
    at: usize,
) {
    let q = observation.parameters.len() / Y;
    let mut sums = [[T::from_f64(0.0); W]; Y];
    for i in 0..M + q {
        let row: [T; W] = load(p, i * n + at);
        for k in 0..Y {
            let h = if i < M {
                observation.moving[k][i]
            } else {
                observation.parameters[k * q + i - M]
            };
            if i >= M || zeros.shows(k, i) {
                sums[k] = mul_add(row, h, sums[k]);
            }
        }
    }
    for (k, sum) in sums.iter().enumerate() {
        store(products, k * n + at, *sum);
    }
}

/// Subtracts Vᵀ V from `W` columns of row `i` of the parameter block, and puts those that end
/// before the diagonal to the other side of it too.
#[inline(always)]
fn downdate<T: Real, const M: usize, const Y: usize, const W: usize>(
    p: &mut [T],
    n: usize,
    gain: &[T],
    weights: &[[T; 1]; Y],
    i: usize,
    column: usize,
) {
    let mut value: [T; W] = load(p, (M + i) * n + M + column);
    for k in 0..Y {
        let v: [T; W] = load(gain, k * n + M + column);
        value = mul_add(v, -weights[k][0], value);
    }
    store(p, (M + i) * n + M + column, value);
    if column + W <= i {
        for (j, element) in value.into_iter().enumerate() {
            p[(M + column + j) * n + M + i] = element;
        }
    }
}

#[inline(always)]
fn check_diagonal<T: Real>(p: &[T], n: usize, count: usize) -> Result<(), EstimationError> {
    let mut bad = 0_u32;
    // Several sums, as one would be a chain.
    let mut sums = [T::from_f64(0.0); 4];
    for i in 0..count {
        let variance = p[i * n + i];
        bad |= u32::from(!variance.is_positive());
        sums[i % 4] = sums[i % 4] + variance;
    }
    let sum = (sums[0] + sums[1]) + (sums[2] + sums[3]);
    // A sum of positive numbers is finite only if all of them are.
    if bad == 0 && sum.is_finite() {
        return Ok(());
    }
    let state = (0..count).find(|i| !is_variance(p[i * n + i])).unwrap_or(0);
    Err(not_positive(p[state * n + state], state))
}
