//! What several records of one platform tell together: read from a joint diagnosis, or by one.

use std::borrow::Cow;

use gyrocal_answer::read_platform;
use gyrocal_calibration::{Options, Run};
use gyrocal_design::{NamedCause, fitted_to_records};
use gyrocal_diagnosis::{
    DiagnoseOptions, DiagnosisError, RecordToDiagnose, diagnose_together, problems_of,
};
use gyrocal_record::{Bench, Record, RecordFile};

use super::PlanArguments;
use super::failed::NotPlanned;
use super::found::{Known, check_inputs, options, refuse};
use crate::Failure;
use crate::diagnose::NotDiagnosed;
use crate::progress::Progress;

pub(super) fn known<'a>(
    arguments: &PlanArguments,
    files: &'a [RecordFile],
    benches: &'a [Bench],
    progress: &mut Progress,
) -> Result<Known<'a>, Failure> {
    let given = arguments.given();
    let checked = given.checked(files, benches, &Options::default())?;
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
