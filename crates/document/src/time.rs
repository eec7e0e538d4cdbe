//! Time as an abscissa.

/// Times since the first row in the unit that suits their length.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeAxis {
    /// The times in that unit.
    pub values: Vec<f64>,
    /// The unit: `s`, `min`, `h` or `days`.
    pub unit: &'static str,
}

impl TimeAxis {
    /// Times of rows, s.
    #[must_use]
    pub fn of(time_s: &[f64]) -> Self {
        let first = time_s.first().copied().unwrap_or(0.0);
        let length_s = time_s.last().map_or(0.0, |last| last - first);
        let (unit_s, unit) = match length_s {
            length if length > 10.0 * 86_400.0 => (86_400.0, "days"),
            length if length > 2.0 * 3600.0 => (3600.0, "h"),
            length if length > 120.0 => (60.0, "min"),
            _ => (1.0, "s"),
        };
        Self {
            values: time_s.iter().map(|time| (time - first) / unit_s).collect(),
            unit,
        }
    }
}
