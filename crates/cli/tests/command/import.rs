//! `gyrocal import` on the recording that ships with the repository.

use gyrocal_record::{CalibrationReport, FitVerdict};

use crate::calibrate::unwrapped;
use crate::folder::{Folder, assert_says, repository, repository_argument};

const LOG: &str = "tests/data/measured/ring_laser_static/imu.csv";
const DESCRIPTION: &str = "tests/data/measured/ring_laser_static/log.toml";

fn arguments<'a>(log: &'a str, description: &'a str) -> [&'a str; 11] {
    [
        "import",
        "strapdown",
        log,
        "--log-description",
        description,
        "--out",
        "r.csv",
        "--bench-out",
        "b.toml",
        "--json",
        "o.json",
    ]
}

#[test]
fn the_recorded_unit_feels_the_earth_turn() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    let text = folder.succeed(arguments(&log, &description));
    assert_says(&text, "One attitude determines three combinations");
    let json: serde_json::Value = folder.json("o.json");
    let rate = |name: &str| {
        let value = |index: usize| {
            json[format!("{name}_rate_deg_per_h")][index]
                .as_f64()
                .unwrap()
        };
        let expected = json[format!("expected_{name}_rate_deg_per_h")]
            .as_f64()
            .unwrap();
        (value(0) - expected, value(1))
    };
    // Earth rate at latitude 34.246048 deg: 15.041067 deg/h times cosine and sine.
    let expected = json["expected_horizontal_rate_deg_per_h"].as_f64().unwrap();
    assert!((expected - 12.4334).abs() < 1e-4);
    // Gyros of this grade err by hundredths of a degree an hour.
    let (horizontal, sigma) = rate("horizontal");
    assert!(
        horizontal.abs() < 0.03 && sigma < 0.01,
        "{horizontal} {sigma}"
    );
    let (vertical, sigma) = rate("vertical");
    assert!(
        vertical.abs() < 4.0 * sigma && sigma < 0.1,
        "{vertical} {sigma}"
    );
    // The vehicle rocks, and not all the time.
    let disturbed: f64 = json["disturbed_s"]
        .as_array()
        .unwrap()
        .iter()
        .map(|ends| ends[1].as_f64().unwrap() - ends[0].as_f64().unwrap())
        .sum();
    assert!((200.0..900.0).contains(&disturbed), "{disturbed}");
}

#[test]
fn a_rate_that_is_not_the_earths_is_called_far_off() {
    let description = std::fs::read_to_string(repository(DESCRIPTION)).unwrap();
    let folder = Folder::new();
    folder.put(
        "l.toml",
        // At this latitude the horizontal rate is higher by 0.1 deg/h, forty sigmas.
        description.replace("latitude_deg = 34.246048", "latitude_deg = 33.5"),
    );
    let text = folder.succeed(arguments(&repository_argument(LOG), "l.toml"));
    let lines: Vec<&str> = text.lines().collect();
    let horizontal = lines
        .iter()
        .position(|l| l.starts_with("  horizontal"))
        .unwrap();
    assert!(
        lines[horizontal + 1].contains("far off: check latitude, units and axes"),
        "{text}"
    );
}

#[test]
fn the_record_can_be_calibrated_and_determines_what_one_attitude_determines() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    folder.succeed(arguments(&log, &description));
    folder.succeed("calibrate r.csv --bench b.toml --json c.json");
    let json: serde_json::Value = folder.json("c.json");
    let report: serde_json::Value = folder.json("o.json");
    let coefficients = json["coefficients"].as_array().unwrap();
    let find = |name: &str| {
        let found = coefficients
            .iter()
            .find(|coefficient| coefficient["name"] == name)
            .unwrap();
        (
            found["estimate"].as_f64().unwrap(),
            found["sigma"].as_f64().unwrap(),
        )
    };
    // Body x points south, so that its gyro's drift in the platform, minus its error, is the
    // north component of the errors: what the horizontal rate shows.
    let (bias, sigma) = find("gyro_x.bias");
    let north = report["horizontal_rate_deg_per_h"][0].as_f64().unwrap()
        - report["expected_horizontal_rate_deg_per_h"]
            .as_f64()
            .unwrap();
    assert!((bias - north).abs() < 4.0 * sigma, "{bias} {sigma} {north}");
    assert!(sigma < 0.05, "{sigma}");
    // A bias and its gyro's terms along the vertical are one number: the prior of 1 shared.
    for name in ["gyro_z.bias", "gyro_z.g_z", "gyro_z.g_zz"] {
        assert!(find(name).1 > 0.5, "{name}");
    }
}

