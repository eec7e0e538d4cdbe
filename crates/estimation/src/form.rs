//! Forms of the error covariance: P itself, or its factors.

use gyrocal_scalar::Real;

use crate::error::EstimationError;
use crate::innovation::Innovation;

/// A form of the covariance and the Kalman step on it. Implemented by [`crate::Covariance`] and
/// [`crate::Factors`]; a filter is generic over it.
///
/// Both know that Φ is the identity on the parameters, and that H is zero but for the moving
/// states and the first q parameters.
pub trait Form<T: Real> {
    /// True if a prediction is faster when zero elements of Φ are known.
    const USES_ZEROS: bool;

    /// Independent errors of the given variances.
    fn start(numbers: &mut Numbers<'_, T>, variances: impl Iterator<Item = T>);

    /// Element (i, j) of P, `moving` being the number of moving states.
    fn element(matrix: &[T], pivots: &[T], moving: usize, i: usize, j: usize) -> T;

    /// The n (n + 1) / 2 numbers that determine P, those that must be positive first: `put` takes
    /// one after the other.
    fn save(matrix: &[T], pivots: &[T], put: impl FnMut(T));

    /// Takes the numbers of [`Self::save`] back, in the same order. Where `get` has none left, the
    /// rest stays as it is.
    fn restore(numbers: &mut Numbers<'_, T>, get: impl FnMut() -> Option<T>);

    /// P ← W (Φ P Φᵀ + Γ diag(variance) Γᵀ) Wᵀ, W being the map on the moving states.
    ///
    /// `zeros` declares which products can be left out; with `SPARSE` there are enough of them among
    /// the parameter columns of Φ to test each element.
    ///
    /// # Errors
    /// [`EstimationError::NotPositiveDefinite`] or [`EstimationError::NotFinite`].
    fn predict<const M: usize, const SPARSE: bool>(
        numbers: &mut Numbers<'_, T>,
        transition: &Transition<'_, T, M>,
        zeros: &impl Zeros,
    ) -> Result<(), EstimationError>;

    /// P ← W P Wᵀ for independent errors, W being the map on the moving states.
    ///
    /// # Errors
    /// As [`Self::predict`].
    fn recentre<const M: usize>(
        numbers: &mut Numbers<'_, T>,
        map: &[[T; M]; M],
    ) -> Result<(), EstimationError>;

    /// The innovation alone; nothing changes but workspace.
    ///
    /// # Errors
    /// As [`Self::update`].
    fn innovation<const M: usize, const Y: usize>(
        numbers: &mut Numbers<'_, T>,
        observation: &Observation<'_, T, M, Y>,
    ) -> Result<Innovation<T, Y>, EstimationError>;

    /// P ← P + `variance` d dᵀ: the state has moved by itself, along a direction d.
    fn diffuse(numbers: &mut Numbers<'_, T>, direction: &[T], variance: T);

    /// P ← `factor` P.
    fn widen(numbers: &mut Numbers<'_, T>, factor: T);

    /// P ← (I - K H) P, and the correction of the state: parameters are corrected in place;
    /// `correct` is called with the moving states' correction as soon as it is known, so that
    /// what depends on it need not wait for P. Neither where the NIS is beyond the largest one of the
    /// observation: nothing has changed then.
    ///
    /// # Errors
    /// [`EstimationError::NotPositiveDefinite`], [`EstimationError::LostPrecision`] or
    /// [`EstimationError::NotFinite`].
    fn update<const M: usize, const Y: usize>(
        numbers: &mut Numbers<'_, T>,
        parameters: &mut [T],
        observation: &Observation<'_, T, M, Y>,
        zeros: &impl Zeros,
        correct: impl FnOnce(&[T; M]),
    ) -> Result<Innovation<T, Y>, EstimationError>;
}

/// Elements of a linearised step that equal those of a unit matrix for every state: zero, and one
/// on the diagonal. The answers must be constants, so that the compiler leaves products out; by
/// default nothing is known.
pub trait Zeros {
    /// False if element (i, j) of the moving columns of Φ is that of a unit matrix.
    #[inline(always)]
    fn moves(&self, i: usize, j: usize) -> bool {
        let _ = (i, j);
        true
    }

    /// False if element (i, j) of the parameter columns of Φ is zero.
    #[inline(always)]
    fn enters(&self, i: usize, j: usize) -> bool {
        let _ = (i, j);
        true
    }

    /// False if element (i, k) of Γ is zero.
    #[inline(always)]
    fn drives(&self, i: usize, k: usize) -> bool {
        let _ = (i, k);
        true
    }

    /// False if element (k, j) of the moving columns of H is zero.
    #[inline(always)]
    fn shows(&self, k: usize, j: usize) -> bool {
        let _ = (k, j);
        true
    }

    /// False if element (i, j) of W is that of a unit matrix.
    #[inline(always)]
    fn maps(&self, i: usize, j: usize) -> bool {
        let _ = (i, j);
        true
    }
}

/// Nothing is known of the elements.
impl Zeros for () {}

/// The numbers of the covariance and workspace, for n states.
#[derive(Debug)]
pub struct Numbers<'a, T> {
    /// P or U; n × n.
    pub matrix: &'a mut [T],
    /// D of the factors; n.
    pub pivots: &'a mut [T],
    /// Gain; Y × n.
    pub gain: &'a mut [T],
    /// Workspace of an update; 2 × n × Y.
    pub sweep: &'a mut [T],
    /// Workspace of a prediction; M × n.
    pub cross: &'a mut [T],
    /// What an update that may turn out unwanted puts back: M × n, and n.
    pub kept: [&'a mut [T]; 2],
}

/// A step of the state, linearised.
#[derive(Debug)]
pub struct Transition<'a, T, const M: usize> {
    /// Moving columns of Φ.
    pub moving: [[T; M]; M],
    /// Parameter columns of Φ; M × p, by rows.
    pub parameters: &'a [T],
    /// Γ: effect of the noise held over the step.
    pub noise: [[T; M]; M],
    /// Variance of each noise input.
    pub variance: [T; M],
    /// W: map of the moving states' errors to the chart after the step.
    pub map: Option<[[T; M]; M]>,
}

/// One measurement: Jacobian of the outputs, their noise and their residuals. An output
/// that was not observed has a zero row, unit variance and zero residual.
#[derive(Debug)]
pub struct Observation<'a, T, const M: usize, const Y: usize> {
    /// Moving columns of H.
    pub moving: [[T; M]; Y],
    /// The columns of H of the q parameters that enter the output (Y × q, by rows).
    pub parameters: &'a [T],
    /// Noise variance of each output.
    pub variance: [T; Y],
    /// Measured minus predicted output.
    pub residual: [T; Y],
    /// True for each output that was observed.
    pub observed: [bool; Y],
    /// Largest standardised innovation that the correction takes: beyond it it takes this one, with
    /// its sign, if the state is at least as certain as the sample. `None`: all as they are.
    pub clip: Option<T>,
    /// Largest NIS that is used: beyond it an update changes nothing but workspace. `None`: any.
    pub largest_nis: Option<T>,
}

impl<T: Real, const M: usize, const Y: usize> Observation<'_, T, M, Y> {
    /// True if the NIS is so large that the observation is not to be used.
    #[inline(always)]
    pub(crate) fn is_refused(&self, nis: T) -> bool {
        self.largest_nis
            .is_some_and(|largest_nis| nis > largest_nis || largest_nis.is_nan())
    }
}
