//! The platform in motion: one quaternion carried through time.

mod steps;

use steps::{LONGEST_STEP_S, MOST_STEPS};

use crate::attitude::Attitude;
use crate::drift::DriftLaw;
use crate::earth_rotation::{EarthAngle, EarthRotation};
use crate::effect::Effect;
use crate::error::Error;
use crate::platform::{EARTH_RATE_RAD_PER_S, Platform};
use crate::scenario::Scenario;
use crate::temperature::Thermal;
use crate::term::{Moment, Term};

/// A platform at one moment.
#[derive(Debug)]
pub(crate) struct Motion<'a> {
    law: DriftLaw<'a>,
    has_switches: bool,
    earth: EarthRotation,
    longest_step_s: f64,
    /// Steps until the motion takes too long.
    pub(crate) steps_left: u64,
    /// Onsets and knocks at known times, in falling order.
    events: Vec<Event>,
    thermal: Line,
    state: State,
}

#[derive(Debug, Clone, Copy)]
struct State {
    /// Platform against the inertial frame, which is local east, north, up at time zero.
    platform_c_inertial: Attitude,
    earth_angle: EarthAngle,
    moment: Moment,
    drift_deg_per_h: [f64; 3],
}

#[derive(Debug, Clone, Copy)]
struct Event {
    time_s: f64,
    /// The rotation vector of a knock, in platform axes.
    turn_rad: [f64; 3],
}

/// A temperature that is linear in time, with its rate and hysteresis.
#[derive(Debug, Clone, Copy)]
struct Line {
    start_s: f64,
    start: Thermal,
    /// Changes per second.
    change: Thermal,
}

impl Line {
    fn at(&self, time_s: f64) -> Thermal {
        let since_s = time_s - self.start_s;
        each(&self.start, &self.change, |start, change| {
            start + change * since_s
        })
    }

    /// From one value to another.
    fn between(start_s: f64, start: Thermal, end_s: f64, end: Thermal) -> Self {
        let duration_s = end_s - start_s;
        let change = each(&start, &end, |start, end| match duration_s > 0.0 {
            true => (end - start) / duration_s,
            false => 0.0,
        });
        Self {
            start_s,
            start,
            change,
        }
    }
}

/// Made of the same number of each.
fn each(one: &Thermal, other: &Thermal, of: impl Fn(f64, f64) -> f64) -> Thermal {
    Thermal {
        temperature_k: of(one.temperature_k, other.temperature_k),
        rate_k_per_h: of(one.rate_k_per_h, other.rate_k_per_h),
        hysteresis_k: of(one.hysteresis_k, other.hysteresis_k),
    }
}

impl<'a> Motion<'a> {
    /// A platform without hidden effects.
    pub(crate) fn new(platform: &Platform) -> Self {
        let law = DriftLaw::new(platform.coefficients, &[], &[]);
        let earth = EarthRotation::new(
            platform.latitude_deg,
            EARTH_RATE_RAD_PER_S,
            platform.specific_force_at_rest_g,
            None,
        );
        let initial = platform.initial_platform_c_enu;
        Self::start(initial, law, earth, Vec::new(), Thermal::default())
    }

    /// The platform of a scenario with its hidden effects.
    pub(crate) fn of(scenario: &Scenario, terms: &'a [Term], thermal: Thermal) -> Self {
        let platform = scenario.platform();
        let law = DriftLaw::new(platform.coefficients, &scenario.hidden, terms);
        let mut earth_rate = EARTH_RATE_RAD_PER_S;
        let turn_rad = [0.0; 3];
        let onsets = law.onsets_s();
        let mut events: Vec<Event> = onsets.map(|time_s| Event { time_s, turn_rad }).collect();
        for hidden in &scenario.hidden {
            match hidden.effect() {
                Effect::EarthRate => earth_rate *= 1.0 + hidden.value(0),
                Effect::Knock => events.push(Event {
                    time_s: hidden.value(3),
                    turn_rad: hidden.three().map(f64::to_radians),
                }),
                _ => {}
            }
        }
        events.sort_by(|a, b| b.time_s.total_cmp(&a.time_s));
        let earth = EarthRotation::new(
            platform.latitude_deg,
            earth_rate,
            platform.specific_force_at_rest_g,
            scenario.magnetic_field_gauss,
        );
        let initial = platform.initial_platform_c_enu;
        Self::start(initial, law, earth, events, thermal)
    }

