//! The page of a diagnosis of any plant.

mod fit;
mod limits;
mod over_time;
mod tables;

pub use fit::{of_comparison, of_fit};

use gyrocal_answer::Answer;
use gyrocal_document::{Part, Section};
use gyrocal_plant::Diagnosed;
use gyrocal_record::Manifest;
use gyrocal_statistics::format;
use gyrocal_words::counted;
use gyrocal_words::plant::first_screen;

use crate::error::PageError;
use crate::origin::{part, record_name};
use crate::ranked;

/// The page of a diagnosis of a plant; `name` is that of its record.
///
/// # Errors
/// [`PageError::Plant`] if a pass over the record fails.
pub fn of_plant(diagnosed: &Diagnosed, name: &str, manifest: &Manifest) -> Result<Part, PageError> {
    let answer = &diagnosed.answer;
    let mut sections: Vec<_> = over_time::sections(diagnosed).into();
    sections.extend(of_tables(answer, Some(diagnosed)));
    sections.push(over_time::innovations(diagnosed)?);
    sections.push(limits::cannot_tell(answer));
    let (name, first) = (name.to_owned(), first_screen(answer));
    Ok(part(manifest, name, size(answer), first, sections))
}

/// Sets, ranking, parameters, records, left-out parts and gain, those that there are.
fn of_tables(answer: &Answer, diagnosed: Option<&Diagnosed>) -> impl Iterator<Item = Section> {
    let all = [
        tables::sets(answer),
        ranked::section(answer),
        tables::parameters(answer),
        tables::records(answer),
        tables::path(answer),
        tables::gain(answer, diagnosed),
    ];
    all.into_iter().flatten()
}

/// The page of a written answer on a plant: all but the charts, for which the record is needed.
pub(crate) fn of_answer(answer: &Answer) -> Part {
    let mut sections: Vec<Section> = of_tables(answer, None).collect();
    sections.push(over_time::tested(answer, None));
    sections.push(limits::cannot_tell(answer));
    let manifest = &answer.manifest;
    let name = record_name(manifest, answer.records.len());
    part(manifest, name, size(answer), first_screen(answer), sections)
}

/// Rows and duration.
fn size(answer: &Answer) -> String {
    let of_records = match answer.records.len() {
        0 => String::new(),
        count => format!(" of {}", counted(count, "record")),
    };
    format!(
        "{}{of_records} over {} s",
        counted(answer.record.rows, "row"),
        format::short(answer.record.duration_s, 4)
    )
}

/// The name of each record of an answer; empty of one that is alone.
fn record_names(answer: &Answer) -> Vec<&str> {
    let names: Vec<&str> = answer.records.iter().map(|one| one.name.as_str()).collect();
    if names.is_empty() { vec![""] } else { names }
}

/// An error of a simulation with its unit; that of one that leaves the finite numbers is infinite.
fn rms(error: Option<f64>, unit: &str) -> String {
    error.map_or_else(|| "∞".to_owned(), |rms| with_unit(rms, unit))
}

/// A number with its unit; `1` is no unit.
fn with_unit(value: f64, unit: &str) -> String {
    let unit = if unit == "1" { "" } else { unit };
    let text = format!("{} {unit}", format::short(value, 3));
    text.trim_end().replace('-', "−")
}
