//! Words of findings.

use core::ops::Range;

use gyrocal_record::{AXES, counted};

/// `accelerometer x`, or `accelerometers x and y`.
pub(crate) fn accelerometers(axes: &[usize]) -> String {
    let letters: Vec<&str> = axes.iter().map(|axis| AXES[*axis]).collect();
    match letters[..] {
        [] => "no accelerometer".to_owned(),
        [one] => format!("accelerometer {one}"),
        [one, two] => format!("accelerometers {one} and {two}"),
        _ => "all accelerometers".to_owned(),
    }
}

/// `1 row` or `12 rows`.
pub(crate) fn rows(count: usize) -> String {
    counted(count, "row")
}

/// Rows counted from 1, as people count them.
pub(crate) fn row(index: usize) -> usize {
    index + 1
}

/// What a finding on the longest of some runs tells of the others.
pub(crate) fn other_runs(runs: usize) -> String {
    match runs {
        0 | 1 => String::new(),
        all => format!(", and {} more such runs", all - 1),
    }
}

/// From the first to after the last of some rising rows.
pub(crate) fn span(rows: &[usize]) -> Range<usize> {
    match (rows.first(), rows.last()) {
        (Some(first), Some(last)) => *first..last + 1,
        _ => 0..0,
    }
}

/// A number with about four significant digits.
pub(crate) fn number(value: f64) -> String {
    if value == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&value.abs()) {
        let digits = 3.0 - value.abs().max(1e-3).log10().floor();
        format!("{value:.*}", digits.clamp(0.0, 6.0) as usize)
    } else {
        format!("{value:.3e}")
    }
}
