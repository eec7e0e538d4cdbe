//! Outputs over time, measured and simulated by both models, and correlations of what the models leave.

use core::ops::Range;

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

impl FittedPlant {
    /// Estimated standard deviation of all noise of each output.
    #[must_use]
    pub fn output_sigmas(&self) -> Vec<f64> {
        let outputs = self.loaded().description.outputs.iter();
        let declared = outputs.zip(self.noise_ratios()).enumerate();
        declared
            .map(|(index, (output, ratio))| {
                let white = output.sigma * ratio;
                (white * white + self.noise.correlated_variance(index)).sqrt()
            })
            .collect()
    }
}
