//! Storage of a filter: arrays for controllers, vectors for batch work.

use gyrocal_scalar::Real;

/// Everything a filter step reads and writes, as slices.
///
/// Matrices over all n states are stored by columns with stride n, those over the n - M
/// parameters by rows with stride n - M.
#[derive(Debug)]
pub struct Buffers<'a, T> {
    /// The state: moving states, then parameters; n.
    pub state: &'a mut [T],
    /// What rounding left of the state, where the number type is coarse; n.
    pub remainder: &'a mut [T],
    /// P by rows (of the parameters' rows only the parameter columns), or U by columns; n × n.
    pub matrix: &'a mut [T],
    /// D of the factors; n.
    pub pivots: &'a mut [T],
    /// Parameter columns of Φ by rows, in the chart that the step began in; M × (n - M).
    pub transition: &'a mut [T],
    /// Parameter columns of the rates' Jacobian at each of up to four stages, by rows;
    /// 4 × M × (n - M). Structural zeros stay zero.
    pub stages: &'a mut [T],
    /// Parameter columns of the output's Jacobian by rows; Y × n at most.
    pub output: &'a mut [T],
    /// Gain of the last update, whitened ([`crate::Covariance`]) or unnormalised; Y × n.
    pub gain: &'a mut [T],
    /// Workspace of an update; 2 × n × Y.
    pub sweep: &'a mut [T],
    /// Workspace of a prediction; M × n.
    pub cross: &'a mut [T],
    /// What an update that may turn out unwanted puts back: moving rows of U by columns, M × n, and D.
    pub kept: [&'a mut [T]; 2],
}

/// Numbers of a filter that persist between steps.
#[derive(Clone, Copy, Debug)]
pub struct View<'a, T> {
    /// The state: moving states, then parameters.
    pub state: &'a [T],
    /// What rounding left of the state, where the number type is coarse.
    pub remainder: &'a [T],
    /// P by rows (of the parameters' rows only the parameter columns), or U by columns; n × n.
    pub matrix: &'a [T],
    /// D of the factors; n.
    pub pivots: &'a [T],
    /// Parameter columns of the last Φ by rows, in the chart that its step began in: see
    /// [`crate::Filter::chart_map`].
    pub transition: &'a [T],
    /// Gain of the last update, whitened ([`crate::Covariance`]) or unnormalised; Y × n.
    pub gain: &'a [T],
}

/// Numbers of a filter with `states()` states.
pub trait Storage<T> {
    /// Number of states, moving ones and parameters together.
    fn states(&self) -> usize;
    /// All numbers, for a step.
    fn buffers(&mut self) -> Buffers<'_, T>;
    /// The numbers that persist between steps.
    fn view(&self) -> View<'_, T>;
}

/// Storage in arrays for `N` states, `M` of them moving, and `Y` outputs.
#[derive(Clone, Debug)]
pub struct ArrayStorage<T, const M: usize, const Y: usize, const N: usize> {
    state: [T; N],
    remainder: [T; N],
    matrix: [[T; N]; N],
    pivots: [T; N],
    transition: [[T; N]; M],
    stages: [[[T; N]; M]; 4],
    output: [[T; N]; Y],
    gain: [[T; N]; Y],
    sweep: [[[T; Y]; N]; 2],
    cross: [[T; N]; M],
    kept: [[T; N]; M],
    kept_pivots: [T; N],
}

impl<T: Real, const M: usize, const Y: usize, const N: usize> ArrayStorage<T, M, Y, N> {
    /// All numbers zero.
    #[must_use]
    pub const fn new() -> Self {
        const {
            assert!(
                M <= N,
                "a filter has at least as many states as moving states"
            )
        };
        let zero = T::ZERO;
        Self {
            state: [zero; N],
            remainder: [zero; N],
            matrix: [[zero; N]; N],
            pivots: [zero; N],
            transition: [[zero; N]; M],
            stages: [[[zero; N]; M]; 4],
            output: [[zero; N]; Y],
            gain: [[zero; N]; Y],
            sweep: [[[zero; Y]; N]; 2],
            cross: [[zero; N]; M],
            kept: [[zero; N]; M],
            kept_pivots: [zero; N],
        }
    }
}

impl<T: Real, const M: usize, const Y: usize, const N: usize> Default for ArrayStorage<T, M, Y, N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T, const M: usize, const Y: usize, const N: usize> Storage<T> for ArrayStorage<T, M, Y, N> {
    #[inline(always)]
    fn states(&self) -> usize {
        N
    }

    #[inline(always)]
    fn buffers(&mut self) -> Buffers<'_, T> {
        Buffers {
            state: &mut self.state,
            remainder: &mut self.remainder,
            matrix: self.matrix.as_flattened_mut(),
            pivots: &mut self.pivots,
            transition: self.transition.as_flattened_mut(),
            stages: self.stages.as_flattened_mut().as_flattened_mut(),
            output: self.output.as_flattened_mut(),
            gain: self.gain.as_flattened_mut(),
            sweep: self.sweep.as_flattened_mut().as_flattened_mut(),
            cross: self.cross.as_flattened_mut(),
            kept: [self.kept.as_flattened_mut(), &mut self.kept_pivots],
        }
    }

    #[inline(always)]
    fn view(&self) -> View<'_, T> {
        View {
            state: &self.state,
            remainder: &self.remainder,
            matrix: self.matrix.as_flattened(),
            pivots: &self.pivots,
            transition: self.transition.as_flattened(),
            gain: self.gain.as_flattened(),
        }
    }
}

/// Storage on the heap for a number of states known at run time.
#[cfg(feature = "alloc")]
#[derive(Clone, Debug)]
pub struct VecStorage<T> {
    states: usize,
    numbers: [alloc::vec::Vec<T>; 12],
}

#[cfg(feature = "alloc")]
impl<T: Copy + Default> VecStorage<T> {
    /// Room for `states` states, `moving` of them moving, and `outputs` outputs.
    #[must_use]
    pub fn new(states: usize, moving: usize, outputs: usize) -> Self {
        let lengths = [
            states,
            states,
            states * states,
            states,
            moving * states,
            4 * moving * states,
            outputs * states,
            outputs * states,
            2 * outputs * states,
            moving * states,
            moving * states,
            states,
        ];
        Self {
            states,
            numbers: lengths.map(|length| alloc::vec![T::default(); length]),
        }
    }
}

#[cfg(feature = "alloc")]
impl<T> Storage<T> for VecStorage<T> {
    fn states(&self) -> usize {
        self.states
    }

    fn buffers(&mut self) -> Buffers<'_, T> {
        let [
            state,
            remainder,
            matrix,
            pivots,
            transition,
            stages,
            output,
            gain,
            sweep,
            cross,
            kept,
            kept_pivots,
        ] = self.numbers.each_mut();
        Buffers {
            state,
            remainder,
            matrix,
            pivots,
            transition,
            stages,
            output,
            gain,
            sweep,
            cross,
            kept: [kept, kept_pivots],
        }
    }

    fn view(&self) -> View<'_, T> {
        let [
            state,
            remainder,
            matrix,
            pivots,
            transition,
            _,
            _,
            gain,
            _,
            _,
            _,
            _,
        ] = self.numbers.each_ref();
        View {
            state,
            remainder,
            matrix,
            pivots,
            transition,
            gain,
        }
    }
}
