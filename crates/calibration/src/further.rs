//! Columns that are no parameters of the model: jumps of the attitude, and shares of a drift.

use std::sync::Arc;

use gyrocal::estimation::batch::Columns;

/// One such column.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// The attitude at the first row, turned about a platform axis, rad: outside its prior.
    Start {
        /// 0, 1, 2 for x, y, z.
        axis: usize,
    },
    /// A sudden turn about a platform axis, rad, in the step after a row.
    Jump {
        /// The row before it.
        row: usize,
        /// 0, 1, 2 for x, y, z.
        axis: usize,
    },
    /// A drift that sets in with the step after a row and stays: what a parameter of the model
    /// does, from there on.
    Onset {
        /// Index of the parameter.
        parameter: usize,
        /// The row.
        row: usize,
    },
    /// A drift that follows a course in time: what a parameter of the model does, times a number
    /// for each step.
    Course {
        /// Index of the parameter.
        parameter: usize,
        /// One number for each step.
        steps: Arc<[f64]>,
    },
    /// A change of the readings of one accelerometer, of which trajectory and parameters know
    /// nothing.
    Readings {
        /// 0, 1, 2 of x, y, z.
        axis: usize,
        /// Of each row, g.
        change_g: Arc<[f64]>,
    },
}

/// A list of columns with their present amplitudes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Further {
    columns: Vec<Column>,
    sigmas: Vec<f64>,
    amplitudes: Vec<f64>,
    /// Places of the columns that change readings.
    readings: Vec<usize>,
}

impl Further {
    /// These columns, all with amplitude zero, of which nothing is known beforehand.
    #[must_use]
    pub fn new(columns: Vec<Column>) -> Self {
        let mut further = Self::default();
        further.extend(columns, f64::INFINITY);
        further
    }

    /// Adds columns whose amplitudes have this standard deviation before the record.
    pub fn extend(&mut self, columns: impl IntoIterator<Item = Column>, sigma: f64) {
        let before = self.columns.len();
        self.columns.extend(columns);
        let new = self.columns.iter().enumerate().skip(before);
        let changing = new.filter(|(_, column)| matches!(column, Column::Readings { .. }));
        self.readings.extend(changing.map(|(place, _)| place));
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

    /// What columns with their amplitudes add to a reading, g.
    pub(crate) fn reading_g(&self, row: usize, output: usize) -> f64 {
        self.readings
            .iter()
            .map(|place| match &self.columns[*place] {
                Column::Readings { axis, change_g } if *axis == output => change_g
                    .get(row)
                    .map_or(0.0, |change_g| self.amplitudes[*place] * change_g),
                _ => 0.0,
            })
            .sum()
    }

    pub(crate) fn set_amplitudes(&mut self, amplitudes: impl Iterator<Item = f64>) {
        for (target, amplitude) in self.amplitudes.iter_mut().zip(amplitudes) {
            *target = amplitude;
        }
    }
}

impl Columns<3, 3> for Further {
    fn count(&self) -> usize {
        self.columns.len()
    }

    fn amplitude(&self, column: usize) -> f64 {
        self.amplitudes[column]
    }

    fn start(&self, column: usize) -> [f64; 3] {
        let mut turn = [0.0; 3];
        if let Column::Start { axis } = self.columns[column] {
            turn[axis] = 1.0;
        }
        turn
    }

    fn drive(&self, row: usize, parameters: &[f64], stride: usize, drive: [&mut [f64]; 3]) {
        for (index, column) in self.columns.iter().enumerate() {
            match column {
                Column::Start { .. } | Column::Readings { .. } => {}
                Column::Jump { row: at, axis } => {
                    if *at == row {
                        drive[*axis][index] = 1.0;
                    }
                }
                Column::Onset { parameter, row: at } => {
                    if row >= *at {
                        for i in 0..3 {
                            drive[i][index] = parameters[i * stride + parameter];
                        }
                    }
                }
                Column::Course { parameter, steps } => {
                    let share = steps.get(row).copied().unwrap_or(0.0);
                    for i in 0..3 {
                        drive[i][index] = share * parameters[i * stride + parameter];
                    }
                }
            }
        }
    }

    fn output(&self, row: usize, output: usize, direct: &mut [f64]) {
        for place in &self.readings {
            if let Column::Readings { axis, change_g } = &self.columns[*place]
                && *axis == output
            {
                direct[*place] = change_g.get(row).copied().unwrap_or(0.0);
            }
        }
    }
}
