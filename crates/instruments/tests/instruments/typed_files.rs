//! Logs in files whose columns have types, by features: MCAP and Parquet.

use std::path::PathBuf;

use gyrocal_instruments::{Description, InstrumentError, read_record};
use gyrocal_testkit::workspace;

pub(crate) fn words(error: impl Into<InstrumentError>) -> String {
    let error = error.into();
    format!("{error}; {}", error.advice())
}

pub(crate) fn case(name: &str) -> PathBuf {
    workspace().join("tests/data/dialects").join(name)
}

pub(crate) fn map(time: &str, accel: &str) -> Description {
    let text = format!("[time]\n{time}\n[accel]\ncolumns = [{accel}]\nunit = \"g\"\n");
    Description::parse(&text, "map.toml").unwrap()
}

#[cfg(feature = "mcap")]
#[test]
fn columns_that_a_file_of_mcap_lacks_are_told_with_its_topics() {
    let description = map("column = \"t\"", r#""acc.0", "acc.1", "acc.3""#);
    let refused = words(read_record(&case("mcap_json.mcap"), &description).unwrap_err());
    for part in ["topic /upper (", "acc.0", "`acc.3`"] {
        assert!(refused.contains(part), "{refused} lacks {part}");
    }
    let description = map("column = \"header.stamp\"", r#""x", "y", "z""#);
    let refused = words(read_record(&case("mcap_ros2.mcap"), &description).unwrap_err());
    for part in ["topic /pressure (data)", "linear_acceleration.x", "`x`"] {
        assert!(refused.contains(part), "{refused} lacks {part}");
    }
}

#[cfg(feature = "mcap")]
#[test]
fn a_file_of_mcap_that_is_cut_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let text = std::fs::read_to_string(case("mcap_ros1.map.toml")).unwrap();
    let description = Description::parse(&text, "map.toml").unwrap();
    let whole = std::fs::read(case("mcap_ros1.mcap")).unwrap();
    for length in (8..whole.len()).step_by(13) {
        let path = folder.path().join("cut.mcap");
        std::fs::write(&path, &whole[..length]).unwrap();
        assert!(read_record(&path, &description).is_err(), "{length} bytes");
    }
}

/// A file of MCAP with messages of JSON, each with the place of its topic.
#[cfg(feature = "mcap")]
fn mcap(topics: &[&str], messages: &[(u16, String)]) -> Vec<u8> {
    const MAGIC: &[u8] = b"\x89MCAP0\r\n";
    let text = |text: &str| [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat();
    let record = |kind: u8, parts: &[&[u8]]| {
        let content = parts.concat();
        let length = (content.len() as u64).to_le_bytes();
        [&[kind][..], &length, &content].concat()
    };
    let mut file = MAGIC.to_vec();
    file.extend(record(1, &[&text(""), &text("")]));
    for (id, topic) in (0_u16..).zip(topics) {
        // No schema, no metadata.
        let (name, encoding) = (text(topic), text("json"));
        file.extend(record(
            4,
            &[&id.to_le_bytes(), &[0; 2], &name, &encoding, &[0; 4]],
        ));
    }
    for (topic, message) in messages {
        // Number and times are zero.
        file.extend(record(
            5,
            &[&topic.to_le_bytes(), &[0; 20], message.as_bytes()],
        ));
    }
    file.extend(record(15, &[&[0; 4]]));
    file.extend(record(2, &[&[0; 20]]));
    file.extend(MAGIC);
    file
}

#[cfg(feature = "mcap")]
#[test]
fn a_temperature_is_that_of_the_topic_of_the_record() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.mcap");
    let read = |messages: &[(u16, String)]| {
        std::fs::write(&path, mcap(&["/platform", "/room"], messages)).unwrap();
        gyrocal_instruments::read_any(&path, None)
            .unwrap()
            .record()
            .clone()
    };
    let force = r#""accel_x_g": 0.0, "accel_y_g": 0.0, "accel_z_g": 1.0"#;
    let other = r#"{"temperature_c": 21.5}"#.to_owned();
    let row = |time_s: u16, more: &str| (0, format!("{{\"time_s\": {time_s}, {force}{more}}}"));
    let apart = read(&[
        (1, other.clone()),
        row(0, ""),
        (1, other.clone()),
        row(60, ""),
    ]);
    assert_eq!((apart.len(), apart.temperature_c), (2, None));
    let warm = r#", "temperature_c": 20.5"#;
    let together = read(&[(1, other), row(0, warm), row(60, warm)]);
    assert_eq!(together.temperature_c, Some(vec![20.5; 2]));
}

#[cfg(not(feature = "mcap"))]
#[test]
fn a_file_of_mcap_is_refused_with_the_feature_to_build() {
    let description = map("column = \"t\"", r#""acc.0", "acc.1", "acc.2""#);
    let refused = words(read_record(&case("mcap_json.mcap"), &description).unwrap_err());
    assert!(
        refused.contains("cargo install --locked --path crates/cli --features mcap"),
        "{refused}"
    );
}

#[cfg(not(feature = "parquet"))]
#[test]
fn a_file_of_parquet_is_refused_with_the_feature_to_build() {
    let description = map("column = \"time_s\"", r#""x", "y", "z""#);
    let refused = words(read_record(&case("typed.parquet"), &description).unwrap_err());
    assert!(
        refused.contains("cargo install --locked --path crates/cli --features parquet"),
        "{refused}"
    );
}

/// Files of Parquet that pyarrow wrote, by `make_parquet.py`, with the rows of `truth.csv`.
#[cfg(feature = "parquet")]
mod parquet {
    use gyrocal_instruments::{average_file, read_any};
    use gyrocal_record::{Record, RecordFile};

    use super::*;

    const EXACT: &str = r#""accel_x_g", "accel_y_g", "accel_z_g""#;

    /// First time of the columns of time stamps, s since 1970.
    const START_S: f64 = 1_772_344_800.125;

    fn truth() -> Record {
        RecordFile::read(&case("truth.csv"))
            .unwrap()
            .record()
            .clone()
    }

    fn typed(time: &str, accel: &str) -> Result<Record, InstrumentError> {
        read_record(&case("typed.parquet"), &map(time, accel)).map(|file| file.record().clone())
    }

    #[test]
    fn values_and_units_are_those_of_the_same_rows_in_csv() {
        let truth = truth();
        let text = std::fs::read_to_string(case("typed.map.toml")).unwrap();
        let text = text.replace("at_ns", "time_ms\"\nunit = \"ms");
        let description = Description::parse(&text, "map.toml").unwrap();
        let found = read_record(&case("typed.parquet"), &description).unwrap();
        assert_eq!(found.record().time_s, truth.time_s);
        assert_eq!(found.record().temperature_c, truth.temperature_c);
        for (found, expected) in found.record().accel_g.iter().zip(&truth.accel_g) {
            // A product and a quotient round once each.
            let near = |axis: usize| (found[axis] - expected[axis]).abs() <= 3e-16;
            assert!((0..3).all(near), "{found:?} for {expected:?}");
        }
    }

    #[test]
    fn a_file_with_the_columns_of_a_record_needs_no_map() {
        let found = read_any(&case("typed.parquet"), None).unwrap();
        assert_eq!(*found.record(), truth());
    }

    #[test]
    fn columns_of_other_types_have_the_same_values() {
        let truth = truth();
        for kind in ["single", "dictionary"] {
            let accel = format!("\"x_{kind}\", \"y_{kind}\", \"z_{kind}\"");
            let found = typed("column = \"time_s\"", &accel).unwrap();
            assert_eq!(found.accel_g, truth.accel_g, "{kind}");
        }
        for kind in ["counts", "short"] {
            let text = format!(
                "[time]\ncolumn = \"time_s\"\n[accel]\ncolumns = [\"x_{kind}\", \"y_{kind}\", \"z_{kind}\"]\n\
                 unit = \"counts\"\ncounts_per_g = 16384\n"
            );
            let description = Description::parse(&text, "map.toml").unwrap();
            let found = read_record(&case("typed.parquet"), &description).unwrap();
            assert_eq!(found.record().accel_g, truth.accel_g, "{kind}");
        }
    }

    #[test]
    fn time_stamps_of_every_unit_with_and_without_a_zone_are_seconds() {
        let expected: Vec<f64> = truth().time_s.iter().map(|t| START_S + t).collect();
        for unit in ["ns", "us", "ms"] {
            for zone in ["", "_utc", "_zone"] {
                let name = format!("column = \"at_{unit}{zone}\"");
                assert_eq!(typed(&name, EXACT).unwrap().time_s, expected, "{name}");
            }
        }
        let description = map("column = \"at_ns\"", EXACT);
        let found = read_record(&case("spark.parquet"), &description).unwrap();
        assert_eq!(found.record().time_s, expected);
    }

    #[test]
    fn nulls_are_missing_values_and_no_times() {
        let found = typed("column = \"time_s\"", r#""x_holes", "y_holes", "z_holes""#).unwrap();
        let holes = [(3, 1), (7, 0), (7, 1), (7, 2), (13, 2)];
        for (row, expected) in truth().accel_g.iter().enumerate() {
            for (axis, expected) in expected.iter().enumerate() {
                let value = found.accel_g[row][axis];
                match holes.contains(&(row, axis)) {
                    true => assert!(value.is_nan(), "{value} in row {row}"),
                    false => assert_eq!(value, *expected),
                }
            }
        }
        let refused = words(typed("column = \"gap_s\"", EXACT).unwrap_err());
        for part in [
            "no value in the column `gap_s` of row 6",
            "a time in numbers in every row",
        ] {
            assert!(refused.contains(part), "{refused} lacks {part}");
        }
    }

    #[test]
    fn rows_of_one_sensor_are_taken_by_a_text_or_a_number() {
        for (only, rows) in [
            ("column = \"sensor\", equals = \"upper\"", 24),
            ("column = \"number\", equals = \"7\"", 24),
            ("column = \"sensor\", equals = \"lower\"", 0),
        ] {
            let text = format!(
                "[file]\nonly = {{ {only} }}\n[time]\ncolumn = \"time_s\"\n[accel]\ncolumns = [{EXACT}]\n\
                 unit = \"g\"\n"
            );
            let description = Description::parse(&text, "map.toml").unwrap();
            match read_record(&case("typed.parquet"), &description) {
                Ok(found) => assert_eq!(found.record().len(), rows),
                Err(refused) => assert!(rows == 0 && words(refused).contains("no rows")),
            }
        }
    }

    #[test]
    fn columns_that_are_missing_or_of_no_use_are_told() {
        let cases = [
            (EXACT.replace("accel_x_g", "Acc X"), "`Acc X`"),
            (
                EXACT.replace("accel_x_g", "Acc X"),
                "the columns time_s, time_ms",
            ),
            (
                EXACT.replace("accel_x_g", "Acc X"),
                "name columns that are there",
            ),
            (EXACT.replace("accel_x_g", "nested"), "name other columns"),
            (EXACT.replace("accel_x_g", "sensor"), "`upper`"),
            (EXACT.replace("accel_x_g", "at_ns"), "a column of numbers"),
        ];
        for (accel, part) in cases {
            let refused = words(typed("column = \"time_s\"", &accel).unwrap_err());
            assert!(refused.contains(part), "{refused} lacks {part}");
        }
    }

    #[test]
    fn a_file_that_is_cut_or_is_none_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("cut.parquet");
        let description = map("column = \"time_s\"", EXACT);
        let whole = std::fs::read(case("typed.parquet")).unwrap();
        let mut contents: Vec<Vec<u8>> = (4..whole.len())
            .step_by(97)
            .map(|length| whole[..length].to_vec())
            .collect();
        contents.push(b"PAR1, a story of a logger\nPAR1".to_vec());
        // The middle of the file is missing.
        contents.push([&whole[..whole.len() / 3], &whole[whole.len() / 2..]].concat());
        for content in contents {
            std::fs::write(&path, &content).unwrap();
            let refused = words(read_record(&path, &description).unwrap_err());
            for part in ["no reader of Parquet accepts", "copy the file again"] {
                assert!(refused.contains(part), "{refused} lacks {part}");
            }
        }
    }

    #[test]
    fn means_of_a_file_are_those_of_its_rows() {
        let averaged = average_file(
            &case("typed.parquet"),
            &map("column = \"time_s\"\nunit_s = 0.05", EXACT),
            6.0,
        )
        .unwrap();
        // Rows every 3 s: two in each mean.
        assert_eq!((averaged.rows, averaged.record.len()), (24, 12));
        let truth = truth();
        for (pair, mean) in truth.accel_g.chunks(2).zip(&averaged.record.accel_g) {
            for axis in 0..3 {
                assert_eq!(mean[axis], 0.5 * (pair[0][axis] + pair[1][axis]));
            }
        }
    }
}
