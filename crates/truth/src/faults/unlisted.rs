//! Effects that are not in the catalogue.

use std::sync::Arc;

use gyrocal_record::AXES;
use gyrocal_statistics::deviates::Draw;

use crate::error::Error;
use crate::hidden::Hidden;
use crate::scenario::Scenario;
use crate::simulation::{Simulation, simulate, simulate_with};
use crate::term::{Moment, Term};

/// Largest size of an effect of a gyro \[deg/h\]. Larger ones change the motion of the platform: the
/// record is then a different one and not the same with a small disturbance.
const LARGEST_GYRO_DEG_PER_H: f64 = 0.05;

/// The same of an accelerometer \[g\].
const LARGEST_ACCEL_G: f64 = 5e-4;

/// Range of the half-width of a play \[g\].
const PLAYS_G: [f64; 2] = [0.03, 0.3];

/// Range of a lag \[h\].
const LAGS_H: [f64; 2] = [0.5, 6.0];

/// Specific force at which the gain of a saturating accelerometer has fallen to 0.42 \[g\].
const SATURATION_G: f64 = 0.6;

/// A kind of effect that the catalogue does not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnlistedKind {
    /// A sine in a drift or an output at a period that no term has.
    Tone,
    /// The sign of a specific force (Coulomb friction).
    Sign,
    /// A dead zone.
    DeadZone,
    /// A cubic product of specific forces along two axes in a drift.
    CubicCross,
    /// A specific force times time in a drift.
    TimeProduct,
    /// Hysteresis: a drift that follows a specific force behind a play.
    Hysteresis,
    /// A D_I that changes at one time.
    ChangingScale,
    /// A drift that follows a specific force with a lag.
    Lag,
    /// An accelerometer with different gains for both signs.
    Rectified,
    /// An accelerometer whose gain falls with the specific force.
    Saturating,
    /// An accelerometer whose scale changes in time.
    AgeingScale,
    /// A product of two other specific forces in an accelerometer.
    OutputProduct,
}

impl UnlistedKind {
    /// All kinds.
    pub const ALL: [Self; 12] = [
        Self::Tone,
        Self::Sign,
        Self::DeadZone,
        Self::CubicCross,
        Self::TimeProduct,
        Self::Hysteresis,
        Self::ChangingScale,
        Self::Lag,
        Self::Rectified,
        Self::Saturating,
        Self::AgeingScale,
        Self::OutputProduct,
    ];

    /// Kinds that depend on more than time, of which the first five served to choose the constants of
    /// the probability of none of the catalogue and the last five did not.
    pub const OF_FORCE: &[Self] = Self::ALL.split_at(2).1;

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Tone => "tone",
            Self::Sign => "sign of a force",
            Self::DeadZone => "dead zone",
            Self::CubicCross => "cubic cross term",
            Self::TimeProduct => "force times time",
            Self::Hysteresis => "hysteresis",
            Self::ChangingScale => "changing D_I",
            Self::Lag => "lagging force",
            Self::Rectified => "gain by sign",
            Self::Saturating => "saturating gain",
            Self::AgeingScale => "ageing scale",
            Self::OutputProduct => "product of forces in an output",
        }
    }
}

/// An effect that the catalogue does not hold, with its size.
pub struct UnlistedEffect {
    /// Its name: an id of the simulator or that of its kind with its channel.
    pub id: String,
    /// Its size: deg/h of a drift, g of an output.
    pub size: f64,
    /// The largest that it may have: larger ones make another record.
    pub largest_size: f64,
    /// Names and values of all other parameters.
    further: Vec<(&'static str, f64)>,
    is_gyro: bool,
    /// Axis and value of an effect of unit size; `None` of an effect that the simulator knows by its id.
    unit: Option<(usize, Arc<Unit>)>,
}

/// Value of an effect of unit size.
type Unit = dyn Fn(&Moment) -> f64 + Send + Sync;

impl UnlistedEffect {
    /// Draws an effect of a kind: its channel, the forces that it depends on, and its parameters.
    ///
    /// # Errors
    /// Those of a simulation of the undisturbed motion, which effects with a memory need.
    pub fn draw(kind: UnlistedKind, scenario: &Scenario, random: &mut Draw) -> Result<Self, Error> {
        let own = (3.0 * random.uniform()) as usize % 3;
        let other = (3.0 * random.uniform()) as usize % 3;
        let gyro = random.uniform() < 0.5;
        let third = (own + 1 + (2.0 * random.uniform()) as usize % 2) % 3;
        let duration_s = scenario.duration_s;
        let named = |suffix: &str, further| {
            let instrument = if gyro { "gyro" } else { "accel" };
            let id = format!("{instrument}_{}.{suffix}", AXES[own]);
            Self::named(id, gyro, further)
        };
        let drift = |unit: Arc<Unit>| Self::of(kind.name(), true, own, unit);
        let output = |unit: Arc<Unit>| Self::of(kind.name(), false, own, unit);
        Ok(match kind {
            UnlistedKind::Tone => {
                let period = ("period_h", odd_period_h(scenario, random));
                let phase = ("phase_deg", 360.0 * random.uniform());
                named("tone", vec![period, phase])
            }
            UnlistedKind::Sign if gyro => named(&format!("sign_{}", AXES[other]), Vec::new()),
            UnlistedKind::Sign => named("sign", Vec::new()),
            UnlistedKind::DeadZone => named("dead_zone", Vec::new()),
            UnlistedKind::CubicCross => drift(Arc::new(move |moment| {
                let [f, g] = [moment.accel_g[other], moment.accel_g[(other + 1) % 3]];
                f * f * g
            })),
            UnlistedKind::TimeProduct => drift(Arc::new(move |moment| {
                moment.accel_g[other] * moment.time_s / duration_s
            })),
            UnlistedKind::ChangingScale => {
                let onset_s = (0.2 + 0.6 * random.uniform()) * duration_s;
                drift(Arc::new(move |moment| match moment.time_s < onset_s {
                    true => 0.0,
                    false => moment.accel_g[own],
                }))
            }
            UnlistedKind::Hysteresis => {
                let half_width_g = random.log_uniform(PLAYS_G);
                let series = Series::of(scenario, other, |state, force, _| {
                    state.clamp(force - half_width_g, force + half_width_g)
                })?;
                drift(Arc::new(move |moment| series.at(moment.time_s)))
            }
            UnlistedKind::Lag => {
                let lag_h = random.log_uniform(LAGS_H);
                let series = Series::of(scenario, other, |state, force, step_s| {
                    force + (-step_s / 3600.0 / lag_h).exp() * (state - force)
                })?;
                drift(Arc::new(move |moment| series.at(moment.time_s)))
            }
            UnlistedKind::Rectified => output(Arc::new(move |moment| moment.accel_g[own].abs())),
            UnlistedKind::Saturating => output(Arc::new(move |moment| {
                (moment.accel_g[own] / SATURATION_G).tanh()
            })),
            UnlistedKind::AgeingScale => output(Arc::new(move |moment| {
                moment.accel_g[own] * moment.time_s / duration_s
            })),
            UnlistedKind::OutputProduct => output(Arc::new(move |moment| {
                moment.accel_g[third] * moment.accel_g[3 - own - third]
            })),
        })
    }

