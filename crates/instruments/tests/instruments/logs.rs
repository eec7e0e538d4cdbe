//! Logs and their descriptions: formats, columns, units and axes.

use gyrocal_instruments::{Description, InstrumentError, Log, StopSettings, Unfit, find_stops};
use gyrocal_statistics::allan::{NoisePart, fit_noise};

pub(crate) const DESCRIPTION: &str = r#"
[time]
column = "ms"
unit_s = 1e-3
[gyro]
columns = ["p", "q", "r"]
unit = "deg/s"
axes = ["y", "-x", "z"]
[accel]
columns = ["u", "v", "w"]
unit = "counts"
zero_counts = 100
counts_per_g = [1000, 2000, 4000]
"#;

/// A log of 200 samples whose time stamps are given.
pub(crate) fn text(stamp_ms: impl Fn(usize) -> f64) -> String {
    let mut text = "w,v,u,ms,p,q,r\n".to_owned();
    for row in 0..200 {
        text += &format!("4100,100,100,{},90,180,-90\n", stamp_ms(row));
    }
    text
}

pub(crate) fn regular(row: usize) -> f64 {
    10.0 * row as f64
}

pub(crate) fn parse(log: &str, description: &str) -> Result<Log, InstrumentError> {
    Log::parse(
        log,
        "log.csv",
        &Description::parse(description, "log.toml")?,
    )
}

pub(crate) fn refused(log: &str, description: &str) -> (Option<Unfit>, String) {
    let error = parse(log, description).unwrap_err();
    (error.kind(), error.to_string())
}

#[test]
fn columns_units_and_axes_are_as_the_description_says() {
    let log = parse(&text(regular), DESCRIPTION).unwrap();
    assert_eq!(log.len(), 200);
    assert!((log.interval_s - 0.01).abs() < 1e-12);
    let turn = core::f64::consts::PI;
    // Body x is column q, body y is column p with its sign changed.
    let expected = [turn, -0.5 * turn, -0.5 * turn];
    for (found, expected) in log.gyro[7].iter().zip(expected) {
        assert!((found - expected).abs() < 1e-15);
    }
    assert_eq!(log.force().unwrap()[7], [0.0, 0.0, 1.0]);
}

#[test]
fn gyros_alone_are_a_log_for_what_needs_no_more() {
    let accel = DESCRIPTION.find("[accel]").unwrap();
    let description = &DESCRIPTION[..accel];
    let both = parse(&text(regular), DESCRIPTION).unwrap();
    let alone = parse(&text(regular), description).unwrap();
    assert_eq!((&alone.gyro, &alone.time_s), (&both.gyro, &both.time_s));
    assert_eq!(alone.accel, None);
    let error = find_stops(&alone, &StopSettings::default()).unwrap_err();
    assert_eq!(error.kind(), Some(Unfit::NoAccelerometers));
    assert!(error.to_string().contains("gyrocal allan"), "{error}");
    // Time stamps follow three columns in the place of six.
    let dated = description.replace("unit_s = 1e-3", "unit = \"rfc3339\"");
    let stamp = |row: usize| format!("2024-05-01T00:{:02}:{:02}Z", row / 60, row % 60);
    let rows = (0..200).map(|row| format!("{},90,180,-90\n", stamp(row)));
    let dated = parse(
        &("ms,p,q,r\n".to_owned() + &rows.collect::<String>()),
        &dated,
    )
    .unwrap();
    assert_eq!(dated.interval_s, 1.0);
}

#[test]
fn a_rate_stands_for_a_clock() {
    let description = DESCRIPTION.replace("column = \"ms\"\nunit_s = 1e-3", "rate_hz = 50");
    let log = parse(&text(|_| 0.0), &description).unwrap();
    assert!((log.time_s[199] - 4.0).abs() < 1e-12);
}

#[test]
fn units_are_read_as_laboratories_write_them() {
    let good = parse(&text(regular), DESCRIPTION).unwrap();
    for (from, to) in [
        ("\"deg/s\"", "\"°/s\""),
        ("\"deg/s\"", "\"dps\""),
        ("\"deg/s\"", "\"deg/sec\""),
        ("unit_s = 1e-3", "unit = \"msec\""),
    ] {
        let description = DESCRIPTION.replace(from, to);
        assert_eq!(parse(&text(regular), &description).unwrap(), good, "{to}");
    }
    for (unit, in_si) in [("deg/hr", 1.0 / 3600.0), ("°/h", 1.0 / 3600.0)] {
        let log = parse(
            &text(regular),
            &DESCRIPTION.replace("\"deg/s\"", &format!("\"{unit}\"")),
        );
        let found = log.unwrap().gyro[0][1];
        assert!((found + 90_f64.to_radians() * in_si).abs() < 1e-15);
    }
    for unit in ["m/s^2", "m/s/s", "m/s²"] {
        let text = format!(
            "[time]\nrate_hz = 1\n[accel]\ncolumns = [\"a\", \"b\", \"c\"]\nunit = \"{unit}\"\n\
             [site]\ngravity_m_per_s2 = 9.81\n"
        );
        Description::parse(&text, "log.toml").unwrap();
    }
}

