//! Dates and times in words, by `jiff`.

use jiff::civil::DateTime;
use jiff::fmt::strtime::BrokenDownTime;
use jiff::fmt::temporal::{DateTimeParser, Pieces};
use jiff::tz::{Offset, TimeZone};

/// Seconds of a day.
const DAY_S: f64 = 86_400.0;

/// An instant that tells whether a format has a date and a time of day: 29 February 2024, 13:14:15.25.
const SAMPLE: DateTime = jiff::civil::date(2024, 2, 29).at(13, 14, 15, 250_000_000);

/// Reader of the dates and times of successive rows.
#[derive(Debug, Clone)]
pub(crate) struct DateTimes {
    /// Format by `strftime`; RFC 3339 without one.
    format: Option<String>,
    /// Whether the format has a date.
    has_date: bool,
    /// Zone of times without an offset.
    zone: TimeZone,
    /// Time of the row before.
    last_s: f64,
}

impl DateTimes {
    /// The reader of a format, RFC 3339 without one, in a zone, UTC without one; `None` if either is none.
    pub(crate) fn of(format: Option<&str>, zone: Option<&str>) -> Option<Self> {
        let zone = match zone {
            Some(zone) => DateTimeParser::new().parse_time_zone(zone).ok()?,
            None => TimeZone::UTC,
        };
        let reader = match format {
            Some(format) => Self::of_format(format)?,
            None => Self::rfc3339(),
        };
        Some(Self { zone, ..reader })
    }

    /// Reader of RFC 3339.
    pub(crate) fn rfc3339() -> Self {
        Self {
            format: None,
            has_date: true,
            zone: TimeZone::UTC,
            last_s: f64::NEG_INFINITY,
        }
    }

    /// Reader of a format, UTC without an offset; `None` of one that tells no time of day.
    pub(crate) fn of_format(format: &str) -> Option<Self> {
        let sample = SAMPLE.to_zoned_datetime(TimeZone::UTC).ok()?;
        let written = BrokenDownTime::from(&sample).to_string(format).ok()?;
        let parts = BrokenDownTime::parse(format, &written).ok()?;
        let is_stamp = parts.timestamp().is_some();
        // A date alone is its midnight, and a clock of twelve hours without %p is early.
        let is_time = parts
            .to_time()
            .is_ok_and(|time| time.hour() == SAMPLE.hour());
        (is_stamp || is_time).then(|| Self {
            format: Some(format.to_owned()),
            has_date: is_stamp || parts.to_date().is_ok(),
            ..Self::rfc3339()
        })
    }

    /// Seconds since 1970-01-01T00:00:00Z; of a format without a date those since the first midnight. `None` of
    /// another text.
    ///
    /// A leap second is the second after it. Of the two instants of a local time when summer time ends it is the
    /// earlier one, unless that is before the last row.
    pub(crate) fn seconds(&mut self, text: &str) -> Option<f64> {
        let text = text.trim();
        let parsed = match &self.format {
            None => of_rfc3339(text),
            Some(format) => {
                // A fraction may have a decimal comma.
                let parse = |text: &str| BrokenDownTime::parse(format, text).ok();
                let parts = parse(text).or_else(|| parse(&text.replacen(',', ".", 1)))?;
                match (parts.timestamp(), parts.to_date()) {
                    (Some(stamp), _) => Some((Offset::UTC.to_datetime(stamp), Some(Offset::UTC))),
                    (None, Ok(date)) => {
                        Some((date.to_datetime(parts.to_time().ok()?), parts.offset()))
                    }
                    (None, Err(_)) if self.has_date => return None,
                    (None, Err(_)) => return self.of_day(&parts),
                }
            }
        };
        let (civil, offset) = parsed?;
        let stamp = match offset {
            Some(offset) => offset.to_timestamp(civil).ok()?,
            None => {
                let either = self.zone.to_ambiguous_timestamp(civil);
                let first = either.compatible().ok()?;
                match first.as_second() as f64 + 1.0 <= self.last_s {
                    true => either.later().ok()?,
                    false => first,
                }
            }
        };
        // The library takes second 60 for 59, and minute 60 for none.
        let leap_s = f64::from(u8::from(text.contains(":60")));
        let fraction_s = f64::from(stamp.subsec_nanosecond()) / 1e9;
        self.last_s = stamp.as_second() as f64 + leap_s + fraction_s;
        Some(self.last_s)
    }

