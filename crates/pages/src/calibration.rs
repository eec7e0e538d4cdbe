//! The page of a calibration.

use gyrocal_calibration::{FittedPlatform, is_gross};
use gyrocal_document::{
    Cell, Column, EstimateRow, Estimates, Item, List, Part, Screen, Section, Standing, Table, Tint,
    ValueWithSigma,
};
use gyrocal_record::{
    Bench, CalibrationReport, Coefficient, FitVerdict, NoiseReport, Record, RunReport,
};
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
    if !report.coefficients.is_empty() {
        sections.push(estimates(report));
    }
    sections.extend(undetermined(report));
    if let Some(first) = records.first() {
        let mut site = coefficients::site(first.fit)?;
        if records.len() > 1 {
            site.title = format!("{}: {}", first.name, site.title);
        }
        sections.push(site);
    }
    let runs: Vec<Item> = runs(report).into_iter().map(Item::from).collect();
    if !runs.is_empty() {
        sections.push(section(
            "records",
            "Records",
            "Attitude and noise of each record; noise is estimated by maximum likelihood.",
            runs,
        ));
    }
    sections.push(section(
        "words",
        "In words",
        "The verdict with the tests that it rests on.",
        vec![Item::text(&*report.verdict_text)],
    ));
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
    let value = |one: &Coefficient| ValueWithSigma {
        value: one.estimate,
        sigma: one.sigma,
    };
    let rows = report.coefficients.iter().enumerate().map(|(place, one)| {
        let extended = with.and_then(|with| with.coefficients.get(place));
        EstimateRow {
            name: one.name.clone(),
            unit: one.unit.clone(),
            values: core::iter::once(one).chain(extended).map(value).collect(),
            note: if one.determined { "yes" } else { "no" }.to_owned(),
            strong: !one.determined,
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
    section(
        "coefficients",
        "Coefficients",
        "The nine drift coefficients with their standard deviations.",
        vec![Item::Estimates(Estimates {
            title: "Drift coefficients".to_owned(),
            models,
            rows: rows.collect(),
            note_head: "determined".to_owned(),
        })],
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
    let entries: Vec<String> = entries.collect();
    (!entries.is_empty()).then(|| {
        section(
            "limits",
            "What cannot be told apart",
            "Combinations of coefficients, each over its prior sigma, of which the record says little.",
            vec![Item::from(List {
                title: String::new(),
                entries,
            })],
        )
    })
}

fn runs(report: &CalibrationReport) -> Vec<Table> {
    let angles = |deg: [f64; 3]| {
        deg.map(|angle| format!("{angle:.3}"))
            .join(", ")
            .replace('-', "−")
    };
    let mut attitudes = Vec::new();
    let mut noises = Vec::new();
    for run in &report.runs {
        attitudes.push(vec![
            Cell::from(run.record.clone()),
            Cell::from(run.rows.to_string()),
            Cell::from(angles(run.initial_angles_deg)),
            Cell::from(angles(run.final_angles_deg)),
        ]);
        noises.extend(run.noise.as_ref().map(|noise| noise_row(run, noise)));
    }
    let mut tables = vec![Table {
        title: "Attitude: angles about x, y, z".to_owned(),
        columns: vec![
            Column::words("record"),
            Column::numbers("rows"),
            Column::numbers("first row, deg"),
            Column::numbers("last row, deg"),
        ],
        rows: attitudes,
    }];
    tables.push(Table {
        title: "Estimated over declared noise: x, y, z".to_owned(),
        columns: vec![
            Column::words("record"),
            Column::numbers("accelerometers"),
            Column::numbers("gyros"),
        ],
        rows: noises,
    });
    tables.retain(|table| !table.rows.is_empty());
    tables
}

fn noise_row(run: &RunReport, noise: &NoiseReport) -> Vec<Cell> {
    let ratios = |of: &[gyrocal_record::NoiseRatioReport; 3]| {
        let each = of.iter().map(|one| {
            let [low, high] = one.interval;
            format!("{:.3} ({low:.3} to {high:.3})", one.ratio)
        });
        Cell::from(each.collect::<Vec<_>>().join(", "))
    };
    vec![
        Cell::from(run.record.clone()),
        ratios(&noise.accel),
        ratios(&noise.gyro),
    ]
}
