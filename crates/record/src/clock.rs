//! Times that do not rise: what is wrong with the clock, and what to do.

use core::ops::Range;

use crate::record::Record;
use crate::words::counted;

/// Most leaps back of a clock that began again: more are rows out of order.
const MOST_RESTARTS: usize = 20;

/// Stands for the file in the advice on a record that has none; [`RecordFile::locate`](crate::RecordFile::locate) puts
/// its name there.
pub const UNNAMED: &str = "RECORD.csv";

/// What is wrong with times that do not rise, and the remedy; both are beginnings of sentences without a full stop.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ClockFault {
    /// The first row whose time does not rise, from 0.
    pub row: usize,
    /// What is wrong.
    pub found: String,
    /// What to do about it.
    pub advice: String,
}

impl ClockFault {
    /// The fault of some times \[s\], with what to do to a file of this name; `None` if they rise.
    #[must_use]
    pub fn of(time_s: &[f64], file: &str) -> Option<Self> {
        let falls = |at: &usize| {
            // Not a number does not rise.
            let rises = time_s[*at] > time_s[*at - 1];
            !rises
        };
        let wrong: Vec<usize> = (1..time_s.len()).filter(falls).collect();
        let row = *wrong.first()?;
        let [before_s, here_s] = [time_s[row - 1], time_s[row]];
        let back = wrong.iter().filter(|at| time_s[**at] < time_s[**at - 1]);
        let (found, advice) = match (restarts(time_s), back.count()) {
            (Some(parts), _) => (
                format!(
                    "a clock that goes back from {before_s} s to {here_s} s: {} parts whose times rise",
                    parts.len()
                ),
                format!(
                    "`gyrocal import csv {file} --split --out PART.csv` writes each part as a record, PART.1.csv and \
                     so on (with `--columns` and the map, if one reads it); the bench description of each part after \
                     the first has no initial angles"
                ),
            ),
            (None, 0) => (
                format!(
                    "{} with the time of the row before and other values, the first at {here_s} s",
                    counted(wrong.len(), "row")
                ),
                "keep one row of each time; if the stamps are rounded and no row is missing, give `rate_hz` in place of \
                 `column` in `[time]` of a map (`--columns MAP.toml`)"
                    .to_owned(),
            ),
            (None, _) => (
                format!(
                    "{} out of order, the first at {here_s} s after {before_s} s",
                    counted(wrong.len(), "row")
                ),
                "sort the rows by time, and keep one of those that repeat".to_owned(),
            ),
        };
        Some(Self { row, found, advice })
    }
}

/// The parts of times that go back at few rows and rise between them; `None` of others. A single row out of order is
/// none: a clock that begins again gives two rows at least that are not later than the last before.
#[must_use]
pub fn restarts(time_s: &[f64]) -> Option<Vec<Range<usize>>> {
    let mut starts = vec![0];
    for (at, pair) in time_s.windows(2).enumerate() {
        if pair[1] < pair[0] {
            if time_s.get(at + 2).is_none_or(|next| *next > pair[0]) {
                return None;
            }
            starts.push(at + 1);
        } else if pair[1].is_nan() || pair[1] == pair[0] {
            return None;
        }
    }
    let ends = starts.iter().skip(1).copied().chain([time_s.len()]);
    let parts: Vec<Range<usize>> = starts
        .iter()
        .copied()
        .zip(ends)
        .map(|(a, b)| a..b)
        .collect();
    let few = (2..=MOST_RESTARTS + 1).contains(&parts.len());
    (few && parts.iter().all(|part| part.len() >= 2)).then_some(parts)
}

/// Leaves rows out that have time and values of the row before; their places.
pub(crate) fn leave_out_repeated(
    record: &mut Record,
    places: &mut Vec<Range<usize>>,
) -> Vec<Range<usize>> {
    let bits = |row: usize| {
        let [x, y, z] = record.accel_g[row];
        let temperature = record.temperature_c.as_ref().map_or(0.0, |all| all[row]);
        [record.time_s[row], x, y, z, temperature].map(f64::to_bits)
    };
    let kept: Vec<bool> = (0..record.len())
        .map(|row| row == 0 || bits(row) != bits(row - 1))
        .collect();
    if kept.iter().all(|kept| *kept) {
        return Vec::new();
    }
    fn keep<T>(values: &mut Vec<T>, kept: &[bool]) {
        let mut kept = kept.iter();
        values.retain(|_| kept.next().copied().unwrap_or(true));
    }
    let of_left = places.iter().zip(&kept).filter(|(_, kept)| !**kept);
    let left = of_left.map(|(place, _)| place.clone()).collect();
    keep(&mut record.time_s, &kept);
    keep(&mut record.accel_g, &kept);
    if let Some(temperature_c) = &mut record.temperature_c {
        keep(temperature_c, &kept);
    }
    keep(places, &kept);
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_that_begins_again_is_no_disorder() {
        let of =
            |times: &[f64]| ClockFault::of(times, "r.csv").map(|fault| (fault.row, fault.found));
        assert_eq!(of(&[0.0, 1.0, 2.0]), None);
        let (row, found) = of(&[5.0, 6.0, 7.0, 0.0, 1.0]).unwrap();
        assert_eq!(row, 3);
        assert!(
            found.starts_with("a clock that goes back from 7 s to 0 s"),
            "{found}"
        );
        assert_eq!(restarts(&[5.0, 6.0, 7.0, 0.0, 1.0]), Some(vec![0..3, 3..5]));
        let (_, found) = of(&[5.0, 6.0, 0.0, 7.0, 8.0, 1.0]).unwrap();
        assert!(found.starts_with("2 rows out of order"), "{found}");
        let (row, found) = of(&[0.0, 1.0, 1.0, 2.0]).unwrap();
        assert_eq!(row, 2);
        assert!(
            found.starts_with("1 row with the time of the row before"),
            "{found}"
        );
        assert!(ClockFault::of(&[0.0, f64::NAN], "r.csv").is_some());
    }

    #[test]
    fn copies_of_the_row_before_are_left_out() {
        let mut record = Record {
            time_s: vec![0.0, 0.0, 1.0, 1.0, 1.0, 2.0],
            accel_g: [1.0, 1.0, f64::NAN, f64::NAN, 3.0, 3.0]
                .map(|x| [x; 3])
                .to_vec(),
            temperature_c: Some(vec![20.0; 6]),
        };
        let mut places = (0..6).map(|row| row..row + 1).collect();
        let left = leave_out_repeated(&mut record, &mut places);
        assert_eq!(left, [1..2, 3..4]);
        assert_eq!(record.time_s, [0.0, 1.0, 1.0, 2.0]);
        assert_eq!(record.temperature_c.map(|all| all.len()), Some(4));
        assert_eq!(places, [0..1, 2..3, 4..5, 5..6]);
    }
}
