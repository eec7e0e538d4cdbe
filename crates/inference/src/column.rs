//! Columns of a linearised record: its parameters, jumps of states, steps and other functions of time,
//! changes of outputs.

use std::sync::Arc;

/// One unknown of a linearised record.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// A parameter of the model.
    Parameter {
        /// Index of the parameter.
        parameter: usize,
    },
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

impl Column {
    /// The parameter that it changes.
    #[must_use]
    pub fn parameter(&self) -> Option<usize> {
        match self {
            Self::Parameter { parameter }
            | Self::Step { parameter, .. }
            | Self::TimeProfile { parameter, .. } => Some(*parameter),
            Self::InitialState { .. } | Self::StateJump { .. } | Self::Output { .. } => None,
        }
    }

    /// What its parameter is multiplied with in the step after a row, and at the row; of the last row the
    /// number of the step before it.
    #[must_use]
    pub fn weight(&self, row: usize) -> f64 {
        match self {
            Self::Parameter { .. } => 1.0,
            Self::Step { row: from, .. } => f64::from(u8::from(row >= *from)),
            Self::TimeProfile { steps, .. } => {
                steps.get(row).or(steps.last()).copied().unwrap_or(0.0)
            }
            Self::InitialState { .. } | Self::StateJump { .. } | Self::Output { .. } => 0.0,
        }
    }
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

    /// Those that are not zero, with their amplitudes.
    pub(crate) fn present(&self) -> impl Iterator<Item = (&Column, f64)> {
        let all = self.columns.iter().zip(self.amplitudes.iter().copied());
        all.filter(|(_, amplitude)| *amplitude != 0.0)
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
