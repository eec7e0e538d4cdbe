//! Pages in a real browser: nothing fetched, no error, the answer on the first screen, zoom, paper.
#![cfg(test)]

use std::path::PathBuf;

use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_pages::{Part, of_diagnosis, of_plant, of_result, page};
use gyrocal_plant::{ColumnMap, LoadedPlant, SearchOptions};
use gyrocal_record::{Bench, Manifest, Record};
use gyrocal_report::to_html;
use gyrocal_testkit::browser::{A4_PX, Browser};
use gyrocal_testkit::workspace;
use serde_json::json;
use tempfile::TempDir;

const WINDOW: [u32; 2] = [1280, 800];

fn part(name: &str, change: impl FnOnce(&mut Record)) -> Part {
    let data = workspace().join("examples/data");
    let mut record = Record::read(&data.join(format!("{name}.csv"))).unwrap();
    change(&mut record);
    let bench = Bench::read(&data.join(format!("{name}.bench.toml"))).unwrap();
    let diagnosis = diagnose(&record, &bench, &DiagnoseOptions::default()).unwrap();
    of_diagnosis(&diagnosis).unwrap()
}

fn written(folder: &TempDir, name: &str, parts: Vec<Part>) -> PathBuf {
    let path = folder.path().join(name);
    std::fs::write(&path, to_html(&page(parts)).unwrap()).unwrap();
    path
}

/// Opens a page that must be quiet: no error in the console, nothing asked of any network.
fn open(browser: &mut Browser, path: &std::path::Path) {
    browser.open(path);
    assert_eq!(
        browser.console_errors(),
        Vec::<String>::new(),
        "{}",
        path.display()
    );
    assert_eq!(
        browser.requests(),
        Vec::<String>::new(),
        "{}",
        path.display()
    );
}

#[test]
fn a_page_answers_on_its_first_screen_zooms_and_prints() {
    let Some(mut browser) = Browser::start(WINDOW) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    // Values of half a day are missing.
    let gap = |record: &mut Record| {
        for row in &mut record.accel_g[1000..1720] {
            row[1] = f64::NAN;
        }
    };
    let hidden = part("hidden_fault", gap);
    let path = written(&folder, "hidden.html", vec![hidden.clone()]);
    let bytes = std::fs::metadata(&path).unwrap().len();
    assert!(bytes < 1_000_000, "4321 rows: {bytes} bytes");
    open(&mut browser, &path);
    first_screen(&mut browser, "gyro_y.g_z");
    for theme in [true, false] {
        browser.set_dark(theme);
        assert_eq!(browser.console_errors(), Vec::<String>::new());
    }
    zooms(&mut browser, 3);
    shows_gaps(&mut browser);
    sorts(&mut browser);
    prints(&mut browser);

    let clean = part("three_days", |_| ());
    let path = written(&folder, "clean.html", vec![clean.clone()]);
    open(&mut browser, &path);
    first_screen(&mut browser, "NO FAULT FOUND");

    let path = written(&folder, "both.html", vec![clean, hidden]);
    open(&mut browser, &path);
    let rows = browser.number("document.querySelectorAll('.overview tbody tr').length");
    assert_eq!(rows, 2.0);
}

#[test]
fn the_page_of_a_plant_answers_on_its_first_screen_and_zooms() {
    let Some(mut browser) = Browser::start(WINDOW) else {
        return;
    };
    let data = workspace().join("examples/duffing");
    let plant = LoadedPlant::read(&data.join("plant.json")).unwrap();
    let columns = ColumnMap::read(&data.join("columns.toml")).unwrap();
    let read = |name: &str| {
        let path = data.join(name);
        columns.record(plant.description(), &path).unwrap()
    };
    let options = SearchOptions::default();
    let diagnosed = gyrocal_plant::diagnose(
        &plant,
        read("record.csv"),
        Some(read("later.csv")),
        &options,
    );
    let manifest = Manifest {
        program: "gyrocal".to_owned(),
        version: String::new(),
        model_hash: String::new(),
        inputs: Vec::new(),
        seed: 0,
        command: "gyrocal plant diagnose".to_owned(),
    };
    let part = of_plant(&diagnosed.unwrap(), "record.csv", &manifest).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let path = written(&folder, "plant.html", vec![part]);
    open(&mut browser, &path);
    first_screen(&mut browser, "v_rate.x^3");
    zooms(&mut browser, 1);
}

fn first_screen(browser: &mut Browser, word: &str) {
    let headline = browser.evaluate("document.querySelector('.verdict').textContent");
    assert!(headline.as_str().unwrap().contains(word), "{headline}");
    let bottom =
        browser.number("document.querySelector('.first-screen').getBoundingClientRect().bottom");
    assert!(
        bottom <= f64::from(WINDOW[1]),
        "the first screen ends at {bottom} px"
    );
    let wide = browser.number("document.documentElement.scrollWidth");
    assert!(wide <= f64::from(WINDOW[0]), "{wide} px wide");
    let unnamed =
        "[...document.querySelectorAll('.plot')].filter((plot) => !plot.ariaLabel).length";
    assert_eq!(browser.number(unnamed), 0.0);
}

