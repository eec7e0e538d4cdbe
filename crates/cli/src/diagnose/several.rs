//! `gyrocal diagnose` of several records of one platform.

use std::path::Path;

use gyrocal::generated::MODEL_HASH;
use gyrocal_diagnosis::diagnose_records;
use gyrocal_pages::{Part, of_diagnosis, of_result, pictures as charts};
use gyrocal_record::InputRole;

use super::{DiagnoseArguments, NotDiagnosed, finished};
use crate::outputs::manifest_of;
use crate::pictures::Named;
use crate::progress::Progress;
use crate::{Failure, Reply, page};

/// Runs the command; `inputs` are each record with its bench file.
pub(super) fn run(
    arguments: &DiagnoseArguments,
    inputs: &[(InputRole, &Path)],
) -> Result<Reply, Failure> {
    refuse_options(arguments)?;
    let (files, benches) = arguments.given.read()?;
    let options = arguments.options();
    let rows = files.iter().map(|file| file.record().len()).sum();
    tracing::info!(rows, records = files.len(), "read");
    let mut progress = Progress::waiting("diagnosing", rows);
    let checked = arguments
        .given
        .checked(&files, &benches, &options.calibration)?;
    let failed = |source| NotDiagnosed::new(arguments.given.first(), &benches[0], source);
    let mut found =
        diagnose_records(checked, &options, |stage| progress.at(stage)).map_err(failed)?;
    drop(progress);
    found.together.result.manifest = manifest_of(MODEL_HASH, options.seed, inputs, &benches)?;
    let result = &found.together.result;
    tracing::info!(verdict = ?result.verdict, "diagnosed");
    let mut answer = Reply::of_answer(result);
    if arguments.views.are_asked() {
        let mut parts = vec![of_result(result)];
        for (record, alone) in arguments.given.records.iter().zip(&found.alone) {
            parts.push(page::part(record, of_diagnosis(alone))?);
        }
        let (views, record) = (&arguments.views, arguments.given.first());
        views.stage_parts(record, parts, drawn, &mut answer)?;
    }
    finished(arguments, result, answer)
}

/// The charts of all parts: those of the answer to all records, and of each record by its number.
fn drawn(parts: &[Part]) -> Vec<Named> {
    let of_part = |(place, part): (usize, &Part)| {
        let of = match place {
            0 => "together".to_owned(),
            _ => format!("record-{place}"),
        };
        charts(part.clone())
            .into_iter()
            .map(move |(name, picture)| (format!("{of}-{name}"), picture))
    };
    parts.iter().enumerate().flat_map(of_part).collect()
}

/// Refuses options that go with one record.
fn refuse_options(arguments: &DiagnoseArguments) -> Result<(), Failure> {
    let one = [
        ("--validate", arguments.validate.is_some()),
        ("--filter", arguments.filter.is_some()),
    ];
    match one.into_iter().find(|(_, given)| *given) {
        Some((option, _)) => Err(Failure::Usage(format!(
            "{option} goes with one record, {} are given: diagnose that record by itself",
            arguments.given.records.len()
        ))),
        None => Ok(()),
    }
}
