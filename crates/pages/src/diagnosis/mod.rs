//! The page of a diagnosis.

pub(crate) mod coefficients;
mod covariates;
mod gain;
mod limits;
pub(crate) mod open_loop;
pub(crate) mod ranking;
mod residuals;

use gyrocal_answer::{Answer, Verdict};
use gyrocal_diagnosis::Diagnosis;
use gyrocal_document::{Item, Part, Section};
use gyrocal_record::Bench;

use crate::error::PageError;
use crate::origin::{file_name, origin};
use crate::ranked::Ranked;
use open_loop::Simulated;

/// The page of a diagnosis with its fits.
///
/// # Errors
/// [`PageError`] where a simulation fails. A series for which the record is too short is left out.
pub fn of_diagnosis(diagnosis: &Diagnosis<'_>, bench: &Bench) -> Result<Part, PageError> {
    let result = &diagnosis.result;
    let simulated = Simulated {
        record: &diagnosis.record,
        bench,
        nominal: &diagnosis.nominal,
        extended: diagnosis.extended.as_ref(),
        effects: accepted(result),
    };
    let mut sections: Vec<Section> = open_loop::sections(&simulated)?.into();
    sections.extend(ranked(result));
    let fits = (&diagnosis.nominal, diagnosis.extended.as_ref());
    let convergence = coefficients::convergence(&diagnosis.record, fits)?;
    sections.extend(coefficients::section(result, convergence));
    sections.push(limits::cannot_tell(result));
    sections.push(residuals::section(result, residuals::charts(diagnosis)));
    sections.extend(covariates::magnitude(diagnosis, bench));
    sections.extend(gain::section(result, diagnosis.later.as_ref()));
    let best = diagnosis.extended.as_ref().unwrap_or(&diagnosis.nominal);
    sections.push(coefficients::site(best)?);
    sections.push(limits::next_run(result));
    sections.push(in_words(result));
    Ok(part(result, sections))
}

/// The page of a written answer on a platform: all but the charts over time, for which the record is needed.
pub(crate) fn of_platform(result: &Answer) -> Part {
    let mut sections = Vec::new();
    if result.verdict != Verdict::Setup {
        sections.extend(ranked(result));
        sections.extend(coefficients::section(result, None));
        sections.push(limits::cannot_tell(result));
        sections.push(residuals::section(result, Vec::new()));
        sections.extend(gain::section(result, None));
        sections.push(limits::next_run(result));
    }
    sections.push(in_words(result));
    part(result, sections)
}

fn part(result: &Answer, sections: Vec<Section>) -> Part {
    Part {
        name: match result.records.len() {
            0 => file_name(&result.manifest, 0, "record"),
            several => gyrocal_words::counted(several, "record"),
        },
        size: format!(
            "{} over {:.2} days",
            gyrocal_words::counted(result.record.rows, "row"),
            result.record.duration_s / 86_400.0
        ),
        first: gyrocal_words::first_screen(result),
        sections,
        origin: origin(&result.manifest),
    }
}

/// The ranking with its table.
fn ranked(result: &Answer) -> Option<Section> {
    let mut section = ranking::section(Ranked::of(result).as_ref())?;
    let table = gyrocal_words::ranking(result);
    section.items.extend(table.map(Item::from));
    Some(section)
}

/// The whole answer in sentences, without the tables that the other sections have.
fn in_words(result: &Answer) -> Section {
    let told = gyrocal_words::told(result).into_iter();
    let lead = "The answer in sentences; tables of its numbers are in the sections above.";
    section("words", "In words", lead, told.map(Item::Words).collect())
}

/// Effects in the extended model.
fn accepted(result: &Answer) -> Vec<&str> {
    let causes = result.causes();
    let accepted = causes.filter(|cause| cause.accepted == Some(true));
    accepted.map(|cause| &*cause.effect).collect()
}

/// A section.
pub(crate) fn section(id: &str, title: &str, lead: &str, items: Vec<Item>) -> Section {
    Section {
        id: id.to_owned(),
        title: title.to_owned(),
        lead: lead.to_owned(),
        items,
    }
}
