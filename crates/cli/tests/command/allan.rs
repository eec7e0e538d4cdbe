//! `gyrocal allan`.

use crate::folder::{Folder, assert_says};

/// The thousand numbers of NIST SP 1065, section 12.4.
fn log() -> String {
    let numbers = std::iter::successors(Some(1_234_567_890_u64), |n| {
        Some(16_807 * n % 2_147_483_647)
    });
    let rows = numbers
        .take(1000)
        .map(|n| format!("{:?},1\n", n as f64 / 2_147_483_647.0));
    "rate,other\n".to_owned() + &rows.collect::<String>()
}

#[test]
fn deviations_are_printed_and_written() {
    let folder = Folder::new();
    folder.put("l.csv", log());
    let text = folder
        .succeed("allan l.csv --columns rate --rate-hz 10 --scale 2 --unit deg/h --json o.json");
    // The handbook prints 2.922319e-1 for the first.
    assert_says(&text, "5.8446e-1");
    let json: serde_json::Value = folder.json("o.json");
    let point = &json["columns"][0]["points"][0];
    assert!((point["deviation"].as_f64().unwrap() / 0.584_463_8 - 1.0).abs() < 1e-6);
    assert!(point["low"].as_f64().unwrap() < 0.5844 && point["high"].as_f64().unwrap() > 0.5845);
    assert_eq!(json["unit"], "deg/h");
}

#[test]
fn bad_input_is_told() {
    let folder = Folder::new();
    folder.put("l.csv", log());
    let errors = folder.fail("allan l.csv --columns rates --rate-hz 10");
    assert_says(&errors, "expected a column `rates`");
    assert_says(&errors, "the columns are rate, other");
    folder.put("n.csv", "rate\n1\n2\nx\n");
    let errors = folder.fail("allan n.csv --columns rate --rate-hz 10");
    assert_says(&errors, "n.csv:4:1: found `x`, expected a finite number");
    // The other column of the log holds ones.
    let errors = folder.fail("allan l.csv --columns rate,other --rate-hz 10");
    assert_says(&errors, "found a column `other` that never changes");
    folder.put("s.csv", "rate\n1\n2\n");
    let errors = folder.fail("allan s.csv --columns rate --rate-hz 10");
    assert_says(&errors, "found 2 samples");
    let output = folder.run("allan l.csv --columns rate --rate-hz 0");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn numbers_that_overflow_are_refused() {
    let folder = Folder::new();
    // A sine, with nothing that would hide an overflow of its squares.
    let rows = (0..300).map(|row| format!("{}\n", 1e9 * (0.1 * f64::from(row)).sin()));
    folder.put("l.csv", "rate\n".to_owned() + &rows.collect::<String>());
    let refused = |rate_hz: &str, scale: &str| {
        let options = ["--rate-hz", rate_hz, "--scale", scale];
        folder.fail([&["allan", "l.csv", "--columns", "rate"], &options[..]].concat())
    };
    for (rate_hz, scale) in [("10", "1e280"), ("1e-308", "1"), ("1e308", "1")] {
        let errors = refused(rate_hz, scale);
        assert_says(&errors, "found a deviation of");
    }
    let errors = refused("10", "1e300");
    let expected = "values of `rate` that are too large when multiplied by 1e300";
    assert!(errors.contains(expected), "{errors}");
    // The largest and the least that can be squared.
    for scale in ["1e140", "1e-165"] {
        let options = ["--rate-hz", "10", "--scale", scale];
        let said =
            folder.succeed([&["allan", "l.csv", "--columns", "rate"], &options[..]].concat());
        assert!(!said.contains("NaN") && !said.contains("inf"), "{said}");
    }
}

#[test]
fn a_description_stands_for_columns_and_rate() {
    let folder = Folder::new();
    let mut rows = "recorded by nobody\nt;gx;gy;gz;ax;ay;az\n".to_owned();
    let mut state = 1_u64;
    for row in 0..2000 {
        let mut number = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        // Stamps in whole milliseconds of a clock of 104 Hz.
        let stamp = (f64::from(row) / 0.104).round();
        rows += &format!("{stamp};{};{};{};0;0;1\n", number(), number(), number());
    }
    folder.put("l.txt", rows);
    folder.put(
        "log.toml",
        "[file]\ndelimiter = \"semicolon\"\n[time]\ncolumn = \"t\"\nunit_s = 1e-3\n[gyro]\n\
         columns = [\"gx\", \"gy\", \"gz\"]\nunit = \"deg/s\"\n[accel]\ncolumns = [\"ax\", \"ay\", \
         \"az\"]\nunit = \"g\"\n",
    );
    let text =
        folder.succeed("allan l.txt --log-description log.toml --estimator hadamard --json o.json");
    assert_says(&text, "steady clock");
    assert_says(&text, "Overlapping Hadamard deviation");
    assert_says(&text, "deviation, deg/h");
    let json: serde_json::Value = folder.json("o.json");
    let noise = &json["columns"][0]["noise"];
    let walk = &noise["coefficients"][1];
    assert_eq!(walk["part"], "random_walk");
    // White samples of a standard deviation of 3600 / √12 deg/h at 104 Hz.
    let expected = 3600.0 / (12.0_f64 * 104.0).sqrt();
    let estimate = walk["estimate"].as_f64().unwrap();
    assert!(
        (estimate / expected - 1.0).abs() < 0.1,
        "{estimate} {expected}"
    );
    assert_eq!(noise["curve"][0]["parts"].as_array().unwrap().len(), 4);
}

#[test]
fn a_sample_that_no_noise_explains_is_left_out_and_told() {
    let folder = Folder::new();
    let wild = log()
        .lines()
        .enumerate()
        .fold(String::new(), |text, (line, row)| {
            text + if line == 501 { "900,1" } else { row } + "\n"
        });
    folder.put("l.csv", wild);
    let arguments = "allan l.csv --columns rate --rate-hz 10 --json o.json";
    let text = folder.succeed(arguments);
    assert!(text.starts_with("BAD SAMPLES  1 sample"), "{text}");
    assert_says(&text, "sample 501 at 50 s (900 ");
    let json: serde_json::Value = folder.json("o.json");
    let column = &json["columns"][0];
    assert_eq!(column["left_out"]["samples"][0]["sample"], 501);
    // The handbook's first deviation, of which the median in the place of one sample takes a thousandth.
    let first = column["points"][0]["deviation"].as_f64().unwrap();
    assert!((first / 0.292_231_9 - 1.0).abs() < 2e-3, "{first}");
}
