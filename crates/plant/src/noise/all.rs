//! All noise together: white noise of the outputs, process noise of every rate, correlated noise of every output.
//!
//! Names that hold in white noise alone are often false: correlated readings and what drives a plant unseen look like
//! effects. White levels, process noises and first-order correlations are estimated together, in each fit anew.
//! Correlation times follow one after the other between levels at their best.

use gyrocal_inference::{Correlated, Process};
use gyrocal_statistics::{chi_square_tail, median_interval_s};

use super::{NoiseFit, NoiseProblem};
use crate::error::PlantError;
use crate::fitted_noise::FittedNoise;

/// Probability that white noise alone makes noise that a plant does not declare seem needed. The test of twice its gain
/// counts an unknown for each process noise and two for each correlated noise. It is conservative: none of their sizes
/// can be negative.
const NEEDED_PROBABILITY: f64 = 0.01;

/// A correlation time is at most this share of a record: what correlates for longer is a drift.
const LONGEST: f64 = 0.05;

/// The shortest over the interval of the rows: the correlation of neighbours is 0.05.
const SHORTEST: f64 = 1.0 / 3.0;

/// Factors that correlation times are changed by, one after the other.
const FACTORS: [f64; 3] = [2.0, 1.4, 1.15];

/// Gain of the log-likelihood that ends a search for a time.
const LEAST_GAIN: f64 = 0.01;

/// Variance over that which the record could just show, from which the correlation time of a noise is estimated.
pub(super) const PRESENT: f64 = 0.1;

/// First sizes of process noise and of correlated noise, over what the record could just show, and the first
/// correlation time over the interval of the rows: either may explain what the other does.
const STARTS: [(f64, f64, f64); 4] = [
    (1.0, 1.0, 5.0),
    (0.1, 5.0, 5.0),
    (0.1, 5.0, 30.0),
    (5.0, 0.1, 5.0),
];

/// First size of a probing noise over that of its state or output, and how often it is brought to what the record
/// could just show: where the first was large, the information on it was no more in proportion.
const PROBE: f64 = 1e-6;
const SCALINGS: usize = 4;

