//! The covariance step on the structure of the model: moving states first, parameters after.
//!
//! P is one n × n array by rows. Rows of moving states are complete; of the rows of parameters
//! only the parameter columns are kept, so the symmetric cross block is stored once. Of the
//! parameter block what lies left of the diagonal is computed and put to its other side, in
//! vectors as wide as four: there both triangles come from the same operations in the same order.
//! So it is symmetric to the last bit without symmetrisation.
//!
//! - Prediction: Φ is the identity on the parameters, so the parameter block does not change;
//!   the moving rows become Φ_mm P_mp + Φ_mp P_pp.
//! - Update: with S = L diag(α) Lᵀ the whitened gain is V = diag(α)^-1/2 L⁻¹ H P, and
//!   P ← P - Vᵀ V. Where a measurement removes nearly all of a wide prior, the moving block is
//!   updated in Joseph form, which cannot lose definiteness by cancellation.
//!
//! Structural zeros of Φ, H and the map to the next chart are left out: see
//! [`Zeros`].
//!
//! A variance that is not positive afterwards is an error; nothing is repaired.

mod predict;
mod update;

use gyrocal_scalar::Real;

use crate::error::EstimationError;
use crate::form::{Form, Numbers, Observation, Transition, Zeros};
use crate::innovation::Innovation;
use crate::projection::Projection;
use crate::unrolled::mul_add;

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

    #[inline]
    fn save(matrix: &[T], pivots: &[T], mut put: impl FnMut(T)) {
        let n = pivots.len().max(1);
        for (i, row) in matrix.chunks_exact(n).enumerate() {
            row.iter()
                .skip(i)
                .take(1)
                .for_each(|variance| put(*variance));
        }
        for (i, row) in matrix.chunks_exact(n).enumerate() {
            row.iter().skip(i + 1).for_each(|element| put(*element));
        }
    }

    #[inline]
    fn restore(numbers: &mut Numbers<'_, T>, mut get: impl FnMut() -> Option<T>) {
        let n = numbers.pivots.len().max(1);
        for (i, row) in numbers.matrix.chunks_exact_mut(n).enumerate() {
            for place in row.iter_mut().skip(i).take(1) {
                *place = get().unwrap_or(*place);
            }
        }
        for i in 0..n {
            for j in i + 1..n {
                let Some(value) = get() else { return };
                // Symmetric; where the lower half is not kept, nothing reads it.
                for at in [i * n + j, j * n + i] {
                    if let Some(place) = numbers.matrix.get_mut(at) {
                        *place = value;
                    }
                }
            }
        }
    }

    #[inline(always)]
    fn predict<const M: usize, const SPARSE: bool>(
        numbers: &mut Numbers<'_, T>,
        transition: &Transition<'_, T, M>,
        zeros: &impl Zeros,
    ) -> Result<(), EstimationError> {
        let n = numbers.pivots.len();
        predict::predict::<_, _, M, SPARSE>(numbers.matrix, n, transition, numbers.cross, zeros)
    }

    #[inline(always)]
    fn recentre<const M: usize>(
        numbers: &mut Numbers<'_, T>,
        map: &[[T; M]; M],
    ) -> Result<(), EstimationError> {
        predict::recentre(numbers.matrix, numbers.pivots.len(), map)
    }

    #[inline]
    fn diffuse(numbers: &mut Numbers<'_, T>, direction: &[T], variance: T) {
        let rows = numbers.matrix.chunks_exact_mut(direction.len().max(1));
        for (row, own) in rows.zip(direction) {
            for (element, other) in row.iter_mut().zip(direction) {
                // The product of both first: it is symmetric to the last bit.
                *element = (*own * *other).mul_add(variance, *element);
            }
        }
    }

    #[inline]
    fn widen(numbers: &mut Numbers<'_, T>, factor: T) {
        for element in numbers.matrix.iter_mut() {
            *element = *element * factor;
        }
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
        update::project_parameters(numbers.matrix, n, observation, zeros, numbers.gain);
        let projection = Projection::new(numbers.matrix, n, observation, zeros);
        projection.check()?;
        let innovation = projection.innovation();
        innovation.check()?;
        if observation.is_refused(innovation.nis) {
            return Ok(innovation);
        }
        let mut head = projection.moving;
        projection.reduce(&mut head);
        let mut correction = [T::from_f64(0.0); M];
        for k in 0..Y {
            correction = mul_add(head[k], innovation.weights[k], correction);
        }
        correct(&correction);
        let pass = update::Pass::new(&projection, &innovation, head);
        pass.run(numbers.matrix, n, parameters, numbers.gain)?;
        Ok(innovation)
    }
}
