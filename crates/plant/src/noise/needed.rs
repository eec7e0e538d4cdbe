//! Which noise that a plant does not declare a fit needs.

use gyrocal_answer::{NoiseKind, UndeclaredNoise};

use super::{ABSENT, NoiseFit, NoiseProblem};
use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::fitted_noise::FittedNoise;

/// What a noise must add to the log-likelihood beside the others to be told: in one of fifty records without it as
/// much is gained, as its size cannot be negative. What lacks less in the place of another explains as much.
const LEAST_GAIN: f64 = 2.0;

impl NoiseProblem<'_> {
    /// The best fit from some noise without those at some places.
    fn without(&self, from: &FittedNoise, absent: &[usize]) -> Result<NoiseFit, PlantError> {
        let mut start = from.clone();
        for place in absent {
            start.factors[*place] = ABSENT;
        }
        self.sizes(&start, absent)
    }
}

impl FittedPlant {
    /// Noise that the plant does not declare and that this model needs, each with what explains as much in its place.
    ///
    /// # Errors
    /// [`PlantError::Singular`].
    pub(crate) fn undeclared_noise(&self) -> Result<Vec<UndeclaredNoise>, PlantError> {
        if self.noise.is_declared() {
            return Ok(Vec::new());
        }
        self.with_noise_problem(|unknown| {
            let all = self.noise.declared()..self.noise.factors.len();
            let mut kept: Vec<usize> = all.collect();
            let mut absent: Vec<usize> = Vec::new();
            let mut fit = unknown.sizes(&self.noise, &[])?;
            // Those that add least go first.
            let gains = loop {
                let mut gains = Vec::with_capacity(kept.len());
                for place in &kept {
                    let left = [&absent[..], &[*place]].concat();
                    let next = unknown.without(&fit.noise, &left)?;
                    gains.push((*place, fit.log_likelihood - next.log_likelihood, next));
                }
                let least = gains
                    .iter()
                    .min_by(|a, b| a.1.total_cmp(&b.1))
                    .filter(|least| least.1 < LEAST_GAIN);
                let Some((place, _, next)) = least else {
                    break gains;
                };
                absent.push(*place);
                kept.retain(|other| other != place);
                fit = next.clone();
            };
            let told = gains.into_iter().map(|(place, gain_nats, _)| {
                let mut instead = Vec::new();
                for other in &absent {
                    let mut left: Vec<usize> = absent.clone();
                    left.retain(|one| one != other);
                    left.push(place);
                    let mut start = fit.noise.clone();
                    start.factors[*other] = 1.0;
                    let rival = unknown.without(&start, &left)?;
                    if fit.log_likelihood - rival.log_likelihood < LEAST_GAIN {
                        instead.push(self.channel(*other).1);
                    }
                }
                Ok(self.told(&fit.noise, place, (gain_nats, instead)))
            });
            told.collect()
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