impl NoiseProblem<'_> {
    /// The largest likelihood by sizes and correlation times, from these.
    pub(crate) fn maximise(&self, start: &FittedNoise) -> Result<NoiseFit, PlantError> {
        self.maximise_others(start, &[])
    }

    /// The same with the sizes of some noises held.
    pub(super) fn maximise_others(
        &self,
        start: &FittedNoise,
        held: &[usize],
    ) -> Result<NoiseFit, PlantError> {
        let mut best = self.sizes(start, held)?;
        let Some(bounds) = self.time_bounds().filter(|_| !start.correlated.is_empty()) else {
            return Ok(best);
        };
        let first = start.factors.len() - start.correlated.len();
        for factor in FACTORS {
            for index in 0..start.correlated.len() {
                for by in [factor, 1.0 / factor] {
                    while best.noise.factors[first + index] > PRESENT {
                        let now = best.noise.correlated[index].time_s;
                        let time_s = (now * by).clamp(bounds.0, bounds.1);
                        if time_s == now {
                            break;
                        }
                        let tried = self.sizes(&best.noise.with_time(index, time_s), held)?;
                        if tried.log_likelihood < best.log_likelihood + LEAST_GAIN {
                            break;
                        }
                        best = tried;
                    }
                }
            }
        }
        Ok(best)
    }

    /// The shortest and the longest correlation time; `None` if the record is too short for any.
    fn time_bounds(&self) -> Option<(f64, f64)> {
        let record = &self.problem.record;
        let bounds = (
            SHORTEST * median_interval_s(&record.time_s),
            LONGEST * record.longest_s(),
        );
        (bounds.0 < bounds.1).then_some(bounds)
    }

    /// All noises of sizes that the record could just show, beside these declared ones; none that it cannot see.
    pub(crate) fn just_visible(&self, declared: &FittedNoise) -> Result<FittedNoise, PlantError> {
        let description = &self.problem.plant.description;
        let (states, outputs) = (description.states.len(), description.outputs.len());
        let record = &self.problem.record;
        let duration_s = record.longest_s();
        let process = description.states.iter().enumerate().map(|(state, own)| {
            let moved = rms(self.points.iter().skip(state).step_by(states));
            // A state at rest is of the size that is known of it, or one.
            let size = match (moved > 0.0, own.sigma.is_finite() && own.sigma > 0.0) {
                (true, _) => moved,
                (_, true) => own.sigma,
                _ => 1.0,
            };
            Process {
                state,
                density: (PROBE * size).powi(2) / duration_s,
            }
        });
        let time_s = self
            .time_bounds()
            .map(|(least, most)| (STARTS[0].2 * least / SHORTEST).min(most));
        let correlated = (0..outputs).filter_map(|output| {
            let own = description.outputs[output].sigma;
            Some(Correlated {
                output,
                time_s: time_s?,
                variance: PROBE * PROBE * own * own * declared.factors[output],
            })
        });
        let mut visible = FittedNoise {
            factors: declared.factors.clone(),
            process: process.collect(),
            correlated: correlated.collect(),
            loose: Vec::new(),
        };
        for _ in 0..SCALINGS {
            self.rescale(&mut visible)?;
        }
        Ok(visible)
    }

    /// Brings the information on the logarithm of each undeclared noise towards one: as long as it is small, it goes
    /// with the square of the variance.
    fn rescale(&self, noise: &mut FittedNoise) -> Result<(), PlantError> {
        let declared = self.problem.declared_noise().factors.len();
        let count = noise.process.len() + noise.correlated.len();
        noise.factors.truncate(declared);
        noise.factors.resize(declared + count, 1.0);
        let score = self.lin.pass(noise, &[]).noise_score()?;
        let all = noise.factors.len();
        let scales: Vec<f64> = (declared..all)
            .map(|place| score.information[place * all + place].sqrt().recip())
            .collect();
        let (of_process, of_correlated) = scales.split_at(noise.process.len());
        let process = noise.process.iter().zip(of_process);
        noise.process = process
            .filter(|(_, by)| by.is_finite())
            .map(|(one, by)| Process {
                density: one.density * by,
                ..*one
            })
            .collect();
        let correlated = noise.correlated.iter().zip(of_correlated);
        noise.correlated = correlated
            .filter(|(_, by)| by.is_finite())
            .map(|(one, by)| Correlated {
                variance: one.variance * by,
                ..*one
            })
            .collect();
        noise
            .factors
            .truncate(declared + noise.process.len() + noise.correlated.len());
        Ok(())
    }

    /// The best of several starts.
    pub(crate) fn best_of_starts(&self, visible: &FittedNoise) -> Result<NoiseFit, PlantError> {
        let first = visible.declared();
        let interval_s = median_interval_s(&self.problem.record.time_s);
        let bounds = self.time_bounds();
        let mut best: Option<NoiseFit> = None;
        for (process, correlated, rows) in STARTS {
            let mut start = visible.clone();
            let second = first + start.process.len();
            start.factors[first..second].fill(process);
            start.factors[second..].fill(correlated);
            if let Some((least, most)) = bounds {
                for one in &mut start.correlated {
                    one.time_s = (rows * interval_s).clamp(least, most);
                }
            }
            // Another start may lead to where this one does not.
            let Ok(found) = self.sizes(&start, &[]) else {
                continue;
            };
            if best
                .as_ref()
                .is_none_or(|best| best.log_likelihood < found.log_likelihood)
            {
                best = Some(found);
            }
        }
        self.maximise(&best.ok_or(PlantError::Singular)?.noise)
    }
}

/// Whether white noise would seldom gain as much.
pub(crate) fn is_needed(with: &NoiseFit, declared: &NoiseFit) -> bool {
    let unknowns = with.noise.process.len() + 2 * with.noise.correlated.len();
    let gain = 2.0 * (with.log_likelihood - declared.log_likelihood);
    chi_square_tail(gain, unknowns as f64).is_some_and(|p| p < NEEDED_PROBABILITY)
}

fn rms<'v>(values: impl Iterator<Item = &'v f64>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for value in values {
        sum += value * value;
        count += 1.0;
    }
    f64::sqrt(sum / f64::max(count, 1.0))
}
