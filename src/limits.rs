use gyrocal_estimation::Precision;

/// Largest NIS of a sample that is taken, unless set otherwise: the value that χ² of three degrees of
/// freedom exceeds with a probability of 1.9e-7, once in the 5 259 600 samples of ten years at one a
/// minute. The innovations of a sound record are independent, so it loses one good sample in ten years;
/// at one sample a second one in two months, which costs as little.
const LARGEST_NIS: f64 = 34.084_7;

/// Limits of what a controller hands to its filter: what is beyond is refused.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits<T> {
    /// Largest reading of an accelerometer, g: beyond its range it says nothing.
    pub largest_force_g: T,
    /// Longest interval of a call, s: a longer one is taken for an error of the clock.
    pub longest_interval_s: T,
    /// Largest normalised innovation squared of a sample of three components: one beyond it is not
    /// taken. Infinite: every sample is.
    pub largest_nis: T,
}

impl<T: Precision> Default for Limits<T> {
    /// 2 g, an hour, and a NIS of 34.08, which a sound record exceeds once in ten years at one sample a
    /// minute.
    fn default() -> Self {
        Self {
            largest_force_g: T::from_f64(2.0),
            longest_interval_s: T::from_f64(3600.0),
            largest_nis: T::from_f64(LARGEST_NIS),
        }
    }
}

impl<T: Precision> Limits<T> {
    /// The limits of a filter that has not started.
    pub(crate) const NONE: Self = Self {
        largest_force_g: T::ZERO,
        longest_interval_s: T::ZERO,
        largest_nis: T::ZERO,
    };

    /// True if all are positive; infinite ones are.
    pub(crate) fn are_positive(&self) -> bool {
        self.largest_force_g.is_positive()
            && self.longest_interval_s.is_positive()
            && self.largest_nis.is_positive()
    }
}

/// Samples that were too surprising, for a time to be judged by.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Surprises<T> {
    /// All since the start.
    pub(crate) count: u32,
    /// Those in a row, and the time that has passed with them, s.
    in_a_row: u32,
    time_s: T,
}

/// Time of surprising samples in a row after which it is the filter that is wrong, s.
const DIVERGED_S: f64 = 3600.0;
/// Their least number, so that one wild sample of an hourly record is none of an hour of them.
const DIVERGED_SAMPLES: u32 = 10;

impl<T: Precision> Surprises<T> {
    /// No sample yet.
    pub(crate) const NONE: Self = Self {
        count: 0,
        in_a_row: 0,
        time_s: T::ZERO,
    };

    /// A sample was taken.
    #[inline(always)]
    pub(crate) fn end(&mut self) {
        self.in_a_row = 0;
        self.time_s = T::ZERO;
    }

    /// Another one, at the end of an interval.
    #[cold]
    pub(crate) fn add(&mut self, interval_s: T) {
        self.count = self.count.saturating_add(1);
        self.in_a_row = self.in_a_row.saturating_add(1);
        self.time_s = self.time_s + interval_s;
    }

    /// True once the filter is more likely wrong than the samples.
    pub(crate) fn have_diverged(&self) -> bool {
        self.in_a_row >= DIVERGED_SAMPLES && self.time_s >= T::from_f64(DIVERGED_S)
    }
}
