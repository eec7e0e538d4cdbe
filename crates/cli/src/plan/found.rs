//! Findings of the records: read from a diagnosis file, or by a diagnosis.

use std::borrow::Cow;
use std::path::Path;

use gyrocal_answer::{Answer, read_platform};
use gyrocal_calibration::{FittedPlatform, Options, Run};
use gyrocal_design::{NamedCause, noise_of};
use gyrocal_diagnosis::{DiagnoseOptions, Gate, diagnose_watched};
use gyrocal_record::{Bench, Input, Record, RecordFile, SetupProblem, printable_path};
use gyrocal_words::counted;

use super::failed::{NotPlanned, OtherInput};
use super::{PlanArguments, several};
use crate::Failure;
use crate::diagnose::NotDiagnosed;
use crate::gyro_axes;
use crate::progress::Progress;

/// Starting point of a plan.
pub(super) struct Known<'a> {
    /// The record without what gross errors of the set-up spoilt.
    pub(super) record: Cow<'a, Record>,
    /// Gross errors that were mended.
    pub(super) setup: Vec<SetupProblem>,
    pub(super) fitted: FittedPlatform<'a>,
    pub(super) named: Vec<NamedCause>,
}

pub(super) fn known<'a>(
    arguments: &PlanArguments,
    files: &'a [RecordFile],
    benches: &'a [Bench],
    progress: &mut Progress,
) -> Result<Known<'a>, Failure> {
    let ([file], [bench]) = (files, benches) else {
        return several::known(arguments, files, benches, progress);
    };
    let axes = gyro_axes::read(&arguments.gyro_axes, [file.record()])?.pop();
    let kind = gyro_axes::kind(&arguments.gyro_axes);
    let checked = Gate::of_file(kind, file, bench, &Options::default())?.with_gyro_axes(axes);
    match &arguments.diagnosis {
        Some(path) => written(path, arguments, checked, bench),
        None => made(arguments, checked, bench, progress),
    }
}

/// Settings of a diagnosis that the command makes.
pub(super) fn options(arguments: &PlanArguments) -> DiagnoseOptions {
    DiagnoseOptions {
        false_alarm_probability: arguments.false_alarm,
        also: arguments.effects.clone(),
        ..DiagnoseOptions::default()
    }
}

fn made<'a>(
    arguments: &PlanArguments,
    checked: Gate<'a>,
    bench: &'a Bench,
    progress: &mut Progress,
) -> Result<Known<'a>, Failure> {
    let options = options(arguments);
    let found = diagnose_watched(checked, bench, &options, |stage| progress.at(stage))
        .map_err(|source| NotDiagnosed::new(&arguments.records[0], bench, source))?;
    Ok(Known {
        named: NamedCause::all(&found.result),
        fitted: found.extended.unwrap_or(found.nominal),
        record: found.record,
        setup: found.result.setup,
    })
}

fn written<'a>(
    path: &Path,
    arguments: &PlanArguments,
    checked: Gate<'a>,
    bench: &'a Bench,
) -> Result<Known<'a>, Failure> {
    let diagnosis = read_platform(path)?;
    refuse(path, &diagnosis, arguments)?;
    check_inputs(path, &diagnosis, arguments)?;
    let named = NamedCause::all(&diagnosis);
    let failed = |source| NotDiagnosed::new(&arguments.records[0], bench, source);
    let axes = checked.usable_axes();
    let axes = axes.map_err(|source| failed(source.into()))?;
    let (record, setup) = checked.sound(&DiagnoseOptions::default()).map_err(failed)?;
    let fitted = {
        let run = Run {
            record: &record,
            bench,
        };
        let noise = noise_of(&diagnosis);
        let options = Options::default();
        let fitted = NamedCause::fitted_of_unit(&named, &run, axes.as_ref(), &noise, &options)
            .map_err(|source| NotPlanned::new(&arguments.records, source))?;
        fitted.into_owned()
    };
    Ok(Known {
        record,
        setup,
        fitted,
        named,
    })
}

/// Refuses a diagnosis of another number of records, and one with axes where none are given, or without.
pub(super) fn refuse(
    path: &Path,
    diagnosis: &Answer,
    arguments: &PlanArguments,
) -> Result<(), Failure> {
    let found = diagnosis.records.len().max(1);
    let given = arguments.records.len();
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
    let what = match (diagnosis.is_strapdown(), arguments.gyro_axes.is_empty()) {
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
pub(super) fn check_inputs(
    path: &Path,
    diagnosis: &Answer,
    arguments: &PlanArguments,
) -> Result<(), Failure> {
    let pairs = arguments.given().pairs().flat_map(|(record, bench)| {
        [
            (record, "of another record"),
            (bench, "with another bench file"),
        ]
    });
    let inputs = &diagnosis.manifest.inputs;
    let pairs = pairs
        .enumerate()
        .map(|(place, (given, other))| (given, other, inputs.get(place)));
    let axes = arguments.gyro_axes.iter().enumerate();
    let axes =
        axes.map(|(place, given)| (given, "with other axes", diagnosis.axes_inputs().get(place)));
    for (given, other, found) in pairs.chain(axes) {
        let expected = Input::of(given)?.sha256;
        if found.is_none_or(|input| input.sha256 != expected) {
            return Err(OtherInput {
                diagnosis: printable_path(path),
                other,
                given: printable_path(given),
                found: found.map_or_else(|| "none".to_owned(), |input| input.sha256.clone()),
                expected,
            }
            .into());
        }
    }
    Ok(())
}
