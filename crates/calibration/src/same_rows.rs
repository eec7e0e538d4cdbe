//! Records that share rows, which would count twice, and records whose times overlap.

use std::collections::HashMap;

use gyrocal_record::Record;

/// Least number of consecutive rows, equal to the last bit, that two records share only if one is
/// taken from the other: noisy values do not repeat so by chance, not even coarse ones.
const LEAST_ROWS: usize = 24;

/// Most places of one sample that are compared: values of a coarse converter occur in many.
const MAX_PLACES: usize = 64;

/// Consecutive rows that two records share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SharedRows {
    /// Index of the first of them in the second record.
    pub first: usize,
    /// Their number.
    pub rows: usize,
}

/// The longest stretch of equal consecutive samples of two records; `None` if it is too short to
/// show that the rows are the same.
#[must_use]
pub fn shared_rows(one: &Record, other: &Record) -> Option<SharedRows> {
    let mut places: HashMap<[u64; 3], Vec<usize>> = HashMap::new();
    for (row, sample) in one.accel_g.iter().enumerate() {
        if sample.iter().all(|value| !value.is_nan()) {
            places.entry(bits(sample)).or_default().push(row);
        }
    }
    let enough = LEAST_ROWS.min(one.len()).min(other.len());
    let mut longest: Option<SharedRows> = None;
    let mut row = 0;
    while row < other.len() {
        let starts = places.get(&bits(&other.accel_g[row]));
        let rows = starts
            .into_iter()
            .flatten()
            .take(MAX_PLACES)
            .map(|start| {
                let pairs = one.accel_g[*start..].iter().zip(&other.accel_g[row..]);
                pairs.take_while(|(a, b)| bits(a) == bits(b)).count()
            })
            .max()
            .unwrap_or(0);
        if rows >= enough && longest.is_none_or(|longest| rows > longest.rows) {
            longest = Some(SharedRows { first: row, rows });
        }
        // A stretch that is long enough is not compared again from its middle.
        row += if rows >= enough { rows } else { 1 };
    }
    longest
}

/// The bits of a sample; all missing values are equal.
fn bits(sample: &[f64; 3]) -> [u64; 3] {
    sample.map(|value| if value.is_nan() { 0 } else { value.to_bits() })
}

/// True if the times of two records overlap although they begin at different times: on one clock
/// that cannot be. Records that begin at the same time have clocks that start at each turn-on.
#[must_use]
pub fn times_overlap(one: &Record, other: &Record) -> bool {
    let span = |record: &Record| {
        let time = |time_s: Option<&f64>| time_s.copied().unwrap_or(f64::NAN);
        (time(record.time_s.first()), time(record.time_s.last()))
    };
    let ((a, b), (c, d)) = (span(one), span(other));
    a != c && a < d && c < b
}

#[cfg(test)]
mod tests {
    use super::*;

    fn record(rows: core::ops::Range<u32>) -> Record {
        Record {
            time_s: rows.clone().map(f64::from).collect(),
            accel_g: rows
                .map(|row| {
                    let row = f64::from(row);
                    [
                        row.sin(),
                        if row == 40.0 { f64::NAN } else { row.cos() },
                        0.5,
                    ]
                })
                .collect(),
            temperature_c: None,
        }
    }

    #[test]
    fn equal_rows_are_found_at_any_place() {
        let found = |one, other| shared_rows(&one, &other).map(|found| (found.first, found.rows));
        assert_eq!(found(record(0..100), record(30..200)), Some((0, 70)));
        assert_eq!(found(record(30..200), record(0..100)), Some((30, 70)));
        assert_eq!(found(record(0..100), record(100..200)), None);
        // 23 rows are one too few.
        assert_eq!(found(record(0..100), record(77..200)), None);
        assert_eq!(found(record(0..100), record(76..200)), Some((0, 24)));
    }

    #[test]
    fn overlapping_times_need_different_beginnings() {
        assert!(times_overlap(&record(0..100), &record(50..150)));
        assert!(!times_overlap(&record(0..100), &record(0..150)));
        assert!(!times_overlap(&record(0..100), &record(99..150)));
    }
}
