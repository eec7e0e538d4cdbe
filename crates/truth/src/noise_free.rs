//! The platform without noise: attitudes and ideal readings at given times.

use crate::attitude::Attitude;
use crate::motion::Motion;
use crate::platform::Platform;
use crate::temperature::Thermal;

impl Platform {
    /// Readings of ideal accelerometers in platform axes \[g\] at times since time zero.
    ///
    /// Times that rise are simulated in one pass; a time that goes back starts another.
    #[must_use]
    pub fn specific_force_g(&self, times_s: &[f64]) -> Vec<[f64; 3]> {
        self.at_times(times_s, |motion| motion.moment().accel_g)
    }

    /// The platform against local east, north, up at times since time zero.
    ///
    /// Times that rise are simulated in one pass; a time that goes back starts another.
    #[must_use]
    pub fn platform_c_enu(&self, times_s: &[f64]) -> Vec<Attitude> {
        self.at_times(times_s, |motion| motion.platform_c_enu())
    }

    fn at_times<T>(&self, times_s: &[f64], see: impl Fn(&Motion<'_>) -> T) -> Vec<T> {
        let mut motion = Motion::new(self);
        let advance = |time_s: &f64| {
            if *time_s < motion.moment().time_s {
                motion = Motion::new(self);
            }
            // A caller's platform takes the time that it takes.
            motion.steps_left = u64::MAX;
            let _ = motion.advance_to(*time_s, [0.0; 3], Thermal::default());
            see(&motion)
        };
        times_s.iter().map(advance).collect()
    }
}
