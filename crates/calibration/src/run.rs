//! A run, and its rows as the batch estimator reads them.

use std::borrow::Cow;
use std::sync::Arc;

use gyrocal::generated::strapdown::StrapdownInputs;
use gyrocal::generated::surveyed::SurveyedInputs;
use gyrocal::{Chart, ChartInputs, Regressors};
use gyrocal_inference::Series;
use gyrocal_record::{Bench, Record};

use crate::gyro_axes::GyroAxes;
use crate::temperature::{TemperatureCourse, TemperatureScale};

/// Model inputs that may depend on time, temperature and the axes of the gyros.
pub(crate) trait Conditions: ChartInputs<f64> {
    /// Sets time since the first row (of the middle of an interval, or of a row), the length of
    /// the interval, and what follows from the temperature.
    fn set_conditions(&mut self, time_s: f64, interval_s: f64, regressors: &Regressors<f64>);

    /// Sets the matrix, by rows, from components along the gyros' axes to components along the
    /// platform's; does nothing in models whose gyros lie along the platform's axes.
    fn set_gyro_axes(&mut self, _platform_c_gyros: &[f64; 9]) {}
}

impl Conditions for SurveyedInputs<f64> {
    fn set_conditions(&mut self, _: f64, _: f64, _: &Regressors<f64>) {}
}

impl Conditions for StrapdownInputs<f64> {
    fn set_conditions(&mut self, _: f64, _: f64, _: &Regressors<f64>) {}

    fn set_gyro_axes(&mut self, platform_c_gyros: &[f64; 9]) {
        self.platform_c_gyros = *platform_c_gyros;
    }
}

/// A record with the bench it was taken on: one turn-on of the platform.
#[derive(Clone, Copy, Debug)]
pub struct Run<'a> {
    /// The samples.
    pub record: &'a Record,
    /// The bench description.
    pub bench: &'a Bench,
}

/// The first rows of a record with the noise variance and weight of each value.
#[derive(Clone, Debug)]
pub(crate) struct WeightedRows<'a> {
    record: Cow<'a, Record>,
    /// Number of rows used, from the first.
    rows: usize,
    /// Variance of a value of weight 1, g².
    variance_g2: [f64; 3],
    /// What the temperature is related to, and what follows from it at each row, if it was logged.
    temperature_scale: Option<TemperatureScale>,
    temperature: Option<Arc<TemperatureCourse>>,
    /// Weight of each value if not all are 1: a value of weight 0 is left out.
    pub(crate) weights: Option<Vec<[f64; 3]>>,
    /// Axes of the gyros, if not those of the platform.
    pub(crate) gyro_axes: Option<Cow<'a, GyroAxes>>,
}

impl<'a> WeightedRows<'a> {
    /// The first `rows` rows with weight 1 and the noise `noise_g` of each accelerometer.
    pub(crate) fn new(record: &'a Record, rows: usize, noise_g: [f64; 3]) -> Self {
        let mut all = Self {
            record: Cow::Borrowed(record),
            rows,
            variance_g2: noise_g.map(|sigma| sigma * sigma),
            temperature_scale: None,
            temperature: None,
            weights: None,
            gyro_axes: None,
        };
        all.set_temperature_scale(TemperatureScale::of(record, &[]));
        all
    }