    fn start(
        initial_platform_c_enu: Attitude,
        law: DriftLaw<'a>,
        earth: EarthRotation,
        events: Vec<Event>,
        thermal: Thermal,
    ) -> Self {
        let mut motion = Self {
            has_switches: law.has_switches(),
            steps_left: MOST_STEPS,
            longest_step_s: law.longest_step_s().min(LONGEST_STEP_S),
            state: State {
                platform_c_inertial: initial_platform_c_enu,
                earth_angle: earth.angle_at(0.0),
                moment: Moment::default(),
                drift_deg_per_h: [0.0; 3],
            },
            law,
            earth,
            events,
            thermal: Line::between(0.0, thermal, 0.0, thermal),
        };
        motion.update_modes();
        motion.apply_events();
        motion
    }

    /// The present moment as hidden effects depend on it; its time is true time since time zero.
    pub(crate) fn moment(&self) -> &Moment {
        &self.state.moment
    }

    /// The platform against local east, north, up now.
    pub(crate) fn platform_c_enu(&self) -> Attitude {
        let enu_c_inertial = self.earth.enu_c_inertial(self.state.earth_angle);
        self.state
            .platform_c_inertial
            .after(enu_c_inertial.inverse())
    }

    /// The platform's inertial rate in its own axes now \[deg/h\], for a drift of the gyros plus a
    /// held one.
    pub(crate) fn rate_deg_per_h(&self, held_deg_per_h: [f64; 3]) -> [f64; 3] {
        self.law
            .platform_rate(sum(self.state.drift_deg_per_h, held_deg_per_h))
    }

    /// Integrates to a later time with a held noise of the gyros and a temperature that changes
    /// linearly to the given one.
    ///
    /// # Errors
    ///
    /// [`Error::InvalidScenario`] if that takes too many steps.
    pub(crate) fn advance_to(
        &mut self,
        time_s: f64,
        noise_deg_per_h: [f64; 3],
        thermal: Thermal,
    ) -> Result<(), Error> {
        let now_s = self.state.moment.time_s;
        self.thermal = Line::between(now_s, self.thermal.at(now_s), time_s, thermal);
        while let Some(event) = self.events.last().filter(|event| event.time_s <= time_s) {
            let event_s = event.time_s;
            self.steps_to(event_s, noise_deg_per_h)?;
            self.apply_events();
        }
        self.steps_to(time_s, noise_deg_per_h)
    }

    fn state_at(
        &self,
        time_s: f64,
        earth_angle: EarthAngle,
        platform_c_inertial: Attitude,
    ) -> State {
        let moment = self.moment_at(time_s, earth_angle, platform_c_inertial);
        State {
            platform_c_inertial,
            earth_angle,
            moment,
            drift_deg_per_h: self.law.drift_deg_per_h(&moment),
        }
    }

    fn moment_at(
        &self,
        time_s: f64,
        earth_angle: EarthAngle,
        platform_c_inertial: Attitude,
    ) -> Moment {
        let field = self.earth.field_inertial_gauss(earth_angle);
        let thermal = self.thermal.at(time_s);
        Moment {
            time_s,
            accel_g: platform_c_inertial.resolve(self.earth.up_inertial_g(earth_angle)),
            temperature_k: thermal.temperature_k,
            temperature_rate_k_per_h: thermal.rate_k_per_h,
            temperature_hysteresis_k: thermal.hysteresis_k,
            field_gauss: field.map_or([0.0; 3], |field| platform_c_inertial.resolve(field)),
        }
    }

    /// Applies the events of the present time.
    fn apply_events(&mut self) {
        let now_s = self.state.moment.time_s;
        while let Some(event) = self.events.pop_if(|event| event.time_s <= now_s) {
            let turn = Attitude::turned_by(event.turn_rad);
            self.state.platform_c_inertial = turn.after(self.state.platform_c_inertial);
            self.update_modes();
        }
    }

    /// Sets the modes of the drift to the present ones.
    fn update_modes(&mut self) {
        let State {
            platform_c_inertial,
            earth_angle,
            moment,
            ..
        } = self.state;
        let moment = self.moment_at(moment.time_s, earth_angle, platform_c_inertial);
        self.law.update_modes(&moment);
        self.state = self.state_at(moment.time_s, earth_angle, platform_c_inertial);
    }
}

fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    core::array::from_fn(|i| a[i] + b[i])
}
