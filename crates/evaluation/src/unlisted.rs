//! Effects that are not in the catalogue.

use std::sync::Arc;

use gyrocal_record::AXES;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Hidden, Moment, Scenario, Simulation, Term, simulate, simulate_with};

use crate::error::EvaluationError;
use crate::scenario::duration_h;

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
    pub const OF_FORCE: [Self; 10] = [
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
    pub(crate) largest_size: f64,
    /// Names and values of all other parameters.
    pub(crate) further: Vec<(&'static str, f64)>,
    form: Form,
}

/// Value of an effect of unit size.
type Unit = dyn Fn(&Moment) -> f64 + Send + Sync;

enum Form {
    /// An effect that the simulator knows by its id.
    Named,
    /// A drift of one gyro.
    Drift(usize, Arc<Unit>),
    /// An error of one accelerometer.
    Output(usize, Arc<Unit>),
}

impl UnlistedEffect {
    /// Draws an effect of a kind: its channel, the forces that it depends on, and its parameters.
    ///
    /// # Errors
    /// Those of a simulation of the undisturbed motion, which effects with a memory need.
    pub fn draw(
        kind: UnlistedKind,
        scenario: &Scenario,
        random: &mut Draw,
    ) -> Result<Self, EvaluationError> {
        let own = (3.0 * random.uniform()) as usize % 3;
        let other = (3.0 * random.uniform()) as usize % 3;
        let gyro = random.uniform() < 0.5;
        let third = (own + 1 + (2.0 * random.uniform()) as usize % 2) % 3;
        let duration_s = scenario.duration_s;
        let named = |suffix: &str, further| {
            let instrument = if gyro { "gyro" } else { "accel" };
            Self::named(
                format!("{instrument}_{}.{suffix}", AXES[own]),
                gyro,
                further,
            )
        };
        Ok(match kind {
            UnlistedKind::Tone => {
                let period_h = odd_period_h(scenario, random);
                let further = vec![
                    ("period_h", period_h),
                    ("phase_deg", 360.0 * random.uniform()),
                ];
                named("tone", further)
            }
            UnlistedKind::Sign if gyro => named(&format!("sign_{}", AXES[other]), Vec::new()),
            UnlistedKind::Sign => named("sign", Vec::new()),
            UnlistedKind::DeadZone => named("dead_zone", Vec::new()),
            UnlistedKind::CubicCross => Self::drift(kind, own, move |moment| {
                let [f, g] = [moment.accel_g[other], moment.accel_g[(other + 1) % 3]];
                f * f * g
            }),
            UnlistedKind::TimeProduct => Self::drift(kind, own, move |moment| {
                moment.accel_g[other] * moment.time_s / duration_s
            }),
            UnlistedKind::ChangingScale => {
                let onset_s = (0.2 + 0.6 * random.uniform()) * duration_s;
                Self::drift(kind, own, move |moment| {
                    if moment.time_s < onset_s {
                        0.0
                    } else {
                        moment.accel_g[own]
                    }
                })
            }
            UnlistedKind::Hysteresis => {
                let half_width_g = random.log_uniform(PLAYS_G);
                let series = Series::of(scenario, other, |state, force, _| {
                    state.clamp(force - half_width_g, force + half_width_g)
                })?;
                Self::drift(kind, own, move |moment| series.at(moment.time_s))
            }
            UnlistedKind::Lag => {
                let lag_h = random.log_uniform(LAGS_H);
                let series = Series::of(scenario, other, |state, force, step_s| {
                    force + (-step_s / 3600.0 / lag_h).exp() * (state - force)
                })?;
                Self::drift(kind, own, move |moment| series.at(moment.time_s))
            }
            UnlistedKind::Rectified => {
                Self::output(kind, own, move |moment| moment.accel_g[own].abs())
            }
            UnlistedKind::Saturating => Self::output(kind, own, move |moment| {
                (moment.accel_g[own] / SATURATION_G).tanh()
            }),
            UnlistedKind::AgeingScale => Self::output(kind, own, move |moment| {
                moment.accel_g[own] * moment.time_s / duration_s
            }),
            UnlistedKind::OutputProduct => Self::output(kind, own, move |moment| {
                moment.accel_g[third] * moment.accel_g[3 - own - third]
            }),
        })
    }

    /// An effect that the simulator knows by its id, in a gyro or in an accelerometer, with the values of
    /// its parameters other than its size.
    #[must_use]
    pub fn named(id: String, gyro: bool, further: Vec<(&'static str, f64)>) -> Self {
        let (size, largest_size) = sizes(gyro);
        Self {
            id,
            size,
            largest_size,
            further,
            form: Form::Named,
        }
    }

    fn drift(
        kind: UnlistedKind,
        gyro: usize,
        unit: impl Fn(&Moment) -> f64 + Send + Sync + 'static,
    ) -> Self {
        Self::drift_of(kind.name(), gyro, unit)
    }

    /// A drift of one gyro, of a kind that is named here.
    pub(crate) fn drift_of(
        kind: &str,
        gyro: usize,
        unit: impl Fn(&Moment) -> f64 + Send + Sync + 'static,
    ) -> Self {
        let form = Form::Drift(gyro, Arc::new(unit));
        let id = format!("{kind} in gyro {}", AXES[gyro]);
        Self {
            form,
            ..Self::named(id, true, Vec::new())
        }
    }

    fn output(
        kind: UnlistedKind,
        axis: usize,
        unit: impl Fn(&Moment) -> f64 + Send + Sync + 'static,
    ) -> Self {
        let form = Form::Output(axis, Arc::new(unit));
        let id = format!("{} in accelerometer {}", kind.name(), AXES[axis]);
        Self {
            form,
            ..Self::named(id, false, Vec::new())
        }
    }

    /// Simulates the scenario with this effect.
    ///
    /// # Errors
    /// Those of the simulator.
    pub fn simulate(&self, scenario: &Scenario) -> Result<Simulation, EvaluationError> {
        let size = self.size;
        let one = |axis: usize, unit: &Arc<Unit>| {
            let unit = Arc::clone(unit);
            Box::new(move |moment: &Moment| {
                let mut all = [0.0; 3];
                all[axis] = size * unit(moment);
                all
            })
        };
        let term = match &self.form {
            Form::Drift(gyro, unit) => Term::Drift(one(*gyro, unit)),
            Form::Output(axis, unit) => Term::Output(one(*axis, unit)),
            Form::Named => {
                let mut parameters = vec![("size", size)];
                parameters.extend(self.further.iter().copied());
                let mut hidden = scenario.hidden.clone();
                hidden.push(Hidden::new(&self.id, &parameters)?);
                return Ok(simulate(&Scenario {
                    hidden,
                    ..scenario.clone()
                })?);
            }
        };
        Ok(simulate_with(scenario, &[term])?)
    }
}

/// First and largest size.
fn sizes(gyro: bool) -> (f64, f64) {
    if gyro {
        (1e-3, LARGEST_GYRO_DEG_PER_H)
    } else {
        (1e-6, LARGEST_ACCEL_G)
    }
}

/// A period between six rows and a third of the record, away from the day and its half, which terms of
/// the catalogue have.
fn odd_period_h(scenario: &Scenario, random: &mut Draw) -> f64 {
    let range = [
        6.0 * scenario.interval_s / 3600.0,
        duration_h(scenario) / 3.0,
    ];
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
pub(crate) struct Series {
    pub(crate) interval_s: f64,
    pub(crate) values: Vec<f64>,
}

impl Series {
    /// `next` makes a value from the one before, the specific force and the time between.
    fn of(
        scenario: &Scenario,
        axis: usize,
        next: impl Fn(f64, f64, f64) -> f64,
    ) -> Result<Self, EvaluationError> {
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

    pub(crate) fn at(&self, time_s: f64) -> f64 {
        let place = (time_s / self.interval_s).max(0.0);
        let last = self.values.len().saturating_sub(1);
        let row = (place as usize).min(last);
        let share = (place - row as f64).clamp(0.0, 1.0);
        let [one, other] = [self.values[row], self.values[(row + 1).min(last)]];
        one + share * (other - one)
    }
}
