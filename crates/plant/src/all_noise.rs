//! A fitted plant in all noise, and what it tells of the noise that the plant does not declare.

use gyrocal_answer::{NoiseKind, UndeclaredNoise};
use gyrocal_statistics::chi_square_quantile;

use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::fitted_noise::FittedNoise;
use crate::noise::is_needed;

/// Most states and outputs together of a plant whose noise is estimated beyond what it declares: time goes with their
/// fourth power.
const MOST: usize = 8;

/// Probability that any noise is told that is not there.
const FALSE: f64 = 0.02;

impl FittedPlant {
    /// The same model with all noise estimated together; `None` where the record has no more than white noise, of
    /// a plant that declares noise of rates, and of one with more than eight states and outputs together.
    ///
    /// # Errors
    /// [`PlantError::Singular`], and those of a fit.
    pub(crate) fn in_all_noise(&self) -> Result<Option<Self>, PlantError> {
        let description = &self.loaded().description;
        let count = description.states.len() + description.outputs.len();
        if !description.noises.is_empty() || count > MOST {
            return Ok(None);
        }
        let white = self.with_noise_problem(|unknown| {
            let declared = unknown.sizes(&self.noise.loosened(Vec::new()), &[])?;
            let visible = unknown.just_visible(&declared.noise)?;
            let all = unknown.best_of_starts(&visible)?;
            Ok(is_needed(&all, &declared).then_some(all.noise))
        })?;
        let Some(mut noise) = white else {
            return Ok(None);
        };
        let mut fitted = self.in_noise(noise)?;
        // Parameters and noise in turn: white noise had led the first fit.
        for _ in 0..2 {
            noise = fitted
                .with_noise_problem(|unknown| unknown.maximise(&fitted.noise))?
                .noise;
            fitted = fitted.in_noise(noise)?;
        }
        Ok(Some(fitted))
    }

    /// Whether this model needs more than the noise that the plant declares.
    ///
    /// # Errors
    /// [`PlantError::Singular`].
    pub(crate) fn needs_further_noise(&self) -> Result<bool, PlantError> {
        if self.noise.is_declared() {
            return Ok(false);
        }
        self.with_noise_problem(|unknown| {
            let with = unknown.sizes(&self.noise, &[])?;
            let declared = unknown.sizes(&self.noise.loosened(Vec::new()), &[])?;
            Ok(is_needed(&with, &declared))
        })
    }

    /// Noise that the plant does not declare and that this model needs, each with what explains as much in its place;
    /// none where it cannot be told.
    ///
    /// # Errors
    /// [`PlantError::Singular`].
    pub(crate) fn undeclared_noise(&self) -> Result<Vec<UndeclaredNoise>, PlantError> {
        if self.noise.is_declared() {
            return Ok(Vec::new());
        }
        // A size and a time, of each that there could be.
        let count = self.noise.factors.len() - self.noise.declared();
        let quantile = chi_square_quantile(1.0 - FALSE / count as f64, 2.0);
        let least_gain = 0.5 * quantile.ok_or(PlantError::Singular)?;
        self.with_noise_problem(|unknown| {
            let Some(found) = unknown.eliminated(&self.noise, least_gain) else {
                return Ok(Vec::new());
            };
            let told = found.gains.iter().map(|(place, gain_nats)| {
                let instead = unknown.instead(&found, *place, least_gain).into_iter();
                let instead = instead.map(|other| self.channel(other).1).collect();
                self.told(&found.fit.noise, *place, (*gain_nats, instead))
            });
            Ok(told.collect())
        })
    }

    /// Kind of a noise that the plant does not declare, and the output or the state that has it.
    fn channel(&self, place: usize) -> (NoiseKind, String) {
        let description = &self.loaded().description;
        let place = place - self.noise.declared();
        match self.noise.process.get(place) {
            Some(process) => (
                NoiseKind::Process,
                format!("rate of {}", description.states[process.state].id),
            ),
            None => {
                let correlated = &self.noise.correlated[place - self.noise.process.len()];
                (
                    NoiseKind::Correlated,
                    description.outputs[correlated.output].id.clone(),
                )
            }
        }
    }

    fn told(
        &self,
        noise: &FittedNoise,
        place: usize,
        (gain_nats, instead): (f64, Vec<String>),
    ) -> UndeclaredNoise {
        let description = &self.loaded().description;
        let (kind, channel) = self.channel(place);
        let own = place - noise.declared();
        let (variance, unit, time_s) = match noise.process.get(own) {
            Some(process) => {
                let unit = &description.states[process.state].unit;
                (process.density, format!("{unit}/sqrt(s)"), None)
            }
            None => {
                let correlated = &noise.correlated[own - noise.process.len()];
                let unit = description.outputs[correlated.output].unit.clone();
                (correlated.variance, unit, Some(correlated.time_s))
            }
        };
        UndeclaredNoise {
            channel,
            kind,
            sigma: (variance * noise.factors[place]).sqrt(),
            unit,
            time_s,
            gain_nats,
            instead,
        }
    }
}
