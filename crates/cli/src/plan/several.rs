//! What several records of one platform tell together: read from a joint diagnosis, or by one.

use std::borrow::Cow;
use std::path::Path;

use gyrocal_answer::read_platform;
use gyrocal_calibration::{Options, Run};
use gyrocal_design::{NamedCause, fitted_to_records};
use gyrocal_diagnosis::{
    DiagnoseOptions, DiagnosisError, Gate, RecordToDiagnose, diagnose_together, problems_of,
};
use gyrocal_record::{Bench, Record, RecordFile, printable_path};

use super::PlanArguments;
use super::failed::NotPlanned;
use super::found::{Known, check_inputs, options, refuse};
use crate::Failure;
use crate::diagnose::NotDiagnosed;
use crate::gyro_axes;
use crate::progress::Progress;
use crate::records::refuse_shared_rows;

pub(super) fn known<'a>(
    arguments: &PlanArguments,
    files: &'a [RecordFile],
    benches: &'a [Bench],
    progress: &mut Progress,
) -> Result<Known<'a>, Failure> {
    let paths = arguments.records.iter();
    let named: Vec<(&Path, &Record)> = paths
        .zip(files)
        .map(|(path, file)| (path.as_path(), file.record()))
        .collect();
    refuse_shared_rows(&named)?;
    let checked = checked(arguments, files, benches)?;
    let failed = |source| NotDiagnosed::new(&arguments.records[0], &benches[0], source);
    let Some(path) = &arguments.diagnosis else {
        let options = options(arguments);
        let found =
            diagnose_together(checked, &options, |stage| progress.at(stage)).map_err(failed)?;
        return Ok(Known {
            named: NamedCause::all(&found.result),
            fitted: found.extended.unwrap_or(found.nominal),
            record: found.record,
            setup: found.result.setup,
        });
    };
    let diagnosis = read_platform(path)?;
    refuse(path, &diagnosis, arguments)?;
    check_inputs(path, &diagnosis, arguments)?;
    let mut setup = Vec::new();
    let mut sound: Vec<Cow<'_, Record>> = Vec::with_capacity(files.len());
    let mut axes = Vec::with_capacity(files.len());
    for RecordToDiagnose { name, gate, .. } in checked {
        let of_record = |source| {
            failed(DiagnosisError::OfRecord {
                name: name.clone(),
                source: Box::new(source),
            })
        };
        let own = gate.usable_axes();
        axes.extend(own.map_err(|source| of_record(source.into()))?);
        let (record, problems) = gate.sound(&DiagnoseOptions::default()).map_err(of_record)?;
        setup.extend(problems_of(&name, problems));
        sound.push(record);
    }
    let runs = sound.iter().zip(benches);
    let runs: Vec<Run<'_>> = runs.map(|(record, bench)| Run { record, bench }).collect();
    let (fitted, record) = fitted_to_records(&diagnosis, &runs, &axes, &Options::default())
        .map_err(|source| NotPlanned::new(&arguments.records, source))?;
    Ok(Known {
        record: Cow::Owned(record),
        setup,
        fitted,
        named: NamedCause::all(&diagnosis),
    })
}

/// Each record with its axes, its set-up checked.
fn checked<'a>(
    arguments: &PlanArguments,
    files: &'a [RecordFile],
    benches: &'a [Bench],
) -> Result<Vec<RecordToDiagnose<'a>>, Failure> {
    let kind = gyro_axes::kind(&arguments.gyro_axes);
    let records = files.iter().map(RecordFile::record);
    let mut axes = gyro_axes::read(&arguments.gyro_axes, records)?.into_iter();
    let named = arguments.records.iter().zip(files).zip(benches);
    named
        .map(|((path, file), bench)| {
            let gate = Gate::of_file(kind, file, bench, &Options::default())?;
            Ok(RecordToDiagnose {
                name: printable_path(path),
                gate: gate.with_gyro_axes(axes.next()),
                bench,
            })
        })
        .collect()
}
