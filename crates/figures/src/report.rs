//! The report: sizes of its files, and what a browser makes of them; and the first ten minutes of a user.

mod first_minutes;

use std::path::Path;

use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run};
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_instruments::multi_position::{
    MultiPositionSettings, multi_position_test, prepare_logs,
};
use gyrocal_instruments::{Description, Log, StopSettings, find_stops};
use gyrocal_pages::{Part, of_diagnosis, of_open_loop, of_tumble, page};
use gyrocal_record::{Bench, Input, Manifest, Record};
use gyrocal_testkit::browser::Browser;
use gyrocal_testkit::workspace;
use gyrocal_truth::{Scenario, simulate};

use crate::error::Error;
use crate::figure::Figure;
use crate::harness::Context;

/// Window of the browser, px.
const WINDOW: [u32; 2] = [1280, 800];

/// Largest file of an example, and of a long record, MB.
const SMALL_FILE: f64 = 1.0;
const LARGE_FILE: f64 = 5.0;

/// Longest time to the first paint, s.
const PAINT_S: f64 = 1.0;

/// Rows of the long record, and of that of a small run.
const ROWS: u64 = 1_000_000;
const FEWER_ROWS: u64 = 50_000;

/// A page to look at: its name, its content, and the largest file, MB.
struct Looked {
    name: String,
    part: Part,
    most: f64,
    picture: Option<&'static str>,
}

/// All figures of the part; with leave to write also the pictures in the documentation.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let pages = [
        diagnosed("three_days", "clean", "report-clean.png")?,
        diagnosed("hidden_fault", "hidden fault", "report-hidden.png")?,
        tumbled()?,
        long(if context.is_small() { FEWER_ROWS } else { ROWS })?,
    ];
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("page.html");
    let mut browser = Browser::start(WINDOW);
    let mut figures = Vec::new();
    for one in pages {
        let html = page(vec![one.part]).to_html().map_err(failed)?;
        let name = |what: &str| format!("{}: {what}", one.name);
        let mut most = |what: &str, limit: f64, measured: f64, unit: &str| {
            figures.push(Figure::at_most(&name(what), limit, measured, unit));
        };
        most("size", one.most, html.len() as f64 / 1e6, "MB");
        let Some(browser) = &mut browser else {
            let why = "not judged: no chromium".to_owned();
            figures.push(Figure::note(&name("in a browser"), why));
            continue;
        };
        std::fs::write(&path, html)?;
        browser.open(&path);
        most("time to first paint", PAINT_S, browser.first_paint_s(), "s");
        let errors = browser.console_errors().len();
        most("console errors", 0.0, errors as f64, "");
        most("requests", 0.0, browser.requests().len() as f64, "");
        let bottom = "document.querySelector('.first-screen').getBoundingClientRect().bottom";
        let height = f64::from(WINDOW[1]);
        most(
            "end of the first screen",
            height,
            browser.number(bottom),
            "px",
        );
        if let Some(picture) = one.picture.filter(|_| context.write) {
            let folder = crate::page::docs().join("pictures");
            std::fs::write(folder.join(picture), browser.screenshot())?;
        }
    }
    if !context.is_small() {
        figures.push(first_minutes::figure()?);
    }
    Ok(figures)
}

/// A failure of a library as that of this topic.
fn failed(reason: impl core::fmt::Display) -> Error {
    Error::from(reason.to_string())
}

fn manifest(paths: &[&Path], command: &str) -> Result<Manifest, Error> {
    let root = workspace();
    let inputs = paths.iter().map(|path| {
        let mut input = Input::of(&root.join(path))?;
        input.path = path.display().to_string();
        Ok(input)
    });
    Ok(Manifest {
        program: "gyrocal".to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        model_hash: gyrocal::generated::MODEL_HASH.to_owned(),
        inputs: inputs.collect::<Result<_, gyrocal_record::Error>>()?,
        seed: 0,
        command: command.to_owned(),
    })
}

/// The report of a diagnosed example.
fn diagnosed(stem: &str, name: &str, picture: &'static str) -> Result<Looked, Error> {
    let csv = format!("examples/data/{stem}.csv");
    let toml = format!("examples/data/{stem}.bench.toml");
    let root = workspace();
    let record = Record::read(&root.join(&csv))?;
    let bench = Bench::read(&root.join(&toml))?;
    let mut diagnosis = diagnose(&record, &bench, &DiagnoseOptions::default()).map_err(failed)?;
    let command = format!("gyrocal diagnose {csv} --bench {toml} --report report.html");
    diagnosis.result.manifest = manifest(&[csv.as_ref(), toml.as_ref()], &command)?;
    Ok(Looked {
        name: format!("{name}, {} rows", record.len()),
        part: of_diagnosis(&diagnosis, &bench).map_err(failed)?,
        most: SMALL_FILE,
        picture: Some(picture),
    })
}

/// The report of the recording of a MEMS unit.
fn tumbled() -> Result<Looked, Error> {
    let csv = "tests/data/measured/xsens_38_positions/imu_counts.csv";
    let toml = "tests/data/measured/xsens_38_positions/log.toml";
    let root = workspace();
    let description = Description::read(&root.join(toml)).map_err(failed)?;
    let log = Log::read(&root.join(csv), &description).map_err(failed)?;
    let stops = find_stops(&log, &StopSettings::default()).map_err(failed)?;
    let prepared = prepare_logs(&[(log, stops)], &description).map_err(failed)?;
    let settings = MultiPositionSettings::default();
    let report = multi_position_test(&prepared.positions, &settings).map_err(failed)?;
    let command = format!("gyrocal tumble {csv} --log-description {toml} --report report.html");
    let manifest = manifest(&[csv.as_ref(), toml.as_ref()], &command)?;
    Ok(Looked {
        name: format!("MEMS unit, {} stops", report.stops),
        part: of_tumble(&manifest, &prepared, &report),
        most: SMALL_FILE,
        picture: Some("report-mems.png"),
    })
}

/// The report of a long simulated record: all charts over time of its calibration.
fn long(rows: u64) -> Result<Looked, Error> {
    let simulation = simulate(&Scenario {
        interval_s: 1.0,
        duration_s: (rows - 1) as f64,
        ..Scenario::default()
    })
    .map_err(failed)?;
    let run = Run {
        record: &simulation.record,
        bench: &simulation.bench,
    };
    let options = Options::default();
    let fit =
        FittedPlatform::nominal_once(&run, &options, &NoiseModel::default()).map_err(failed)?;
    Ok(Looked {
        name: format!("{rows} simulated rows"),
        part: of_open_loop("simulated", run.record, run.bench, &fit).map_err(failed)?,
        most: LARGE_FILE,
        picture: None,
    })
}
