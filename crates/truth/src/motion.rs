//! The platform in motion: one quaternion carried through time.

use libm::sqrt;

use crate::attitude::{Attitude, dot, norm};
use crate::drift::DriftLaw;
use crate::effect::Effect;
use crate::platform::{EARTH_RATE_RAD_PER_S, Platform};
use crate::scenario::Scenario;
use crate::sky::{Hand, Sky};
use crate::term::{Moment, Term};

/// The longest step.
pub(crate) const LONGEST_STEP_S: f64 = 60.0;

/// The largest angle by which Earth and platform turn against each other in a step when the
/// drift is 1 deg/h; the Earth alone takes 0.0044 rad of it in 60 s. The error of a step is
/// proportional to the drift and to the fourth power of the angle, so with another drift the
/// angle goes with its inverse fourth root: below 1e-12 rad over days, whatever the drift.
const LARGEST_STEP_RAD: f64 = 0.011;

/// Up to this drift the limit on the angle makes no step shorter than [`LONGEST_STEP_S`].
const SLOW_DEG_PER_H: f64 = 5.0;

/// How closely the moment is found at which a mode of the drift changes.
const SWITCH_S: f64 = 1e-9;

/// The least time from one such moment to the next; where a drift drives the platform back
/// whenever it has crossed over, it hovers with this period.
const SHORTEST_MODE_S: f64 = 0.05;

const RAD_PER_S_PER_DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;

/// A platform at one moment.
#[derive(Debug)]
pub(crate) struct Motion<'a> {
    law: DriftLaw<'a>,
    has_switches: bool,
    sky: Sky,
    longest_step_s: f64,
    /// What happens at known times; the next one is the last.
    events: Vec<Event>,
    temperature: Line,
    state: State,
}

#[derive(Debug, Clone, Copy)]
struct State {
    /// The inertial frame is local east, north, up at time zero.
    platform_c_inertial: Attitude,
    hand: Hand,
    moment: Moment,
    drift_deg_per_h: [f64; 3],
}

#[derive(Debug, Clone, Copy)]
struct Event {
    time_s: f64,
    /// The rotation vector of a knock, in platform axes.
    turn_rad: [f64; 3],
}

/// A temperature that is linear in time.
#[derive(Debug, Clone, Copy)]
struct Line {
    start_s: f64,
    start_k: f64,
    k_per_s: f64,
}

impl<'a> Motion<'a> {
    /// A platform that is as it should be.
    pub(crate) fn new(platform: &Platform) -> Self {
        let law = DriftLaw::new(platform.coefficients, &[], &[]);
        let sky = Sky::new(
            platform.latitude_deg,
            EARTH_RATE_RAD_PER_S,
            platform.specific_force_at_rest_g,
            None,
        );
        Self::start(platform.initial_platform_c_enu, law, sky, Vec::new(), 0.0)
    }

    /// The platform of a scenario with all that is hidden in it.
    pub(crate) fn of(scenario: &Scenario, terms: &'a [Term], temperature_k: f64) -> Self {
        let platform = scenario.platform();
        let law = DriftLaw::new(platform.coefficients, &scenario.hidden, terms);
        let mut earth_rate = EARTH_RATE_RAD_PER_S;
        let mut events: Vec<Event> = law
            .onsets_s()
            .map(|time_s| Event {
                time_s,
                turn_rad: [0.0; 3],
            })
            .collect();
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
        let sky = Sky::new(
            platform.latitude_deg,
            earth_rate,
            platform.specific_force_at_rest_g,
            scenario.magnetic_field_gauss,
        );
        let initial = platform.initial_platform_c_enu;
        Self::start(initial, law, sky, events, temperature_k)
    }

    fn start(
        initial_platform_c_enu: Attitude,
        law: DriftLaw<'a>,
        sky: Sky,
        events: Vec<Event>,
        temperature_k: f64,
    ) -> Self {
        let mut motion = Self {
            has_switches: law.has_switches(),
            longest_step_s: law.longest_step_s().min(LONGEST_STEP_S),
            state: State {
                platform_c_inertial: initial_platform_c_enu,
                hand: sky.hand_at(0.0),
                moment: Moment::default(),
                drift_deg_per_h: [0.0; 3],
            },
            law,
            sky,
            events,
            temperature: Line {
                start_s: 0.0,
                start_k: temperature_k,
                k_per_s: 0.0,
            },
        };
        motion.settle();
        motion.meet_events();
        motion
    }

    /// The moment, as hidden effects see it; its time is true time since time zero.
    pub(crate) fn moment(&self) -> &Moment {
        &self.state.moment
    }

    /// The platform against local east, north, up now.
    pub(crate) fn platform_c_enu(&self) -> Attitude {
        let enu_c_inertial = self.sky.enu_c_inertial(self.state.hand);
        self.state
            .platform_c_inertial
            .after(enu_c_inertial.inverse())
    }

    /// The platform's inertial rate in its own axes now \[deg/h\], with something held that is
    /// added to the drift of the gyros.
    pub(crate) fn rate_deg_per_h(&self, held_deg_per_h: [f64; 3]) -> [f64; 3] {
        self.law
            .platform_rate(sum(self.state.drift_deg_per_h, held_deg_per_h))
    }

