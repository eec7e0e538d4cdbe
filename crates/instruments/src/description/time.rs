//! Times of the samples of a log.

use serde::{Deserialize, Serialize};

/// Times of the samples: a column of time stamps, or a rate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// The column of time stamps.
    pub column: Option<String>,
    /// Unit or notation of that column; seconds if neither it nor `unit_s` is given.
    pub unit: Option<TimeUnit>,
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

/// Units and notations of time stamps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub enum TimeUnit {
    /// Seconds.
    #[serde(rename = "s")]
    Second,
    /// Milliseconds.
    #[serde(rename = "ms")]
    Millisecond,
    /// Microseconds.
    #[serde(rename = "us", alias = "µs", alias = "μs")]
    Microsecond,
    /// Nanoseconds.
    #[serde(rename = "ns")]
    Nanosecond,
    /// Minutes.
    #[serde(rename = "min")]
    Minute,
    /// Hours.
    #[serde(rename = "h")]
    Hour,
    /// Date and time of RFC 3339, as `2026-03-01T12:00:00.25Z`; a blank may stand for the T, and without an
    /// offset the time is UTC. A leap second is the second after it.
    #[serde(rename = "rfc3339")]
    Rfc3339,
    /// Seconds of the GPS week of the column `week_column`; without one the week turns over by itself.
    #[serde(rename = "gps")]
    Gps,
    /// Days of a spreadsheet (serial date and time).
    #[serde(rename = "excel")]
    Excel,
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
        self.unit == Some(TimeUnit::Rfc3339)
    }

    /// First mistake beyond types: its key, and the expected value.
    pub(super) fn mistake(&self) -> Option<(&'static str, &'static str)> {
        let positive = |value: f64| value.is_finite() && value > 0.0;
        if self.column.is_some() == self.rate_hz.is_some() {
            return Some(("[time]", "either `column` or `rate_hz`"));
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
