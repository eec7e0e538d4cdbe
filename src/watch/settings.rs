use gyrocal_estimation::Precision;
use gyrocal_watch::{Budget, Settings};

/// Hours of a year, of which false alarms are counted.
const YEAR_H: f64 = 8766.0;
/// Steps between two onsets of jumps.
const SPAN_STEPS: u32 = 4;

/// Settings of a watch beside the filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WatchSettings<T> {
    /// Largest probability of a false alarm in a year of samples, of all effects and jumps together.
    pub false_alarms_per_year: T,
    /// The probability holds for ever and not for each year.
    pub for_ever: bool,
    /// Time between two samples, s; the filter is told the time of each.
    pub interval_s: T,
    /// Time between two onsets, s: a block.
    pub block_s: T,
    /// Random walk of the drift of each gyro, deg/h/√h, which filter and watch expect.
    pub walk_deg_per_h_per_sqrt_h: [T; 3],
    /// Largest standardised innovation that filter and watch take; larger ones count as this one.
    pub clip: T,
    /// Deviance within which effects cannot be told apart; beside a third of the largest one.
    pub set_width: T,
    /// Standard deviation of the sizes that are looked for, in units of the sigma that a day of
    /// samples leaves of them.
    pub sought_sigmas: T,
    /// Standard deviation of the jumps that are looked for, rad.
    pub sought_jump_rad: T,
}

impl<T: Precision> Default for WatchSettings<T> {
    /// A false alarm in a hundred years, samples of a minute, blocks of two hours, a walk of
    /// 1e-5 deg/h/√h, innovations up to 3.
    fn default() -> Self {
        let number = T::from_f64;
        Self {
            false_alarms_per_year: number(0.01),
            for_ever: false,
            interval_s: number(60.0),
            block_s: number(7200.0),
            walk_deg_per_h_per_sqrt_h: [number(1e-5); 3],
            clip: number(3.0),
            set_width: number(9.0),
            sought_sigmas: number(4.0),
            sought_jump_rad: number(4e-5),
        }
    }
}

impl<T: Precision> WatchSettings<T> {
    /// True if every setting has a meaning.
    pub(crate) fn is_valid(&self) -> bool {
        let positive = [
            self.false_alarms_per_year,
            self.interval_s,
            self.block_s,
            self.clip,
            self.set_width,
            self.sought_sigmas,
            self.sought_jump_rad,
        ];
        let walks = &self.walk_deg_per_h_per_sqrt_h;
        positive
            .iter()
            .all(|number| number.is_positive() && number.is_finite())
            && walks
                .iter()
                .all(|walk| *walk >= T::ZERO && walk.is_finite())
    }

    /// Settings of the test. `information_of_a_day` is that on each size.
    #[must_use]
    pub fn of_test<const E: usize>(&self, information_of_a_day: [T; E]) -> Settings<T, E, 3> {
        let block_steps = (self.block_s / self.interval_s + T::from_f64(0.5)).to_u32();
        let steps_per_year = T::from_f64(3600.0 * YEAR_H) / self.interval_s;
        let budget = |steps: u32| Budget {
            // Half for the effects, half for jumps.
            alpha: T::from_f64(0.5) * self.false_alarms_per_year,
            onsets_per_year: steps_per_year / T::from_u32(steps.max(1)),
            for_ever: self.for_ever,
        };
        let scale = T::from_f64(1.0) / (self.sought_sigmas * self.sought_sigmas);
        Settings {
            block_steps,
            span_steps: SPAN_STEPS,
            precision: information_of_a_day.map(|information| information * scale),
            jump_precision: [T::from_f64(1.0) / (self.sought_jump_rad * self.sought_jump_rad); 3],
            budget: budget(block_steps),
            jump_budget: budget(SPAN_STEPS),
        }
    }
}
