//! Records of a stable platform in the formats and dialects of other programs.

use gyrocal_instruments::{Description, InstrumentError, average_file, read_any, read_record};
use gyrocal_record::Record;

use crate::dialect_set::check_dialects;

fn words(error: impl Into<InstrumentError>) -> String {
    let error = error.into();
    format!("{error}; {}", error.advice())
}

#[test]
fn every_file_of_the_test_set_is_read_right_or_refused_with_the_line_to_add() {
    let outcomes = check_dialects(|path, map| {
        let description = Description::parse(map, "map.toml").map_err(words)?;
        let file = read_record(path, &description).map_err(words)?;
        Ok(file.record().clone())
    });
    assert!(outcomes.len() >= 40);
    let faults: Vec<String> = outcomes
        .iter()
        .filter(|one| !one.fault.is_empty())
        .map(|one| format!("{}: {}", one.file, one.fault))
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

const MAP: &str = "[time]\ncolumn = \"t\"\nunit = \"ms\"\n[accel]\ncolumns = [\"a\", \"b\", \"c\"]\n\
                   unit = \"mg\"\n[temperature]\ncolumn = \"T\"\n";

#[test]
fn means_of_a_file_in_many_blocks_are_those_of_its_rows() {
    use std::fmt::Write;
    let rows = 60_000;
    let mut text = "t,a,b,c,T\n".to_owned();
    let value = |row: usize| (row % 1000) as f64;
    for row in 0..rows {
        let b = if row % 7 == 0 {
            String::new()
        } else {
            format!("{:.4}", value(row))
        };
        writeln!(
            text,
            "{}.0000,{:.6},{b},1000.000000,20.5000",
            row * 10,
            value(row)
        )
        .unwrap();
    }
    // More than two blocks of a mebibyte.
    assert!(text.len() > 2 << 20);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, text).unwrap();
    let description = Description::parse(MAP, "map.toml").unwrap();
    let averaged = average_file(&path, &description, 1.0).unwrap();
    assert_eq!((averaged.rows, averaged.record.len()), (rows, rows / 100));
    for (group, accel_g) in averaged.record.accel_g.iter().enumerate() {
        let there = || (group * 100..group * 100 + 100).filter(|row| row % 7 != 0);
        let sum: f64 = there().map(value).sum();
        let first = value(group * 100) + 49.5;
        // Sums of a hundred numbers below one round to parts in 1e15.
        assert!((accel_g[0] - first / 1e3).abs() < 1e-12, "{group}");
        assert!((accel_g[1] - sum / there().count() as f64 / 1e3).abs() < 1e-12);
        assert!((accel_g[2] - 1.0).abs() < 1e-12);
        let time_s = group as f64 + 0.495;
        assert!((averaged.record.time_s[group] - time_s).abs() < 1e-9);
    }
    let refused = average_file(&path, &description, 60.0).unwrap_err();
    assert!(words(refused).contains("calibrate --average"));
}

#[test]
fn an_error_behind_the_first_block_has_its_line() {
    let rows = 100_000;
    let text = "t,a,b,c,T\n".to_owned() + &"0,1.0,2.0,3.0,4.0\n".repeat(rows) + "0,up,2,3,4\n";
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, text).unwrap();
    let description = Description::parse(MAP, "map.toml").unwrap();
    let refused = average_file(&path, &description, 1.0)
        .unwrap_err()
        .to_string();
    assert!(
        refused.contains(&format!("log.csv:{}:3: found `up`", rows + 2)),
        "{refused}"
    );
}

#[test]
fn another_header_without_a_map_is_refused_with_its_map() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, "Time;Acc X;Acc Y;Acc Z\n0;0;0;1\n").unwrap();
    let refused = words(read_any(&path, None).unwrap_err());
    for line in [
        "log.csv:1:5",
        "--columns MAP.toml",
        "delimiter = \"semicolon\"",
        "column = \"Time\"",
        "columns = [\"Acc X\", \"Acc Y\", \"Acc Z\"]",
    ] {
        assert!(refused.contains(line), "{refused} lacks {line}");
    }
}

#[test]
fn a_description_without_gyros_is_none_of_an_instrument_test() {
    let description = Description::parse(MAP, "map.toml").unwrap();
    let refused = gyrocal_instruments::Log::parse("t,a,b,c,T\n", "log.csv", &description);
    assert!(words(refused.unwrap_err()).contains("[gyro]"));
    let wrong = MAP.replace("unit = \"ms\"", "unit = \"ms\"\nunit_s = 1.0");
    let refused = Description::parse(&wrong, "map.toml")
        .unwrap_err()
        .to_string();
    assert!(refused.contains("either `unit` or `unit_s`"), "{refused}");
}

#[test]
fn a_record_is_the_same_with_and_without_the_description_of_its_columns() {
    let path = gyrocal_testkit::workspace().join("examples/data/three_days.csv");
    let described = read_record(&path, &Description::of_records().unwrap()).unwrap();
    assert_eq!(described.record(), &Record::read(&path).unwrap());
}
