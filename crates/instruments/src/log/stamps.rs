//! What time stamps may not be, and what to do about it.

use gyrocal_record::InputErrorKind;

use super::{GAP, LONGEST_JITTER, Log};
use crate::clock::Rounded;
use crate::columns::FileColumns;
use crate::error::{InstrumentError, Unfit};

/// By how much a clock that is set by hand or by law jumps \[s\].
const HOUR_S: f64 = 3600.0;

/// Usual intervals by which a jump of the clock may differ from whole hours.
const NEAR: f64 = 2.0;

/// Refuses times that fall.
pub(super) fn refuse_backwards(
    file: &FileColumns,
    time_s: &[f64],
    interval_s: f64,
) -> Result<(), InstrumentError> {
    let mut falls = time_s.windows(2).enumerate();
    let falls = falls.by_ref().filter(|(_, pair)| pair[1] < pair[0]);
    let falls: Vec<usize> = falls.map(|(row, _)| row).collect();
    let Some(first) = falls.first().copied() else {
        return Ok(());
    };
    let back_s = time_s[first] - time_s[first + 1];
    let found = match falls.len() {
        1 => format!("time {} s after {} s", time_s[first + 1], time_s[first]),
        count => format!(
            "time {} s after {} s, the first of {count} such steps back",
            time_s[first + 1],
            time_s[first]
        ),
    };
    let advice = match (&falls[..], hours(back_s + interval_s, interval_s)) {
        _ if falls.iter().all(|row| is_one_off(time_s, *row, interval_s)) => {
            "the stamps about it are in step, so that a stamp alone is wrong: give `rate_hz` in place of the time \
             column, or correct it"
                .to_owned()
        }
        ([_], Some(hours)) => format!(
            "the clock was set back by {hours} h: add {} s to the stamps from this line on, or give `rate_hz` in place of \
             the time column",
            hours * HOUR_S
        ),
        _ => "split the file in front of this line, with the header in front of both parts, and give both logs; \
              `gyrocal allan` and `gyrocal import` take one of them; if only the stamps are wrong, give `rate_hz` in \
              place of the time column"
            .to_owned(),
    };
    Err(file.error_at(
        first + 1,
        InputErrorKind::Time,
        Unfit::Jitter,
        [&found, "times that rise", &advice],
    ))
}

/// Whether the stamps are in step again if one of the two at a fall is left out.
fn is_one_off(time_s: &[f64], row: usize, interval_s: f64) -> bool {
    let in_step = |from: Option<usize>, to: usize| {
        let pair = from.and_then(|from| Some((time_s.get(from)?, time_s.get(to)?)));
        pair.is_some_and(|(from, to)| (GAP..=2.0 + GAP).contains(&((to - from) / interval_s)))
    };
    in_step(Some(row), row + 2) || in_step(row.checked_sub(1), row + 1)
}

/// Whole hours of a jump, if it is some.
fn hours(jump_s: f64, interval_s: f64) -> Option<f64> {
    let hours = (jump_s / HOUR_S).round();
    let is_near = (jump_s - hours * HOUR_S).abs() <= NEAR * interval_s;
    (hours >= 1.0 && is_near && interval_s < 1.0).then_some(hours)
}

impl Log {
    /// Refuses stamps that repeat, and intervals that are no jitter.
    pub(super) fn refuse_long_gaps(&self, file: &FileColumns) -> Result<(), InstrumentError> {
        if let Some(repeats) = Repeats::of(self) {
            return Err(repeats.error(
                file,
                self,
                "stamps of packets are no times of samples: leave out `jitter`, or give `rate_hz` in place of the time \
                 column",
            ));
        }
        match self.longest_s() > LONGEST_JITTER * self.interval_s {
            true => Err(self.gap(file, 0)),
            false => Ok(()),
        }
    }

    fn longest_s(&self) -> f64 {
        let intervals = self.time_s.windows(2).map(|pair| pair[1] - pair[0]);
        intervals.fold(0.0, f64::max)
    }

