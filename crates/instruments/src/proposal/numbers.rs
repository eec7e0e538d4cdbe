//! Times in numbers, and their unit, by names and values.

use gyrocal_statistics::median;

use super::layout::Table;
use super::sensors::{force, vectors};
use super::time::{Stamps, column_of, rises, words};

/// Words in the names of times, and of counts that are none.
const NAMES: [&str; 8] = [
    "time", "stamp", "zeit", "datum", "date", "sec", "epoch", "elapsed",
];
const COUNTS: [&str; 9] = [
    "index", "sample", "count", "counter", "nr", "no", "packet", "seq", "row",
];

/// Words of units, in seconds.
const UNITS: [(&str, f64); 26] = [
    ("s", 1.0),
    ("sec", 1.0),
    ("secs", 1.0),
    ("seconds", 1.0),
    ("sekunden", 1.0),
    ("ms", 1e-3),
    ("msec", 1e-3),
    ("millis", 1e-3),
    ("milliseconds", 1e-3),
    ("us", 1e-6),
    ("µs", 1e-6),
    ("usec", 1e-6),
    ("micros", 1e-6),
    ("ns", 1e-9),
    ("nsec", 1e-9),
    ("nanos", 1e-9),
    ("min", 60.0),
    ("minutes", 60.0),
    ("minuten", 60.0),
    ("h", 3600.0),
    ("hours", 3600.0),
    ("hrs", 3600.0),
    ("d", DAY_S),
    ("days", DAY_S),
    ("doy", DAY_S),
    ("mjd", DAY_S),
];

const DAY_S: f64 = 86_400.0;

/// Rate of the Earth \[rad/s\], with which gravity turns in a platform; about this share of it where it turns on a cone.
const EARTH_RAD_PER_S: f64 = 7.292_115e-5;
const CONE: f64 = 0.7;

/// Intervals between rows that records have \[s\].
const INTERVALS_S: core::ops::RangeInclusive<f64> = 1e-5..=21_600.0;

/// Seconds of the GPS week, with the week.
pub(super) fn gps(table: &Table<'_>) -> Option<Stamps> {
    let column = column_of(table, &["tow", "sow", "gpstow", "itow"])?;
    let week = column_of(table, &["week", "wn", "wk", "gpsweek"])?;
    let in_week = table
        .numbers(column)
        .iter()
        .all(|value| (0.0..=7.0 * DAY_S).contains(value));
    in_week.then_some(Stamps::Gps { column, week })
}

/// Numbers that rise.
pub(super) fn numbers(table: &Table<'_>) -> Option<Stamps> {
    let rising = (0..table.names.len()).filter(|column| {
        let values = table.numbers(*column);
        values.iter().all(|value| value.is_finite()) && rises(&values)
    });
    let has = |column: usize, names: &[&str]| {
        let words = words(&table.titles[column]);
        names
            .iter()
            .any(|name| words.iter().any(|word| word == name))
    };
    let rank = |column: &usize| {
        let title = table.titles[*column].to_lowercase();
        let is_time = NAMES.iter().any(|name| title.contains(name)) || has(*column, &["t", "tow"]);
        let is_unit = UNITS.iter().any(|(name, _)| has(*column, &[name]));
        let is_count = has(*column, &COUNTS);
        2 * usize::from(!is_time) + usize::from(!is_unit) + 4 * usize::from(is_count)
    };
    let column = rising.min_by_key(rank)?;
    let unit_s = unit_s(table, column);
    Some(Stamps::Numbers { column, unit_s })
}

/// Seconds in one unit of a column of numbers: by its name, by the size of its values, or by how fast gravity turns.
fn unit_s(table: &Table<'_>, column: usize) -> f64 {
    let values = table.numbers(column);
    let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let step = median(&steps);
    let is_plausible = |unit_s: &f64| INTERVALS_S.contains(&(step * unit_s));
    let words = words(&table.titles[column]);
    let named = words
        .iter()
        .rev()
        .find_map(|word| UNITS.iter().find(|(name, _)| name == word));
    let first = values[0];
    // Seconds since 1970 in units of 2001 to 2065; days of spreadsheets, of MATLAB and of astronomers.
    let since_1970 = [1.0, 1e-3, 1e-6, 1e-9]
        .into_iter()
        .find(|unit_s| (1e9..3e9).contains(&(first * unit_s)));
    let is_day = (30_000.0..70_000.0).contains(&first) && step < 0.25;
    let is_long_day = (700_000.0..2_500_000.0).contains(&first) && step < 0.25;
    let days = (is_day
        && words
            .iter()
            .any(|word| ["date", "datum", "excel", "serial"].contains(&word.as_str())))
        || is_long_day;
    let chosen = named.map(|(_, unit_s)| *unit_s).filter(is_plausible);
    let chosen = chosen
        .or(since_1970.filter(is_plausible))
        .or(days.then_some(DAY_S));
    chosen
        .or_else(|| by_rotation(table, column, &values))
        .unwrap_or(1.0)
}

/// The unit in which gravity turns about as fast as the Earth.
fn by_rotation(table: &Table<'_>, column: usize, values: &[f64]) -> Option<f64> {
    const BLOCKS: usize = 16;
    /// Least turn between blocks \[rad\] that is told from noise.
    const LEAST_RAD: f64 = 2e-3;
    let force = force(table, &[column])?;
    let rows = vectors(table, force.columns);
    let block = rows.len() / BLOCKS;
    let means: Vec<[f64; 4]> = (0..if block > 0 { BLOCKS } else { 0 })
        .map(|number| {
            let all = number * block..(number + 1) * block;
            let here: Vec<usize> = all
                .filter(|row| rows[*row].iter().all(|value| value.is_finite()))
                .collect();
            let mean = |of: &dyn Fn(usize) -> f64| {
                here.iter().map(|row| of(*row)).sum::<f64>() / here.len() as f64
            };
            let up: [f64; 3] =
                core::array::from_fn(|axis| mean(&|row| rows[row][axis] - force.zero));
            let size = up.iter().map(|it| it * it).sum::<f64>().sqrt();
            [
                up[0] / size,
                up[1] / size,
                up[2] / size,
                mean(&|row| values[row]),
            ]
        })
        .collect();
    let turn = |pair: &[[f64; 4]]| {
        let chord = (0..3)
            .map(|axis| (pair[1][axis] - pair[0][axis]).powi(2))
            .sum::<f64>()
            .sqrt();
        [chord, chord / (pair[1][3] - pair[0][3])]
    };
    let turns: Vec<[f64; 2]> = means
        .windows(2)
        .map(turn)
        .filter(|turn| turn[1].is_finite())
        .collect();
    let of = |which: usize| -> Vec<f64> { turns.iter().map(|turn| turn[which]).collect() };
    if turns.is_empty() || median(&of(0)) < LEAST_RAD {
        return None;
    }
    let rate = median(&of(1));
    let units = [1.0, 1e-3, 1e-6, 1e-9, 60.0, 3600.0, DAY_S];
    let distance = |unit_s: &f64| (rate / unit_s / (CONE * EARTH_RAD_PER_S)).ln().abs();
    units
        .into_iter()
        .min_by(|a, b| distance(a).total_cmp(&distance(b)))
}
