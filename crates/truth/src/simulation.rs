//! A scenario simulated exactly.

use gyrocal_record::{Bench, Record};

use crate::attitude::Attitude;
use crate::coefficients::Coefficients;
use crate::error::Error;
use crate::motion::Motion;
use crate::sampling::Sampling;
use crate::scenario::Scenario;
use crate::term::Term;

/// A record and all that is behind it.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// What the logger wrote.
    pub record: Record,
    /// What the operator knows.
    pub bench: Bench,
    /// What only the simulator knows.
    pub truth: Truth,
}

/// The truth behind a record; the vectors have one element for each of its rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// What the gyros do.
    pub coefficients: Coefficients,
    /// Platform against local east, north, up.
    pub platform_c_enu: Vec<Attitude>,
    /// Drift of the gyros without noise, hidden terms included.
    pub drift_deg_per_h: Vec<[f64; 3]>,
}

impl Truth {
    /// Platform against local east, north, up at the first row.
    #[must_use]
    pub fn platform_c_enu_first(&self) -> Attitude {
        self.platform_c_enu
            .first()
            .copied()
            .unwrap_or(Attitude::IDENTITY)
    }

    /// Platform against local east, north, up at the last row.
    #[must_use]
    pub fn platform_c_enu_last(&self) -> Attitude {
        self.platform_c_enu
            .last()
            .copied()
            .unwrap_or(Attitude::IDENTITY)
    }
}

/// Simulates a scenario.
///
/// # Errors
///
/// [`Error::InvalidScenario`] if a value of the scenario makes no sense.
pub fn simulate(scenario: &Scenario) -> Result<Simulation, Error> {
    simulate_with(scenario, &[])
}

/// Simulates a scenario with hidden effects.
///
/// # Errors
///
/// [`Error::InvalidScenario`] if a value of the scenario makes no sense.
pub fn simulate_with(scenario: &Scenario, terms: &[Term]) -> Result<Simulation, Error> {
    simulate_watched(scenario, terms, |_| ())
}

/// Simulates a scenario with hidden effects and tells after each row of the regular grid, whose
/// number is [`Scenario::grid_rows`], how many are done.
///
/// # Errors
///
/// [`Error::InvalidScenario`] if a value of the scenario makes no sense.
pub fn simulate_watched(
    scenario: &Scenario,
    terms: &[Term],
    mut rows_done: impl FnMut(usize),
) -> Result<Simulation, Error> {
    scenario.check()?;
    let platform = scenario.platform();
    let mut motion = Motion::new(&platform, terms);
    let mut sampling = Sampling::new(scenario, terms);
    let mut truth = Truth {
        coefficients: scenario.coefficients,
        platform_c_enu: Vec::new(),
        drift_deg_per_h: Vec::new(),
    };
    for (row, clock_s) in sampling.grid_s().enumerate() {
        if row > 0 {
            let noise = sampling.held_gyro_noise_deg_per_h();
            motion.advance_to(true_time_s(clock_s, terms), noise);
        }
        let moment = motion.moment();
        let mut accel_g = moment.accel_g;
        for term in terms {
            if let Term::Output(error) = term {
                let error = error(&moment);
                accel_g = [0, 1, 2].map(|axis| accel_g[axis] + error[axis]);
            }
        }
        if sampling.log(row, clock_s, accel_g) {
            truth.platform_c_enu.push(motion.platform_c_enu());
            truth.drift_deg_per_h.push(motion.drift_deg_per_h(&moment));
        }
        rows_done(row + 1);
    }
    Ok(Simulation {
        record: sampling.into_record(),
        bench: scenario.bench(),
        truth,
    })
}

fn true_time_s(clock_s: f64, terms: &[Term]) -> f64 {
    terms.iter().fold(clock_s, |time_s, term| match term {
        Term::Time(true_time_s) => true_time_s(time_s),
        _ => time_s,
    })
}
