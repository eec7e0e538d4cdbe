//! Each way in which a record can be wrong: place, what was found, what was expected.

#![cfg(test)]

use std::path::Path;

use gyrocal_record::{Error, InputError, InputErrorKind, Record, RecordFile, SourceText};
use miette::Diagnostic as _;

const HEADER: &str = "time_s,accel_x_g,accel_y_g,accel_z_g";

fn refused(text: &str) -> InputError {
    match Record::parse(text, "r.csv").unwrap_err() {
        Error::Input(error) => *error,
        other => panic!("{other}"),
    }
}

/// The message has the place first, and then these words in this order.
fn assert_says(error: &InputError, kind: InputErrorKind, place: &str, words: &[&str]) {
    assert_eq!(error.kind, kind);
    let shown = error.to_string();
    let mut rest = shown
        .split_once(&format!("r.csv:{place}: found "))
        .unwrap_or_else(|| panic!("{shown} is not at {place}"))
        .1;
    for word in words {
        let (_, after) = rest
            .split_once(word)
            .unwrap_or_else(|| panic!("no `{word}` in `{rest}` of `{shown}`"));
        rest = after;
    }
}

fn rows(rows: &[&str]) -> String {
    format!("{HEADER}\n{}\n", rows.join("\n"))
}

#[test]
fn an_empty_file() {
    for text in ["", " \n\n", "\u{feff}"] {
        let error = match SourceText::from_bytes(text.into(), "r.csv").unwrap_err() {
            Error::Input(error) => *error,
            other => panic!("{other}"),
        };
        assert_says(
            &error,
            InputErrorKind::Empty,
            "1:1",
            &["an empty file", "expected"],
        );
    }
}

#[test]
fn a_file_that_is_not_utf8() {
    let mut bytes = rows(&["0,0,0,1"]).into_bytes();
    bytes.extend(b"60,0,\xff,1\n");
    let Error::Input(error) = SourceText::from_bytes(bytes, "r.csv").unwrap_err() else {
        panic!()
    };
    let words = ["byte 0xFF", "expected UTF-8"];
    assert_says(&error, InputErrorKind::NotUtf8, "3:6", &words);
}

