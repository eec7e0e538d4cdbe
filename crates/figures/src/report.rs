//! The report: sizes of its files, and what a browser makes of them; and the first ten minutes of a user.

mod first_minutes;

use std::path::Path;

use gyrocal_testkit::browser::Browser;
use gyrocal_testkit::contracts::words;
use gyrocal_testkit::{run, workspace};

use crate::before::gyrocal;
use crate::harness::{Context, Error, Figure};

/// Window of the browser, px.
const WINDOW: [u32; 2] = [1280, 800];

/// Longest time to the first paint, s.
const PAINT_S: f64 = 1.0;

/// Names of reports of recordings in the tree, the commands that write them, and their pictures in the documentation.
const REPORTS: [[&str; 3]; 3] = [
    [
        "clean, 4321 rows",
        "diagnose examples/data/three_days.csv --bench examples/data/three_days.bench.toml",
        "report-clean.png",
    ],
    [
        "hidden fault, 4321 rows",
        "diagnose examples/data/hidden_fault.csv --bench examples/data/hidden_fault.bench.toml",
        "report-hidden.png",
    ],
    [
        "MEMS unit, 38 stops",
        "tumble tests/data/measured/xsens_38_positions/imu_counts.csv \
         --log-description tests/data/measured/xsens_38_positions/log.toml",
        "report-mems.png",
    ],
];

/// Largest file of each, MB.
const SMALL_FILE: f64 = 1.0;

/// Rows of the long record, and of that of a small run; its largest file, MB.
const ROWS: u64 = 1_000_000;
const FEWER_ROWS: u64 = 50_000;
const LARGE_FILE: f64 = 5.0;

/// All figures of the part; with leave to write also the pictures in the documentation.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let folder = tempfile::tempdir()?;
    let page = folder.path().join("page.html");
    let mut browser = Browser::start(WINDOW);
    let mut figures = Vec::new();
    for [name, command, picture] in REPORTS {
        ran(&format!("{command} --report %page.html"), folder.path())?;
        figures.extend(looked_at(name, &page, SMALL_FILE, browser.as_mut())?);
        if let Some(browser) = browser.as_mut().filter(|_| context.write) {
            let pictures = crate::page::docs().join("pictures");
            std::fs::write(pictures.join(picture), browser.screenshot())?;
        }
    }
    let rows = if context.is_small() { FEWER_ROWS } else { ROWS };
    long(rows, folder.path())?;
    let name = format!("{rows} simulated rows");
    figures.extend(looked_at(&name, &page, LARGE_FILE, browser.as_mut())?);
    if !context.is_small() {
        figures.push(first_minutes::figure()?);
    }
    Ok(figures)
}

/// Runs a line of [`words`] as `gyrocal` in the tree.
fn ran(line: &str, folder: &Path) -> Result<(), Error> {
    let outcome = run(gyrocal(&workspace())?.args(words(line, folder)));
    match outcome.success {
        true => Ok(()),
        false => Err(format!("`gyrocal {line}`: {}", outcome.stderr).into()),
    }
}

/// Size of a page, and what a browser says of it.
fn looked_at(
    name: &str,
    page: &Path,
    largest_mb: f64,
    browser: Option<&mut Browser>,
) -> Result<Vec<Figure>, Error> {
    let most = |what: &str, limit: f64, measured: f64, unit: &str| {
        Figure::at_most(&format!("{name}: {what}"), limit, measured, unit)
    };
    let bytes = std::fs::metadata(page)?.len() as f64;
    let size = most("size", largest_mb, bytes / 1e6, "MB");
    let Some(browser) = browser else {
        let name = format!("{name}: in a browser");
        let why = "not judged: no chromium".to_owned();
        return Ok(vec![size, Figure::note(&name, why)]);
    };
    browser.open(page);
    let bottom = "document.querySelector('.first-screen').getBoundingClientRect().bottom";
    let height = f64::from(WINDOW[1]);
    let (paint_s, end_px) = (browser.first_paint_s(), browser.number(bottom));
    let [errors, requests] = [browser.console_errors(), browser.requests()];
    Ok(vec![
        size,
        most("time to first paint", PAINT_S, paint_s, "s"),
        most("console errors", 0.0, errors.len() as f64, ""),
        most("requests", 0.0, requests.len() as f64, ""),
        most("end of the first screen", height, end_px, "px"),
    ])
}

/// The report of a long record: an example, each second.
fn long(rows: u64, folder: &Path) -> Result<(), Error> {
    let example = workspace().join("examples/data/three_days.scenario.toml");
    let duration = format!("duration_s = {}.0", rows - 1);
    let text = std::fs::read_to_string(example)?;
    let text = text.replace("duration_s = 259200.0", &duration);
    let text = text.replace("interval_s = 60.0", "interval_s = 1.0");
    std::fs::write(folder.join("scenario.toml"), text)?;
    let simulate = "simulate %scenario.toml --out %record.csv --bench-out %bench.toml";
    let calibrate = "calibrate %record.csv --bench %bench.toml --report %page.html";
    [simulate, calibrate]
        .iter()
        .try_for_each(|line| ran(line, folder))
}
