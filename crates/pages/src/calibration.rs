//! The page of a calibration.

mod details;

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::{FittedPlatform, is_gross};
use gyrocal_document::{
    Column, EstimateRow, Estimates, Item, List, Part, Screen, Section, Standing, Table, Tint,
};
use gyrocal_record::{Bench, CalibrationReport, Coefficient, FitVerdict, Record};
use gyrocal_statistics::format;
use gyrocal_words::{first_input_files, record_and_bench};

use crate::diagnosis::open_loop::{self, Simulated};
use crate::diagnosis::{coefficients, section};
use crate::error::PageError;
use crate::origin::{file_name, origin};
use crate::words::listed;

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

/// The page of a calibration with its first screen. Charts over time are of the records that are given.
///
/// # Errors
/// [`PageError`] where a simulation fails.
pub fn of_calibration(
    report: &CalibrationReport,
    records: &[CalibratedRecord<'_, '_>],
    first: Screen,
) -> Result<Part, PageError> {
    let mut sections = Vec::new();
    for (place, one) in records.iter().enumerate() {
        sections.extend(over_time(one, (records.len() > 1).then_some(place))?);
    }
    sections.extend(calibration_sections(report));
    Ok(Part {
        name: match report.runs.len() {
            0 | 1 => file_name(&report.manifest, 0, "record"),
            count => format!(
                "{} and {} further records",
                file_name(&report.manifest, 0, "record"),
                count - 1
            ),
        },
        size: format!("{} rows used", report.rows),
        first,
        sections,
        origin: origin(&report.manifest),
    })
}

/// The sections of a written calibration: what it tells without the records. One that is not usable has its
/// verdict alone.
#[must_use]
pub fn calibration_sections(report: &CalibrationReport) -> Vec<Section> {
    let verdict = section(
        "words",
        "In words",
        "The verdict with the tests that it rests on.",
        vec![Item::text(&*report.verdict_text)],
    );
    if report.coefficients.is_empty() || report.nis_mean.is_some_and(is_gross) {
        return vec![verdict];
    }
    let mut sections = vec![estimates(report)];
    sections.extend(undetermined(report));
    sections.push(details::site(report));
    sections.extend(details::turn_ons(report));
    sections.extend(details::records(report));
    sections.push(verdict);
    sections
}

/// The first screen of a written calibration: what it tells without the records.
#[must_use]
pub fn calibration_screen(report: &CalibrationReport) -> Screen {
    let (standing, verdict) = match report.verdict {
        _ if report.nis_mean.is_some_and(is_gross) => (Standing::Bad, "NOT USABLE"),
        FitVerdict::Consistent => (Standing::Good, "CALIBRATED"),
        FitVerdict::EffectsFound => (Standing::Bad, "FAULT"),
        FitVerdict::TooLarge | FitVerdict::TooSmall | FitVerdict::NoiseDiffers => {
            (Standing::Doubtful, "MISFIT")
        }
        FitVerdict::Unexplained => (Standing::Bad, "UNEXPLAINED"),
        _ => (Standing::Bad, "SET-UP WRONG"),
    };
    let mut screen = Screen::new(standing, verdict, &*report.verdict_text);
    if report.verdict == FitVerdict::Setup {
        for problem in &report.setup {
            screen.fact("what is wrong", problem.text());
        }
        return screen;
    }
    let shown = report.effects.iter().filter(|test| test.significant);
    let effects: Vec<&str> = shown.filter_map(|test| test.effect.as_deref()).collect();
    screen.fact("first sign", listed(&effects));
    if let (Some(mean), Some([low, high])) = (report.nis_mean, report.nis_band) {
        let words = format!("mean NIS {mean:.3} (expected {low:.3} to {high:.3})");
        screen.fact("how sure", words);
    }
    let open = report.coefficients.iter().filter(|one| !one.determined);
    let open: Vec<&str> = open.map(|one| &*one.name).collect();
    screen.fact("not determined", listed(&open));
    let rows = report.coefficients.iter().map(|one| {
        let [estimate, sigma] = format::estimate(one.estimate, one.sigma);
        [
            one.name.clone(),
            format!("{estimate} ± {sigma}"),
            one.unit.clone(),
        ]
    });
    screen.table = Some(Table::new(
        "Drift coefficients",
        vec![
            Column::words("coefficient"),
            Column::numbers("estimate ± σ"),
            Column::words("unit"),
        ],
        rows,
    ));
    let inputs = &report.manifest.inputs;
    let files = first_input_files(inputs).unwrap_or_else(|| record_and_bench(inputs));
    let why = match report.verdict {
        FitVerdict::Consistent => "tests for all else, and says what could go undetected",
        _ => "looks for the causes",
    };
    screen.then(format!("gyrocal diagnose {files}"), why);
    screen
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
        sections.push(section(
            "convergence",
            "Convergence",
            "Estimates against the length of the record.",
            vec![Item::Chart(chart)],
        ));
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
    let mut models = vec![("nominal model".to_owned(), Tint::Nominal)];
    let effects = with.map(|with| {
        let names: Vec<&str> = with.effects.iter().map(|one| &*one.effect).collect();
        listed(&names)
    });
    models.extend(
        effects
            .as_ref()
            .map(|names| (format!("with {names}"), Tint::Extended)),
    );
    let estimates = Estimates {
        title: "Drift coefficients".to_owned(),
        models,
        rows: rows.collect(),
        note_head: "determined".to_owned(),
    };
    let mut items = vec![
        Item::Estimates(estimates),
        Item::text(details::determined(report)),
    ];
    items.extend(with.into_iter().flat_map(details::with_effects));
    let columns = Column::heads("coefficient | meaning");
    let meanings = DRIFT.map(|one| [one.id, one.doc].map(str::to_owned));
    items.push(Table::new("What they are", columns, meanings).into());
    section(
        "coefficients",
        "Coefficients",
        "The nine drift coefficients with their standard deviations.",
        items,
    )
}

fn undetermined(report: &CalibrationReport) -> Option<Section> {
    let entries = report.undetermined.iter().map(|one| {
        let share = format::percent(one.share_of_prior);
        format!(
            "{}: its sigma is {share} of that before the record",
            one.text
        )
    });
    let lead =
        "Combinations of coefficients, each over its prior sigma, of which the record says little.";
    let list = List::of("", entries)?.into();
    Some(section(
        "limits",
        "What cannot be told apart",
        lead,
        vec![list],
    ))
}
