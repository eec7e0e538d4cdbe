//! A record: inputs and outputs of a plant at rising times.

use core::ops::Range;

use gyrocal_record::counted;
use gyrocal_statistics::format::short;
use gyrocal_statistics::{median_interval_s, quantile};

use crate::description::Description;
use crate::error::PlantError;

/// Interval between rows, s, in the time that the search is given: its shapes and tests are made for
/// records of days, and any record is one in some unit of time.
const SEARCH_INTERVAL_S: f64 = 60.0;

/// Distance between the clocks of two records that are joined, in usual intervals between rows: to every
/// test a gap.
const GAP_INTERVALS: f64 = 10.0;

/// Interval between rows, in usual ones, from which on inputs between them are told as unknown: where charts leave a
/// line open.
const OPEN_INTERVALS: f64 = 4.0;

/// Rows beyond the unknowns, which the noise is told from.
const ROWS_FOR_NOISE: usize = 8;

/// Most that an input may be over what 19 of 20 of its values that are not zero stay below, and in its unit: a pulse among
/// rounding errors is sound, and no unit makes an input as large. No simulation that goes through a larger one resolves
/// the others, and steps are halved for it without an end.
const MOST_OVER_USUAL: f64 = 1e6;
const MOST: f64 = 1e9;

/// Rows of inputs, outputs and logged quantities, of one record or of several that are joined.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlantRecord {
    /// Time of each row, s.
    pub time_s: Vec<f64>,
    /// Inputs, by rows.
    pub inputs: Vec<f64>,
    /// Outputs, by rows; NaN where one is missing.
    pub outputs: Vec<f64>,
    /// Logged quantities, each over all rows; [`Self::prepared`] adds the waves of known periods.
    pub regressors: Vec<Vec<f64>>,
    /// Their means, which [`Self::prepared`] takes from them.
    pub regressor_means: Vec<f64>,
    /// First row of each record after the first; empty of one record.
    pub starts: Vec<usize>,
}

/// A record with its name.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedRecord {
    /// Its name in the answer, such as that of its file.
    pub name: String,
    /// The record.
    pub record: PlantRecord,
}

