//! Columns of accelerometers and temperature, by names and values.

use gyrocal_statistics::{median, quantile};

use super::layout::Table;

/// Words at the beginning of the names of accelerometers.
const ACCELEROMETERS: [&str; 6] = ["acc", "force", "beschl", "sf", "spec", "a"];

/// Words in the names of temperatures.
const TEMPERATURES: [&str; 7] = ["temp", "rtd", "pt100", "pt1000", "ntc", "therm", "°c"];

/// Columns that are tried as accelerometers where names do not tell.
const MOST_COLUMNS: usize = 24;

/// Rows that are enough for a magnitude.
const SAMPLES: usize = 400;

/// Largest relative spread (10 to 90 %) of the magnitude of specific force.
const SPREAD: f64 = 0.1;

/// Counts of a converter at zero that are tried.
const ZEROS: [f64; 8] = [
    0.0,
    128.0,
    2048.0,
    32768.0,
    131_072.0,
    524_288.0,
    8_388_608.0,
    2_147_483_648.0,
];

/// Three columns of specific force.
pub(super) struct Force {
    pub(super) columns: [usize; 3],
    /// Unit by its word in a map.
    pub(super) unit: &'static str,
    /// Median magnitude in the unit of the file.
    pub(super) magnitude: f64,
    /// Count at zero.
    pub(super) zero: f64,
}

/// A column of temperature.
pub(super) struct Warmth {
    pub(super) column: usize,
    pub(super) unit: &'static str,
}

/// Three numbers of each row that has them.
pub(super) fn vectors(table: &Table<'_>, columns: [usize; 3]) -> Vec<[f64; 3]> {
    let row = |row: usize| columns.map(|column| table.number(row, column));
    (0..table.rows.len()).map(row).collect()
}

/// Specific force: columns with names of it, else three whose magnitude is one, near that of a usual unit if
/// there are such.
pub(super) fn force(table: &Table<'_>, taken: &[usize]) -> Option<Force> {
    let is_free = |column: &usize| !taken.contains(column) && table.share_of_numbers(*column) > 0.5;
    let free: Vec<usize> = (0..table.names.len()).filter(is_free).collect();
    if let Some(columns) = named(table, &free) {
        return of_columns(table, columns, f64::INFINITY);
    }
    let free = &free[..free.len().min(MOST_COLUMNS)];
    let mut best: Option<(f64, Force)> = None;
    for (at, x) in free.iter().enumerate() {
        for (between, y) in free[at + 1..].iter().enumerate() {
            for z in &free[at + between + 2..] {
                let Some(force) = of_columns(table, [*x, *y, *z], SPREAD) else {
                    continue;
                };
                let usual = f64::from(u8::from(force.unit != "counts"));
                let rank = 100.0 * usual - (z - x) as f64;
                if best.as_ref().is_none_or(|(highest, _)| rank > *highest) {
                    best = Some((rank, force));
                }
            }
        }
    }
    best.map(|(_, force)| force)
}

/// Columns of x, y and z by their names.
fn named(table: &Table<'_>, free: &[usize]) -> Option<[usize; 3]> {
    let words = |is_one: fn(&str, char) -> bool| {
        let of_axis = |axis: char| {
            free.iter()
                .copied()
                .find(|column| is_one(&table.titles[*column], axis))
        };
        Some([of_axis('x')?, of_axis('y')?, of_axis('z')?])
    };
    words(is_accelerometer).or_else(|| words(|title, axis| bare(title) == axis.to_string()))
}

/// A title without its unit.
fn bare(title: &str) -> String {
    let end = title.find(['[', '(']).unwrap_or(title.len());
    title[..end].trim().to_lowercase()
}

/// Whether a title is that of the accelerometer of an axis: words for it, with the letter of the axis as a word or at
/// the end of one.
fn is_accelerometer(title: &str, axis: char) -> bool {
    let bare = bare(title);
    let mut words = bare.split(|sign: char| !sign.is_alphanumeric());
    let has_axis = words.any(|word| word.ends_with(axis));
    has_axis && ACCELEROMETERS.iter().any(|word| bare.starts_with(word))
}

/// Specific force of some columns, if the relative spread of its magnitude is below a limit.
fn of_columns(table: &Table<'_>, columns: [usize; 3], limit: f64) -> Option<Force> {
    let step = table.rows.len().div_ceil(SAMPLES).max(1);
    let rows: Vec<[f64; 3]> = vectors(table, columns).into_iter().step_by(step).collect();
    let magnitudes = |zero: f64| -> Vec<f64> {
        let of = |row: &[f64; 3]| {
            row.iter()
                .map(|value| (value - zero).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        rows.iter()
            .map(of)
            .filter(|size| size.is_finite())
            .collect()
    };
    let spread = |zero: f64| {
        let sizes = magnitudes(zero);
        match sizes.is_empty() {
            true => f64::INFINITY,
            false => (quantile(&sizes, 0.9) - quantile(&sizes, 0.1)) / median(&sizes),
        }
    };
    let is_whole = rows
        .iter()
        .flatten()
        .all(|value| value.is_nan() || value.fract() == 0.0);
    let zeros = if is_whole { &ZEROS[..] } else { &ZEROS[..1] };
    let zero = zeros
        .iter()
        .copied()
        .min_by(|a, b| spread(*a).total_cmp(&spread(*b)))?;
    let sizes = magnitudes(zero);
    if sizes.is_empty() || spread(zero).is_nan() || spread(zero) > limit {
        return None;
    }
    let magnitude = median(&sizes);
    let unit = match zero == 0.0 {
        true => unit_of(magnitude),
        false => "counts",
    };
    (magnitude > 0.0).then_some(Force {
        columns,
        unit,
        magnitude,
        zero,
    })
}

/// The unit in which gravity has this magnitude.
fn unit_of(magnitude: f64) -> &'static str {
    match magnitude {
        0.9..=1.1 => "g",
        9.7..=9.9 => "m/s2",
        // Gravity in ft/s².
        31.9..=32.4 => "ft/s2",
        // 981 Gal are no thousand mg.
        985.0..=1100.0 | 900.0..=975.0 => "mg",
        9e5..=1.1e6 => "ug",
        _ => "counts",
    }
}

/// Temperature, by its name.
pub(super) fn warmth(table: &Table<'_>, taken: &[usize]) -> Option<Warmth> {
    let is_one = |column: &usize| {
        let title = table.titles[*column].to_lowercase();
        let has_word = TEMPERATURES.iter().any(|word| title.contains(word)) || bare(&title) == "t";
        has_word && !taken.contains(column) && table.share_of_numbers(*column) > 0.01
    };
    let column = (0..table.names.len()).find(is_one)?;
    let values: Vec<f64> = table
        .numbers(column)
        .into_iter()
        .filter(|value| value.is_finite())
        .collect();
    let title = table.titles[column].to_lowercase();
    let words: Vec<&str> = title.split(|sign: char| !sign.is_alphanumeric()).collect();
    let says = |names: [&str; 3]| words.iter().any(|word| names.contains(word));
    let unit = if says(["f", "degf", "fahrenheit"]) {
        "F"
    } else if says(["k", "kelvin", "degk"]) {
        "K"
    } else if says(["c", "degc", "celsius"]) {
        "C"
    } else {
        // Temperatures of a laboratory.
        match median(&values) {
            200.0..=350.0 => "K",
            55.0..=120.0 => "F",
            _ => "C",
        }
    };
    Some(Warmth { column, unit })
}
