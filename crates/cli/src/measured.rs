//! Shared parts of the commands on logs of real sensors.

use std::path::{Path, PathBuf};

use gyrocal_instruments::{Description, InstrumentError, Log};
use gyrocal_record::printable_path;
use miette::miette;

use crate::Failure;

/// An error of a log as a failure of the command.
pub(crate) fn unusable(log: &Path, error: InstrumentError) -> Failure {
    match error {
        InstrumentError::File(error) => error.into(),
        InstrumentError::Unfit {
            found,
            expected,
            advice,
            ..
        } => Failure::Work(miette!(
            code = "gyrocal::measured::unfit",
            help = advice,
            "{}: found {found}, expected {expected}",
            printable_path(log)
        )),
        other => Failure::of(log, other),
    }
}

/// Logs of one unit, each read by the description in this file, and what there is to tell of their clocks.
pub(crate) fn logs<T>(
    paths: &[PathBuf],
    description: &Path,
    read: impl Fn(&Path, &Description) -> Result<T, InstrumentError>,
    log: impl Fn(&T) -> &Log,
) -> Result<(Description, Vec<T>, Vec<String>), Failure> {
    let description =
        Description::read(description).map_err(|error| unusable(&paths[0], error.into()))?;
    let logs = paths.iter();
    let logs = logs.map(|path| read(path, &description).map_err(|error| unusable(path, error)));
    let logs: Vec<T> = logs.collect::<Result<_, _>>()?;
    let mut notes: Vec<String> = logs
        .iter()
        .filter_map(|one| log(one).clock.note())
        .collect();
    notes.dedup();
    Ok((description, logs, notes))
}

/// Parses `FROM:TO`.
pub(crate) fn interval(text: &str) -> Result<[f64; 2], String> {
    let ends = text
        .split_once(':')
        .and_then(|(from, to)| Some([from.parse::<f64>().ok()?, to.parse::<f64>().ok()?]));
    ends.filter(|[from, to]| from < to)
        .ok_or_else(|| "expected two times in seconds, FROM:TO, FROM before TO".to_owned())
}
