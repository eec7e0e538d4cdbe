//! Which noise that a plant does not declare a fit needs.

use gyrocal_answer::{NoiseKind, UndeclaredNoise};
use gyrocal_statistics::chi_square_quantile;

use super::all::PRESENT;
use super::{ABSENT, NoiseFit, NoiseProblem};
use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::fitted_noise::FittedNoise;

/// Probability that any noise is told that is not there.
const FALSE: f64 = 0.02;

impl NoiseProblem<'_> {
    /// The best fit from some noise without those at some places.
    fn without(&self, from: &FittedNoise, absent: &[usize]) -> Result<NoiseFit, PlantError> {
        let mut start = from.clone();
        for place in absent {
            start.factors[*place] = ABSENT;
        }
        self.maximise_others(&start, absent)
    }

    /// The best fit without noises that add little, these, and what each other one adds. One that others cannot do
    /// without stays.
    fn eliminated(&self, from: &FittedNoise, least_gain: f64) -> Option<Eliminated> {
        let all = from.declared()..from.factors.len();
        let (mut kept, mut absent): (Vec<usize>, Vec<usize>) =
            all.partition(|place| from.factors[*place] > PRESENT);
        let mut fit = self.without(from, &absent).ok()?;
        // Those that add least go first.
        loop {
            let mut gains = Vec::with_capacity(kept.len());
            let mut least: Option<(usize, f64, NoiseFit)> = None;
            for place in &kept {
                let left = [&absent[..], &[*place]].concat();
                let Ok(next) = self.without(&fit.noise, &left) else {
                    gains.push((*place, f64::INFINITY));
                    continue;
                };
                let gain = fit.log_likelihood - next.log_likelihood;
                gains.push((*place, gain));
                if least.as_ref().is_none_or(|least| gain < least.1) {
                    least = Some((*place, gain, next));
                }
            }
            match least {
                Some((place, gain, next)) if gain < least_gain => {
                    absent.push(place);
                    kept.retain(|other| *other != place);
                    fit = next;
                }
                _ => return Some(Eliminated { fit, absent, gains }),
            }
        }
    }

    /// Noises among the absent ones that explain as much in the place of another.
    fn instead(&self, found: &Eliminated, place: usize, least_gain: f64) -> Vec<usize> {
        let rivals = found.absent.iter().copied();
        rivals
            .filter(|other| {
                let mut left = found.absent.clone();
                left.retain(|one| one != other);
                left.push(place);
                let mut start = found.fit.noise.clone();
                start.factors[*other] = 1.0;
                // One that cannot be fitted is no rival.
                self.without(&start, &left)
                    .is_ok_and(|rival| found.fit.log_likelihood - rival.log_likelihood < least_gain)
            })
            .collect()
    }
}

/// A fit without noises that add little.
struct Eliminated {
    fit: NoiseFit,
    absent: Vec<usize>,
    /// What each other one adds to the log-likelihood, by its place.
    gains: Vec<(usize, f64)>,
}

impl FittedPlant {
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
