//! The platform in motion: one quaternion carried through time.

use crate::attitude::Attitude;
use crate::platform::Platform;
use crate::term::{Moment, Term};

/// The longest step. At 10 s the error over five days is near 1e-14 rad: the drift changes
/// with the Earth's turn (7e-4 rad a step), to the fifth power a step.
pub(crate) const LONGEST_STEP_S: f64 = 10.0;

const RAD_PER_S_PER_DEG_PER_H: f64 = core::f64::consts::PI / 180.0 / 3600.0;

/// A platform at one moment.
#[derive(Debug)]
pub(crate) struct Motion<'a> {
    platform: &'a Platform,
    terms: &'a [Term],
    earth_rate_enu_rad_per_s: [f64; 3],
    longest_step_s: f64,
    time_s: f64,
    /// The inertial frame is local east, north, up at time zero.
    platform_c_inertial: Attitude,
    up_inertial: [f64; 3],
}

impl<'a> Motion<'a> {
    pub(crate) fn new(platform: &'a Platform, terms: &'a [Term]) -> Self {
        Self::with_longest_step(platform, terms, LONGEST_STEP_S)
    }

    pub(crate) fn with_longest_step(
        platform: &'a Platform,
        terms: &'a [Term],
        longest_step_s: f64,
    ) -> Self {
        let mut motion = Self {
            platform,
            terms,
            earth_rate_enu_rad_per_s: platform.earth_rate_enu_rad_per_s(),
            longest_step_s,
            time_s: 0.0,
            platform_c_inertial: platform.initial_platform_c_enu,
            up_inertial: [0.0; 3],
        };
        motion.up_inertial = motion.up_inertial_at(0.0);
        motion
    }

    /// True time since time zero.
    pub(crate) fn time_s(&self) -> f64 {
        self.time_s
    }

    /// What ideal accelerometers read now, in platform axes \[g\].
    pub(crate) fn specific_force_g(&self) -> [f64; 3] {
        self.platform_c_inertial.resolve(self.up_inertial)
    }

    /// The platform against local east, north, up now.
    pub(crate) fn platform_c_enu(&self) -> Attitude {
        let enu_c_inertial = self.enu_c_inertial_at(self.time_s);
        self.platform_c_inertial.after(enu_c_inertial.inverse())
    }

    /// The moment, as hidden effects see it.
    pub(crate) fn moment(&self) -> Moment {
        Moment {
            time_s: self.time_s,
            accel_g: self.specific_force_g(),
        }
    }

    /// Drift of the gyros at a moment, without noise \[deg/h\].
    pub(crate) fn drift_deg_per_h(&self, moment: &Moment) -> [f64; 3] {
        let mut drift = self.platform.coefficients.drift_deg_per_h(moment.accel_g);
        for term in self.terms {
            if let Term::Drift(added) = term {
                let added = added(moment);
                drift = [0, 1, 2].map(|gyro| drift[gyro] + added[gyro]);
            }
        }
        drift
    }

    /// Goes on to a later time in equal steps, with a noise of the gyros that is held so long.
    pub(crate) fn advance_to(&mut self, time_s: f64, noise_deg_per_h: [f64; 3]) {
        let duration_s = time_s - self.time_s;
        // `as` saturates: a time that is not a number takes no step.
        let steps = (duration_s / self.longest_step_s).ceil().max(0.0) as u64;
        let start_s = self.time_s;
        for step in 1..=steps {
            let end_s = start_s + duration_s * (step as f64 / steps as f64);
            self.step_to(end_s, noise_deg_per_h);
        }
    }

    /// One step of the classical Runge–Kutta rule.
    fn step_to(&mut self, end_s: f64, noise_deg_per_h: [f64; 3]) {
        let (start_s, step_s) = (self.time_s, end_s - self.time_s);
        let middle_s = start_s + 0.5 * step_s;
        let up_middle = self.up_inertial_at(middle_s);
        let up_end = self.up_inertial_at(end_s);
        let start = self.platform_c_inertial;
        let slope = |time_s: f64, up_inertial: [f64; 3], attitude: Attitude| {
            let moment = Moment {
                time_s,
                accel_g: attitude.resolve(up_inertial),
            };
            let drift = self.drift_deg_per_h(&moment);
            // The servo loops hold the platform to the gyros: its inertial rate is their drift.
            attitude.derivative(
                [0, 1, 2]
                    .map(|gyro| (drift[gyro] + noise_deg_per_h[gyro]) * RAD_PER_S_PER_DEG_PER_H),
            )
        };
        let k1 = slope(start_s, self.up_inertial, start);
        let k2 = slope(middle_s, up_middle, start.moved(0.5 * step_s, k1));
        let k3 = slope(middle_s, up_middle, start.moved(0.5 * step_s, k2));
        let k4 = slope(end_s, up_end, start.moved(step_s, k3));
        let sum = [0, 1, 2, 3].map(|i| k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]);
        self.platform_c_inertial = start.moved(step_s / 6.0, sum).normalised();
        self.time_s = end_s;
        self.up_inertial = up_end;
    }

    fn enu_c_inertial_at(&self, time_s: f64) -> Attitude {
        Attitude::turned_by(self.earth_rate_enu_rad_per_s.map(|rate| rate * time_s))
    }

    /// Specific force at rest points up; up turns with the Earth.
    fn up_inertial_at(&self, time_s: f64) -> [f64; 3] {
        let up_enu = [0.0, 0.0, self.platform.specific_force_at_rest_g];
        self.enu_c_inertial_at(time_s).inverse().resolve(up_enu)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, clippy::expect_used)]
mod tests {
    use super::*;
    use crate::coefficients::Coefficients;

    const DAY_S: f64 = 86_400.0;

    fn after(days: f64, longest_step_s: f64) -> Attitude {
        let platform = Platform {
            latitude_deg: 39.1,
            specific_force_at_rest_g: 1.0,
            coefficients: Coefficients::PAPER_LIKE,
            initial_platform_c_enu: Attitude::from_angles_rad([0.3, -0.5, 1.1]),
        };
        let mut motion = Motion::with_longest_step(&platform, &[], longest_step_s);
        motion.advance_to(days * DAY_S, [0.0; 3]);
        motion.platform_c_inertial
    }

    fn distance_rad(a: Attitude, b: Attitude) -> f64 {
        crate::attitude::norm(a.rotation_from_rad(b))
    }

    #[test]
    fn halving_a_coarse_step_divides_the_error_by_sixteen() {
        // Coarse, because at fine steps there is nothing left but rounding.
        let exact = after(2.0, 60.0);
        let coarse = distance_rad(after(2.0, 3600.0), exact);
        let half = distance_rad(after(2.0, 1800.0), exact);
        // The next order makes up to a quarter of the error at an hour a step.
        assert!(
            (12.0..20.0).contains(&(coarse / half)),
            "{coarse:e} / {half:e}"
        );
    }

    #[test]
    fn the_usual_step_is_exact_to_rounding_over_five_days() {
        let difference = distance_rad(after(5.0, LONGEST_STEP_S), after(5.0, 2.5));
        // 170 000 fine steps of 1e-16 each, added like a random walk with a small bias.
        assert!(difference < 1e-12, "{difference:e}");
    }

    #[test]
    fn the_quaternion_keeps_its_length() {
        // One rounding of the last normalisation.
        assert!((after(5.0, LONGEST_STEP_S).length() - 1.0).abs() < 4.0 * f64::EPSILON);
    }
}