impl PlantRecord {
    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Whether there are no rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    /// Time from the first row to the last, s; the sum over the records that are joined.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.durations_s().sum()
    }

    /// The duration of the longest record, s.
    pub(crate) fn longest_s(&self) -> f64 {
        self.durations_s().fold(0.0, f64::max)
    }

    fn durations_s(&self) -> impl Iterator<Item = f64> + '_ {
        self.records().map(|rows| match &self.time_s[rows] {
            [first, .., last] => last - first,
            _ => 0.0,
        })
    }

    /// The rows of each record.
    pub fn records(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        let firsts = core::iter::once(0).chain(self.starts.iter().copied());
        let ends = self.starts.iter().copied().chain([self.len()]);
        firsts.zip(ends).map(|(first, end)| first..end)
    }

    /// Whether a record after the first begins with a row.
    pub(crate) fn begins(&self, row: usize) -> bool {
        self.starts.binary_search(&row).is_ok()
    }

    /// Some rows as a record.
    pub(crate) fn part(&self, rows: Range<usize>) -> Self {
        let per_row = |values: &[f64]| {
            let width = values.len() / self.len().max(1);
            values[rows.start * width..rows.end * width].to_vec()
        };
        Self {
            time_s: self.time_s[rows.clone()].to_vec(),
            inputs: per_row(&self.inputs),
            outputs: per_row(&self.outputs),
            regressors: self
                .regressors
                .iter()
                .map(|one| one[rows.clone()].to_vec())
                .collect(),
            regressor_means: self.regressor_means.clone(),
            starts: Vec::new(),
        }
    }

    /// Records of one plant, one after the other, as one: on a clock that goes on ten intervals after the
    /// end of each, and with regressors about the mean of all.
    #[must_use]
    pub fn joined(records: &[Self]) -> Self {
        let Some((first, others)) = records.split_first() else {
            return Self::default();
        };
        let mut all = first.clone();
        for record in others {
            let last_s = all.time_s.last().copied().unwrap_or(0.0);
            let first_s = record.time_s.first().copied().unwrap_or(0.0);
            let offset_s = last_s + GAP_INTERVALS * median_interval_s(&record.time_s) - first_s;
            let start = all.len();
            all.starts.push(start);
            all.starts
                .extend(record.starts.iter().map(|row| start + row));
            all.time_s
                .extend(record.time_s.iter().map(|t| t + offset_s));
            all.inputs.extend_from_slice(&record.inputs);
            all.outputs.extend_from_slice(&record.outputs);
            let means = all.regressor_means.iter().zip(&record.regressor_means);
            let shifts: Vec<f64> = means.map(|(mean, own)| own - mean).collect();
            for ((values, own), shift) in all
                .regressors
                .iter_mut()
                .zip(&record.regressors)
                .zip(shifts)
            {
                values.extend(own.iter().map(|value| value + shift));
            }
        }
        let rows = all.len().max(1) as f64;
        for (values, mean) in all.regressors.iter_mut().zip(&mut all.regressor_means) {
            let further = values.iter().sum::<f64>() / rows;
            values.iter_mut().for_each(|value| *value -= further);
            *mean += further;
        }
        all
    }

    /// Rows after which there are none for longer than usual.
    pub(crate) fn gaps(&self) -> Vec<usize> {
        let usual_s = median_interval_s(&self.time_s);
        let pairs = self.time_s.windows(2).enumerate();
        let long = pairs.filter(|(_, pair)| pair[1] - pair[0] > OPEN_INTERVALS * usual_s);
        long.map(|(row, _)| row).collect()
    }

    /// Refuses fewer rows than are needed.
    fn refuse_fewer(&self, needed: usize, why: &str, origin: &str) -> Result<(), PlantError> {
        if self.len() >= needed {
            return Ok(());
        }
        Err(PlantError::Input {
            origin: origin.to_owned(),
            problem: format!(
                "it has {}, and {needed} are needed: {why}",
                counted(self.len(), "row")
            ),
            advice: "give a longer record".to_owned(),
        })
    }

    /// Place and usual size of a value of an input that is beyond all measure, if there is one.
    fn absurd_input(&self, inputs: usize) -> Option<(usize, f64)> {
        (0..inputs).find_map(|input| {
            let own = || self.inputs.iter().enumerate().skip(input).step_by(inputs);
            let sizes = own().map(|(_, value)| value.abs());
            let sizes: Vec<f64> = sizes.filter(|size| *size > 0.0).collect();
            let usual = quantile(&sizes, 0.95);
            let mut own = own();
            let most = MOST.max(MOST_OVER_USUAL * usual);
            let found = own.find(|(_, value)| value.abs() > most);
            found.map(|(place, _)| (place, usual))
        })
    }

    /// Time of the search over time.
    pub(crate) fn search_scale(&self) -> f64 {
        SEARCH_INTERVAL_S / median_interval_s(&self.time_s)
    }

    /// The record with outputs missing where they saturate, and regressors about their means.
    ///
    /// # Errors
    /// [`PlantError::Input`] if a length is wrong, there are too few rows for a fit, time does not rise, an input is not
    /// a number or beyond all measure, or an output has no value.
    pub fn prepared(self, description: &Description, origin: &str) -> Result<Self, PlantError> {
        let (states, parameters) = (description.states.len(), description.parameters.len());
        let why = format!(
            "{} and {} are estimated, and {ROWS_FOR_NOISE} further rows tell the noise",
            counted(parameters, "parameter"),
            counted(states, "initial state"),
        );
        self.refuse_fewer(states + parameters + ROWS_FOR_NOISE, &why, origin)?;
        self.checked(description, origin)
    }

    /// The same of a run that is simulated, and not fitted.
    pub(crate) fn prepared_run(
        self,
        description: &Description,
        origin: &str,
    ) -> Result<Self, PlantError> {
        self.refuse_fewer(2, "a simulation goes from one row to the next", origin)?;
        self.checked(description, origin)
    }

    fn checked(mut self, description: &Description, origin: &str) -> Result<Self, PlantError> {
        let rows = self.len();
        let (inputs, outputs) = (description.inputs.len(), description.outputs.len());
        let refuse = |problem: String, advice: &str| PlantError::Input {
            origin: origin.to_owned(),
            problem,
            advice: advice.to_owned(),
        };
        let sized = self.inputs.len() == rows * inputs
            && self.outputs.len() == rows * outputs
            && self.regressors.len() == description.regressors.len()
            && self.regressors.iter().all(|one| one.len() == rows);
        if !sized {
            let advice = "give every row each input, output and regressor of the plant";
            return Err(refuse("columns of different lengths".to_owned(), advice));
        }
        if let Some(row) = (1..rows).find(|row| self.time_s[*row] <= self.time_s[row - 1]) {
            let advice = "remove repeated rows and sort by time";
            return Err(refuse(
                format!("time does not rise at row {}", row + 1),
                advice,
            ));
        }
        if let Some(place) = self.inputs.iter().position(|value| !value.is_finite()) {
            let name = &description.inputs[place % inputs].id;
            let problem = format!("input `{name}` has no value in row {}", place / inputs + 1);
            return Err(refuse(problem, "fill the gap, or cut the record there"));
        }
        if let Some((place, usual)) = self.absurd_input(inputs) {
            let name = &description.inputs[place % inputs].id;
            let [value, usual] = [self.inputs[place], usual].map(|one| short(one, 3));
            let row = place / inputs + 1;
            let problem = format!(
                "input `{name}` is {value} in row {row}, and 19 of 20 of its values are within {usual}"
            );
            let advice = "correct the value, or cut the record there: no simulation resolves both";
            return Err(refuse(problem, advice));
        }
        for (index, output) in description.outputs.iter().enumerate() {
            let own = self.outputs.iter_mut().skip(index).step_by(outputs);
            let mut used = 0;
            for value in own {
                if output.is_beyond(*value) || !value.is_finite() {
                    *value = f64::NAN;
                }
                used += usize::from(!value.is_nan());
            }
            if used == 0 {
                let problem = format!("output `{}` has no value that says anything", output.id);
                return Err(refuse(problem, "check its column and its saturation"));
            }
        }
        self.regressors.extend(description.waves(&self.time_s));
        for regressor in &mut self.regressors {
            let mean = regressor.iter().sum::<f64>() / rows as f64;
            if !mean.is_finite() {
                return Err(refuse(
                    "a regressor has a missing value".to_owned(),
                    "fill the gap",
                ));
            }
            regressor.iter_mut().for_each(|value| *value -= mean);
            self.regressor_means.push(mean);
        }
        Ok(self)
    }

    /// Ids of inputs that never move.
    #[must_use]
    pub fn still_inputs(&self, description: &Description) -> Vec<String> {
        let count = description.inputs.len();
        let moves = |index: usize| {
            let mut own = self.inputs.iter().skip(index).step_by(count);
            let first = own.next();
            own.any(|value| Some(value) != first)
        };
        let all = description.inputs.iter().enumerate();
        all.filter(|(index, _)| !moves(*index))
            .map(|(_, input)| input.id.clone())
            .collect()
    }
}