#[test]
fn in_the_axes_of_its_gyros_one_attitude_leaves_seven_of_nine_combinations_undetermined() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    folder.succeed([&arguments(&log, &description)[..], &["--axes-out", "a.csv"]].concat());
    folder.succeed("calibrate r.csv --bench b.toml --gyro-axes a.csv --json c.json");
    let json: serde_json::Value = folder.json("c.json");
    let coefficients = json["coefficients"].as_array().unwrap();
    let determined: Vec<&str> = coefficients
        .iter()
        .filter(|coefficient| coefficient["determined"] == true)
        .map(|coefficient| coefficient["name"].as_str().unwrap())
        .collect();
    // Body x points south. Up is gyro z's bias, g_z and g_zz together: none of them by itself.
    assert_eq!(determined, ["gyro_x.bias"]);
    let said = folder.succeed("calibrate r.csv --bench b.toml --gyro-axes a.csv");
    let said = unwrapped(&said);
    let combinations = said.matches(" % of that before the record");
    assert_eq!(combinations.count(), 7, "{said}");
    // An error of an output, not the drift of a platform: the north component's sign is turned.
    let report: serde_json::Value = folder.json("o.json");
    let rate = |name: &str| report[name].as_f64().unwrap();
    let north = report["horizontal_rate_deg_per_h"][0].as_f64().unwrap()
        - rate("expected_horizontal_rate_deg_per_h");
    let bias = coefficients[0]["estimate"].as_f64().unwrap();
    let sigma = coefficients[0]["sigma"].as_f64().unwrap();
    assert!((bias + north).abs() < 3.0 * sigma, "{bias} {sigma} {north}");
}

#[test]
fn its_diagnosis_names_no_physical_cause_and_says_what_would_pass_unseen() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    folder.succeed(arguments(&log, &description));
    folder.succeed("diagnose r.csv --bench b.toml --json d.json");
    let json: serde_json::Value = folder.json("d.json");
    for finding in json["findings"].as_array().unwrap() {
        // The vehicle rocks: its noise is not quite what was declared. Half an hour in one
        // attitude can tell no drift term from another, and a uniform turn is no converter's step.
        let effect = finding["effect"].as_str().unwrap();
        assert!(
            effect == "accel.outliers" || effect.ends_with(".noise"),
            "{effect}"
        );
    }
    let unseen: Vec<&str> = json["not_searched"]
        .as_array()
        .unwrap()
        .iter()
        .map(|entry| entry["effect"].as_str().unwrap())
        .collect();
    for effect in ["gyro_x.g_y", "gyro_y.ramp", "gyro_z.g_xy", "site.latitude"] {
        assert!(unseen.contains(&effect), "{effect}");
    }
}

