//! The test set of formats and dialects in `tests/data/dialects`, made by its `make.py` from known values.

use std::path::Path;

use gyrocal_record::{Record, RecordFile};
use gyrocal_testkit::workspace;
use serde_json::Value;

/// Outcome of one file of the set.
pub(crate) struct DialectOutcome {
    /// The file.
    pub(crate) file: String,
    /// What went wrong; empty if it was read right, or refused as it has to be.
    pub(crate) fault: String,
}

/// Reads every file of the set by `read`, which gets the path of a file and the text of its map. With the
/// map values have to be those of the record; without the line that a case names, the error has to name that
/// line. A file that a reader is not built in for may be refused if the error says how to build it.
pub(crate) fn check_dialects(
    read: impl Fn(&Path, &str) -> Result<Record, String>,
) -> Vec<DialectOutcome> {
    let folder = workspace().join("tests/data/dialects");
    let text = std::fs::read_to_string(folder.join("cases.json")).unwrap();
    let truth = RecordFile::read(&folder.join("truth.csv")).unwrap();
    let truth = truth.record();
    let cases: Vec<Value> = serde_json::from_str(&text).unwrap();
    let outcome = |case: &Value| {
        let file = case["file"].as_str().unwrap().to_owned();
        let path = folder.join(&file);
        let map = std::fs::read_to_string(folder.join(case["map"].as_str().unwrap())).unwrap();
        let result = read(&path, &map);
        let refused = matches!(&result, Err(error) if error.contains("--features "));
        let mut fault = match &result {
            _ if refused => String::new(),
            Err(error) => error.clone(),
            Ok(record) if case["straight"] == true => straight(record),
            Ok(record) => difference(record, truth, case),
        };
        if let Some(line) = case["without"].as_str().filter(|_| !refused) {
            fault += &refusal(
                line,
                &map,
                read(&path, &map.replacen(&format!("{line}\n"), "", 1)),
            );
        }
        DialectOutcome { file, fault }
    };
    cases.iter().map(outcome).collect()
}

fn refusal(line: &str, map: &str, without: Result<Record, String>) -> String {
    assert!(map.contains(line), "{map} without {line}");
    match without {
        Ok(_) => format!("read without `{line}`"),
        Err(error) if error.contains(&format!("`{line}`")) => String::new(),
        Err(error) => format!("the error does not name `{line}`: {error}"),
    }
}

/// Values on the straight lines of the case with jitter, at equal intervals.
fn straight(record: &Record) -> String {
    let steps: Vec<f64> = record
        .time_s
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .collect();
    let even = steps.iter().all(|step| (step - steps[0]).abs() < 1e-9);
    let lies = |(time_s, accel_g): (&f64, &[f64; 3])| {
        let row = time_s / 60.0;
        let line = [row / 32.0, 1.0 - row / 64.0, row / 128.0];
        (0..3).all(|axis| (accel_g[axis] - line[axis]).abs() < 1e-12)
    };
    let all = record.time_s.iter().zip(&record.accel_g).all(lies);
    match even && all && record.len() > 20 {
        true => String::new(),
        false => "not on the lines at equal intervals".to_owned(),
    }
}

fn difference(record: &Record, truth: &Record, case: &Value) -> String {
    let number = |key: &str| case[key].as_f64().unwrap();
    if record.len() != truth.len() {
        return format!("{} rows for {}", record.len(), truth.len());
    }
    let missing: Vec<[usize; 2]> = serde_json::from_value(case["missing"].clone()).unwrap();
    let first_s = match case["since_first"] == true {
        true => record.time_s[0],
        false => 0.0,
    };
    for row in 0..truth.len() {
        let away = record.time_s[row] - first_s - truth.time_s[row];
        // Seconds since 1970 have steps of 2.4e-7 s.
        let step_s = if first_s == 0.0 { 0.0 } else { 5e-7 };
        let right = away.abs() <= number("time_tolerance_s") + step_s;
        if !right {
            return format!("time {away} s away in row {row}");
        }
        for axis in 0..3 {
            let value = record.accel_g[row][axis];
            let away = value - truth.accel_g[row][axis];
            let right = match missing.contains(&[row, axis]) {
                true => value.is_nan(),
                false => away.abs() <= number("tolerance_g"),
            };
            if !right {
                return format!("{value} g on axis {axis} in row {row}");
            }
        }
    }
    match (
        &record.temperature_c,
        &truth.temperature_c,
        case["temperature"] == true,
    ) {
        (Some(found), Some(truth), true) => {
            let away = found
                .iter()
                .zip(truth)
                .map(|(found, truth)| (found - truth).abs());
            let worst = away.fold(0.0, f64::max);
            // Conversion from °F and interpolation round twice.
            match worst < 1e-12 * 20.0 * 4.0 {
                true => String::new(),
                false => format!("temperature {worst} K away"),
            }
        }
        (None, _, false) => String::new(),
        _ => "temperature where there is none, or none where there is one".to_owned(),
    }
}
