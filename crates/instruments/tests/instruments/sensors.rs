//! Sensors of logs that stand still, are saturated, slower than others or of another unit.

use crate::logs::{DESCRIPTION, parse, refused};

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
