//! A second record of a plant, and what its true model gains there.

use gyrocal_answer::{OutputError, Validation};
use gyrocal_plant::{LoadedPlant, PlantError, PlantRecord};

use super::simulated::{Setting, simulate};

/// Gain of the true model over the nominal one, nats, from which on a better prediction is asked for.
pub(super) const LEAST_GAIN: f64 = 3.0;

/// A second record with the sensors of its simulator.
pub(super) struct Second {
    pub(super) record: PlantRecord,
    /// Outputs of the simulator without noise, by rows.
    quiet: Vec<f64>,
    /// Standard deviations of the noise of each output.
    sigmas: Vec<f64>,
}

/// Whether simulations are nearer to the outputs with what was found, on average over outputs.
pub(super) fn is_better(later: &Validation) -> bool {
    let ratio = |error: &OutputError| Some(error.extended? / error.nominal?);
    let ratios: Option<Vec<f64>> = later.open_loop.iter().map(ratio).collect();
    ratios.is_some_and(|all| all.iter().sum::<f64>() < all.len() as f64)
}

impl Second {
    /// Simulates it with and without noise.
    pub(super) fn new(plant: &LoadedPlant, setting: &Setting) -> Result<Self, PlantError> {
        let run = simulate(setting, None);
        let without = Setting {
            noise: 0.0,
            ..setting.clone()
        };
        let quiet = simulate(&without, Some(&run.inputs)).outputs.concat();
        let sigmas = setting.kind.facts().sigmas.iter();
        Ok(Self {
            record: super::prepared(plant, run)?,
            quiet,
            sigmas: sigmas.map(|sigma| setting.noise * sigma).collect(),
        })
    }

    /// Logarithm of the density of the outputs by the true model less that by a simulation of the nominal
    /// one, nats.
    pub(super) fn true_gain(&self, later: &Validation) -> f64 {
        let outputs = self.sigmas.len();
        let gain = |(output, sigma): (usize, &f64)| {
            let own = (output..self.quiet.len()).step_by(outputs);
            let differences = own.map(|place| self.record.outputs[place] - self.quiet[place]);
            let seen: Vec<f64> = differences.filter(|value| !value.is_nan()).collect();
            let noise: f64 = seen.iter().map(|value| value * value).sum();
            let nominal = seen.len() as f64
                * later.open_loop[output]
                    .nominal
                    .unwrap_or(f64::INFINITY)
                    .powi(2);
            0.5 * (nominal - noise) / (sigma * sigma)
        };
        self.sigmas.iter().enumerate().map(gain).sum()
    }
}
