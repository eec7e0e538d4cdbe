//! Times of the samples of a log.

use serde::{Deserialize, Serialize};

use super::names::named_units;
use crate::date_time::DateTimes;

/// Times of the samples: a column of time stamps, or a rate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// The column of time stamps.
    pub column: Option<String>,
    /// Columns in place of it whose texts, joined by blanks, are date and time: `["date", "time"]`.
    pub columns: Option<Vec<String>>,
    /// Unit or notation of that column; seconds if neither it nor `unit_s` nor `format` is given. Several columns
    /// without a format are of RFC 3339.
    pub unit: Option<TimeUnit>,
    /// Format of dates and times by `strftime`: `"%d.%m.%Y %H:%M:%S"`. `%.f` is a fraction of a second that may be
    /// absent, `%j` the day of the year, `%z` an offset, `%p` AM or PM. Without a date midnight begins a new day.
    pub format: Option<String>,
    /// Zone of dates and times without an offset: its name, `"Europe/Berlin"`, or its offset, `"+01:00"`; UTC if it is
    /// not given.
    pub zone: Option<String>,
    /// Seconds in one unit of that column, for a unit without a name here.
    pub unit_s: Option<f64>,
    /// The column of GPS weeks, with the unit `"gps"`.
    pub week_column: Option<String>,
    /// Samples a second, on a clock that is exact; in place of a column.
    pub rate_hz: Option<f64>,
    /// Meaning of time stamps that jitter. Those of a record of a stable platform are used as they are,
    /// unless they are to be resampled.
    #[serde(default)]
    pub jitter: Jitter,
}

named_units! {
    /// Units and notations of time stamps.
    TimeUnit {
        /// Seconds.
        Second = &["s", "sec", "seconds"],
        /// Milliseconds.
        Millisecond = &["ms", "msec", "milliseconds"],
        /// Microseconds.
        Microsecond = &["us", "µs", "μs", "usec", "microseconds"],
        /// Nanoseconds.
        Nanosecond = &["ns", "nsec", "nanoseconds"],
        /// Minutes.
        Minute = &["min", "minutes"],
        /// Hours.
        Hour = &["h", "hr", "hours"],
        /// Date and time of RFC 3339, as `2026-03-01T12:00:00.25Z`; a blank may stand for the T, and without an
        /// offset the time is UTC. A leap second is the second after it.
        Rfc3339 = &["rfc3339"],
        /// Seconds of the GPS week of the column `week_column`; without one the week turns over by itself.
        Gps = &["gps"],
        /// Days of a spreadsheet (serial date and time).
        Excel = &["excel"],
    }
}

/// Meaning of time stamps that jitter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Jitter {
    /// Stamps of a computer that received samples of a steady clock: equal intervals, if no sample is
    /// missing.
    #[default]
    Steady,
    /// Times of samples, used as they are.
    Use,
    /// Times of samples, which are interpolated at equal intervals.
    Resample,
}

/// Seconds of a day and of a GPS week.
const DAY_S: f64 = 86_400.0;
pub(crate) const WEEK_S: f64 = 7.0 * DAY_S;

impl Time {
    /// Seconds in one unit of numeric stamps.
    #[must_use]
    pub fn numeric_unit_s(&self) -> f64 {
        match (self.unit_s, self.unit) {
            (Some(unit_s), _) => unit_s,
            (None, Some(unit)) => unit.seconds(),
            (None, None) => 1.0,
        }
    }

    /// Whether stamps are dates and times in words.
    #[must_use]
    pub fn is_text(&self) -> bool {
        self.format.is_some() || self.columns.is_some() || self.unit == Some(TimeUnit::Rfc3339)
    }

    /// The reader of its dates and times; `None` of numbers, or if format or zone are none.
    pub(crate) fn dates(&self) -> Option<DateTimes> {
        let reader = DateTimes::of(self.format.as_deref(), self.zone.as_deref());
        reader.filter(|_| self.is_text())
    }

    /// The columns of time stamps.
    pub(crate) fn stamps(&self) -> &[String] {
        match &self.columns {
            Some(columns) => columns,
            None => self.column.as_slice(),
        }
    }

    /// First mistake beyond types: its key, and the expected value.
    pub(super) fn mistake(&self) -> Option<(&'static str, &'static str)> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        let given = [
            self.column.is_some(),
            self.columns.is_some(),
            self.rate_hz.is_some(),
        ];
        if given.into_iter().filter(|given| *given).count() != 1 {
            return Some(("[time]", "one of `column`, `columns` and `rate_hz`"));
        }
        if self.columns.as_ref().is_some_and(Vec::is_empty) {
            return Some(("columns", "at least one column of times"));
        }
        if !self.rate_hz.is_none_or(positive) {
            return Some(("rate_hz", "a positive number"));
        }
        if !self.unit_s.is_none_or(positive) {
            return Some(("unit_s", "a positive number"));
        }
        if self.unit.is_some() && self.unit_s.is_some() {
            return Some(("unit_s", "either `unit` or `unit_s`"));
        }
        let other_unit =
            self.unit.is_some_and(|unit| unit != TimeUnit::Rfc3339) || self.unit_s.is_some();
        if self.is_text() && other_unit {
            return Some((
                "[time]",
                "dates and times (`columns`, `format`) without a `unit` of numbers",
            ));
        }
        if self.format.is_some() && self.unit.is_some() {
            return Some(("format", "either `unit` or `format`"));
        }
        if self.zone.is_some() && !self.is_text() {
            return Some((
                "zone",
                "dates and times (`format`, or the unit `rfc3339`) with it",
            ));
        }
        if self.is_text() && self.dates().is_none() {
            let zone = Self {
                format: None,
                unit: Some(TimeUnit::Rfc3339),
                ..self.clone()
            };
            return Some(match zone.dates() {
                Some(_) => (
                    "format",
                    "a format of date and time by strftime, as `%d.%m.%Y %H:%M:%S`",
                ),
                None => ("zone", "a zone, as `Europe/Berlin` or `+01:00`"),
            });
        }
        if self.week_column.is_some() && self.unit != Some(TimeUnit::Gps) {
            return Some(("week_column", "the unit `gps` with it"));
        }
        None
    }
}

impl TimeUnit {
    /// Seconds in one unit.
    fn seconds(self) -> f64 {
        match self {
            Self::Second | Self::Rfc3339 | Self::Gps => 1.0,
            Self::Millisecond => 1e-3,
            Self::Microsecond => 1e-6,
            Self::Nanosecond => 1e-9,
            Self::Minute => 60.0,
            Self::Hour => 3600.0,
            Self::Excel => DAY_S,
        }
    }
}