    /// The error of stamps that no steady clock gives from some sample on.
    pub(super) fn gap(&self, file: &FileColumns, from: usize) -> InstrumentError {
        if self.interval_s <= 0.0 {
            return match Rounded::of(&self.time_s) {
                Some(rounded) => self.uneven_steps(file, rounded),
                None => self.no_steady_clock(file, from),
            };
        }
        let intervals = self.time_s.windows(2).map(|pair| pair[1] - pair[0]);
        let is_gap = |interval_s: &f64| *interval_s > GAP * self.interval_s;
        let gaps: Vec<f64> = intervals.filter(is_gap).collect();
        if gaps.is_empty() {
            return self.no_steady_clock(file, from);
        }
        let longest_s = self.longest_s();
        let of_longest = |pair: &[f64]| pair[1] - pair[0] >= longest_s;
        let first = self.time_s.windows(2).position(of_longest).unwrap_or(0);
        if let ([jump_s], Some(hours)) = (
            &gaps[..],
            hours(longest_s - self.interval_s, self.interval_s),
        ) {
            return file.error_at(
                first + 1,
                InputErrorKind::Time,
                Unfit::Gap,
                [
                    &format!(
                        "1 gap(s) in the time stamps, of {jump_s:.4} s after {} s",
                        self.time_s[first]
                    ),
                    &format!("a sample every {:.4} s", self.interval_s),
                    &format!(
                        "if the clock was set by {hours} h, take {} s off the stamps from this line on, or give `rate_hz` \
                         in place of the time column; if the log rested, split it in front of this line",
                        hours * HOUR_S
                    ),
                ],
            );
        }
        let missing: f64 = gaps
            .iter()
            .map(|gap_s| (gap_s / self.interval_s).round() - 1.0)
            .sum();
        let found = format!(
            "{} gap(s) in the time stamps, in which {missing} sample(s) are missing, the longest of {longest_s:.4} s after \
             {} s",
            gaps.len(),
            self.time_s[first]
        );
        let between = match longest_s > LONGEST_JITTER * self.interval_s {
            true => "",
            false => {
                "; `jitter = \"resample\"` interpolates between samples, and if the sensor samples at such intervals, \
                 `jitter = \"use\"` takes them as they are"
            }
        };
        let advice = format!(
            "split the log at each gap, since rotation that was not recorded cannot be integrated; if the clock is wrong and \
             not the samples, give `rate_hz` in place of the time column{between}"
        );
        file.error_at(
            first + 1,
            InputErrorKind::Time,
            Unfit::Gap,
            [
                &found,
                &format!("a sample every {:.4} s", self.interval_s),
                &advice,
            ],
        )
    }

    /// The error of stamps in steps of which some have fewer samples.
    fn uneven_steps(&self, file: &FileColumns, rounded: Rounded) -> InstrumentError {
        let [fewest, most] = rounded.samples;
        let inner = self.time_s.iter().position(|at_s| *at_s > self.time_s[0]);
        let inner = inner.unwrap_or(0);
        let groups = self.time_s[inner..].chunk_by(|one, next| one == next);
        let mut row = inner;
        for group in groups {
            if group.len() == fewest {
                break;
            }
            row += group.len();
        }
        file.error_at(
            row.min(self.len() - 1),
            InputErrorKind::Time,
            Unfit::Jitter,
            [
                &format!(
                    "time stamps in steps of {:.4} s, with {fewest} to {most} samples each, the fewest from here on",
                    rounded.step_s
                ),
                "a stamp for each sample, or as many samples in each step",
                &format!(
                    "write stamps with more digits; if no sample is missing, give their rate in place of the time column: \
                     `rate_hz = {}` by the mean of all steps",
                    (rounded.mean / rounded.step_s * 1e3).round() / 1e3
                ),
            ],
        )
    }

    /// The error of stamps that no steady clock gives, though none of their intervals is long: repeated rows, or a rate that
    /// changes.
    fn no_steady_clock(&self, file: &FileColumns, from: usize) -> InstrumentError {
        if let Some(repeats) = Repeats::of(self) {
            return repeats.error(
                file,
                self,
                "if the log holds samples twice, keep one row of each stamp; if several samples share a stamp and none is \
                 missing, give `rate_hz` in place of the time column",
            );
        }
        file.error_at(
            from,
            InputErrorKind::Time,
            Unfit::Jitter,
            [
                "time stamps without a gap that no steady clock gives, from about here on",
                &format!("a sample every {:.4} s", self.interval_s),
                "if the rate changes, split the log there; if the clock is wrong and not the samples, give `rate_hz` in \
                 place of the time column; if the sensor samples at such intervals, `jitter = \"use\"` or \
                 `\"resample\"`",
            ],
        )
    }
}

/// Rows with the stamp of the row before.
struct Repeats {
    /// The first.
    first: usize,
    count: usize,
    /// Those that have the values of the row before, too.
    same: usize,
}

impl Repeats {
    fn of(log: &Log) -> Option<Self> {
        let pairs = log.time_s.windows(2).enumerate();
        let repeats: Vec<usize> = pairs
            .filter(|(_, pair)| pair[1] == pair[0])
            .map(|(row, _)| row + 1)
            .collect();
        let is_same = |row: &&usize| {
            let force = log.accel.as_ref();
            log.gyro[**row] == log.gyro[**row - 1]
                && force.is_none_or(|force| force[**row] == force[**row - 1])
        };
        Some(Self {
            first: *repeats.first()?,
            count: repeats.len(),
            same: repeats.iter().filter(is_same).count(),
        })
    }

    /// The error of them, with the advice for rows with other values.
    fn error(&self, file: &FileColumns, log: &Log, otherwise: &str) -> InstrumentError {
        let Self { first, count, same } = *self;
        let (what, advice) = if same == count {
            (
                " and the values of the row before".to_owned(),
                "keep one row of each stamp",
            )
        } else if same == 0 {
            (" of the row before and other values".to_owned(), otherwise)
        } else {
            (
                format!(" of the row before, {same} of them with its values too"),
                otherwise,
            )
        };
        let found = format!(
            "{count} rows with the stamp{what}, the first at {} s",
            log.time_s[first]
        );
        file.error_at(
            first,
            InputErrorKind::Time,
            Unfit::Jitter,
            [&found, "a stamp for each sample", advice],
        )
    }
}
