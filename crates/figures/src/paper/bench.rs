//! The paper's bench, its simulated records, and the calibration of one record.

use gyrocal_calibration::{Calibration, Options, calibrate};
use gyrocal_record::{AXES, Bench};
use gyrocal_truth::{Coefficients, Scenario, Simulation, euler_rule, simulate};
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;

use super::Error;
use crate::values::{Table, Values, fixed};

/// Seeds of all statistics, fixed beforehand.
pub(super) const SEEDS: std::ops::RangeInclusive<u64> = 1..=60;
/// Seed of the record of the curves.
pub(super) const SHOWN_SEED: u64 = 1;
pub(super) const DAY_S: f64 = 86_400.0;
/// Duration of the paper's simulation.
pub(super) const PAPER_DAYS: f64 = 3.0;

/// Simulation of a record.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Data {
    /// By the independent simulator.
    Exact,
    /// By the rule of the paper's filter.
    PaperRule,
}

impl Data {
    pub(super) fn simulate(self, scenario: &Scenario) -> Result<Simulation, Error> {
        Ok(match self {
            Self::Exact => simulate(scenario)?,
            Self::PaperRule => euler_rule(scenario)?,
        })
    }
}

/// The paper's bench: its coefficients, noise and step.
pub(super) fn scenario(seed: u64, days: f64) -> Scenario {
    Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        duration_s: days * DAY_S,
        ..Scenario::default()
    }
}

/// A calibration and the truth.
pub(super) struct Judged {
    pub(super) truth: [f64; 9],
    pub(super) estimate: [f64; 9],
    pub(super) sigma: [f64; 9],
    pub(super) nis_mean: f64,
    /// Its band of 99.9 % probability for a consistent record.
    pub(super) nis_band: [f64; 2],
    /// Normalised estimation error squared of the nine; 9 is expected.
    pub(super) nees: f64,
}

impl Judged {
    pub(super) fn of(
        simulation: &Simulation,
        bench: &Bench,
        options: &Options,
    ) -> Result<Self, Error> {
        let found = calibrate(&simulation.record, bench, options, |_| ())?;
        let truth = simulation
            .truth
            .coefficients
            .named()
            .map(|(_, value, _)| value);
        let estimate = found.drift.to_array();
        let error = core::array::from_fn(|i| estimate[i] - truth[i]);
        Ok(Self {
            truth,
            estimate,
            sigma: core::array::from_fn(|i| found.covariance[i][i].sqrt()),
            nis_mean: found.fit.nis_mean(),
            nis_band: found.fit.nis_band(),
            nees: nees(&found, error)?,
        })
    }

    /// Estimate minus truth.
    pub(super) fn error(&self) -> [f64; 9] {
        core::array::from_fn(|i| self.estimate[i] - self.truth[i])
    }

    /// The same in percent of the coefficients.
    pub(super) fn percent(&self) -> [f64; 9] {
        core::array::from_fn(|i| 100.0 * self.error()[i] / self.truth[i])
    }

    /// The same in its sigmas.
    pub(super) fn in_sigmas(&self) -> [f64; 9] {
        core::array::from_fn(|i| self.error()[i] / self.sigma[i])
    }
}

fn nees(found: &Calibration, error: [f64; 9]) -> Result<f64, Error> {
    let covariance = SMatrix::<f64, 9, 9>::from_fn(|i, j| found.covariance[i][j]);
    let error = SVector::from(error);
    let cholesky = covariance
        .cholesky()
        .ok_or("the covariance is not positive definite")?;
    Ok(error.dot(&cholesky.solve(&error)))
}

/// All seeds with one filter.
pub(super) fn judge_all(data: Data, days: f64, options: &Options) -> Result<Vec<Judged>, Error> {
    SEEDS
        .into_par_iter()
        .map(|seed| {
            let simulation = data.simulate(&scenario(seed, days))?;
            Judged::of(&simulation, &simulation.bench, options)
        })
        .collect()
}

/// Names of the coefficients.
pub(super) fn names() -> [&'static str; 9] {
    Coefficients::NONE.named().map(|(name, _, _)| name)
}

/// The seeds in words.
pub(super) fn seeds() -> String {
    format!("{} to {}", SEEDS.start(), SEEDS.end())
}

/// Table 1 and further constants of the bench.
pub(super) fn describe(values: &mut Values) {
    let scenario = scenario(SHOWN_SEED, PAPER_DAYS);
    let mut table = Table::new(["gyro", "D_F (deg/h)", "D_I (deg/h/g)", "D_II (deg/h/g²)"]);
    let of = scenario.coefficients;
    for (axis, name) in AXES.into_iter().enumerate() {
        table.row([
            name.to_owned(),
            fixed(of.bias_deg_per_h[axis], 2),
            fixed(of.g_deg_per_h_per_g[axis], 2),
            fixed(of.gg_deg_per_h_per_g2[axis], 2),
        ]);
    }
    values.put("table_1", table.text());
    values.put("latitude", fixed(scenario.latitude_deg, 1));
    values.put("interval", fixed(scenario.interval_s, 0));
    values.put("days", fixed(PAPER_DAYS, 0));
    values.put("accel_noise", format!("{:e}", scenario.accel_noise_g));
    values.put("gyro_noise", fixed(scenario.gyro_noise_deg_per_h, 3));
    values.put(
        "angle_sigma",
        fixed(scenario.initial_angles_sigma_deg[0], 2),
    );
    values.put(
        "prior_sigma",
        fixed(scenario.prior.bias_sigma_deg_per_h[0], 0),
    );
    values.put("runs", SEEDS.count().to_string());
    values.put("seeds", seeds());
    values.put("shown_seed", SHOWN_SEED.to_string());
}