    /// Goes on to a later time, with a noise of the gyros that is held so long and to a
    /// temperature that is reached linearly.
    pub(crate) fn advance_to(
        &mut self,
        time_s: f64,
        noise_deg_per_h: [f64; 3],
        temperature_k: f64,
    ) {
        let now = &self.state.moment;
        let duration_s = time_s - now.time_s;
        self.temperature = Line {
            start_s: now.time_s,
            start_k: now.temperature_k,
            k_per_s: if duration_s > 0.0 {
                (temperature_k - now.temperature_k) / duration_s
            } else {
                0.0
            },
        };
        while let Some(event) = self.events.last().filter(|event| event.time_s <= time_s) {
            let event_s = event.time_s;
            self.steps_to(event_s, noise_deg_per_h);
            self.meet_events();
        }
        self.steps_to(time_s, noise_deg_per_h);
    }

    /// Equal steps, through which every step of the drift is on or off.
    fn steps_to(&mut self, time_s: f64, noise_deg_per_h: [f64; 3]) {
        let start_s = self.state.moment.time_s;
        let duration_s = time_s - start_s;
        let rate = self.rate_deg_per_h(noise_deg_per_h);
        let longest_s = if dot(rate, rate) < SLOW_DEG_PER_H * SLOW_DEG_PER_H {
            self.longest_step_s
        } else {
            self.longest_step_s.min(longest_step_s(norm(rate)))
        };
        // Times on a grid are rounded: a millionth of a millionth more is no reason for two
        // steps. `as` saturates: a time that is not a number takes no step.
        let steps = (duration_s / longest_s - 1e-9).ceil().max(0.0) as u64;
        let steps = if duration_s > 0.0 { steps.max(1) } else { 0 };
        for step in 1..=steps {
            let end_s = if step == steps {
                time_s
            } else {
                start_s + duration_s * (step as f64 / steps as f64)
            };
            if self.has_switches {
                self.switching_step_to(end_s, noise_deg_per_h);
            } else {
                self.state = self.stepped(end_s, noise_deg_per_h);
            }
        }
    }

    /// Steps that end where a mode of the drift changes.
    fn switching_step_to(&mut self, end_s: f64, noise_deg_per_h: [f64; 3]) {
        while self.state.moment.time_s < end_s {
            let mut after = self.stepped(end_s, noise_deg_per_h);
            let switched = self.law.switched(&after.moment);
            if switched {
                after = self.first_switch(after, noise_deg_per_h);
            }
            self.state = after;
            if switched {
                self.settle();
            }
        }
    }

    /// The first state found with another mode, by halving the step to a state that has one.
    fn first_switch(&self, mut after: State, noise_deg_per_h: [f64; 3]) -> State {
        let mut before_s = self.state.moment.time_s;
        let shortest_s = before_s + SHORTEST_MODE_S;
        if shortest_s < after.moment.time_s {
            let short = self.stepped(shortest_s, noise_deg_per_h);
            if self.law.switched(&short.moment) {
                return short;
            }
            before_s = shortest_s;
        }
        while after.moment.time_s - before_s > SWITCH_S {
            let middle_s = 0.5 * (before_s + after.moment.time_s);
            let middle = self.stepped(middle_s, noise_deg_per_h);
            if self.law.switched(&middle.moment) {
                after = middle;
            } else {
                before_s = middle_s;
            }
        }
        after
    }

