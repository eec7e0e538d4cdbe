//! The page of a calibration.

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::FittedPlatform;
use gyrocal_document::{EstimateRow, Estimates, Item, Part, Section, Table, Tint};
use gyrocal_record::{Bench, CalibrationReport, Coefficient, Record};
use gyrocal_words::{calibration, calibration_screen};

use crate::diagnosis::coefficients;
use crate::diagnosis::open_loop::{self, Simulated};
use crate::error::PageError;
use crate::origin::{file_name, part};
use crate::panels;
use crate::words::{listed, section};

/// A calibrated record with the fit of the nominal model to it alone, for the charts over time.
pub struct CalibratedRecord<'a, 'b> {
    /// Its name.
    pub name: String,
    /// The record.
    pub record: &'a Record,
    /// Its bench description.
    pub bench: &'a Bench,
    /// The fit.
    pub fit: &'a FittedPlatform<'b>,
}

/// The page of a calibration. Charts over time are of the records that are given.
///
/// # Errors
/// [`PageError`] where a simulation fails.
pub fn of_calibration(
    report: &CalibrationReport,
    records: &[CalibratedRecord<'_, '_>],
) -> Result<Part, PageError> {
    let mut sections = Vec::new();
    for (place, one) in records.iter().enumerate() {
        sections.extend(over_time(one, (records.len() > 1).then_some(place))?);
    }
    if report.usable {
        sections.push(estimates(report));
    }
    let lead = "Records, verdict with the tests that it rests on, what the records determine, noise, site.";
    let items = calibration(report).into_iter().map(Item::Words).collect();
    sections.push(section("words", "In words", lead, items));
    let (manifest, first) = (&report.manifest, calibration_screen(report));
    let mut name = file_name(manifest, 0, "record");
    if let more @ 1.. = report.records.len().saturating_sub(1) {
        name += &format!(" and {more} further records");
    }
    let size = format!("{} rows used", report.rows);
    Ok(part(manifest, name, size, first, sections))
}

/// The sections over time of a record; of several with its number in their anchors.
fn over_time(
    one: &CalibratedRecord<'_, '_>,
    place: Option<usize>,
) -> Result<Vec<Section>, PageError> {
    let mut sections: Vec<Section> = open_loop::sections(&Simulated {
        record: one.record,
        bench: one.bench,
        nominal: one.fit,
        extended: None,
        effects: Vec::new(),
    })?
    .into();
    if let Some(chart) = coefficients::convergence(one.record, (one.fit, None))? {
        let lead = "Estimates against the length of the record.";
        let items = vec![Item::Chart(chart)];
        sections.push(section("convergence", "Convergence", lead, items));
    }
    if let Some(place) = place {
        for section in &mut sections {
            section.id = format!("{}-{}", section.id, place + 1);
            section.title = format!("{}: {}", one.name, section.title);
        }
    }
    Ok(sections)
}

fn estimates(report: &CalibrationReport) -> Section {
    let with = report.with_effects.as_ref();
    let value = |one: &Coefficient| [one.estimate, one.sigma];
    let rows = report.coefficients.iter().enumerate().map(|(place, one)| {
        let extended = with.and_then(|with| with.coefficients.get(place));
        let values = core::iter::once(one).chain(extended);
        EstimateRow {
            note: if one.determined { "yes" } else { "no" }.to_owned(),
            strong: !one.determined,
            ..EstimateRow::new(&one.name, &one.unit, values.map(value))
        }
    });
    let effects = with.map(|with| {
        let names: Vec<&str> = with.effects.iter().map(|one| &*one.effect).collect();
        format!("with {}", listed(&names))
    });
    let nominal = [(panels::NOMINAL, Tint::Nominal)].into_iter();
    let extended = effects.iter().map(|with| (&**with, Tint::Extended));
    let models: Vec<_> = nominal.chain(extended).collect();
    let estimates = Estimates {
        note_head: "determined".to_owned(),
        ..Estimates::new("Drift coefficients", &models, rows)
    };
    let meanings = DRIFT.map(|one| [one.id, one.doc].map(str::to_owned));
    let meanings = Table::of("What they are", "coefficient | meaning", meanings);
    let lead = "The nine drift coefficients with their standard deviations.";
    let items = vec![Item::Estimates(estimates), meanings.into()];
    section("coefficients", "Coefficients", lead, items)
}