#[test]
fn a_header_that_is_wrong() {
    // The header, the place of the mistake, words of the message and of the advice.
    let cases = r"
        time_s,accel_x,accel_y_g,accel_z_g | 1:8 | `accel_x` ... expected ... `accel_x_g` | did you mean `accel_x_g`
        Time_s,accel_x_g,accel_y_g,accel_z_g | 1:1 | `Time_s` ... expected | did you mean `time_s`
        time_s,accel_x_g,accel_y_g | 1:1 | the header ... expected a column `accel_z_g` | time_s,accel_x_g
        time_s,accel_x_g,accel_y_g,accel_z_g,pressure_hpa | 1:38 | `pressure_hpa` ... expected `temperature_c` | remove it
        time_s,accel_x_g,accel_y_g,accel_y_g | 1:28 | second column `accel_y_g` ... once | rename
        time_s;accel_x_g;accel_y_g;accel_z_g | 1:7 | another character ... commas | commas
        time_s\taccel_x_g\taccel_y_g\taccel_z_g | 1:7 | another character ... commas | commas
        0,0,0,1 | 1:1 | a row of numbers ... header `time_s, | header
    ";
    for case in cases.trim().lines() {
        let columns: Vec<_> = case.split('|').map(str::trim).collect();
        let [header, place, words, advice] = columns[..] else {
            panic!("{case}")
        };
        let header = header.replace("\\t", "\t");
        let error = refused(&format!("{header}\n0,0,0,1\n"));
        let words: Vec<_> = words.split(" ... ").collect();
        assert_says(&error, InputErrorKind::Header, place, &words);
        assert!(error.advice.contains(advice), "{}", error.advice);
    }
}

#[test]
fn a_field_that_is_no_number() {
    let cases = [
        ("0,0,0,one", "2:7", "`one`", "a finite number or `nan`"),
        ("0, zero ,0,1", "2:4", "`zero`", "a finite number or `nan`"),
        ("0,,0,1", "2:3", "nothing", "a finite number or `nan`"),
        ("0,inf,0,1", "2:3", "`inf`", "a finite number or `nan`"),
        ("nan,0,0,1", "2:1", "`nan`", "a finite number"),
        ("-inf,0,0,1", "2:1", "`-inf`", "a finite number"),
        ("0,1e999,0,1", "2:3", "`1e999`", "a finite number or `nan`"),
    ];
    for (row, place, found, expected) in cases {
        let error = refused(&rows(&[row]));
        assert_says(
            &error,
            InputErrorKind::NotANumber,
            place,
            &[found, expected],
        );
    }
    let text = format!("{HEADER},temperature_c\n0,0,0,1,nan\n");
    let error = refused(&text);
    assert_says(
        &error,
        InputErrorKind::NotANumber,
        "2:9",
        &["`nan`", "a finite number"],
    );
}

#[test]
fn places_are_right_whatever_stands_around_them() {
    let plain = format!("{HEADER}\n0,0,0,1\n60,0, zéro ,1\n");
    let windows = plain.replace('\n', "\r\n");
    let macintosh = plain.replace('\n', "\r");
    let marked = format!("\u{feff}{plain}");
    let quoted = plain
        .replace(" zéro ", "\"zéro\"")
        .replace("\n60,0", "\n60,0 ");
    for text in [plain, windows, macintosh, marked, quoted] {
        let error = refused(&text);
        assert_says(&error, InputErrorKind::NotANumber, "3:7", &["`zéro`"]);
    }
    // The header of a marked file starts in column 1, and empty lines are counted.
    let error = refused(&format!("\u{feff}\r\n\r\n{HEADER}x\r\n"));
    assert_says(&error, InputErrorKind::Header, "3:28", &["`accel_z_gx`"]);
}

#[test]
fn a_row_with_too_many_or_too_few_fields() {
    let error = refused(&rows(&["0,0,0,1", "60,0,0"]));
    assert_says(
        &error,
        InputErrorKind::FieldCount,
        "3:1",
        &["3 fields", "4 fields"],
    );
    // Decimal commas.
    let error = refused(&rows(&["0,0,0,0,0,1,0"]));
    assert_says(
        &error,
        InputErrorKind::FieldCount,
        "2:1",
        &["7 fields", "4 fields"],
    );
    assert!(error.advice.contains("point"), "{}", error.advice);
}

#[test]
fn time_that_repeats_or_goes_back() {
    for time in ["60", "59.5", "-60"] {
        let error = refused(&rows(&["0,0,0,1", "60,0,0,1", &format!("{time},0,1,0")]));
        let words = [time, "times that rise"];
        assert_says(&error, InputErrorKind::Time, "4:1", &words);
    }
}

#[test]
fn time_that_runs_for_ages_is_suspected_of_its_unit() {
    for (first, last) in [("0", "6e9"), ("-1.7e308", "1.7e308")] {
        let error = refused(&rows(&[
            &format!("{first},0,0,1"),
            &format!("{last},0,0,1"),
        ]));
        let words = ["s in a record that starts at", "a hundred years"];
        assert_says(&error, InputErrorKind::Time, "3:1", &words);
        assert!(error.advice.contains("milliseconds"), "{}", error.advice);
    }
}

/// Reads a record that something is to be estimated from.
fn read_at_least(path: &Path, rows: usize) -> Result<Record, Error> {
    let file = RecordFile::read(path)?;
    file.check(file.record(), rows)?;
    file.into_rising()
}

/// Reads rows for a job that needs two of them.
fn of_a_platform(rows: impl Iterator<Item = String>) -> Result<Record, Box<InputError>> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("r.csv");
    let rows: Vec<String> = rows.collect();
    std::fs::write(&path, format!("{HEADER}\n{}\n", rows.join("\n"))).unwrap();
    read_at_least(&path, 2).map_err(|error| match error {
        Error::Input(error) => error,
        other => panic!("{other}"),
    })
}

#[test]
fn rows_too_far_apart_to_follow_a_platform() {
    let apart = |seconds: &[u32]| of_a_platform(seconds.iter().map(|time| format!("{time},0,0,1")));
    let error = apart(&[0, 60_000, 120_000, 180_000]).unwrap_err();
    let words = ["farther apart than a quarter of a day", "after row 1"];
    assert_says(&error, InputErrorKind::Time, "3:1", &words);
    assert!(error.advice.contains("milliseconds"), "{}", error.advice);
    let error = apart(&[0, 60, 120, 34_560_000, 34_560_060]).unwrap_err();
    let words = ["more than a month without a reading", "after row 3"];
    assert_says(&error, InputErrorKind::Time, "5:1", &words);
    assert!(error.advice.contains("cut it there"), "{}", error.advice);
    // Once an hour, and a week of pause, are rare and no mistake.
    assert!(apart(&[0, 3600, 7200, 612_000]).is_ok());
}

#[test]
fn readings_that_hardly_ever_change() {
    let stuck = |rows: u32, other: &str| {
        of_a_platform((0..rows).map(|row| {
            let values = if row == 70 { other } else { "0,0,1" };
            format!("{},{values}", 60 * row)
        }))
    };
    let words = ["readings that hardly ever change", "gravity turns"];
    // A missing value, an outlier or an axis that was never there makes them no platform's.
    for other in ["0,0,1", "0,0,nan", "nan,nan,nan", "0.1,0.1,0.9"] {
        let error = stuck(721, other).unwrap_err();
        assert_says(&error, InputErrorKind::Stuck, "2:1", &words);
    }
    let one_axis = of_a_platform((0..100).map(|row| format!("{row},nan,nan,1")));
    assert_says(&one_axis.unwrap_err(), InputErrorKind::Stuck, "2:1", &words);
    assert!(stuck(100, "0,0,1").is_err());
    assert!(stuck(99, "0,0,1").is_ok());
}

#[test]
fn readings_of_a_coarse_converter_change_with_gravity() {
    // Without noise, which would only make more of them differ: steps of a hundredth of g, read
    // once a second for three hours, in which gravity turns by 45 deg. Successive readings of
    // each axis are equal in more than 99 of 100 rows.
    let coarse = |value: f64| (100.0 * value).round() / 100.0;
    let row = |time_s: u32| {
        let angle = (15.0 / 3600.0 * f64::from(time_s)).to_radians();
        let [x, y, z] = [0.77 * angle.sin(), 0.77 * angle.cos(), 0.64].map(coarse);
        format!("{time_s},{x},{y},{z}")
    };
    assert!(of_a_platform((0..10_800).map(row)).is_ok());
    // Twenty minutes are the least: steps of three sigmas of 3e-5 g, every ten seconds.
    let coarse = |value: f64| (1e4 * value).round() / 1e4;
    let row = |row: u32| {
        let angle = (15.0 / 3600.0 * f64::from(10 * row)).to_radians();
        let [x, y, z] = [0.77 * angle.sin(), 0.77 * angle.cos(), 0.64].map(coarse);
        format!("{},{x},{y},{z}", 10 * row)
    };
    assert!(of_a_platform((0..120).map(row)).is_ok());
}

#[test]
fn fewer_rows_than_states() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("r.csv");
    std::fs::write(&path, rows(&["0,0,0,1", "60,0,0,1"])).unwrap();
    assert_eq!(read_at_least(&path, 2).unwrap().len(), 2);
    let Error::Input(error) = read_at_least(&path, 12).unwrap_err() else {
        panic!()
    };
    assert_eq!(error.kind, InputErrorKind::TooFewRows);
    assert_eq!((error.line, error.column), (3, 1));
    let shown = error.to_string();
    assert!(shown.contains("found 2 rows"), "{shown}");
    assert!(shown.contains("expected at least 12 rows"), "{shown}");
    // A row without any value says nothing.
    let error = refused(&rows(&["0,nan,nan,nan", "60,nan,nan,nan"]));
    let words = ["0 rows with a value", "at least 1 row"];
    assert_says(&error, InputErrorKind::TooFewRows, "3:1", &words);
    let error = refused(&rows(&[]));
    assert_says(
        &error,
        InputErrorKind::TooFewRows,
        "1:1",
        &["0 rows", "at least 1 row"],
    );
}

#[test]
fn a_norm_far_from_gravity_is_suspected_of_its_unit() {
    let cases = [
        ("9.81", "m/s^2"),
        ("1000", "mg"),
        ("981.2", "Gal"),
        ("1e6", "micro-g"),
        ("32.17", "ft/s^2"),
        ("0.0002", "removed"),
        ("0.7", "scale"),
    ];
    for (norm, suspicion) in cases {
        let error = refused(&rows(&[
            &format!("0,0,0,{norm}"),
            &format!("60,{norm},0,0"),
            "120,nan,0,0",
        ]));
        let words = ["median norm", "row 1", "near 1 g"];
        assert_says(&error, InputErrorKind::Norm, "2:1", &words);
        assert!(error.advice.contains(suspicion), "{norm}: {}", error.advice);
    }
}

#[test]
fn a_single_row_of_nonsense_is_named() {
    let error = refused(&rows(&["0,0,0,1", "60,0,0,1", "120,0,2.5,1", "180,0,0,1"]));
    let words = ["2.693 g (row 3", "from 0.5 to 1.5"];
    assert_says(&error, InputErrorKind::Norm, "4:1", &words);
    // An outlier is no nonsense.
    let outlier = rows(&["0,0,0,1", "60,0,0,1", "120,0,0.2,1", "180,0,0,1"]);
    assert_eq!(Record::parse(&outlier, "r.csv").unwrap().len(), 4);
}

#[test]
fn the_marked_place_is_the_place_of_the_message() {
    let text = rows(&["0,0,0,1", "60,0,null,1"]);
    let error = refused(&text);
    let label = error.labels().unwrap().next().unwrap();
    let source = error.source_code().unwrap();
    let marked = source.read_span(label.inner(), 0, 0).unwrap();
    assert_eq!(marked.data(), b"null");
    assert_eq!((marked.line(), marked.column()), (2, 5));
    assert_eq!(error.file(), "r.csv");
}

#[test]
fn a_file_that_is_not_there() {
    let error = Record::read("no/such/record.csv".as_ref()).unwrap_err();
    assert!(matches!(error, Error::Unreadable { .. }));
    assert!(
        error
            .to_string()
            .starts_with("no/such/record.csv: cannot be read")
    );
}
