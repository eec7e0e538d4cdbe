//! Which noise that a plant does not declare a fit needs.

use super::all::PRESENT;
use super::{ABSENT, NoiseFit, NoiseProblem};
use crate::error::PlantError;
use crate::fitted_noise::FittedNoise;

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
    pub(crate) fn eliminated(&self, from: &FittedNoise, least_gain: f64) -> Option<Eliminated> {
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
    pub(crate) fn instead(&self, found: &Eliminated, place: usize, least_gain: f64) -> Vec<usize> {
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
pub(crate) struct Eliminated {
    pub(crate) fit: NoiseFit,
    absent: Vec<usize>,
    /// What each other one adds to the log-likelihood, by its place.
    pub(crate) gains: Vec<(usize, f64)>,
}
