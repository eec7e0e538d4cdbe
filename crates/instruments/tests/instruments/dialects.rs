//! Records of a stable platform in the formats and dialects of other programs.

use gyrocal_instruments::{
    Description, InstrumentError, average_file, propose_map, read_any, read_record,
};
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

/// A text as a file, read by a map.
fn read(bytes: &[u8], map: &str) -> Result<gyrocal_record::RecordFile, String> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    std::fs::write(&path, bytes).unwrap();
    let description = Description::parse(map, "map.toml").map_err(words)?;
    read_record(&path, &description).map_err(words)
}

const AXES: &str = "[accel]\ncolumns = [\"ax\", \"ay\", \"az\"]\nunit = \"g\"\n";

#[test]
fn another_header_without_a_map_is_refused_with_the_command_that_writes_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    for text in [
        &b"Time;Acc X;Acc Y;Acc Z\n0;0;0;1\n"[..],
        b"T [\xb0C]\n",
        b"a b c d\n",
    ] {
        std::fs::write(&path, text).unwrap();
        let refused = words(read_any(&path, None).unwrap_err());
        let command = format!("`gyrocal import csv {} --propose MAP.toml`", path.display());
        for part in ["log.csv:1:", &command, "--columns MAP.toml"] {
            assert!(refused.contains(part), "{refused} lacks {part}");
        }
    }
    assert!(words(propose_map(&path).unwrap_err()).contains("three"));
}

#[test]
fn dates_without_their_format_are_refused_with_the_line_that_reads_them() {
    for (time, stamps, format) in [
        (
            "column = \"t\"",
            ["t", "28.03.2026 10:00:00", "28.03.2026 10:01:00"],
            "%d.%m.%Y %H:%M:%S%.f",
        ),
        (
            "column = \"t\"\nunit = \"rfc3339\"",
            ["t", "03/28/2026 12:59:30 PM", "03/28/2026 1:00:30 PM"],
            "%m/%d/%Y %I:%M:%S%.f %p",
        ),
        (
            "column = \"t\"\nunit = \"rfc3339\"",
            ["t", "23:59:30", "00:00:30"],
            "%H:%M:%S%.f",
        ),
        (
            "columns = [\"d\", \"t\"]",
            ["d,t", "28.03.2026,10:00:00.5", "28.03.2026,10:01:00.5"],
            "%d.%m.%Y %H:%M:%S%.f",
        ),
    ] {
        let [title, first, second] = stamps;
        let text = format!("{title},ax,ay,az\n{first},0,0,1\n{second},0,0,1\n");
        let refused = read(text.as_bytes(), &format!("[time]\n{time}\n{AXES}")).unwrap_err();
        let line = format!("format = \"{format}\"");
        assert!(
            refused.contains(&format!("give `{line}` in place")),
            "{refused}"
        );
        let time = time.replace("\nunit = \"rfc3339\"", "");
        let found = read(text.as_bytes(), &format!("[time]\n{time}\n{line}\n{AXES}")).unwrap();
        let times = &found.record().time_s;
        assert!((times[1] - times[0] - 60.0).abs() < 1e-6, "{times:?}");
    }
    // Day and month may be either.
    let text = b"t,ax,ay,az\n03/04/2026 10:00:00,0,0,1\n";
    let refused = read(text, &format!("[time]\ncolumn = \"t\"\n{AXES}")).unwrap_err();
    assert!(
        refused.contains("`format = \"%d/%m/%Y %H:%M:%S%.f\"` or `format = \"%m/%d/%Y"),
        "{refused}"
    );
}

#[test]
fn dates_and_times_are_read_by_their_format() {
    for (time, rows) in [
        (
            "column = \"t\"\nformat = \"%d.%m.%Y %H:%M:%S\"",
            ["t", "28.03.2026 10:00:00", "28.03.2026 10:01:00"],
        ),
        (
            "column = \"t\"\nformat = \"%m/%d/%Y %I:%M:%S %p\"",
            ["t", "3/28/2026 12:59:30 PM", "3/28/2026 1:00:30 PM"],
        ),
        (
            "columns = [\"d\", \"t\"]",
            ["d,t", "2026-03-28,10:00:00.5", "2026-03-28,10:01:00.5"],
        ),
        (
            "columns = [\"y\", \"j\", \"t\"]\nformat = \"%Y %j %H:%M:%S\"",
            ["y,j,t", "2026,87,23:59:30", "2026,88,00:00:30"],
        ),
        (
            "column = \"t\"\nformat = \"%F %T %z\"",
            [
                "t",
                "2026-03-29 01:59:30 +0100",
                "2026-03-29 03:00:30 +0200",
            ],
        ),
        (
            "column = \"t\"\nformat = \"%F %T\"\nzone = \"Europe/Berlin\"",
            ["t", "2026-03-29 01:59:30", "2026-03-29 03:00:30"],
        ),
    ] {
        let text = format!(
            "{},ax,ay,az\n{},0,0,1\n{},0,1,0\n",
            rows[0], rows[1], rows[2]
        );
        let file = read(text.as_bytes(), &format!("[time]\n{time}\n{AXES}")).unwrap();
        let times = &file.record().time_s;
        assert_eq!(times[1] - times[0], 60.0, "{time}");
        // A log of an instrument test reads the same times.
        let map = format!(
            "[time]\n{time}\n[gyro]\ncolumns = [\"ax\", \"ay\", \"az\"]\nunit = \"deg/s\"\n"
        );
        let description = Description::parse(&map, "map.toml").unwrap();
        let log = gyrocal_instruments::Log::parse(&text, "log.csv", &description);
        assert!(words(log.unwrap_err()).contains("found 2 samples"));
    }
}

