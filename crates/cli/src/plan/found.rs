//! Findings of the records: read from a diagnosis file, or by a diagnosis.

use std::path::Path;

use gyrocal_answer::{Answer, read_platform};
use gyrocal_calibration::Options;
use gyrocal_design::{Known, NotKnown};
use gyrocal_diagnosis::{DiagnoseOptions, RecordToDiagnose, diagnose_together, diagnose_watched};
use gyrocal_record::{Bench, Input, RecordFile, printable_path};
use gyrocal_words::counted;
use miette::miette;

use super::PlanArguments;
use super::failed::NotPlanned;
use crate::Failure;
use crate::diagnose::NotDiagnosed;
use crate::progress::Progress;

pub(super) fn known<'a>(
    arguments: &PlanArguments,
    files: &'a [RecordFile],
    benches: &'a [Bench],
    progress: &mut Progress,
) -> Result<Known<'a>, Failure> {
    let given = &arguments.given;
    let mut checked = given.checked(files, benches, &Options::default())?;
    let failed = |source| NotDiagnosed::new(given.first(), &benches[0], source);
    if let Some(path) = &arguments.diagnosis {
        let diagnosis = read_platform(path)?;
        refuse(path, &diagnosis, arguments)?;
        check_inputs(path, &diagnosis, arguments)?;
        return Known::written(&diagnosis, checked).map_err(|error| match error {
            NotKnown::Record(source) => failed(source).into(),
            NotKnown::Fit(source) => NotPlanned::new(&given.records, source).into(),
        });
    }
    let options = DiagnoseOptions {
        false_alarm_probability: arguments.false_alarm,
        also: arguments.effects.clone(),
        ..DiagnoseOptions::default()
    };
    let one = checked.pop_if(|_| files.len() == 1);
    let found = match one {
        Some(RecordToDiagnose { gate, bench, .. }) => {
            diagnose_watched(gate, bench, &options, |stage| progress.at(stage))
        }
        None => diagnose_together(checked, &options, |stage| progress.at(stage)),
    };
    Ok(found.map_err(failed)?.into())
}

/// Refuses a diagnosis of another number of records, and one with axes where none are given, or without.
fn refuse(path: &Path, diagnosis: &Answer, arguments: &PlanArguments) -> Result<(), Failure> {
    let found = diagnosis.records.len().max(1);
    let given = arguments.given.records.len();
    if found != given {
        return Err(Failure::Usage(format!(
            "{} is a result of {}, and {} given: give what was diagnosed, in the same order",
            printable_path(path),
            counted(found, "record"),
            match given {
                1 => "one is".to_owned(),
                more => format!("{more} are"),
            }
        )));
    }
    let what = match (
        diagnosis.is_strapdown(),
        arguments.given.gyro_axes.is_empty(),
    ) {
        (true, true) => {
            "is of a strapdown unit: give its axes, --gyro-axes AXES.csv, for each record"
        }
        (false, false) => {
            "is of a stabilised platform: leave --gyro-axes out, or diagnose with them"
        }
        _ => return Ok(()),
    };
    Err(Failure::Usage(format!("{} {what}", printable_path(path))))
}

/// The inputs of a diagnosis are each record with its bench file; a later record and its bench file may
/// follow, then axes.
fn check_inputs(path: &Path, diagnosis: &Answer, arguments: &PlanArguments) -> Result<(), Failure> {
    let pairs = arguments.given.pairs().flat_map(|(record, bench)| {
        [
            (record, "of another record"),
            (bench, "with another bench file"),
        ]
    });
    let inputs = &diagnosis.manifest.inputs;
    let pairs = pairs
        .enumerate()
        .map(|(place, (given, other))| (given, other, inputs.get(place)));
    let axes = arguments.given.gyro_axes.iter().enumerate();
    let axes =
        axes.map(|(place, given)| (given, "with other axes", diagnosis.axes_inputs().get(place)));
    for (given, other, found) in pairs.chain(axes) {
        let expected = Input::of(given)?.sha256;
        if found.is_none_or(|input| input.sha256 != expected) {
            return Err(Failure::Work(miette!(
                code = "gyrocal::plan",
                help = "diagnose these records with these bench files, in this order, or leave --diagnosis out: the \
                        command then diagnoses them",
                "{}: a diagnosis {other}; that has SHA-256 {}, expected {expected}, that of {}",
                printable_path(path),
                found.map_or("none", |input| &input.sha256),
                printable_path(given),
            )));
        }
    }
    Ok(())
}
