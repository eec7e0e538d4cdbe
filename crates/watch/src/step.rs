/// One step of the filter as errors of its state see it.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a, T, const M: usize, const Y: usize, const N: usize> {
    /// Moving rows of Φ, in the chart after the step.
    pub transition: &'a [[T; N]; M],
    /// The measurement at its end; `None` if there was none.
    pub observed: Option<&'a Observed<T, M, Y, N>>,
    /// Its part of a block: the sum over a block is one.
    pub part: T,
}

/// Jacobian and gain of a measurement, both whitened: with S = C Cᵀ the rows of C⁻¹ H and the columns
/// of K C.
#[derive(Clone, Copy, Debug)]
pub struct Observed<T, const M: usize, const Y: usize, const N: usize> {
    /// Moving columns of C⁻¹ H.
    pub output: [[T; M]; Y],
    /// C⁻¹.
    pub whitening: [[T; Y]; Y],
    /// Columns of K C: the correction of the state is their sum, weighted with the whitened
    /// innovations.
    pub gain: [[T; N]; Y],
}

/// Deviations of the elements of a step's whitened innovation, for each column.
#[derive(Clone, Copy, Debug)]
pub struct Whitened<T, const Y: usize, const N: usize, const D: usize> {
    /// For a unit of each state at the beginning of the block.
    pub unit: [[T; N]; Y],
    /// For each driven column.
    pub driven: [[T; D]; Y],
}