#[test]
fn a_date_that_is_none_of_its_format_is_told_with_its_place() {
    let map = format!("[time]\ncolumn = \"t\"\nformat = \"%d.%m.%Y %H:%M:%S\"\n{AXES}");
    let refused = read(b"t,ax,ay,az\n30.02.2026 10:00:00,0,0,1\n", &map).unwrap_err();
    for part in ["log.csv:2:1", "`30.02.2026 10:00:00`", "%d.%m.%Y %H:%M:%S"] {
        assert!(refused.contains(part), "{refused} lacks {part}");
    }
    for (line, expected) in [
        ("format = \"%d.%m.%Y\"", "a format of date and time"),
        ("format = \"%F %T\"\nzone = \"Europe/Atlantis\"", "a zone"),
        (
            "format = \"%F %T\"\nunit = \"rfc3339\"",
            "either `unit` or `format`",
        ),
        ("zone = \"Europe/Berlin\"", "dates and times"),
        (
            "columns = [\"t\"]",
            "one of `column`, `columns` and `rate_hz`",
        ),
    ] {
        let refused = Description::parse(
            &format!("[time]\ncolumn = \"t\"\n{line}\n{AXES}"),
            "map.toml",
        );
        let refused = refused.unwrap_err().to_string();
        assert!(
            refused.contains("map.toml:") && refused.contains(expected),
            "{line}: {refused}"
        );
    }
}

#[test]
fn texts_of_other_encodings_are_read() {
    let text = "t,ax,ay,az,T [°C]\n0,0,0,1,20\n60,0,1,0,21\n";
    let utf16 = |text: &str| {
        text.encode_utf16()
            .flat_map(u16::to_le_bytes)
            .collect::<Vec<u8>>()
    };
    let latin1: Vec<u8> = text
        .chars()
        .map(|sign| u8::try_from(sign).unwrap())
        .collect();
    let map = |file: &str| {
        format!("{file}[time]\ncolumn = \"t\"\n[temperature]\ncolumn = \"T [°C]\"\n{AXES}")
    };
    for (bytes, file) in [
        (utf16(&format!("\u{feff}{text}")), ""),
        (utf16(text), "[file]\nencoding = \"utf-16le\"\n"),
        (latin1.clone(), "[file]\nencoding = \"latin1\"\n"),
    ] {
        let found = read(&bytes, &map(file)).unwrap();
        assert_eq!(
            found.record().temperature_c.as_deref(),
            Some(&[20.0, 21.0][..]),
            "{file}"
        );
    }
    let refused = read(&latin1, &map("")).unwrap_err();
    assert!(
        refused.contains("log.csv:1:15") && refused.contains("`encoding = \"latin1\"`"),
        "{refused}"
    );
    let refused = read(&latin1, &map("[file]\nencoding = \"latin-one\"\n")).unwrap_err();
    assert!(refused.contains("map.toml:2:1"), "{refused}");
}