    /// The same with a copy of the record.
    pub(crate) fn into_owned(self) -> WeightedRows<'static> {
        WeightedRows {
            record: Cow::Owned(self.record.into_owned()),
            rows: self.rows,
            variance_g2: self.variance_g2,
            temperature_scale: self.temperature_scale,
            temperature: self.temperature,
            weights: self.weights,
            gyro_axes: self.gyro_axes.map(|axes| Cow::Owned(axes.into_owned())),
        }
    }

    /// Times of the rows, s.
    pub(crate) fn times_s(&self) -> &[f64] {
        &self.record.time_s[..self.rows]
    }

    /// Time from the first row to the last, s.
    pub(crate) fn duration_s(&self) -> f64 {
        let times = self.times_s();
        match times {
            [first, .., last] => last - first,
            _ => 0.0,
        }
    }

    /// Gives the values of some rows weight 0.
    pub(crate) fn exclude(&mut self, rows: core::ops::Range<usize>) {
        let count = self.rows;
        let weights = self.weights.get_or_insert_with(|| vec![[1.0; 3]; count]);
        for weight in &mut weights[rows] {
            *weight = [0.0; 3];
        }
    }

    /// The record.
    pub(crate) fn record(&self) -> &Record {
        &self.record
    }

    /// Whether temperature was logged.
    pub(crate) fn has_temperature(&self) -> bool {
        self.temperature.is_some()
    }

    /// What the temperature is related to, if it was logged.
    pub(crate) fn temperature_scale(&self) -> Option<TemperatureScale> {
        self.temperature_scale
    }

    /// Relates temperatures to those of several records; `None` if one has none.
    pub(crate) fn set_temperature_scale(&mut self, scale: Option<TemperatureScale>) {
        let rows = 0..self.record.len();
        let course = scale.and_then(|scale| TemperatureCourse::of_rows(&self.record, rows, scale));
        self.temperature_scale = scale;
        self.temperature = course.map(Arc::new);
    }

    /// Sets the standard deviation of values of weight 1.
    pub(crate) fn set_noise(&mut self, noise_g: [f64; 3]) {
        self.variance_g2 = noise_g.map(|sigma| sigma * sigma);
    }

    /// Standard deviation of a value of weight 1, g.
    pub(crate) fn declared_noise_g(&self) -> [f64; 3] {
        self.variance_g2.map(f64::sqrt)
    }
}

impl<I: Conditions> Series<Chart<f64, I>, 3> for WeightedRows<'_> {
    fn rows(&self) -> usize {
        self.rows
    }

    fn time_s(&self, row: usize) -> f64 {
        self.record.time_s[row]
    }

    fn measured(&self, row: usize) -> [f64; 3] {
        let mut measured = self.record.accel_g[row];
        if let Some(weights) = &self.weights {
            for (value, weight) in measured.iter_mut().zip(weights[row]) {
                if weight == 0.0 {
                    *value = f64::NAN;
                }
            }
        }
        measured
    }

    fn noise_variance(&self, row: usize) -> [f64; 3] {
        match &self.weights {
            None => self.variance_g2,
            Some(weights) => {
                core::array::from_fn(|axis| self.variance_g2[axis] / weights[row][axis])
            }
        }
    }

    fn over(&self, row: usize, from_s: f64, to_s: f64, inputs: &mut Chart<f64, I>) {
        let first_s = self.record.time_s[0];
        // The middle stands for the mean.
        let (before_s, after_s) = (self.record.time_s[row], self.record.time_s[row + 1]);
        let middle_s = 0.5 * (from_s + to_s);
        let share = (middle_s - before_s) / (after_s - before_s);
        let regressors = match &self.temperature {
            Some(course) => course.between(row, share),
            None => Regressors::default(),
        };
        inputs
            .inputs_mut()
            .set_conditions(middle_s - first_s, to_s - from_s, &regressors);
        if let Some(axes) = &self.gyro_axes {
            let platform_c_gyros = axes.between(row, share);
            inputs.inputs_mut().set_gyro_axes(&platform_c_gyros);
        }
    }

    fn at(&self, row: usize, inputs: &mut Chart<f64, I>) {
        let time_s = self.record.time_s[row] - self.record.time_s[0];
        // No output depends on the length of an interval.
        let regressors = match &self.temperature {
            Some(course) => course.at(row),
            None => Regressors::default(),
        };
        inputs.inputs_mut().set_conditions(time_s, 1.0, &regressors);
        if let Some(axes) = &self.gyro_axes {
            inputs.inputs_mut().set_gyro_axes(&axes.between(row, 0.0));
        }
    }
}
