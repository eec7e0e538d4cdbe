//! The page of a diagnosis.

pub(crate) mod coefficients;
mod covariates;
mod findings;
mod gain;
mod limits;
pub(crate) mod open_loop;
mod residuals;
mod test_table;

use gyrocal_answer::{Answer, Verdict};
use gyrocal_diagnosis::Diagnosis;
use gyrocal_document::{Item, Part, Section};

use crate::error::PageError;
use crate::origin::{part, record_name};
use open_loop::Simulated;

/// The page of a diagnosis with its fits.
///
/// # Errors
/// [`PageError`] where a simulation fails. A series for which the record is too short is left out.
pub fn of_diagnosis(diagnosis: &Diagnosis<'_>) -> Result<Part, PageError> {
    let result = &diagnosis.result;
    let simulated = Simulated {
        record: &diagnosis.record,
        bench: &diagnosis.bench,
        nominal: &diagnosis.nominal,
        extended: diagnosis.extended.as_ref(),
        effects: accepted(result),
    };
    let mut sections: Vec<Section> = open_loop::sections(&simulated)?.into();
    sections.extend(found(result));
    let fits = (&diagnosis.nominal, diagnosis.extended.as_ref());
    let convergence = coefficients::convergence(&diagnosis.record, fits)?;
    sections.extend(coefficients::section(result, convergence));
    sections.push(limits::cannot_tell(result));
    sections.push(residuals::section(result, residuals::charts(diagnosis)));
    sections.extend(covariates::magnitude(diagnosis));
    sections.extend(gain::section(result, diagnosis.later.as_ref()));
    let best = diagnosis.extended.as_ref().unwrap_or(&diagnosis.nominal);
    sections.push(coefficients::site(best)?);
    sections.push(limits::next_run(result));
    Ok(assembled(result, sections))
}

/// The page of a written answer on a platform: all but the charts over time, for which the record is needed.
pub(crate) fn of_platform(result: &Answer) -> Part {
    let mut sections = found(result);
    if result.verdict != Verdict::Setup {
        sections.extend(coefficients::section(result, None));
        sections.push(limits::cannot_tell(result));
        sections.push(residuals::section(result, Vec::new()));
        sections.extend(gain::section(result, None));
        sections.push(limits::next_run(result));
    }
    assembled(result, sections)
}

fn assembled(result: &Answer, sections: Vec<Section>) -> Part {
    let (manifest, first) = (&result.manifest, gyrocal_words::first_screen(result));
    let name = record_name(manifest, result.records.len());
    let size = gyrocal_words::size(result.record.rows, result.record.duration_s);
    part(manifest, name, size, first, sections)
}

/// Errors of the set-up, findings, records and ranking.
fn found(result: &Answer) -> Vec<Section> {
    let of_records = [findings::findings(result), findings::records(result)];
    let all = [findings::set_up(result)].into_iter().chain(of_records);
    all.chain([ranked(result)]).flatten().collect()
}

/// The ranking with its table.
fn ranked(result: &Answer) -> Option<Section> {
    let mut section = crate::ranked::section(result)?;
    let table = gyrocal_words::ranking(result);
    section.items.extend(table.map(Item::from));
    Some(section)
}

/// Effects in the extended model.
fn accepted(result: &Answer) -> Vec<&str> {
    let causes = result.causes();
    let accepted = causes.filter(|cause| cause.accepted == Some(true));
    accepted.map(|cause| &*cause.effect).collect()
}
