//! Names of the columns of a frame.

use gyrocal_record::RecordFile;

use crate::error::{Failure, Outcome};

/// The columns of a record, time first; the last one is optional.
pub(crate) const COLUMNS: [&str; 5] = [
    "time_s",
    "accel_x_g",
    "accel_y_g",
    "accel_z_g",
    "temperature_c",
];

/// Refuses names that a file of a record does not have: the rules, and the advice, are those of the
/// header of such a file.
pub(crate) fn check_names(names: &[&str], frame: &str) -> Outcome<()> {
    let odd = |name: &&&str| name.is_empty() || name.contains([',', '"', '\n', '\r', ';', '\t']);
    if let Some(name) = names.iter().find(odd) {
        return Err(Failure::of_value(
            frame,
            format!("a column `{name}`"),
            "the columns of a record",
            "select time_s, accel_x_g, accel_y_g, accel_z_g and, if there is one, temperature_c",
        ));
    }
    let located = RecordFile::parse(&names.join(","), frame).map(|_| ());
    located.map_err(|error| {
        let failure = Failure::from(error);
        // A frame has no lines.
        let found = failure.found.as_deref().unwrap_or_default();
        let expected = failure.expected.as_deref().unwrap_or_default();
        Failure {
            message: format!("{frame}: found {found}, expected {expected}"),
            line: None,
            column: None,
            ..failure
        }
    })
}
