//! A platform that drifts without noise, and its samples.

use chacha20::ChaCha12Rng;
use gyrocal::scalar::{Model, Recentre};
use gyrocal::{Anchored, Chart, Platform, Site};
use rand::{RngExt, SeedableRng};

pub(crate) const STEP_S: f64 = 60.0;
/// (0.002 deg/h)² held over 60 s.
pub(crate) const DENSITY: [f64; 3] = [2.4e-4; 3];
/// (1e-5 g)².
pub(crate) const VARIANCE: [f64; 3] = [1e-10; 3];
/// Deg/h, deg/h/g, deg/h/g².
pub(crate) const DRIFT: [f64; 9] = [0.2, -0.1, 0.05, 0.3, 0.1, -0.05, 0.1, 0.02, 0.02];

pub(crate) fn chart() -> Chart<f64> {
    Chart::east_north_up(Site::at_latitude_deg(39.1))
}

/// The platform itself, and the noise of its accelerometers.
#[derive(Debug)]
pub(crate) struct Truth {
    chart: Chart<f64>,
    rng: ChaCha12Rng,
}

impl Truth {
    /// A platform at the given angles.
    pub(crate) fn at(angles_rad: [f64; 3], seed: u64) -> Self {
        let mut chart = chart();
        Anchored(Platform).recentre(&mut { angles_rad }, &mut chart);
        Self {
            chart,
            rng: ChaCha12Rng::seed_from_u64(seed),
        }
    }

    /// Moves on by a step (Runge-Kutta), and samples with noise of 1e-5 g.
    pub(crate) fn sample(&mut self) -> [f64; 3] {
        let model = Anchored(Platform);
        let rates = |from: [f64; 3], part_s: f64| {
            model.rates(&from.map(|rate| rate * part_s), &DRIFT, &self.chart)
        };
        let first = rates([0.0; 3], 0.0);
        let second = rates(first, STEP_S / 2.0);
        let third = rates(second, STEP_S / 2.0);
        let fourth = rates(third, STEP_S);
        let mut moving = core::array::from_fn(|i| {
            (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) * STEP_S / 6.0
        });
        model.recentre(&mut moving, &mut self.chart);
        // Uniform over ±√3 sigma has the variance of the filter's assumption.
        let mut noise = || 1e-5 * self.rng.random_range(-1.7..1.7);
        let noise = [noise(), noise(), noise()];
        let clean = model.output(&[0.0; 3], &DRIFT, &self.chart);
        core::array::from_fn(|i| clean[i] + noise[i])
    }
}
