//! Integration of the attitude: Runge-Kutta steps that end where a mode of the drift changes.

use super::{Motion, State, sum};
use crate::attitude::{Attitude, dot, norm};
use crate::earth_rotation::EarthAngle;
use crate::error::Error;
use crate::platform::EARTH_RATE_RAD_PER_S;

/// Longest step, s.
pub(crate) const LONGEST_STEP_S: f64 = 60.0;

/// Most steps of a motion: about a minute. A hundred years at [`LONGEST_STEP_S`] take a quarter of them.
pub(super) const MOST_STEPS: u64 = 200_000_000;

/// Largest relative rotation of Earth and platform in a step at a drift of 1 deg/h, rad; the Earth
/// alone contributes 0.0044 rad in 60 s. The error of a step is proportional to the drift and to the
/// fourth power of the angle, so the angle scales with the inverse fourth root of the drift: the
/// error stays below 1e-12 rad over days for any drift.
const LARGEST_STEP_RAD: f64 = 0.011;

/// Drift below which the limit on the angle makes no step shorter than [`LONGEST_STEP_S`].
const SLOW_DEG_PER_H: f64 = 5.0;

/// Precision of the time at which a mode of the drift changes, s.
const SWITCH_S: f64 = 1e-9;

/// Least time between two mode changes, s; where a drift drives the platform back after each
/// crossing, the modes alternate with this period.
const SHORTEST_MODE_S: f64 = 0.05;

const RAD_PER_S_PER_DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;

impl Motion<'_> {
    /// Integrates in equal steps over an interval in which no onset falls.
    pub(super) fn steps_to(&mut self, time_s: f64, noise_deg_per_h: [f64; 3]) -> Result<(), Error> {
        let start_s = self.state.moment.time_s;
        let duration_s = time_s - start_s;
        let rate = self.rate_deg_per_h(noise_deg_per_h);
        let longest_s = match dot(rate, rate) < SLOW_DEG_PER_H * SLOW_DEG_PER_H {
            true => self.longest_step_s,
            false => self.longest_step_s.min(longest_step_s(norm(rate))),
        };
        // Times on a grid are rounded: a millionth of a millionth more is no reason for two
        // steps. `as` saturates: a time that is not a number takes no step.
        let steps = (duration_s / longest_s - 1e-9).ceil().max(0.0) as u64;
        let steps = if duration_s > 0.0 { steps.max(1) } else { 0 };
        self.take_steps(steps, rate)?;
        for step in 1..=steps {
            let end_s = match step == steps {
                true => time_s,
                false => start_s + duration_s * (step as f64 / steps as f64),
            };
            match self.has_switches {
                true => self.switching_step_to(end_s, noise_deg_per_h)?,
                false => self.state = self.stepped(end_s, noise_deg_per_h),
            }
        }
        Ok(())
    }

    /// Counts steps at an inertial rate of the platform \[deg/h\].
    fn take_steps(&mut self, steps: u64, rate: [f64; 3]) -> Result<(), Error> {
        let left = self.steps_left.checked_sub(steps);
        self.steps_left = left.ok_or_else(|| Error::InvalidScenario {
            name: "drift",
            found: format!(
                "{:.3e} deg/h at {:.0} s, of which a step goes over {:.1e} s at most: more than {MOST_STEPS} steps",
                norm(rate),
                self.state.moment.time_s,
                self.longest_step_s,
            ),
            expected: "slower drifts, longer periods, or a shorter record".to_owned(),
        })?;
        Ok(())
    }

    /// Integrates to a time in steps that end where a mode of the drift changes.
    fn switching_step_to(&mut self, end_s: f64, noise_deg_per_h: [f64; 3]) -> Result<(), Error> {
        while self.state.moment.time_s < end_s {
            let mut after = self.stepped(end_s, noise_deg_per_h);
            let switched = self.law.mode_changed(&after.moment);
            if switched {
                self.take_steps(1, self.state.drift_deg_per_h)?;
                after = self.first_switch(after, noise_deg_per_h);
            }
            self.state = after;
            if switched {
                self.update_modes();
            }
        }
        Ok(())
    }

    /// The first state found with another mode, by halving the step to a state that has one.
    fn first_switch(&self, mut after: State, noise_deg_per_h: [f64; 3]) -> State {
        let mut before_s = self.state.moment.time_s;
        let shortest_s = before_s + SHORTEST_MODE_S;
        if shortest_s < after.moment.time_s {
            let short = self.stepped(shortest_s, noise_deg_per_h);
            if self.law.mode_changed(&short.moment) {
                return short;
            }
            before_s = shortest_s;
        }
        while after.moment.time_s - before_s > SWITCH_S {
            let middle_s = 0.5 * (before_s + after.moment.time_s);
            let middle = self.stepped(middle_s, noise_deg_per_h);
            match self.law.mode_changed(&middle.moment) {
                true => after = middle,
                false => before_s = middle_s,
            }
        }
        after
    }

    /// One step of the classical Runge–Kutta rule.
    fn stepped(&self, end_s: f64, noise_deg_per_h: [f64; 3]) -> State {
        let start_s = self.state.moment.time_s;
        let step_s = end_s - start_s;
        let middle_s = start_s + 0.5 * step_s;
        let middle = self.earth.angle_at(middle_s);
        let end = self.earth.angle_at(end_s);
        let start = self.state.platform_c_inertial;
        // The servo loops hold the platform to the gyros: its inertial rate is their drift.
        let slope = |drift: [f64; 3], attitude: Attitude| {
            let rate = self.law.platform_rate(sum(drift, noise_deg_per_h));
            attitude.derivative(rate.map(|rate| rate * RAD_PER_S_PER_DEG_PER_H))
        };
        let slope_at = |time_s: f64, earth_angle: EarthAngle, attitude: Attitude| {
            let moment = self.moment_at(time_s, earth_angle, attitude);
            slope(self.law.drift_deg_per_h(&moment), attitude)
        };
        let k1 = slope(self.state.drift_deg_per_h, start);
        let k2 = slope_at(middle_s, middle, start.moved(0.5 * step_s, k1));
        let k3 = slope_at(middle_s, middle, start.moved(0.5 * step_s, k2));
        let k4 = slope_at(end_s, end, start.moved(step_s, k3));
        let mean = [0, 1, 2, 3].map(|i| k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        self.state_at(end_s, end, start.moved(step_s / 6.0, mean).normalised())
    }
}

/// The longest step at an inertial rate of the platform.
fn longest_step_s(rate_deg_per_h: f64) -> f64 {
    let against_earth = EARTH_RATE_RAD_PER_S + rate_deg_per_h * RAD_PER_S_PER_DEG_PER_H;
    LARGEST_STEP_RAD / (against_earth * rate_deg_per_h.sqrt().sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::coefficients::Coefficients;
    use crate::platform::Platform;

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
        let ratio = coarse / half;
        assert!((12.0..20.0).contains(&ratio), "{coarse:e} / {half:e}");
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
        // The accuracy that the crate documentation states.
        assert!(difference < 1e-12, "{difference:e}");
    }

    #[test]
    fn the_quaternion_keeps_its_length() {
        // One rounding of the last normalisation.
        let length = after(5.0, LONGEST_STEP_S, 1.0).length();
        assert!((length - 1.0).abs() < 4.0 * f64::EPSILON);
    }
}