/// Length of the abscissa of each panel of the first chart.
fn lengths(browser: &mut Browser) -> Vec<f64> {
    let lengths = browser.evaluate(
        "gyrocalCharts.drawn.get('chart-1').plots.map((plot) => plot.scales.x.max - plot.scales.x.min)",
    );
    lengths
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one.as_f64().unwrap())
        .collect()
}

/// Zooms the first chart, which has so many panels.
fn zooms(browser: &mut Browser, panels: usize) {
    let rest = "new Promise((done) => setTimeout(() => done(0), 300))";
    browser.evaluate(
        "document.documentElement.style.scrollBehavior = 'auto';
         document.getElementById('chart-1').scrollIntoView({ block: 'center' }); 0",
    );
    browser.evaluate(rest);
    let whole = lengths(browser);
    assert_eq!(whole.len(), panels);
    let frame = browser.evaluate(
        "(() => { const all = document.querySelector('#chart-1 .u-over').getBoundingClientRect();
          return [all.left, all.top, all.width, all.height]; })()",
    );
    let frame: Vec<f64> = frame
        .as_array()
        .unwrap()
        .iter()
        .map(|one| one.as_f64().unwrap())
        .collect();
    let at = |part: f64| [frame[0] + part * frame[2], frame[1] + 0.5 * frame[3]];
    browser.drag(at(0.25), at(0.5));
    browser.evaluate(rest);
    for (zoomed, whole) in lengths(browser).iter().zip(&whole) {
        // A quarter, to a pixel or two.
        assert!((zoomed / whole - 0.25).abs() < 0.02, "{zoomed} of {whole}");
    }
    browser.evaluate("document.querySelector('#chart-1 .reset').click(); 0");
    assert_eq!(lengths(browser), whole);
}

/// The panels of the residual have no values where the record has none.
fn shows_gaps(browser: &mut Browser) {
    let missing = browser.evaluate(
        "[0, 1].map((panel) => gyrocalData.column(gyrocalData.charts[1].panels[panel].lines[0].values)
           .filter((value) => value === null).length)",
    );
    assert_eq!(missing, json!([0, 720]));
}

fn sorts(browser: &mut Browser) {
    let sorted = browser.evaluate(
        "(() => {
           const head = document.querySelector('.estimates thead th:nth-child(2)');
           head.querySelector('button').click();
           const cells = [...document.querySelectorAll('.estimates tbody td:nth-child(2)')];
           const values = cells.map((cell) => parseFloat(cell.textContent.replace('−', '-')));
           return values.length === 9 && values.every((value, place) => place === 0 || values[place - 1] <= value);
         })()",
    );
    assert_eq!(sorted, true);
}

/// On paper no figure is cut: each keeps together and is lower than a sheet, drawn for its width.
fn prints(browser: &mut Browser) {
    let pdf = browser.pdf();
    let pages = String::from_utf8_lossy(&pdf)
        .matches("/Type /Page\n")
        .count();
    assert!((4..20).contains(&pages), "{pages} pages");
    browser.call("Emulation.setEmulatedMedia", json!({ "media": "print" }));
    browser.resize(A4_PX.map(|px| px as u32));
    browser.evaluate("dispatchEvent(new Event('beforeprint')); 0");
    let highest = browser.number(
        "Math.max(...[...document.querySelectorAll('figure, .keep, .card')].map((block) =>
           getComputedStyle(block).breakInside === 'avoid' ? block.offsetHeight : Infinity))",
    );
    assert!(highest < A4_PX[1], "a figure is {highest} px high");
    let widest = browser.number(
        "Math.max(...[...document.querySelectorAll('.plot')].map((plot) =>
           plot.querySelector('canvas').getBoundingClientRect().right))",
    );
    assert!(widest <= A4_PX[0], "a panel ends at {widest} px");
    browser.call("Emulation.setEmulatedMedia", json!({ "media": "" }));
    browser.resize(WINDOW);
    browser.evaluate("dispatchEvent(new Event('afterprint')); 0");
}

#[test]
fn texts_of_files_cannot_become_markup() {
    let mut diagnosis = {
        let data = workspace().join("examples/data");
        let record = Record::read(&data.join("hidden_fault.csv")).unwrap();
        let bench = Bench::read(&data.join("hidden_fault.bench.toml")).unwrap();
        let short = Record {
            time_s: record.time_s[..60].to_vec(),
            accel_g: record.accel_g[..60].to_vec(),
            temperature_c: None,
        };
        diagnose(&short, &bench, &DiagnoseOptions::default())
            .unwrap()
            .result
    };
    diagnosis.manifest.command = "</script><script>alert(1)</script> & \u{202E}\u{7}".to_owned();
    let html = to_html(&page(vec![of_result(&diagnosis)])).unwrap();
    assert!(!html.contains("<script>alert"));
    assert!(
        html.contains("&lt;script&gt;alert(1)") && html.contains("\\u{202e}\\u{7}"),
        "escaped"
    );
}
