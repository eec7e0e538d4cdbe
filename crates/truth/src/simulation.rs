//! A scenario simulated exactly.

use core::ops::ControlFlow;

use gyrocal_record::{Bench, Record};

use crate::attitude::Attitude;
use crate::coefficients::Coefficients;
use crate::effect::Effect;
use crate::error::Error;
use crate::gyro_noise::GyroNoise;
use crate::hidden::Hidden;
use crate::motion::Motion;
use crate::sampling::Sampling;
use crate::scenario::Scenario;
use crate::sensing::Sensing;
use crate::temperature::{Thermal, thermal_course};
use crate::term::Term;

/// A record, its bench description and the truth.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// The record.
    pub record: Record,
    /// The bench description: the operator's knowledge.
    pub bench: Bench,
    /// The truth, known to the simulator only.
    pub truth: Truth,
}

/// The truth behind a record; the vectors but `hidden` have one element for each of its rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// Drift coefficients of the gyros.
    pub coefficients: Coefficients,
    /// Hidden effects.
    pub hidden: Vec<Hidden>,
    /// Platform against local east, north, up.
    pub platform_c_enu: Vec<Attitude>,
    /// Inertial rate of the platform in its own axes without white noise, which is the drift of
    /// its gyros; hidden effects and a random walk included.
    pub drift_deg_per_h: Vec<[f64; 3]>,
    /// True for each component that is an outlier, missing or not.
    pub outliers: Vec<[bool; 3]>,
}

impl Truth {
    /// Platform against local east, north, up at the first row.
    #[must_use]
    pub fn platform_c_enu_first(&self) -> Attitude {
        let first = self.platform_c_enu.first();
        first.copied().unwrap_or(Attitude::IDENTITY)
    }

    /// Platform against local east, north, up at the last row.
    #[must_use]
    pub fn platform_c_enu_last(&self) -> Attitude {
        let last = self.platform_c_enu.last();
        last.copied().unwrap_or(Attitude::IDENTITY)
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

/// Simulates a scenario with terms of the caller in addition to its hidden effects.
///
/// # Errors
///
/// [`Error::InvalidScenario`] if a value of the scenario makes no sense.
pub fn simulate_with(scenario: &Scenario, terms: &[Term]) -> Result<Simulation, Error> {
    simulate_watched(scenario, terms, |_| ControlFlow::Continue(()))
}

/// As [`simulate_with`]; reports after each row of the regular grid how many of
/// [`Scenario::grid_rows`] are done, and ends where it is told to.
///
/// # Errors
///
/// [`Error::InvalidScenario`] if a value of the scenario makes no sense; [`Error::Stopped`] if `rows_done` breaks.
pub fn simulate_watched(
    scenario: &Scenario,
    terms: &[Term],
    mut rows_done: impl FnMut(usize) -> ControlFlow<()>,
) -> Result<Simulation, Error> {
    run(scenario, terms, &mut rows_done)
}

/// Not generic: callers compile no simulator.
fn run(
    scenario: &Scenario,
    terms: &[Term],
    rows_done: &mut dyn FnMut(usize) -> ControlFlow<()>,
) -> Result<Simulation, Error> {
    scenario.check()?;
    let temperature = scenario.temperature_course();
    let times_s = scenario.grid_s();
    let logged: Vec<bool> = times_s.map(|time_s| scenario.logs(time_s)).collect();
    let course = temperature.as_deref();
    let thermal = course.map(|course| thermal_course(course, &logged));
    let thermal_at = |row: usize| thermal.as_ref().map_or(Thermal::default(), |all| all[row]);
    let clock = Clock::new(scenario, terms);

    let mut motion = Motion::of(scenario, terms, thermal_at(0));
    let mut gyro_noise = GyroNoise::new(scenario);
    let sensing = Sensing::new(&scenario.hidden, terms);
    let mut sampling = Sampling::new(scenario, terms, temperature);
    let rows = scenario.grid_rows();
    let mut platform_c_enu = Vec::with_capacity(rows);
    let mut drift_deg_per_h = Vec::with_capacity(rows);
    for (row, clock_s) in scenario.grid_s().enumerate() {
        if row > 0 {
            let noise = gyro_noise.next_deg_per_h(scenario.interval_s);
            motion.advance_to(clock.true_time_s(clock_s), noise, thermal_at(row))?;
        }
        if sampling.log(row, clock_s, sensing.output_g(motion.moment())) {
            platform_c_enu.push(motion.platform_c_enu());
            drift_deg_per_h.push(motion.rate_deg_per_h(gyro_noise.walk_deg_per_h()));
        }
        if rows_done(row + 1).is_break() {
            return Err(Error::Stopped);
        }
    }
    let (record, outliers) = sampling.into_record();
    Ok(Simulation {
        record,
        bench: scenario.bench(),
        truth: Truth {
            coefficients: scenario.coefficients,
            hidden: scenario.hidden.clone(),
            platform_c_enu,
            drift_deg_per_h,
            outliers,
        },
    })
}

/// Conversion from the record's clock to true time.
struct Clock<'a> {
    seconds_per_second: f64,
    terms: &'a [Term],
}

impl<'a> Clock<'a> {
    fn new(scenario: &Scenario, terms: &'a [Term]) -> Self {
        let rates = scenario.hidden.iter().map(|hidden| match hidden.effect() {
            Effect::ClockRate => 1.0 + hidden.value(0),
            _ => 1.0,
        });
        Self {
            seconds_per_second: rates.product(),
            terms,
        }
    }

    fn true_time_s(&self, clock_s: f64) -> f64 {
        let changed = |time_s: f64, term: &Term| match term {
            Term::Time(true_time_s) => true_time_s(time_s),
            _ => time_s,
        };
        let terms = self.terms.iter();
        terms.fold(clock_s / self.seconds_per_second, changed)
    }
}
