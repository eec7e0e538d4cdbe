//! Date and time of RFC 3339.

/// Seconds since 1970-01-01T00:00:00Z of a date and time, fraction included; `None` if it is none. A blank
/// or an underscore may stand for the T, and without an offset the time is UTC.
pub(crate) fn seconds_of(text: &str) -> Option<f64> {
    let text = text.trim();
    let (date, rest) = text.split_at_checked(10)?;
    let rest = rest.strip_prefix(['T', 't', ' ', '_'])?;
    let zone = rest.find(['Z', 'z', '+', '-']).unwrap_or(rest.len());
    let (time, zone) = rest.split_at(zone);
    let [year, month, day] = parts(date, '-')?;
    let (time, fraction) = match time.trim().split_once(['.', ',']) {
        Some((time, digits)) => (time, fraction(digits)?),
        None => (time.trim(), 0.0),
    };
    let [hour, minute, second] = parts(time, ':')?;
    let in_range = (1..=12).contains(&month)
        && (1..=days_of(year, month)).contains(&day)
        && hour < 24
        && minute < 60
        && second <= 60;
    let seconds = (days_before(year, month, day) * 24 + hour) * 3600 + minute * 60 + second;
    in_range.then(|| (seconds - offset_s(zone)) as f64 + fraction)
}

/// Three whole numbers with a sign between them.
fn parts(text: &str, between: char) -> Option<[i64; 3]> {
    let mut numbers = text.split(between).map(whole);
    let three = [numbers.next()??, numbers.next()??, numbers.next()??];
    numbers.next().is_none().then_some(three)
}

fn whole(digits: &str) -> Option<i64> {
    let plain = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
    plain.then(|| digits.parse().ok()).flatten()
}

fn fraction(digits: &str) -> Option<f64> {
    whole(digits)?;
    format!("0.{digits}").parse().ok()
}

/// Seconds that an offset such as `+01:00` is ahead of UTC.
fn offset_s(zone: &str) -> i64 {
    let ahead = if zone.starts_with('-') { -1 } else { 1 };
    let digits: String = zone.chars().filter(char::is_ascii_digit).collect();
    let number = digits.parse().unwrap_or(0);
    let minutes = match digits.len() {
        0..=2 => number * 60,
        _ => number / 100 * 60 + number % 100,
    };
    ahead * minutes * 60
}

fn is_leap(year: i64) -> bool {
    year % 4 == 0 && (year % 100 != 0 || year % 400 == 0)
}

fn days_of(year: i64, month: i64) -> i64 {
    match month {
        2 if is_leap(year) => 29,
        2 => 28,
        4 | 6 | 9 | 11 => 30,
        _ => 31,
    }
}

/// Days from 1970-01-01 to a date of the Gregorian calendar.
fn days_before(year: i64, month: i64, day: i64) -> i64 {
    let last = year - 1;
    // 719162 days from 0001-01-01 to 1970-01-01.
    let before = last * 365 + last / 4 - last / 100 + last / 400 - 719_162;
    before + (1..month).map(|month| days_of(year, month)).sum::<i64>() + day - 1
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
            ("2024-12-31 12:00:00+01:00", 1_735_642_800.0),
            ("2026-03-01T00:00:00-0530", 1_772_343_000.0),
            ("2016-12-31T23:59:60Z", 1_483_228_800.0),
        ] {
            assert_eq!(seconds_of(text), Some(seconds), "{text}");
        }
    }

    #[test]
    fn what_is_no_date_and_time_is_refused() {
        for text in [
            "2026-02-29T00:00:00Z",
            "2026-03-01T24:00:00Z",
            "01.03.2026 12:00:00",
            "2026-03-01",
            "12.5",
            "2026-03-01T12:00:00.x",
            "é026-03-01T",
        ] {
            assert_eq!(seconds_of(text), None, "{text}");
        }
    }
}