#[test]
fn preambles_comments_and_other_delimiters_are_read() {
    let good = parse(&text(regular), DESCRIPTION).unwrap();
    let with = |file: &str| format!("[file]\n{file}\n{DESCRIPTION}");
    let preamble = format!(
        "Logger 7, unit 3\nrange: 4 g, 2000 deg/s\n\n{}",
        text(regular)
    );
    assert_eq!(parse(&preamble, DESCRIPTION).unwrap(), good);
    let comments = text(regular).replace("\n4100,100,100,50,", "\n# a mark\n4100,100,100,50,");
    assert_eq!(parse(&comments, &with("comment = \"#\"")).unwrap(), good);
    for (delimiter, separator) in [("semicolon", ";"), ("tab", "\t"), ("space", "   ")] {
        let other = text(regular).replace(',', separator);
        let description = with(&format!("delimiter = \"{delimiter}\""));
        assert_eq!(parse(&other, &description).unwrap(), good, "{delimiter}");
        let (_, message) = refused(&other, DESCRIPTION);
        assert!(message.contains("a header without it"), "{message}");
    }
    // The same without a header: columns are called by their numbers.
    let bare: String = text(regular)
        .lines()
        .skip(1)
        .map(|line| line.to_owned() + "\n")
        .collect();
    let mut numbered = with("header = false\nskip_lines = 1");
    for (name, number) in [
        ("ms", 4),
        ("p", 5),
        ("q", 6),
        ("r", 7),
        ("u", 3),
        ("v", 2),
        ("w", 1),
    ] {
        numbered = numbered.replace(&format!("\"{name}\""), &format!("\"{number}\""));
    }
    assert_eq!(
        parse(&format!("a line of text\n{bare}"), &numbered).unwrap(),
        good
    );
    let (_, message) = refused(&bare, &numbered.replace("\"7\"", "\"8\""));
    assert!(message.contains("7 columns without a header"), "{message}");
}

#[test]
fn one_sensor_of_several_is_read() {
    let good = parse(&text(regular), DESCRIPTION).unwrap();
    let mut rows = String::new();
    for (number, line) in text(regular).lines().enumerate() {
        let title = if number == 0 { "sensor" } else { "imu" };
        rows += &format!("{title},{line}\n");
        if number % 3 == 1 {
            rows += "gps,34.2,108.9\n";
        }
    }
    let only = |name: &str| {
        format!("[file.only]\ncolumn = \"sensor\"\nequals = \"{name}\"\n{DESCRIPTION}")
    };
    assert_eq!(parse(&rows, &only("imu")).unwrap(), good);
    let (_, message) = refused(&rows, &only("imu2"));
    assert!(
        message.contains("no row with `imu2` in the column `sensor`"),
        "{message}"
    );
}

#[test]
fn binary_records_are_read_and_refused() {
    let good = parse(&text(regular), DESCRIPTION).unwrap();
    let fields = r#"
[file.binary]
byte_order = "big"
skip_bytes = 5
fields = [
    { name = "ms", type = "u32" },
    { name = "p", type = "f32" }, { name = "q", type = "f64" }, { name = "r", type = "i16" },
    { name = "u", type = "i16" }, { name = "v", type = "u16" }, { name = "w", type = "i32" },
]
"#;
    let description = Description::parse(&format!("{fields}{DESCRIPTION}"), "log.toml").unwrap();
    let mut bytes = b"magic".to_vec();
    for row in 0..200_u32 {
        bytes.extend((10 * row).to_be_bytes());
        bytes.extend(90_f32.to_be_bytes());
        bytes.extend(180_f64.to_be_bytes());
        bytes.extend((-90_i16).to_be_bytes());
        bytes.extend(100_i16.to_be_bytes());
        bytes.extend(100_u16.to_be_bytes());
        bytes.extend(4100_i32.to_be_bytes());
    }
    let path = std::env::temp_dir().join(format!("gyrocal-binary-{}.log", std::process::id()));
    let read = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        Log::read(&path, &description)
    };
    assert_eq!(read(&bytes).unwrap(), good);
    let error = read(&bytes[..bytes.len() - 3]).unwrap_err();
    assert_eq!(error.kind(), Some(Unfit::Binary), "{error}");
    assert!(
        error.to_string().contains("whole records of 26 bytes"),
        "{error}"
    );
    // The mean of a rate that is not a number.
    bytes[5 + 26 + 4..5 + 26 + 8].copy_from_slice(&f32::NAN.to_be_bytes());
    let error = read(&bytes).unwrap_err().to_string();
    assert!(error.contains("NaN as `p` of record 2"), "{error}");
    std::fs::remove_file(&path).unwrap();
}