    /// A time of day, on the next day if it is earlier than the last by half a day or more.
    fn of_day(&mut self, parts: &BrokenDownTime) -> Option<f64> {
        let since = parts
            .to_time()
            .ok()?
            .duration_since(jiff::civil::Time::midnight());
        let of_day_s = since.as_secs_f64();
        let day = match self.last_s.is_finite() {
            true => (self.last_s / DAY_S).floor(),
            false => 0.0,
        };
        let same_s = day * DAY_S + of_day_s;
        let is_next = same_s < self.last_s - 0.5 * DAY_S;
        self.last_s = same_s + DAY_S * f64::from(u8::from(is_next));
        Some(self.last_s)
    }
}

/// Date and time of RFC 3339, and its offset. A blank or an underscore may stand for the T.
fn of_rfc3339(text: &str) -> Option<(DateTime, Option<Offset>)> {
    let blank = match text.as_bytes().get(10) {
        Some(b'_') if text.is_char_boundary(10) => format!("{} {}", &text[..10], &text[11..]),
        _ => text.to_owned(),
    };
    let pieces = Pieces::parse(&blank).ok()?;
    let civil = pieces.date().to_datetime(pieces.time()?);
    Some((civil, pieces.to_numeric_offset()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_and_times_are_those_of_the_calendar() {
        // Counts of `date --date=... +%s`.
        for (text, seconds) in [
            ("1970-01-01T00:00:00Z", 0.0),
            ("2000-02-29T23:59:59.5Z", 951_868_799.5),
            ("2000-02-29_23:59:59,5", 951_868_799.5),
            ("2024-12-31 12:00:00+01:00", 1_735_642_800.0),
            ("2026-03-01T00:00:00-0530", 1_772_343_000.0),
            ("2016-12-31T23:59:60Z", 1_483_228_800.0),
        ] {
            assert_eq!(DateTimes::rfc3339().seconds(text), Some(seconds), "{text}");
        }
    }

    #[test]
    fn formats_are_those_of_strftime() {
        // Counts of `date --date=... +%s`.
        for (format, text, seconds) in [
            ("%d.%m.%Y %H:%M:%S", "28.03.2026 10:00:00", 1_774_692_000.0),
            (
                "%d.%m.%Y %H:%M:%S%.f",
                "28.03.2026 10:00:00,25",
                1_774_692_000.25,
            ),
            (
                "%m/%d/%Y %I:%M:%S %p",
                "3/28/2026 10:00:00 PM",
                1_774_735_200.0,
            ),
            ("%Y %j %H:%M:%S", "2026 87 10:00:00", 1_774_692_000.0),
            (
                "%d-%b-%y %H:%M:%S %z",
                "28-Mar-26 10:00:00 +0100",
                1_774_688_400.0,
            ),
            ("%s", "1774692000", 1_774_692_000.0),
            ("%H:%M:%S", "10:00:00", 36_000.0),
        ] {
            let mut reader = DateTimes::of_format(format).unwrap();
            assert_eq!(reader.seconds(text), Some(seconds), "{text}");
        }
        for format in ["%Y-%m-%d", "%F %I:%M", "%q", "time", "%H:%M %"] {
            assert!(DateTimes::of_format(format).is_none(), "{format}");
        }
    }

    #[test]
    fn the_hour_after_summer_time_is_not_the_hour_before() {
        let time = |zone: &str| DateTimes::of(Some("%F %T"), Some(zone));
        let mut berlin = time("Europe/Berlin").unwrap();
        let times = [
            "01:59:00", "02:30:00", "02:59:00", "02:00:00", "02:59:00", "03:00:00",
        ];
        let seconds = times.map(|time| berlin.seconds(&format!("2026-10-25 {time}")).unwrap());
        let minutes = seconds.map(|second| (second - seconds[0]) / 60.0);
        assert_eq!(minutes, [0.0, 31.0, 60.0, 61.0, 120.0, 121.0]);
        let mut east = time("+01:00").unwrap();
        assert_eq!(east.seconds("1970-01-01 01:00:00"), Some(0.0));
        assert!(time("Europe/Atlantis").is_none());
    }

    #[test]
    fn times_of_day_go_on_after_midnight() {
        let mut reader = DateTimes::of_format("%H:%M:%S").unwrap();
        let times = ["23:59:00", "00:00:30", "12:00:00", "23:59:59", "00:00:00"];
        let seconds = times.map(|time| reader.seconds(time).unwrap());
        assert_eq!(
            seconds,
            [86_340.0, 86_430.0, 129_600.0, 172_799.0, 172_800.0]
        );
    }

    #[test]
    fn what_is_no_date_and_time_is_refused() {
        for text in [
            "2026-02-29T00:00:00Z",
            "2026-03-01T24:00:00Z",
            "01.03.2026 12:00:00",
            "2026-03-01",
            "2026-03-01T12:60:00Z",
            "12.5",
            "2026-03-01T12:00:00.x",
            "é026-03-01T",
        ] {
            assert_eq!(DateTimes::rfc3339().seconds(text), None, "{text}");
        }
    }
}
