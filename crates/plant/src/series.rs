//! Outputs over time, measured and simulated by both models, and correlations of what the models leave.

use core::ops::Range;

use gyrocal_statistics::NORMAL_97_5;

use crate::diagnosis::Diagnosed;
use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::loaded::LoadedPlant;
use crate::record::PlantRecord;

/// Outputs of a record over time.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordSeries {
    /// Time of each row since the first, s.
    pub time_s: Vec<f64>,
    /// The outputs.
    pub outputs: Vec<OutputSeries>,
}

/// An output over time.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputSeries {
    /// Id of the output.
    pub output: String,
    /// Its unit.
    pub unit: String,
    /// Measured; NaN where it is missing.
    pub measured: Vec<f64>,
    /// Simulated with the nominal model.
    pub nominal: Vec<f64>,
    /// Simulated with what was found; `None` if nothing was.
    pub extended: Option<Vec<f64>>,
    /// Estimated standard deviation of the sensor's noise.
    pub sigma: f64,
}

/// Correlation of the whitened innovations of an output over rows.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputCorrelation {
    /// Id of the output.
    pub output: String,
    /// Number of innovations.
    pub values: usize,
    /// Correlations of the nominal model at the lags 1, 2, ….
    pub nominal: Vec<f64>,
    /// Those of the model with what was found; `None` if nothing was.
    pub extended: Option<Vec<f64>>,
    /// Half width of the band that holds 95 % of the correlations of white innovations.
    pub band: f64,
}

impl OutputSeries {
    /// Measured less simulated by the nominal model.
    #[must_use]
    pub fn nominal_residuals(&self) -> Vec<f64> {
        self.less(&self.nominal)
    }

    /// Measured less simulated with what was found.
    #[must_use]
    pub fn extended_residuals(&self) -> Option<Vec<f64>> {
        self.extended.as_ref().map(|extended| self.less(extended))
    }

    fn less(&self, simulated: &[f64]) -> Vec<f64> {
        let pairs = self.measured.iter().zip(simulated);
        pairs
            .map(|(measured, simulated)| measured - simulated)
            .collect()
    }
}

impl RecordSeries {
    /// Of some rows of a record and simulations of all.
    pub(crate) fn new(
        plant: &LoadedPlant,
        (record, rows): (&PlantRecord, Range<usize>),
        (nominal, extended): (&[f64], Option<&[f64]>),
        sigmas: &[f64],
    ) -> Self {
        let outputs = &plant.description.outputs;
        let first_s = record.time_s.get(rows.start).copied().unwrap_or(0.0);
        let times = record.time_s[rows.clone()].iter();
        let series = outputs.iter().zip(sigmas).enumerate();
        Self {
            time_s: times.map(|time_s| time_s - first_s).collect(),
            outputs: series
                .map(|(index, (output, sigma))| {
                    let column = |values: &[f64]| -> Vec<f64> {
                        let own = rows.clone().map(|row| row * outputs.len() + index);
                        own.map(|place| values[place]).collect()
                    };
                    OutputSeries {
                        output: output.id.clone(),
                        unit: output.unit.clone(),
                        measured: column(&record.outputs),
                        nominal: column(nominal),
                        extended: extended.map(column),
                        sigma: *sigma,
                    }
                })
                .collect(),
        }
    }
}

impl Diagnosed {
    /// Outputs of each record over time. Simulations of a plant without noise of the rates go from the first
    /// row of a record to its last, others over the horizon of the answer.
    #[must_use]
    pub fn series(&self) -> Vec<RecordSeries> {
        let fitted = &self.searched.fitted;
        let (plant, record) = (fitted.loaded(), fitted.record());
        let nominal = self.searched.nominal.simulated();
        let extended = self.answer.has_findings().then(|| fitted.simulated());
        let sigmas = fitted.output_sigmas();
        record
            .records()
            .map(|rows| {
                let simulated = (&nominal[..], extended.as_deref());
                RecordSeries::new(plant, (record, rows), simulated, &sigmas)
            })
            .collect()
    }

    /// Outputs of all records on the clock on which they are joined.
    #[must_use]
    pub fn joined_series(&self) -> RecordSeries {
        let fitted = &self.searched.fitted;
        let (plant, record) = (fitted.loaded(), fitted.record());
        let nominal = self.searched.nominal.simulated();
        let extended = self.answer.has_findings().then(|| fitted.simulated());
        let simulated = (&nominal[..], extended.as_deref());
        let sigmas = fitted.output_sigmas();
        RecordSeries::new(plant, (record, 0..record.len()), simulated, &sigmas)
    }

    /// Whether simulations go over whole records: no rate has noise.
    #[must_use]
    pub fn is_simulated_whole(&self) -> bool {
        let plant = self.searched.fitted.loaded();
        plant.description.noises.is_empty()
    }

    /// Correlations of the innovations of each output at the lags from one on; none at lags longer than a
    /// quarter of the innovations.
    ///
    /// # Errors
    /// [`PlantError::Singular`].
    pub fn correlations(&self, lags: usize) -> Result<Vec<OutputCorrelation>, PlantError> {
        let nominal = self.searched.nominal.whitened()?;
        let extended = match self.answer.has_findings() {
            true => Some(self.searched.fitted.whitened()?),
            false => None,
        };
        let outputs = self.searched.fitted.loaded().description.outputs.iter();
        let all = outputs.enumerate().map(|(index, output)| {
            let own = of_output(&nominal, index);
            OutputCorrelation {
                output: output.id.clone(),
                values: own.len(),
                nominal: correlations(&own, lags),
                extended: extended
                    .as_ref()
                    .map(|extended| correlations(&of_output(extended, index), lags)),
                band: NORMAL_97_5 / (own.len().max(1) as f64).sqrt(),
            }
        });
        Ok(all.collect())
    }
}

impl FittedPlant {
    /// Estimated standard deviation of the noise of each output.
    #[must_use]
    pub fn output_sigmas(&self) -> Vec<f64> {
        let outputs = self.loaded().description.outputs.iter();
        let declared = outputs.zip(self.noise_ratios());
        declared
            .map(|(output, ratio)| output.sigma * ratio)
            .collect()
    }
}

/// The innovations of an output, of [`FittedPlant::whitened`].
pub(crate) fn of_output(whitened: &[(usize, usize, f64)], output: usize) -> Vec<f64> {
    let own = whitened.iter().filter(|(_, own, _)| *own == output);
    own.map(|(.., value)| *value).collect()
}

/// Correlations of values at the lags from one on, up to a quarter of them.
pub(crate) fn correlations(values: &[f64], lags: usize) -> Vec<f64> {
    let power: f64 = values.iter().map(|value| value * value).sum();
    let lags = 1..=lags.min(values.len() / 4);
    lags.map(|lag| {
        let pairs = values.iter().zip(&values[lag..]);
        pairs.map(|(a, b)| a * b).sum::<f64>() / power
    })
    .collect()
}
