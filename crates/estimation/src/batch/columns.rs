//! Sensitivity columns in addition to those of the model's own parameters.

/// Columns besides the parameters of the model: jumps of the moving states, parameters that enter
/// in proportion to one of the model's, or anything else that is linear in its amplitude.
///
/// `M` moving states, `Y` outputs.
pub trait Columns<const M: usize, const Y: usize> {
    /// Number of columns.
    fn count(&self) -> usize;

    /// The amplitude of a column at the linearisation point.
    fn amplitude(&self, column: usize) -> f64 {
        let _ = column;
        0.0
    }

    /// Change of the moving states at the first row, for a unit of the column.
    fn start(&self, column: usize) -> [f64; M] {
        let _ = column;
        [0.0; M]
    }

    /// Change of the moving states at the end of the step after `row`, for a unit of each column
    /// over the step: `drive` has a row of [`Self::count`] numbers for each moving state and
    /// comes zeroed. `parameters` are the model's own columns of that step, with `stride`
    /// numbers for each moving state.
    fn drive(&self, row: usize, parameters: &[f64], stride: usize, drive: [&mut [f64]; M]) {
        let _ = (row, parameters, stride, drive);
    }

    /// Direct change of an output at a row, for a unit of each column; comes zeroed.
    fn output(&self, row: usize, output: usize, direct: &mut [f64]) {
        let _ = (row, output, direct);
    }
}

/// No further columns.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoColumns;

impl<const M: usize, const Y: usize> Columns<M, Y> for NoColumns {
    fn count(&self) -> usize {
        0
    }
}
