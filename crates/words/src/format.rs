//! Numbers in sentences.

pub use gyrocal_record::{capitalised, counted};
use gyrocal_statistics::format;

/// Estimate and sigma with the digits that the sigma allows: `0.00133 ± 0.00008`.
pub(crate) fn with_sigma(estimate: f64, sigma: f64) -> String {
    let [estimate, sigma] = format::estimate(estimate, sigma);
    format!("{estimate} ± {sigma}")
}

/// A unit behind a value, with a blank between them; `1` is no unit.
#[must_use]
pub fn behind(unit: &str) -> String {
    match unit {
        "" | "1" => String::new(),
        unit => format!(" {unit}"),
    }
}

/// A number with four digits at most.
pub(crate) fn short(value: f64) -> String {
    format::short(value, 4)
}

/// A time in the unit that serves it: `0.0500 s`, `12.5 min`, `5.30 h`.
#[must_use]
pub fn time(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{} s", format::significant(s, 3)),
        s if s < 7200.0 => format!("{} min", format::significant(s / 60.0, 3)),
        s => format!("{:.2} h", s / 3600.0),
    }
}

/// A duration of hours: `72 h`, `12.5 h`, `1.5 h`.
#[must_use]
pub fn hours(seconds: f64) -> String {
    match seconds / 3600.0 {
        hours if hours >= 10.0 => format!("{} h", format::short(hours, 3)),
        hours => format!("{hours:.1} h"),
    }
}

/// Rows and duration of a record: `2880 rows over 2.00 days`.
#[must_use]
pub fn size(rows: usize, duration_s: f64) -> String {
    let days = duration_s / 86_400.0;
    format!("{} over {days:.2} days", counted(rows, "row"))
}

/// What stands in the place of a p-value that was not computed.
pub(crate) const NO_P: &str = "p not computed for the final model";

/// A p-value in words.
pub(crate) fn tested(p: Option<f64>) -> String {
    p.map_or_else(|| NO_P.to_owned(), format::p_value)
}
