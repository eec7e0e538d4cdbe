//! Series behind the charts of a diagnosis: spectra and autocorrelations of the innovations.

use gyrocal_record::Record;
use gyrocal_statistics::{NORMAL_97_5, Periodogram, autocorrelation, periodogram};

use crate::diagnose::Diagnosis;
use crate::error::DiagnosisError;

/// One of the two models of a diagnosis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelVersion {
    /// The nominal model.
    Nominal,
    /// The extended model.
    Extended,
}

/// Periodogram of the innovations of one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelSpectrum {
    /// The model that the innovations are of.
    pub model: ModelVersion,
    /// 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// The periodogram with its largest line.
    pub periodogram: Periodogram,
    /// Power of the largest line over the detection threshold.
    pub line_over_threshold: f64,
    /// Number of innovations.
    pub samples: usize,
}

/// Autocorrelation of the innovations of one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct ChannelCorrelation {
    /// The model that the innovations are of.
    pub model: ModelVersion,
    /// 0, 1, 2 for x, y, z.
    pub axis: usize,
    /// Correlation at each lag, from one row on; nan where no two innovations are so far apart.
    pub correlation: Vec<f64>,
    /// Half width of the 95 % band of white innovations.
    pub band: f64,
    /// Number of lags outside of the band.
    pub outside: usize,
    /// The correlation of the largest magnitude.
    pub largest: f64,
    /// Number of innovations.
    pub samples: usize,
}

impl Diagnosis<'_> {
    /// Periodograms of the innovations of all axes and models.
    ///
    /// # Errors
    /// [`DiagnosisError::Statistics`] of a record that is too short.
    pub fn spectra(&self, record: &Record) -> Result<Vec<ChannelSpectrum>, DiagnosisError> {
        let mut spectra = Vec::new();
        for (model, innovations) in self.models() {
            for axis in 0..3 {
                let series: Vec<f64> = innovations.iter().map(|row| row[axis]).collect();
                let probability = self.result.false_alarm_probability;
                let periodogram = periodogram(&record.time_s, &series, probability)?;
                spectra.push(ChannelSpectrum {
                    model,
                    axis,
                    line_over_threshold: periodogram.line.power / periodogram.level,
                    periodogram,
                    samples: series.iter().filter(|value| !value.is_nan()).count(),
                });
            }
        }
        Ok(spectra)
    }

    /// Autocorrelations of the innovations of all axes and models up to a lag.
    ///
    /// # Errors
    /// [`DiagnosisError::Statistics`] of a record that is too short.
    pub fn autocorrelations(&self, lags: usize) -> Result<Vec<ChannelCorrelation>, DiagnosisError> {
        let mut channels = Vec::new();
        for (model, innovations) in self.models() {
            let probability = self.result.false_alarm_probability;
            let found = autocorrelation(innovations, lags, probability)?;
            for axis in 0..3 {
                // No product has no deviation.
                let known = |value: f64, sigma: f64| if sigma > 0.0 { value } else { f64::NAN };
                let lags = found.correlation.iter().zip(&found.sigma);
                let correlation: Vec<f64> = lags
                    .map(|(lag, sigma)| known(lag[axis], sigma[axis]))
                    .collect();
                let sigma = found.sigma.first().map_or(0.0, |lag| lag[axis]);
                let sigma = known(sigma, sigma);
                let band = NORMAL_97_5 * sigma;
                channels.push(ChannelCorrelation {
                    model,
                    axis,
                    band,
                    outside: correlation
                        .iter()
                        .filter(|value| value.abs() > band)
                        .count(),
                    largest: correlation.iter().fold(0.0_f64, |largest, value| {
                        if value.abs() > largest.abs() {
                            *value
                        } else {
                            largest
                        }
                    }),
                    correlation,
                    samples: innovations.iter().filter(|row| !row[axis].is_nan()).count(),
                });
            }
        }
        Ok(channels)
    }

    /// Innovations of the nominal model and, if there is one, of the extended model.
    fn models(&self) -> Vec<(ModelVersion, &[[f64; 3]])> {
        let nominal = self.innovations.normalised.as_slice();
        let extended = self.extended.as_ref().map(|_| self.whitened.as_slice());
        core::iter::once((ModelVersion::Nominal, nominal))
            .chain(extended.map(|whitened| (ModelVersion::Extended, whitened)))
            .collect()
    }
}