    /// One step of the classical Runge–Kutta rule.
    fn stepped(&self, end_s: f64, noise_deg_per_h: [f64; 3]) -> State {
        let start_s = self.state.moment.time_s;
        let step_s = end_s - start_s;
        let middle_s = start_s + 0.5 * step_s;
        let middle = self.sky.hand_at(middle_s);
        let end = self.sky.hand_at(end_s);
        let start = self.state.platform_c_inertial;
        // The servo loops hold the platform to the gyros: its inertial rate is their drift.
        let slope = |drift: [f64; 3], attitude: Attitude| {
            let rate = self.law.platform_rate(sum(drift, noise_deg_per_h));
            attitude.derivative(rate.map(|rate| rate * RAD_PER_S_PER_DEG_PER_H))
        };
        let slope_at = |time_s: f64, hand: Hand, attitude: Attitude| {
            let moment = self.moment_at(time_s, hand, attitude);
            slope(self.law.drift_deg_per_h(&moment), attitude)
        };
        let k1 = slope(self.state.drift_deg_per_h, start);
        let k2 = slope_at(middle_s, middle, start.moved(0.5 * step_s, k1));
        let k3 = slope_at(middle_s, middle, start.moved(0.5 * step_s, k2));
        let k4 = slope_at(end_s, end, start.moved(step_s, k3));
        let mean = [0, 1, 2, 3].map(|i| k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        self.state_at(end_s, end, start.moved(step_s / 6.0, mean).normalised())
    }

    fn state_at(&self, time_s: f64, hand: Hand, platform_c_inertial: Attitude) -> State {
        let moment = self.moment_at(time_s, hand, platform_c_inertial);
        State {
            platform_c_inertial,
            hand,
            moment,
            drift_deg_per_h: self.law.drift_deg_per_h(&moment),
        }
    }

    fn moment_at(&self, time_s: f64, hand: Hand, platform_c_inertial: Attitude) -> Moment {
        let field = self.sky.field_inertial_gauss(hand);
        let line = &self.temperature;
        Moment {
            time_s,
            accel_g: platform_c_inertial.resolve(self.sky.up_inertial_g(hand)),
            temperature_k: line.start_k + line.k_per_s * (time_s - line.start_s),
            field_gauss: field.map_or([0.0; 3], |field| platform_c_inertial.resolve(field)),
        }
    }

    /// Takes part in all that happens now.
    fn meet_events(&mut self) {
        let now_s = self.state.moment.time_s;
        while let Some(event) = self.events.pop_if(|event| event.time_s <= now_s) {
            let turn = Attitude::turned_by(event.turn_rad);
            self.state.platform_c_inertial = turn.after(self.state.platform_c_inertial);
            self.settle();
        }
    }

    /// Takes the modes of the drift that are right from now on.
    fn settle(&mut self) {
        let State {
            platform_c_inertial,
            hand,
            moment,
            ..
        } = self.state;
        let moment = self.moment_at(moment.time_s, hand, platform_c_inertial);
        self.law.settle(&moment);
        self.state = self.state_at(moment.time_s, hand, platform_c_inertial);
    }
}

/// The longest step at an inertial rate of the platform.
fn longest_step_s(rate_deg_per_h: f64) -> f64 {
    let against_earth = EARTH_RATE_RAD_PER_S + rate_deg_per_h * RAD_PER_S_PER_DEG_PER_H;
    LARGEST_STEP_RAD / (against_earth * sqrt(sqrt(rate_deg_per_h)))
}

fn sum(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + b[i])
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::expect_used)]
mod tests {
    use super::*;
    use crate::coefficients::Coefficients;

    const DAY_S: f64 = 86_400.0;

    fn after(days: f64, longest_step_s: f64, times: f64) -> Attitude {
        let three = |values: [f64; 3]| values.map(|value| value * times);
        let paper = Coefficients::PAPER_LIKE;
        let platform = Platform {
            latitude_deg: 39.1,
            specific_force_at_rest_g: 1.0,
            coefficients: Coefficients {
                bias_deg_per_h: three(paper.bias_deg_per_h),
                g_deg_per_h_per_g: three(paper.g_deg_per_h_per_g),
                gg_deg_per_h_per_g2: three(paper.gg_deg_per_h_per_g2),
            },
            initial_platform_c_enu: Attitude::from_angles_rad([0.3, -0.5, 1.1]),
        };
        let mut motion = Motion::new(&platform);
        motion.longest_step_s = longest_step_s;
        let steps = (days * DAY_S / longest_step_s).ceil();
        // Through the single steps, so that no other limit makes them shorter.
        for step in 1..=(steps as u32) {
            let end_s = days * DAY_S * f64::from(step) / steps;
            motion.state = motion.stepped(end_s, [0.0; 3]);
        }
        motion.state.platform_c_inertial
    }

    fn distance_rad(a: Attitude, b: Attitude) -> f64 {
        norm(a.rotation_from_rad(b))
    }

    #[test]
    fn halving_a_coarse_step_divides_the_error_by_sixteen() {
        // Coarse, because at fine steps there is nothing left but rounding.
        let exact = after(2.0, 60.0, 1.0);
        let coarse = distance_rad(after(2.0, 3600.0, 1.0), exact);
        let half = distance_rad(after(2.0, 1800.0, 1.0), exact);
        // The next order makes up to a quarter of the error at an hour a step.
        assert!(
            (12.0..20.0).contains(&(coarse / half)),
            "{coarse:e} / {half:e}"
        );
    }

    #[test]
    fn the_usual_step_is_exact_to_rounding_over_five_days() {
        let difference = distance_rad(after(5.0, LONGEST_STEP_S, 1.0), after(5.0, 2.5, 1.0));
        // 170 000 fine steps of 1e-16 each, added like a random walk with a small bias.
        assert!(difference < 1e-12, "{difference:e}");
    }

    #[test]
    fn a_platform_that_drifts_fast_is_stepped_finely_enough() {
        // 30 times the usual drift, up to 42 deg/h in all.
        let step_s = longest_step_s(30.0 * 1.4);
        assert!(step_s < LONGEST_STEP_S);
        assert!(longest_step_s(SLOW_DEG_PER_H) > LONGEST_STEP_S);
        let difference = distance_rad(after(3.0, step_s, 30.0), after(3.0, 5.0, 30.0));
        // What the simulator promises.
        assert!(difference < 1e-12, "{difference:e}");
    }

    #[test]
    fn the_quaternion_keeps_its_length() {
        // One rounding of the last normalisation.
        let length = after(5.0, LONGEST_STEP_S, 1.0).length();
        assert!((length - 1.0).abs() < 4.0 * f64::EPSILON);
    }
}
