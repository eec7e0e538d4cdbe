//! The report: sizes of its files, and what a browser makes of them; and the first ten minutes of a user.

mod first_minutes;

use std::ffi::OsString;
use std::path::Path;

use gyrocal_calibration::{FittedPlatform, NoiseModel, Options, Run};
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_instruments::multi_position::{
    MultiPositionSettings, multi_position_test, prepare_logs,
};
use gyrocal_instruments::{Description, Log, StopSettings, find_stops, read_record};
use gyrocal_pages::{Part, of_diagnosis, of_open_loop, of_tumble, page};
use gyrocal_record::{Bench, Input, Manifest, Record};
use gyrocal_testkit::browser::Browser;
use gyrocal_testkit::contracts::check_contracts;
use gyrocal_testkit::dialects::check_dialects;
use gyrocal_testkit::workspace;
use gyrocal_truth::{Scenario, simulate};

use crate::error::Error;
use crate::figure::Figure;

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

/// All figures of the topic; with `write` also the pictures in the documentation.
pub(crate) fn figures(small: bool, write: bool) -> Result<Vec<Figure>, Error> {
    let mut pages = vec![
        diagnosed("three_days", "clean", "report-clean.png")?,
        diagnosed("hidden_fault", "hidden fault", "report-hidden.png")?,
        tumbled()?,
    ];
    pages.push(long(if small { FEWER_ROWS } else { ROWS })?);
    let folder = tempfile::tempdir()?;
    let mut browser = Browser::start(WINDOW);
    let mut figures = Vec::new();
    for one in pages {
        let html = page(vec![one.part]).to_html().map_err(failed)?;
        let megabytes = html.len() as f64 / 1e6;
        let name = |what: &str| format!("{}: {what}", one.name);
        figures.push(Figure::at_most(&name("size"), one.most, megabytes, "MB"));
        let Some(browser) = &mut browser else {
            figures.push(Figure::note(
                &name("in a browser"),
                "not judged: no chromium".to_owned(),
            ));
            continue;
        };
        let path = folder.path().join("page.html");
        std::fs::write(&path, html)?;
        browser.open(&path);
        let paint_s = browser.first_paint_s();
        figures.push(Figure::at_most(
            &name("time to first paint"),
            PAINT_S,
            paint_s,
            "s",
        ));
        let errors = browser.console_errors().len() as f64;
        figures.push(Figure::within(&name("console errors"), [0.0, 0.0], errors));
        let requests = browser.requests().len() as f64;
        figures.push(Figure::within(&name("requests"), [0.0, 0.0], requests));
        let bottom = browser
            .number("document.querySelector('.first-screen').getBoundingClientRect().bottom");
        figures.push(Figure::at_most(
            &name("end of the first screen"),
            800.0,
            bottom,
            "px",
        ));
        if let Some(picture) = one.picture.filter(|_| write) {
            let folder = crate::page::docs().join("pictures");
            std::fs::write(folder.join(picture), browser.screenshot())?;
        }
    }
    if !small {
        figures.push(first_minutes::figure()?);
    }
    figures.push(dialects());
    figures.push(contracts());
    Ok(figures)
}

/// Files of the test set of formats and dialects that are read right, or refused with the line to add.
fn dialects() -> Figure {
    let outcomes = check_dialects(|path, map| {
        let description = Description::parse(map, "map.toml").map_err(words)?;
        let file = read_record(path, &description).map_err(words)?;
        Ok(file.record().clone())
    });
    let right = outcomes.iter().filter(|one| one.fault.is_empty()).count() as f64;
    let refused = outcomes.iter().filter(|one| one.refused).count();
    let all = outcomes.len() as f64;
    let of_features = match refused {
        0 => String::new(),
        _ => format!(" ({refused} refused with the feature to build: Parquet, MCAP)"),
    };
    let what = "formats and dialects read right or refused with the line to add";
    Figure::within(&format!("{what}, of {all}{of_features}"), [all, all], right)
}

/// Commands whose result for programs conforms to its published schema.
fn contracts() -> Figure {
    let commands = gyrocal_cli::commands_with_json();
    let outcomes = check_contracts(&commands, |arguments| {
        let words = ["gyrocal", "--quiet"].map(str::to_owned);
        let words = words.iter().chain(arguments).map(OsString::from);
        match gyrocal_cli::run(words) {
            0 => Ok(()),
            code => Err(format!("exit code {code}")),
        }
    });
    for one in outcomes.iter().filter(|one| !one.fault.is_empty()) {
        println!("{}: {}", one.command, one.fault);
    }
    let valid = outcomes.iter().filter(|one| one.fault.is_empty()).count() as f64;
    let all = commands.len() as f64;
    let name = format!("JSON of every command valid by its schema, of {all}");
    Figure::within(&name, [all, all], valid)
}

/// The words of an error with its advice.
fn words(error: impl Into<gyrocal_instruments::InstrumentError>) -> String {
    let error = error.into();
    format!("{error}; {}", error.advice())
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
