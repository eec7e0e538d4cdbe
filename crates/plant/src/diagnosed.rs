//! A diagnosis with the fits that it rests on: outputs over time and correlations of both models.

use gyrocal_answer::Answer;
use gyrocal_hypothesis::Searched;
use gyrocal_statistics::NORMAL_97_5;

use crate::correlation::{correlations, of_output};
use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::series::{OutputCorrelation, RecordSeries};

/// A diagnosis with the fits that it rests on.
pub struct Diagnosed {
    /// The answer.
    pub answer: Answer,
    /// The search, with the nominal and the extended model.
    pub searched: Searched<FittedPlant>,
    /// The later record, predicted by both models.
    pub later: Option<RecordSeries>,
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
