//! Logs and their descriptions: columns, units, axes, clocks, and their faults.

use gyrocal_instruments::{Description, InstrumentError, Log, StopSettings, Unfit, find_stops};
use gyrocal_statistics::allan::{NoisePart, fit_noise};

const DESCRIPTION: &str = r#"
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
fn text(stamp_ms: impl Fn(usize) -> f64) -> String {
    let mut text = "w,v,u,ms,p,q,r\n".to_owned();
    for row in 0..200 {
        text += &format!("4100,100,100,{},90,180,-90\n", stamp_ms(row));
    }
    text
}

fn regular(row: usize) -> f64 {
    10.0 * row as f64
}

fn parse(log: &str, description: &str) -> Result<Log, InstrumentError> {
    Log::parse(
        log,
        "log.csv",
        &Description::parse(description, "log.toml")?,
    )
}

fn refused(log: &str, description: &str) -> (Option<Unfit>, String) {
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
fn clocks_that_jump_or_go_back_are_refused() {
    for jitter in ["", "jitter = \"use\"\n"] {
        let description =
            DESCRIPTION.replace("unit_s = 1e-3\n", &format!("unit_s = 1e-3\n{jitter}"));
        let longer = if jitter.is_empty() { 35.0 } else { 135.0 };
        let gap = text(|row| regular(row) + if row > 120 { longer } else { 0.0 });
        let error = parse(&gap, &description).unwrap_err();
        let message = error.to_string();
        // The header is line 1, so row 121, counted from 0, is line 123.
        assert!(
            message.starts_with("log.csv:123:1: found 1 gap(s) in the time stamps"),
            "{message}"
        );
        let expected = format!("{:.4} s after 1.2 s", (10.0 + longer) * 1e-3);
        assert!(message.contains(&expected), "{message}");
        assert!(error.advice().contains("rate_hz"), "{error}");
        // What is advised is taken: interpolation over a short gap.
        let offers = error.advice().contains("`jitter = \"resample\"`");
        assert_eq!(offers, jitter.is_empty());
        if offers {
            let resampled = description.replace("1e-3\n", "1e-3\njitter = \"resample\"\n");
            parse(&gap, &resampled).unwrap();
        }
    }
    let (kind, message) = refused(&text(|row| regular(row % 150)), DESCRIPTION);
    assert_eq!(kind, None);
    // The header is line 1, so row 150, counted from 0, is line 152.
    assert!(
        message.starts_with("log.csv:152:1: found time 0 s after 1.49 s"),
        "{message}"
    );
    // As much jitter as the Xsens log has is borne.
    let slight = text(|row| regular(row) + if row % 5 == 0 { 0.4 } else { 0.0 });
    parse(&slight, DESCRIPTION).unwrap();
}

#[test]
fn stamps_that_jitter_are_a_steady_clock_or_used_or_resampled() {
    // Stamps of even samples are 4 ms late: intervals of 6 and 14 ms, and no sample is missing.
    let jitter = text(|row| regular(row) + if row % 2 == 0 { 4.0 } else { 0.0 });
    let log = parse(&jitter, DESCRIPTION).unwrap();
    let steady: Vec<f64> = log
        .time_s
        .windows(2)
        .map(|pair| pair[1] - pair[0])
        .collect();
    // The line through alternating stamps is off by 6 of 200² in slope.
    assert!(
        steady
            .iter()
            .all(|interval_s| (interval_s - 0.01).abs() < 1e-5)
    );
    assert!(
        log.clock.note().unwrap().contains("2.00 ms rms"),
        "{:?}",
        log.clock
    );
    let with = |jitter: &str| {
        DESCRIPTION.replace(
            "unit_s = 1e-3",
            &format!("unit_s = 1e-3\njitter = \"{jitter}\""),
        )
    };
    let used = parse(&jitter, &with("use")).unwrap();
    assert!((used.time_s[1] - used.time_s[0] - 0.006).abs() < 1e-12);
    assert_eq!(used.clock.note(), None);
    let resampled = parse(&jitter, &with("resample")).unwrap();
    assert_eq!(resampled.gyro[0], used.gyro[0]);
    assert!(resampled.clock.note().unwrap().contains("interpolated"));
    // Packets of four samples have one stamp, which is no time of a sample.
    let packets = text(|row| regular(row - row % 4));
    parse(&packets, DESCRIPTION).unwrap();
    let (_, message) = refused(&packets, &with("use"));
    assert!(
        message.starts_with("log.csv:3:1: found 150 rows with the stamp and the values"),
        "{message}"
    );
}

#[test]
fn clocks_that_are_set_and_stamps_that_are_wrong_alone_are_told_as_such() {
    let told = |stamp_ms: &dyn Fn(usize) -> f64| {
        let error = parse(&text(stamp_ms), DESCRIPTION).unwrap_err();
        (error.to_string(), error.advice().to_owned())
    };
    let hour = 3_600_000.0;
    let later = |row: usize| if row > 120 { hour } else { 0.0 };
    for (stamp, words) in [
        (
            &(|row| regular(row) + later(row)) as &dyn Fn(usize) -> f64,
            "take 3600 s off the stamps",
        ),
        (
            &|row| regular(row) + hour - later(row),
            "add 3600 s to the stamps",
        ),
    ] {
        let (message, advice) = told(stamp);
        assert!(message.starts_with("log.csv:123:1: "), "{message}");
        assert!(advice.contains(words), "{advice}");
    }
    let (_, advice) = told(&|row| regular(row) - if row == 90 { 25.0 } else { 0.0 });
    assert!(advice.contains("a stamp alone is wrong"), "{advice}");
    let (message, advice) = told(&|row| regular(row % 50));
    assert!(
        message.contains("time 0 s after 0.49 s, the first of 3 such steps back"),
        "{message}"
    );
    assert!(advice.contains("split the file"), "{advice}");
}

#[test]
fn stamps_in_whole_steps_are_a_steady_clock_if_no_sample_is_missing() {
    // Eight samples share a stamp, after the first.
    let stamp = |row: usize| ((row + 3) / 8 * 80) as f64;
    let log = parse(&text(stamp), DESCRIPTION).unwrap();
    assert!((log.interval_s - 0.01).abs() < 1e-4, "{}", log.interval_s);
    // Half-way between two steps rounding goes either way: 7 to 9 samples.
    let ties = |row: usize| {
        let extra = usize::from((row / 8).is_multiple_of(3));
        ((row + 3 + extra) / 8 * 80) as f64
    };
    parse(&text(ties), DESCRIPTION).unwrap();
    // The fifth step lacks four of them.
    let lost = |row: usize| stamp(row + if row >= 40 { 4 } else { 0 });
    let error = parse(&text(lost), DESCRIPTION).unwrap_err();
    let message = error.to_string();
    assert!(
        message.starts_with(
            "log.csv:39:1: found time stamps in steps of 0.0800 s, with 4 to 8 samples"
        ),
        "{message}"
    );
    let rate = "rate_hz = 97.917";
    assert!(error.advice().contains(rate), "{}", error.advice());
    parse(
        &text(lost),
        &DESCRIPTION.replace("column = \"ms\"\nunit_s = 1e-3", rate),
    )
    .unwrap();
}

/// A log of noise, of which some rows are others.
fn noisy(change: impl Fn(usize, [f64; 6]) -> [f64; 6]) -> String {
    let mut state = 3_u64;
    let mut uniform = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut text = "w,v,u,ms,p,q,r\n".to_owned();
    for row in 0..1000 {
        let [w, v, u, p, q, r] = change(
            row,
            [
                4100.0 + uniform(),
                100.0 + uniform(),
                100.0 + uniform(),
                uniform(),
                uniform(),
                // Coarse: most values repeat the one before.
                (0.55 * uniform()).round() + 5.0,
            ],
        );
        text += &format!("{w},{v},{u},{},{p},{q},{r}\n", 10 * row);
    }
    text
}

#[test]
fn gyros_that_stand_still_and_padding_are_told_with_their_line() {
    parse(&noisy(|_, row| row), DESCRIPTION).unwrap();
    let still = |row: usize, [w, v, u, p, q, r]: [f64; 6]| match row {
        // Within the range of `q`.
        300..330 => [w, v, u, p, 0.1, r],
        _ => [w, v, u, p, q, r],
    };
    let error = parse(&noisy(still), DESCRIPTION).unwrap_err();
    let message = error.to_string();
    assert!(
        message.starts_with("log.csv:302:1: found `q` at 0.1 in 30 samples from here on"),
        "{message}"
    );
    // The part in front of it is a log.
    let lines: Vec<String> = noisy(still).lines().map(str::to_owned).collect();
    parse(&lines[..301].join("\n"), DESCRIPTION).unwrap();
    // Coarse steps hide the noise of a sensor that is shaken now and then.
    let shaken = |row: usize, [w, v, u, p, q, r]: [f64; 6]| {
        let size = if (row / 100).is_multiple_of(2) {
            0.8
        } else {
            4.0
        };
        [w, v, u, p, (size * q).round(), r]
    };
    parse(&noisy(shaken), DESCRIPTION).unwrap();
    // Zero is no end of the range of a gyro whose rates are all negative.
    let dead = |row: usize, [w, v, u, p, q, r]: [f64; 6]| match row {
        970.. => [w, v, u, p, 0.0, r],
        _ => [w, v, u, p, q - 1.0, r],
    };
    let (_, message) = refused(&noisy(dead), DESCRIPTION);
    assert!(
        message.starts_with("log.csv:972:1: found `q` at 0 in 30 samples"),
        "{message}"
    );
    let padded = |row: usize, values: [f64; 6]| match row {
        950.. => [100.0, 100.0, 100.0, 0.0, 0.0, 0.0],
        _ => values,
    };
    let error = parse(&noisy(padded), DESCRIPTION).unwrap_err();
    let message = error.to_string();
    assert!(
        message.starts_with("log.csv:952:1: found 50 rows to the end of the log"),
        "{message}"
    );
    assert!(
        error.advice().contains("delete the rows from this line on"),
        "{error}"
    );
}

#[test]
fn sensors_slower_than_the_gyros_are_interpolated() {
    let description =
        format!("{DESCRIPTION}[temperature]\ncolumn = \"T\"\n[file]\nmissing = [\"--\"]\n");
    let log = |force: &dyn Fn(usize) -> String, warmth: &dyn Fn(usize) -> String| {
        let mut text = "w,v,u,ms,p,q,r,T\n".to_owned();
        for row in 0..200 {
            text += &format!(
                "4100,100,{},{},90,180,-90,{}\n",
                force(row),
                10 * row,
                warmth(row)
            );
        }
        text
    };
    let every = |rows: usize, value: fn(usize) -> f64, none: &'static str| {
        move |row: usize| match row.is_multiple_of(rows) {
            true => value(row).to_string(),
            false => none.to_owned(),
        }
    };
    let force = every(4, |row| 100.0 + row as f64, "");
    let warmth = every(50, |row| 20.0 + row as f64 / 100.0, "--");
    let read = parse(&log(&force, &warmth), &description).unwrap();
    let celsius = read.temperature_c.as_ref().unwrap();
    // Rows 196 and 150 are the last that have them.
    for row in [0, 1, 2, 77, 150] {
        let [x, ..] = read.force().unwrap()[row];
        assert!((x - row as f64 / 1000.0).abs() < 1e-12, "{row}: {x}");
        assert!((celsius[row] - 20.0 - row as f64 / 100.0).abs() < 1e-12);
    }
    assert_eq!(read.force().unwrap()[199][0], 0.196);
    assert_eq!(celsius[199], 21.5);
    // A long hole is no slow sensor, and a word is no missing value unless it is listed.
    let hole = |row: usize| match row {
        60..150 => String::new(),
        _ => force(row),
    };
    let (_, message) = refused(&log(&hole, &warmth), &description);
    assert!(
        message.starts_with("log.csv:59:1: found no value of `u` in 95 rows"),
        "{message}"
    );
    let word = every(50, |_| 20.0, "N/A");
    let error = parse(&log(&force, &word), &description).unwrap_err();
    assert!(
        error.advice().contains("missing = [\"N/A\"]"),
        "{}",
        error.advice()
    );
    let (_, message) = refused(&log(&force, &|_| String::new()), &description);
    assert!(message.contains("no value of `T` in 200 rows"), "{message}");
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

/// A log at rest whose first gyro and temperature are given.
fn with(rate: impl Fn(usize) -> f64, temperature: impl Fn(usize) -> f64) -> String {
    let mut text = "w,v,u,ms,p,q,r,T\n".to_owned();
    for row in 0..400 {
        let (rate, temperature) = (rate(row), temperature(row));
        text += &format!("4100,100,100,{},{rate},180,-90,{temperature}\n", 10 * row);
    }
    text
}

#[test]
fn temperatures_in_another_unit_are_told_with_their_line() {
    let description =
        |unit: &str| format!("{DESCRIPTION}[temperature]\ncolumn = \"T\"\nunit = \"{unit}\"\n");
    let rate = |row: usize| (row as f64).sin();
    let (kind, told) = refused(&with(rate, |_| 293.15), &description("C"));
    assert_eq!(kind, None);
    assert!(
        told.contains("log.csv:2:") && told.contains("a temperature of 293.15 degrees Celsius"),
        "{told}"
    );
    let error = parse(&with(rate, |_| 293.15), &description("C")).unwrap_err();
    assert!(
        error.advice().contains("`unit = \"K\"`"),
        "{}",
        error.advice()
    );
    // Degrees Celsius as kelvins lie below all cold.
    let (_, told) = refused(
        &with(rate, |row| 20.0 + row as f64 / 100.0),
        &description("K"),
    );
    assert!(told.contains("a temperature of -253.15"), "{told}");
    for (unit, value) in [("C", 20.0), ("K", 293.15), ("F", 68.0)] {
        parse(&with(rate, |_| value), &description(unit)).unwrap();
    }
}

#[test]
fn saturated_gyros_are_told_with_the_line_where_they_begin_to_be() {
    let rate = |row: usize| (250.0 * (row as f64 / 40.0).sin()).clamp(-300.0, 240.0);
    let error = parse(&with(rate, |_| 20.0), DESCRIPTION).unwrap_err();
    let told = error.to_string();
    let first = (0..400).position(|row| rate(row) == 240.0).unwrap();
    // The header is line 1.
    assert!(told.contains(&format!("log.csv:{}:", first + 2)), "{told}");
    assert!(
        told.contains("samples of `p` at the end of its range, 240"),
        "{told}"
    );
    assert!(error.advice().contains("cut the log"), "{}", error.advice());
    // A gyro that reaches the end for a moment is not saturated.
    parse(
        &with(|row| 250.0 * (row as f64 / 40.0).sin(), |_| 20.0),
        DESCRIPTION,
    )
    .unwrap();
}

#[test]
fn rows_that_repeat_are_told_as_such() {
    // From row 100 on each sample is there twice.
    let twice = |row: usize| regular(if row < 100 { row } else { 50 + row / 2 });
    let (_, message) = refused(&text(twice), DESCRIPTION);
    // The header is line 1.
    assert!(
        message.starts_with("log.csv:103:1: found 50 rows with the stamp and the values"),
        "{message}"
    );
    assert!(message.contains("the first at 1 s"), "{message}");
    // A rate that changes has no gap either.
    let slower = |row: usize| regular(row) + 2.0 * row.saturating_sub(100) as f64;
    let (_, message) = refused(&text(slower), DESCRIPTION);
    assert!(message.contains("no steady clock"), "{message}");
}