#[test]
fn counts_without_a_scale_are_refused() {
    let without = DESCRIPTION.replace("counts_per_g = [1000, 2000, 4000]", "");
    let (kind, message) = refused(&text(regular), &without);
    assert_eq!(kind, Some(Unfit::NoScale));
    assert!(
        message.contains("counts_per_g = \"from-stops\""),
        "{message}"
    );
    let estimated = DESCRIPTION.replace("[1000, 2000, 4000]", "\"from-stops\"");
    let log = parse(&text(regular), &estimated).unwrap();
    assert!(log.accel_in_counts);
    assert_eq!(log.force().unwrap()[0], [0.0, 0.0, 4000.0]);
}

#[test]
fn files_are_refused_where_they_are_wrong() {
    let good = text(regular);
    let cases = [
        (
            good.replace("w,v,u", "w,v,z"),
            "log.csv:1:1: found a header without it, expected a column `u`",
        ),
        (
            good.replace("w,v,u", "u,v,u"),
            "log.csv:1:1: found the column `u` twice",
        ),
        (
            good.replacen("4100,100,100,20,90,", "4100,100,100,20,nan,", 1),
            "log.csv:4:17: found `nan`, expected a finite number",
        ),
        (
            good.replacen("4100,100,100,20,", "4100,100,100,20,1,", 1),
            "log.csv:4:1: found 8 fields, expected 7 fields",
        ),
        (
            good.lines().next().unwrap().to_owned(),
            "log.csv:1:1: found a header without rows",
        ),
    ];
    for (log, expected) in cases {
        let (_, message) = refused(&log, DESCRIPTION);
        assert!(message.starts_with(expected), "{expected}\n{message}");
    }
    let short: Vec<&str> = good.lines().take(50).collect();
    assert_eq!(
        refused(&short.join("\n"), DESCRIPTION).0,
        Some(Unfit::TooShort)
    );
}

#[test]
fn descriptions_are_refused_where_they_are_wrong() {
    let cases = [
        (
            "unit_s = 1e-3",
            "rate_hz = 5",
            "log.toml:2:1: found `[time]`, expected one of",
        ),
        (
            "unit_s = 1e-3",
            "unit_s = -1",
            "log.toml:4:1: found `unit_s = -1`, expected a positive",
        ),
        (
            "\"deg/s\"",
            "\"rpm\"",
            "log.toml:7:8: found `\"rpm\"` (unknown variant",
        ),
        (
            "[\"y\", \"-x\", \"z\"]",
            "[\"up\", \"x\", \"y\"]",
            "log.toml:8:9: found `\"up\"`",
        ),
        (
            "[1000, 2000, 4000]",
            "[1000, 0, 4000]",
            "log.toml:13:1: found `counts_per_g",
        ),
        (
            "zero_counts",
            "zero_count",
            "log.toml:12:1: found `zero_count` (unknown field",
        ),
        (
            "unit = \"counts\"",
            "unit = \"m/s2\"",
            "log.toml:9:1: found `[accel]`, expected `gravity",
        ),
    ];
    for (from, to, expected) in cases {
        let (_, message) = refused(&text(regular), &DESCRIPTION.replace(from, to));
        assert!(message.starts_with(expected), "{expected}\n{message}");
    }
}

#[test]
fn parts_of_a_noise_are_told_by_their_slopes() {
    // White noise of unit variance each second, from a linear congruence.
    let mut state = 1_u64;
    let mut uniform = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut series = || -> Vec<f64> { (0..100_000).map(|_| uniform() * 12.0_f64.sqrt()).collect() };
    let (white, other) = (series(), series());
    let angle: Vec<f64> = other
        .windows(2)
        .map(|pair| 10.0 * (pair[1] - pair[0]))
        .collect();
    let both: Vec<f64> = white
        .iter()
        .zip(&angle)
        .map(|(rate, angle)| rate + angle)
        .collect();
    let of =
        |rate: &[f64], part: NoisePart| *fit_noise(rate, 1.0).unwrap().coefficient(part).unwrap();
    // A hundred thousand samples leave less than a percent; quantisation hides all but the thousand lowest ordinates.
    let found = of(&white, NoisePart::RandomWalk);
    assert!((found.estimate.unwrap() - 1.0).abs() < 0.05, "{found:?}");
    let found = of(&white, NoisePart::Quantisation);
    assert!(found.estimate.unwrap() < 0.1, "{found:?}");
    let found = of(&both, NoisePart::Quantisation);
    assert!(
        (found.estimate.unwrap() / 10.0 - 1.0).abs() < 0.05,
        "{found:?}"
    );
    let found = of(&both, NoisePart::RandomWalk);
    assert!((found.estimate.unwrap() - 1.0).abs() < 0.2, "{found:?}");
}
