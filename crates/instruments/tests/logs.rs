//! Logs and their descriptions: columns, units, axes, clocks, and their faults.

#![allow(clippy::unwrap_used, clippy::expect_used)] // tests stop where they fail

use gyrocal_instruments::{Description, InstrumentError, Log, Unfit};
use gyrocal_statistics::allan::{NoisePart, allan_deviation, fit_noise, octaves};

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
    assert_eq!(log.accel[7], [0.0, 0.0, 1.0]);
}

#[test]
fn a_rate_stands_for_a_clock() {
    let description = DESCRIPTION.replace("column = \"ms\"\nunit_s = 1e-3", "rate_hz = 50");
    let log = parse(&text(|_| 0.0), &description).unwrap();
    assert!((log.time_s[199] - 4.0).abs() < 1e-12);
}

#[test]
fn clocks_that_jump_or_jitter_are_refused() {
    let gap = text(|row| regular(row) + if row > 120 { 35.0 } else { 0.0 });
    let (kind, message) = refused(&gap, DESCRIPTION);
    assert_eq!(kind, Some(Unfit::Gap));
    assert!(message.contains("0.0450 s after 1.2 s"), "{message}");
    assert!(message.contains("rate_hz"), "{message}");
    let jitter = text(|row| regular(row) + if row % 2 == 0 { 0.0 } else { 1.0 });
    assert_eq!(refused(&jitter, DESCRIPTION).0, Some(Unfit::Jitter));
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
    assert_eq!(log.accel[0], [0.0, 0.0, 4000.0]);
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
            good.replacen("4100,100,100,20,", "4100,100,nan,20,", 1),
            "log.csv:4:10: found `nan`, expected a finite number",
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
            "log.toml:2:1: found `[time]`, expected either",
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
    let parts = |rate: &[f64]| {
        let points = allan_deviation(rate, 1.0, &octaves(3000), 0.683).unwrap();
        fit_noise(&points, rate.len()).unwrap()
    };
    let of = |rate: &[f64], part: NoisePart| *parts(rate).coefficient(part).unwrap();
    // Octaves up to a thousand seconds leave a hundred averages: five percent.
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
