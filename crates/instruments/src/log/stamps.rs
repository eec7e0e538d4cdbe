//! What time stamps may not be, and what to do about it.

use super::{GAP, LONGEST_JITTER, Log};
use crate::error::{InstrumentError, Unfit};

impl Log {
    /// Refuses stamps that repeat, and intervals that are no jitter.
    pub(super) fn refuse_long_gaps(&self) -> Result<(), InstrumentError> {
        let longest_s = LONGEST_JITTER * self.interval_s;
        if self.time_s.windows(2).any(|pair| pair[1] <= pair[0]) {
            return Err(InstrumentError::unfit(
                Unfit::Jitter,
                "time stamps that repeat",
                "times that rise",
                "stamps of packets are no times of samples: leave out `jitter`, or give `rate_hz` in \
                 place of the time column",
            ));
        }
        match self
            .time_s
            .windows(2)
            .position(|pair| pair[1] - pair[0] > longest_s)
        {
            Some(at) => Err(self.gap([at, at + 1])),
            None => Ok(()),
        }
    }

    /// The error of missing samples among those between two numbers.
    pub(super) fn gap(&self, [from, to]: [usize; 2]) -> InstrumentError {
        let interval_s = |at: &usize| self.time_s[at + 1] - self.time_s[*at];
        let longer = |a: &usize, b: &usize| interval_s(a).total_cmp(&interval_s(b));
        let first = (from..to).max_by(longer).unwrap_or(from);
        let gaps = self
            .time_s
            .windows(2)
            .filter(|pair| pair[1] - pair[0] > GAP * self.interval_s)
            .count();
        if gaps == 0 {
            return self.no_steady_clock();
        }
        InstrumentError::unfit(
            Unfit::Gap,
            format!(
                "{gaps} gap(s) in the time stamps, the longest there of {:.4} s after {} s",
                interval_s(&first),
                self.time_s[first]
            ),
            format!("a sample every {:.4} s", self.interval_s),
            "cut the log at the gap, since rotation that was not recorded cannot be integrated; if \
             the clock is wrong and not the samples, give `rate_hz` in place of the time column; if the \
             sensor samples at such intervals, `jitter = \"use\"` or `\"resample\"`",
        )
    }

    /// The error of stamps that no steady clock gives, though none of their intervals is long: repeated rows, or a rate that
    /// changes.
    fn no_steady_clock(&self) -> InstrumentError {
        let repeats = |pair: &[f64]| pair[1] == pair[0];
        let first = self.time_s.windows(2).position(repeats);
        let Some(first) = first else {
            return InstrumentError::unfit(
                Unfit::Jitter,
                "time stamps without a gap that no steady clock gives",
                format!("a sample every {:.4} s", self.interval_s),
                "if the rate changes, cut the log there; if the clock is wrong and not the samples, give `rate_hz` in \
                 place of the time column; if the sensor samples at such intervals, `jitter = \"use\"` or \
                 `\"resample\"`",
            );
        };
        let count = self.time_s.windows(2).filter(|pair| repeats(pair)).count();
        let same = |at: usize| {
            let force = self.accel.as_ref();
            self.gyro[at] == self.gyro[at + 1]
                && force.is_none_or(|force| force[at] == force[at + 1])
        };
        let (what, advice) = if same(first) {
            (
                "rows with the stamp and the values of the row before",
                "keep one row of each stamp",
            )
        } else {
            (
                "rows with the stamp of the row before and other values",
                "if the log holds samples twice, keep one row of each stamp; if several samples share a stamp and none is \
                 missing, give `rate_hz` in place of the time column",
            )
        };
        InstrumentError::unfit(
            Unfit::Jitter,
            format!(
                "{count} {what}, the first in row {} at {} s, in a part of the log",
                first + 2,
                self.time_s[first]
            ),
            "a stamp for each sample",
            advice,
        )
    }
}