#[test]
fn empty_last_fields_and_headers_that_come_again_are_read() {
    let tab = format!("[file]\ndelimiter = \"tab\"\n[time]\ncolumn = \"t\"\n{AXES}");
    for text in [
        "t\tax\tay\taz\tComment\n0\t0\t0\t1\t\n60\t0\t1\t0\topen\n120\t0\t1\t0\t\n",
        "t\tax\tay\taz\n0\t0\t0\t1\t\n60\t0\t1\t0\t\n120\t0\t1\t0\n",
        "t\tax\tay\taz\t\n0\t0\t0\t1\n60\t0\t1\t0\t\n120\t0\t1\t0\t\n",
        "LabVIEW Measurement\t\n***End_of_Header***\t\n\t\nChannels\t3\t\t\nSamples\t1\t1\t1\t\n***End_of_Header***\t\t\t\n\
         t\tax\tay\taz\tComment\n0\t0\t0\t1\t\nChannels\t3\t\t\nSamples\t1\t1\t1\t\n***End_of_Header***\t\t\t\n\
         t\tax\tay\taz\tComment\n60\t0\t1\t0\t\n120\t0\t1\t0\t\n",
    ] {
        let file = read(text.as_bytes(), &tab).unwrap();
        assert_eq!(file.record().time_s, [0.0, 60.0, 120.0], "{text}");
    }
    let map = format!("[time]\ncolumn = \"t\"\n{AXES}");
    let again = "t,ax,ay,az\n0,0,0,1\nt,ax,ay,az\n60,0,1,0\nt,ax,ay,az\n120,0,1,0\n";
    let file = read(again.as_bytes(), &map).unwrap();
    assert_eq!(file.record().len(), 3);
    let notes = file.notes().join("\n");
    assert!(
        notes.contains("log.csv:3:") && notes.contains("2 line(s)"),
        "{notes}"
    );
    let other = again.replacen("0,0,0,1\nt,ax", "0,0,0,1\ntime,ax", 1);
    let refused = read(other.as_bytes(), &map).unwrap_err();
    for part in ["log.csv:3:1", "a second header", "line 1"] {
        assert!(refused.contains(part), "{refused} lacks {part}");
    }
}

#[test]
fn a_row_that_repeats_the_one_before_is_left_out_and_told() {
    let map = format!("[time]\ncolumn = \"t\"\n{AXES}");
    let file = read(
        b"t,ax,ay,az\n0,0,0,1\n60,0,1,0\n60,0,1,0\n120,0,1,0\n",
        &map,
    )
    .unwrap();
    assert_eq!(file.record().time_s, [0.0, 60.0, 120.0]);
    assert_eq!(file.line(2), Some(5));
    assert!(file.notes().join("").contains("log.csv:4:"));
    let file = read(
        b"t,ax,ay,az\n0,0,0,1\n60,0,1,0\n60,1,0,0\n120,0,1,0\n",
        &map,
    )
    .unwrap();
    let refused = words(file.into_rising().unwrap_err());
    assert!(
        refused.contains("log.csv:4:1") && refused.contains("keep one row of each time"),
        "{refused}"
    );
}

#[test]
fn a_proposed_map_reads_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    let mut text = "Messung;Plattform 3\r\n\r\nDatum;Uhrzeit;K1;K2;K3;Temp. [K]\r\n".to_owned();
    for row in 0..200 {
        let angle = 0.004 * f64::from(row);
        let [x, y] = [9.81 * angle.cos(), 9.81 * angle.sin()];
        let fields = format!(
            "{:02}:{:02}:00;{x:.5};{y:.5};0.10000;295.1",
            10 + row / 60,
            row % 60
        );
        text += &format!("28.03.2026;{}\r\n", fields.replace('.', ","));
    }
    std::fs::write(&path, &text).unwrap();
    let map = propose_map(&path).unwrap();
    for line in [
        "delimiter = \"semicolon\"",
        "decimal = \"comma\"",
        "columns = [\"Datum\", \"Uhrzeit\"]",
        "format = \"%d.%m.%Y %H:%M:%S\"",
        "columns = [\"K1\", \"K2\", \"K3\"]",
        "unit = \"m/s2\"",
        "column = \"Temp. [K]\"",
        "unit = \"K\"",
        "gravity_m_per_s2 = 9.81051",
    ] {
        assert!(map.contains(line), "{map} lacks {line}");
    }
    let record = read(text.as_bytes(), &map).unwrap();
    let record = record.into_sound().unwrap();
    assert_eq!((record.len(), record.duration_s()), (200, 199.0 * 60.0));
}

#[test]
fn a_map_is_proposed_of_a_clock_that_begins_anew_below_its_first_time() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("restart.csv");
    let mut text = "t,ax,ay,az\n".to_owned();
    for row in 0..120 {
        let time_s = if row < 70 { 86_340.0 } else { -4_193.0 } + 60.0 * f64::from(row);
        let (sine, cosine) = (7.292e-5 * 60.0 * f64::from(row)).sin_cos();
        text += &format!("{time_s},{:.9},{:.9},0.6\n", 0.8 * cosine, 0.8 * sine);
    }
    std::fs::write(&path, &text).unwrap();
    let map = propose_map(&path).unwrap();
    assert!(map.contains("column = \"t\"\nunit = \"s\""), "{map}");
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