    /// An effect that the simulator knows by its id, in a gyro or in an accelerometer, with the values of
    /// its parameters other than its size.
    #[must_use]
    pub fn named(id: String, is_gyro: bool, further: Vec<(&'static str, f64)>) -> Self {
        let [size, largest_size] = match is_gyro {
            true => [1e-3, LARGEST_GYRO_DEG_PER_H],
            false => [1e-6, LARGEST_ACCEL_G],
        };
        Self {
            id,
            size,
            largest_size,
            further,
            is_gyro,
            unit: None,
        }
    }

    /// A drift of one gyro or an error of one accelerometer, by its value of unit size.
    #[must_use]
    pub fn of(kind: &str, is_gyro: bool, axis: usize, unit: Arc<Unit>) -> Self {
        let instrument = if is_gyro { "gyro" } else { "accelerometer" };
        let id = format!("{kind} in {instrument} {}", AXES[axis]);
        Self {
            unit: Some((axis, unit)),
            ..Self::named(id, is_gyro, Vec::new())
        }
    }

    /// Simulates the scenario with this effect.
    ///
    /// # Errors
    /// Those of the simulator.
    pub fn simulate(&self, scenario: &Scenario) -> Result<Simulation, Error> {
        let size = self.size;
        let Some((axis, unit)) = self.unit.clone() else {
            let mut parameters = vec![("size", size)];
            parameters.extend(self.further.iter().copied());
            let mut with = scenario.clone();
            with.hidden.push(Hidden::new(&self.id, &parameters)?);
            return simulate(&with);
        };
        let of = Box::new(move |moment: &Moment| {
            let mut all = [0.0; 3];
            all[axis] = size * unit(moment);
            all
        });
        let term = match self.is_gyro {
            true => Term::Drift(of),
            false => Term::Output(of),
        };
        simulate_with(scenario, &[term])
    }
}

/// A period between six rows and a third of the record, away from the day and its half, which terms of
/// the catalogue have.
fn odd_period_h(scenario: &Scenario, random: &mut Draw) -> f64 {
    let range = [6.0 * scenario.interval_s, scenario.duration_s / 3.0].map(|s| s / 3600.0);
    loop {
        let period_h = random.log_uniform(range);
        let away = |from_h: f64| libm::fabs(libm::log(period_h / from_h)) > 0.15;
        if away(24.0) && away(12.0) {
            return period_h;
        }
    }
}

/// Values at the rows of a grid and between them: of a specific force and its past, along the motion without
/// the effect.
pub struct Series {
    /// Time between rows.
    pub interval_s: f64,
    /// Values at rows.
    pub values: Vec<f64>,
}

impl Series {
    /// `next` makes a value from the one before, the specific force and the time between.
    fn of(
        scenario: &Scenario,
        axis: usize,
        next: impl Fn(f64, f64, f64) -> f64,
    ) -> Result<Self, Error> {
        let undisturbed = simulate(&Scenario {
            hidden: Vec::new(),
            gaps_s: Vec::new(),
            accel_noise_g: 0.0,
            ..scenario.clone()
        })?;
        let interval_s = scenario.interval_s;
        let forces = undisturbed.record.accel_g.iter().map(|row| row[axis]);
        let mut state = None;
        let values = forces.map(|force| {
            let value = next(state.unwrap_or(force), force, interval_s);
            state = Some(value);
            value
        });
        Ok(Self {
            interval_s,
            values: values.collect(),
        })
    }

    /// The value at a time since the first row.
    #[must_use]
    pub fn at(&self, time_s: f64) -> f64 {
        let place = (time_s / self.interval_s).max(0.0);
        let last = self.values.len().saturating_sub(1);
        let row = (place as usize).min(last);
        let share = (place - row as f64).clamp(0.0, 1.0);
        let [one, other] = [self.values[row], self.values[(row + 1).min(last)]];
        one + share * (other - one)
    }
}