#[test]
fn it_is_diagnosed_in_the_axes_of_its_gyros() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    folder.succeed([&arguments(&log, &description)[..], &["--axes-out", "a.csv"]].concat());
    let diagnose = ["diagnose", "r.csv", "--bench", "b.toml"];
    let with = |more: &[&'static str]| [&diagnose[..], more].concat();
    let said = folder.succeed(with(&["--gyro-axes", "a.csv", "--json", "d.json"]));
    assert_says(&said, "fixed to a body");
    let json: serde_json::Value = folder.json("d.json");
    assert_eq!(json["subject"], "strapdown");
    for finding in json["findings"].as_array().unwrap() {
        // As without the axes: the vehicle rocks.
        let effect = finding["effect"].as_str().unwrap();
        assert!(
            effect == "accel.outliers" || effect.ends_with(".noise"),
            "{effect}"
        );
    }
    let short = folder.run(with(&["--gyro-axes", "a.csv"]));
    let short = String::from_utf8(short.stdout).unwrap();
    let short = short.replace("\\\n", " ");
    let next: Vec<&str> = short.split("next").skip(1).collect();
    assert!(!next.is_empty(), "{short}");
    for step in next {
        let step = step.split_whitespace().collect::<Vec<_>>().join(" ");
        let files = "r.csv --bench b.toml --gyro-axes a.csv";
        assert!(step.contains(files), "{step}");
    }
    let refused = |arguments: &[&str], code: i32, words: &str| {
        let output = folder.run(arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{errors}");
        assert!(errors.contains(words), "{words}\nis not in\n{errors}");
    };
    let twice = with(&["--gyro-axes", "a.csv", "--gyro-axes", "a.csv"]);
    refused(&twice, 2, "one for each record");
    let euler = with(&["--gyro-axes", "a.csv", "--filter", "euler"]);
    refused(&euler, 2, "--filter");
    let later = ["--validate", "r.csv", "--validate-bench", "b.toml"];
    refused(
        &[&twice[..6], &later[..]].concat(),
        2,
        "--validate-gyro-axes",
    );
    let extend = ["extend", "d.json", "--out", "x.model.toml"];
    // Noise is no term, of whatever gyros.
    refused(&extend, 1, "expected an effect of the extended model");
}

#[test]
fn a_heading_that_is_none_is_refused_as_an_option() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    let cases = [
        ("nan", "1", "expected an angle in degrees, from -360 to 360"),
        (
            "1e300",
            "1",
            "expected an angle in degrees, from -360 to 360",
        ),
        (
            "-30",
            "nan",
            "expected degrees, greater than 0 and at most 180",
        ),
        (
            "-30",
            "181",
            "expected degrees, greater than 0 and at most 180",
        ),
    ];
    for (heading, sigma, message) in cases {
        let options = ["--heading-deg", heading, "--heading-sigma-deg", sigma];
        let output = folder.run([&arguments(&log, &description), &options[..]].concat());
        assert_eq!(output.status.code(), Some(2));
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(errors.contains(message), "{message}\nis not in\n{errors}");
    }
}

#[test]
fn a_computed_platform_is_checked_as_far_as_it_is_one() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    folder.succeed([&arguments(&log, &description)[..], &["--axes-out", "a.csv"]].concat());
    let sound = folder.text("r.csv");
    let calibrate = "calibrate r.csv --bench b.toml --gyro-axes a.csv --json c.json";
    folder.succeed(calibrate);
    let report: CalibrationReport = folder.json("c.json");
    assert!(report.setup.is_empty());
    assert_eq!(report.effects.len(), 1);
    assert!(report.effects[0].causes.is_empty(), "{:?}", report.effects);
    let change = |change: &dyn Fn(usize, &mut Vec<f64>)| {
        let mut lines = sound.lines();
        let mut text = lines.next().unwrap().to_owned();
        for (row, line) in lines.enumerate() {
            let numbers = line.split(',').map(|field| field.parse().unwrap());
            let mut fields: Vec<f64> = numbers.collect();
            change(row, &mut fields);
            let fields: Vec<String> = fields.iter().map(|value| format!("{value:?}")).collect();
            text.push_str(&format!("\n{}", fields.join(",")));
        }
        folder.put("r.csv", text + "\n");
    };
    let wrong = |kind: &str| {
        let errors = folder.fail_writing(calibrate, &["c.json"]);
        let report: CalibrationReport = folder.json("c.json");
        assert_eq!(report.verdict, FitVerdict::Setup, "{errors}");
        assert_eq!(report.setup[0].kind, kind, "{errors}");
    };
    change(&|_, fields| fields[1..4].iter_mut().for_each(|value| *value *= 9.81));
    wrong("unit");
    change(&|row, fields| fields[0] -= if row == 30 { 1e4 } else { 0.0 });
    wrong("clock");
}

#[test]
fn axes_that_belong_to_another_record_are_refused() {
    let folder = Folder::new();
    let (log, description) = (repository_argument(LOG), repository_argument(DESCRIPTION));
    folder.succeed([&arguments(&log, &description)[..], &["--axes-out", "a.csv"]].concat());
    let axes = folder.text("a.csv");
    let calibrate = [
        "calibrate",
        "r.csv",
        "--bench",
        "b.toml",
        "--gyro-axes",
        "x.csv",
    ];
    folder.put(
        "x.csv",
        axes.lines().take(20).collect::<Vec<_>>().join("\n"),
    );
    let errors = folder.fail(calibrate);
    assert_says(&errors, "found 19 rows, expected 61");
    folder.put("x.csv", axes.replacen("q_w", "w", 1));
    let errors = folder.fail(calibrate);
    assert_says(&errors, "a column `q_w`");
    folder.put("x.csv", axes);
    let twice = [&calibrate[..], &["--gyro-axes", "x.csv"]].concat();
    assert_eq!(folder.run(&twice).status.code(), Some(2));
    let streaming = [&calibrate[..], &["--streaming"]].concat();
    assert_eq!(folder.run(&streaming).status.code(), Some(2));
}

