//! Columns of a linearised model that are no parameters of it: jumps of states, steps and other
//! functions of time, changes of outputs.

use std::sync::Arc;

use gyrocal_estimation::batch::Columns;

/// One such column.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// Change of a moving state at the first row of a record, outside its prior.
    InitialState {
        /// The first row of the record.
        row: usize,
        /// Index of the state.
        state: usize,
    },
    /// Sudden change of a moving state in the step after a row.
    StateJump {
        /// The row before it.
        row: usize,
        /// Index of the state.
        state: usize,
    },
    /// Effect of a parameter of the model from the step after a row on.
    Step {
        /// Index of the parameter.
        parameter: usize,
        /// The row.
        row: usize,
    },
    /// Effect of a parameter of the model, times a number for each step.
    TimeProfile {
        /// Index of the parameter.
        parameter: usize,
        /// One number for each step.
        steps: Arc<[f64]>,
    },
    /// Change of one output, which neither trajectory nor parameters notice.
    Output {
        /// Index of the output.
        output: usize,
        /// Change at each row, in the unit of the output.
        change: Arc<[f64]>,
    },
}

/// A list of columns with their prior standard deviations and present amplitudes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ExtraColumns {
    columns: Vec<Column>,
    sigmas: Vec<f64>,
    amplitudes: Vec<f64>,
    /// Places of the columns that change outputs.
    outputs: Vec<usize>,
}

impl ExtraColumns {
    /// These columns with amplitude zero and without a prior.
    #[must_use]
    pub fn new(columns: Vec<Column>) -> Self {
        let mut extra = Self::default();
        extra.extend(columns, f64::INFINITY);
        extra
    }

    /// Adds columns whose amplitudes have this standard deviation before the record.
    pub fn extend(&mut self, columns: impl IntoIterator<Item = Column>, sigma: f64) {
        let before = self.columns.len();
        self.columns.extend(columns);
        let new = self.columns.iter().enumerate().skip(before);
        let changing = new.filter(|(_, column)| matches!(column, Column::Output { .. }));
        self.outputs.extend(changing.map(|(place, _)| place));
        self.sigmas.resize(self.columns.len(), sigma);
        self.amplitudes.resize(self.columns.len(), 0.0);
    }

    /// Standard deviation of each amplitude before the record.
    #[must_use]
    pub fn sigmas(&self) -> &[f64] {
        &self.sigmas
    }

    /// The columns.
    #[must_use]
    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// Sum of the columns with their amplitudes in an output at a row.
    #[must_use]
    pub fn output_change(&self, row: usize, output: usize) -> f64 {
        self.outputs
            .iter()
            .map(|place| match &self.columns[*place] {
                Column::Output {
                    output: own,
                    change,
                } if *own == output => change
                    .get(row)
                    .map_or(0.0, |change| self.amplitudes[*place] * change),
                _ => 0.0,
            })
            .sum()
    }

    /// Sets the amplitudes, in the order of the columns.
    pub fn set_amplitudes(&mut self, amplitudes: impl Iterator<Item = f64>) {
        for (target, amplitude) in self.amplitudes.iter_mut().zip(amplitudes) {
            *target = amplitude;
        }
    }
}

impl<const M: usize, const Y: usize> Columns<M, Y> for ExtraColumns {
    fn count(&self) -> usize {
        self.columns.len()
    }

    fn amplitude(&self, column: usize) -> f64 {
        self.amplitudes[column]
    }

    fn start(&self, column: usize) -> [f64; M] {
        let mut change = [0.0; M];
        if let Column::InitialState { row: 0, state } = self.columns[column] {
            change[state] = 1.0;
        }
        change
    }

    fn drive(&self, row: usize, parameters: &[f64], stride: usize, drive: [&mut [f64]; M]) {
        for (index, column) in self.columns.iter().enumerate() {
            match column {
                Column::InitialState { .. } | Column::Output { .. } => {}
                Column::StateJump { row: at, state } => {
                    if *at == row {
                        drive[*state][index] = 1.0;
                    }
                }
                Column::Step { parameter, row: at } => {
                    if row >= *at {
                        for i in 0..M {
                            drive[i][index] = parameters[i * stride + parameter];
                        }
                    }
                }
                Column::TimeProfile { parameter, steps } => {
                    let weight = steps.get(row).copied().unwrap_or(0.0);
                    for i in 0..M {
                        drive[i][index] = weight * parameters[i * stride + parameter];
                    }
                }
            }
        }
    }

    fn output(&self, row: usize, output: usize, direct: &mut [f64]) {
        for place in &self.outputs {
            if let Column::Output {
                output: own,
                change,
            } = &self.columns[*place]
                && *own == output
            {
                direct[*place] = change.get(row).copied().unwrap_or(0.0);
            }
        }
    }
}
