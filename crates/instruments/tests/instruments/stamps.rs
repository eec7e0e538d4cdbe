//! Clocks of logs: stamps that jump, jitter, repeat or are rounded.

use crate::logs::{DESCRIPTION, parse, refused, regular, text};

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
