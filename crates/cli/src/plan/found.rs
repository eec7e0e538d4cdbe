//! Findings of the records: read from a diagnosis file, or by a diagnosis.

use std::borrow::Cow;
use std::path::Path;

use gyrocal_calibration::{FittedPlatform, Options, Run};
use gyrocal_design::{NamedCause, noise_of};
use gyrocal_diagnosis::prose::counted;
use gyrocal_diagnosis::{DiagnoseOptions, DiagnosisResult, Gate, diagnose_watched, result};
use gyrocal_record::{Bench, Input, Record, RecordFile, SetupProblem, printable_path};
use gyrocal_setup::PlatformKind;

use super::failed::{NotPlanned, OtherInput};
use super::{PlanArguments, several};
use crate::Failure;
use crate::diagnose::NotDiagnosed;
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
    let kind = PlatformKind::Stabilised;
    let checked = Gate::of_file(kind, file, bench, &Options::default())?;
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
    let diagnosis = result::read(path)?;
    refuse(path, &diagnosis, 1)?;
    check_inputs(path, &diagnosis, arguments)?;
    let named = NamedCause::all(&diagnosis);
    let (record, setup) = checked
        .sound(&DiagnoseOptions::default())
        .map_err(|source| NotDiagnosed::new(&arguments.records[0], bench, source))?;
    let fitted = {
        let run = Run {
            record: &record,
            bench,
        };
        let noise = noise_of(&diagnosis);
        let fitted = NamedCause::fitted(&named, &run, &noise, &Options::default())
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

/// Refuses a diagnosis of another number of records, and of what is no stabilised platform.
pub(super) fn refuse(
    path: &Path,
    diagnosis: &DiagnosisResult,
    given: usize,
) -> Result<(), Failure> {
    let found = diagnosis.records.len().max(1);
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
    if diagnosis.strapdown {
        return Err(Failure::Usage(format!(
            "{} is of a strapdown unit (--gyro-axes): a run is planned of a stabilised platform. The next log \
             of a unit is best one in another attitude",
            printable_path(path)
        )));
    }
    Ok(())
}

/// The inputs of a diagnosis are each record with its bench file; a later record and its bench file may
/// follow.
pub(super) fn check_inputs(
    path: &Path,
    diagnosis: &DiagnosisResult,
    arguments: &PlanArguments,
) -> Result<(), Failure> {
    let given = arguments.pairs().flat_map(|(record, bench)| {
        [
            (record, "of another record"),
            (bench, "with another bench file"),
        ]
    });
    for (place, (given, other)) in given.enumerate() {
        let expected = Input::of(given)?.sha256;
        let found = diagnosis.manifest.inputs.get(place);
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
