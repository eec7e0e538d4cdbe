//! A record as a generated model takes it.

/// The rows of a record, and the model's inputs over and at them.
pub trait Series<I, const Y: usize> {
    /// Number of rows.
    fn rows(&self) -> usize;

    /// Time of a row, s; rises with the rows.
    fn time_s(&self, row: usize) -> f64;

    /// Measured outputs, NaN where one is missing.
    fn measured(&self, row: usize) -> [f64; Y];

    /// Noise variance of the outputs of a row.
    fn noise_variance(&self, row: usize) -> [f64; Y];

    /// Sets the inputs that are held over an interval, which begins in the step after `row`.
    fn over(&self, row: usize, from_s: f64, to_s: f64, inputs: &mut I) {
        let _ = (row, from_s, to_s, inputs);
    }

    /// Sets the inputs that hold at a row.
    fn at(&self, row: usize, inputs: &mut I) {
        let _ = (row, inputs);
    }
}