#[test]
fn bad_input_is_told() {
    let log = std::fs::read_to_string(repository(LOG)).unwrap();
    let description = std::fs::read_to_string(repository(DESCRIPTION)).unwrap();
    let refused = |log: &str, description: &str| {
        let folder = Folder::new();
        folder.put("l.csv", log);
        folder.put("l.toml", description);
        folder.fail(arguments("l.csv", "l.toml"))
    };
    let with = |from: &str, to: &str| refused(&log, &description.replace(from, to));
    let gap: String = log
        .lines()
        .enumerate()
        .filter(|(row, _)| !(5000..5050).contains(row))
        .map(|(_, line)| line.to_owned() + "\n")
        .collect();
    let cases = [
        (
            with("\"rad/s\"", "\"deg/s\""),
            "expected Earth rate, 15.041",
        ),
        (
            with("\"m/s2\"", "\"g\""),
            "found a norm of specific force at rest of 9.79",
        ),
        (
            with(
                "unit = \"rad/s\"",
                "unit = \"rad/s\"\naxes = [\"x\", \"y\", \"-z\"]",
            ),
            "found a vertical rate of -8.",
        ),
        (
            with("latitude_deg = 34.246048", ""),
            "a description without latitude",
        ),
        (
            with("latitude_deg = 34.246048", "latitude_deg = -34.246048"),
            "found a vertical rate of 8.4",
        ),
        (
            with(
                "unit = \"rad/s\"",
                "unit = \"counts\"\ncounts_per_rad_per_s = \"from-turns\"",
            ),
            "counts whose scale is to be estimated",
        ),
        (refused(&gap, &description), "1 gap(s) in the time stamps"),
        (
            refused(
                &log.lines().take(1000).collect::<Vec<_>>().join("\n"),
                &description,
            ),
            "found 3 intervals of 30 s",
        ),
    ];
    for (errors, message) in cases {
        assert!(errors.contains(message), "{message}\nis not in\n{errors}");
    }
}

#[test]
fn a_proposal_tells_a_clock_that_restarts_with_its_line() {
    let folder = Folder::new();
    let rows = |order: &[u32]| {
        let row = |time_s: &u32| {
            let (sine, cosine) = (7.292e-5 * f64::from(*time_s)).sin_cos();
            format!("{time_s},{:.9},{:.9},0.6\n", 0.8 * cosine, 0.8 * sine)
        };
        "t,ax,ay,az\n".to_owned() + &order.iter().map(row).collect::<String>()
    };
    let times: Vec<u32> = (0..120)
        .map(|row| 60 * if row < 70 { 1439 + row } else { row - 70 })
        .collect();
    folder.put("restart.csv", rows(&times));
    let said = unwrapped(&folder.succeed("import csv restart.csv --propose MAP.toml"));
    // 69 and 49 intervals of a minute.
    assert_says(&said, "120 rows over 7080.0 s, the clock restarts");
    assert_says(
        &said,
        "line 72: a clock that goes back from 90480 s to 0 s: 2 parts",
    );
    let next = "import csv restart.csv --columns MAP.toml --split --out PART.csv";
    assert_says(&said, next);
    folder.succeed(next);
    assert_eq!(folder.text("PART.2.csv").lines().count(), 51);
    // A row out of order is no restart.
    let mut times: Vec<u32> = (0..120).map(|row| 60 * row).collect();
    times.swap(70, 71);
    folder.put("order.csv", rows(&times));
    let said = unwrapped(&folder.succeed("import csv order.csv --propose ORDER.toml"));
    assert_says(&said, "120 rows, times do not rise");
    assert_says(&said, "line 73: 1 row out of order");
    assert!(!said.contains("gyrocal diagnose"), "{said}");
}
