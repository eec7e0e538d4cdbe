//! `gyrocal calibrate` as a user runs it.

mod findings;
mod verdict;

use gyrocal_record::{Bench, CALIBRATION_SCHEMA_VERSION, CalibrationReport, Record};
use gyrocal_truth::Scenario;
use serde_json::Value;

use crate::folder::{Folder, assert_says, example, repository};

const PLAIN: &str = "calibrate r.csv --bench b.toml";
const JSON: &str = "calibrate r.csv --bench b.toml --json o.json";

/// A folder with the record that ships and its bench description.
fn folder() -> Folder {
    let folder = Folder::new();
    folder.put("r.csv", example("three_days.csv"));
    folder.put("b.toml", example("three_days.bench.toml"));
    folder
}

/// The coefficients that the record that ships was simulated with.
fn truth() -> Scenario {
    Scenario::read(&repository("examples/data/three_days.scenario.toml")).unwrap()
}

#[test]
fn the_record_that_ships_gives_the_coefficients_of_its_scenario() {
    let folder = folder();
    let said = folder.succeed(JSON);
    let report: CalibrationReport = folder.json("o.json");
    let truth = truth().coefficients.named();
    assert_eq!(report.coefficients.len(), truth.len());
    for (found, (name, value, unit)) in report.coefficients.iter().zip(truth) {
        assert_eq!((&found.name[..], &found.unit[..]), (name, unit));
        let error = (found.estimate - value) / found.sigma;
        // One of nine normal errors exceeds 4 sigmas once in 1750 records; this one is fixed.
        assert!(error.abs() < 4.0, "{name}: {error} sigmas");
        // Three days leave a hundredth of the prior's 1 deg/h (per g, per g^2) at most; zero
        // would make the line above a division by it.
        assert!(
            found.sigma > 0.0 && found.sigma < 0.01,
            "{name}: {}",
            found.sigma
        );
        assert!(found.determined, "{name}");
    }
    assert!(said.starts_with("CALIBRATED  "), "{said}");
    assert_says(&said, "\nr.csv: 4321 rows over 3.00 days\n");
    assert_says(&said, "Data, model and declared noise agree. Mean NIS");
    assert!(
        said.ends_with("o.json: the result for programs\n"),
        "{said}"
    );
}

#[test]
fn the_table_shows_what_the_json_says_rounded_by_its_sigma() {
    let folder = folder();
    let said = folder.succeed(JSON);
    let report: CalibrationReport = folder.json("o.json");
    for coefficient in report.coefficients {
        // The table of the first screen comes before that of the details.
        let rows = said.lines();
        let rows: Vec<&str> = rows
            .filter(|line| line.starts_with(&format!(" {} ", coefficient.name)))
            .collect();
        let [_, row, meaning, ..] = rows[..] else {
            panic!("no {} in {said}", coefficient.name);
        };
        assert_says(meaning, " of gyro ");
        let cells: Vec<&str> = row.split_whitespace().collect();
        let [estimate, sigma] = [cells[1], cells[3]].map(|cell| cell.parse::<f64>().unwrap());
        // Half a unit of the second digit of sigma is at most a twentieth of it.
        let tolerance = 0.051 * coefficient.sigma;
        assert!((estimate - coefficient.estimate).abs() < tolerance, "{row}");
        assert!((sigma - coefficient.sigma).abs() < tolerance, "{row}");
        assert_eq!(cells[3].trim_start_matches(['0', '.']).len(), 2, "{row}");
        assert_eq!(cells[2], "±", "{row}");
        assert_eq!(cells[4..6], [&coefficient.unit[..], "yes"], "{row}");
    }
}

#[test]
#[expect(clippy::cognitive_complexity, reason = "one field after the other")]
fn the_json_has_every_field_of_its_contract() {
    let folder = folder();
    folder.succeed_as_is(JSON);
    let json: Value = folder.json("o.json");
    assert_eq!(json["schema_version"], CALIBRATION_SCHEMA_VERSION);
    assert_eq!(json["method"], "batch");
    // One pass of the filter is a good start; each further step squares what is left.
    assert!(
        (2..8).contains(&json["iterations"].as_u64().unwrap()),
        "{}",
        json["iterations"]
    );
    assert_eq!(json["rows"], 4321);
    assert_eq!(json["verdict"], "consistent");
    assert!(json["verdict_text"].as_str().unwrap().contains("Mean NIS"));

    let names = [
        "bias", "g_x", "g_xx", "bias", "g_y", "g_yy", "bias", "g_z", "g_zz",
    ];
    let units = ["deg/h", "deg/h/g", "deg/h/g^2"];
    let coefficients = json["coefficients"].as_array().unwrap();
    let covariance = json["covariance"].as_array().unwrap();
    assert_eq!((coefficients.len(), covariance.len()), (9, 9));
    for (i, coefficient) in coefficients.iter().enumerate() {
        let gyro = ["gyro_x", "gyro_y", "gyro_z"][i / 3];
        assert_eq!(coefficient["name"], format!("{gyro}.{}", names[i]));
        assert_eq!(coefficient["unit"], units[i % 3]);
        assert_eq!(coefficient["determined"], true);
        let sigma = coefficient["sigma"].as_f64().unwrap();
        let row = covariance[i].as_array().unwrap();
        assert_eq!(row.len(), 9);
        let variance = row[i].as_f64().unwrap();
        // A square root and a square, each rounded once.
        assert!(
            (sigma * sigma / variance - 1.0).abs() < 1e-15,
            "{coefficient}"
        );
        for (j, other) in covariance.iter().enumerate() {
            let variance_there = other[j].as_f64().unwrap();
            let [above, below] = [&row[j], &other[i]].map(|entry| entry.as_f64().unwrap());
            // Two sums of nine products each, in different order.
            let tolerance = 1e-14 * (variance * variance_there).sqrt();
            assert!((above - below).abs() < tolerance, "{above} {below}");
        }
    }

    let mean = json["nis_mean"].as_f64().unwrap();
    let band = json["nis_band"].as_array().unwrap();
    let [low, high] = [&band[0], &band[1]].map(|end| end.as_f64().unwrap());
    // Chi-square of 12 963 values: 3 ± 3.29 · 3 · sqrt(2 / 12 963), its skewness enters as 1e-3.
    assert!(
        (low - 2.877).abs() < 5e-3 && (high - 3.123).abs() < 5e-3,
        "{low} {high}"
    );
    assert!((low..high).contains(&mean), "{mean}");

    let manifest = &json["manifest"];
    assert_eq!(manifest["program"], "gyrocal");
    assert_eq!(manifest["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(manifest["seed"], 0);
    assert_eq!(
        manifest["command"],
        "gyrocal calibrate r.csv --bench b.toml --json o.json"
    );
    let hash = |value: &Value| {
        let digits = value.as_str().unwrap().to_owned();
        assert_eq!(digits.len(), 64, "{digits}");
        assert!(
            digits.bytes().all(|digit| digit.is_ascii_hexdigit()),
            "{digits}"
        );
        digits
    };
    hash(&manifest["model_hash"]);
    let inputs = manifest["inputs"].as_array().unwrap();
    assert_eq!(inputs.len(), 2);
    assert_eq!(
        (&inputs[0]["path"], &inputs[1]["path"]),
        (&"r.csv".into(), &"b.toml".into())
    );
    assert_ne!(hash(&inputs[0]["sha256"]), hash(&inputs[1]["sha256"]));
}

#[test]
fn final_angles_are_those_of_the_simulated_platform() {
    let folder = folder();
    let scenario = repository("examples/data/three_days.scenario.toml");
    let scenario = scenario.to_str().unwrap();
    folder.succeed([
        "simulate",
        scenario,
        "--out",
        "again.csv",
        "--json",
        "t.json",
    ]);
    let said = folder.succeed(JSON);
    let [found, expected] = ["o.json", "t.json"].map(|name| -> [f64; 3] {
        let json: Value = folder.json(name);
        serde_json::from_value(json["final_angles_deg"].clone()).unwrap()
    });
    for (found, expected) in found.iter().zip(expected) {
        // Attitude about the vertical is known to 1e-5 rad after three days: 6e-4 deg, five
        // times that for luck and for Euler angles away from zero.
        assert!((found - expected).abs() < 3e-3, "{found} {expected}");
        assert!(said.contains(&format!("{found:.4}")), "{said}");
    }
}

/// The output without line breaks.
pub(crate) fn unwrapped(said: &str) -> String {
    said.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[test]
fn the_effect_of_latitude_is_that_of_the_symmetry() {
    let said = unwrapped(&folder().succeed(PLAIN));
    let (_, rest) = said.split_once("mean of the three D_I by ").unwrap();
    let shift: f64 = rest.split(' ').next().unwrap().parse().unwrap();
    // Turning the meridian by 1 arc second is lowering all D_I by rate / cos(latitude) times it,
    // but for a change of the rate; 0.5 to 1.0 of that was seen at middle latitudes.
    let rate_deg_per_h = 15.041_07;
    let full = rate_deg_per_h * (1.0_f64 / 3600.0).to_radians() / 48.2_f64.to_radians().cos();
    assert!((0.5..1.05).contains(&(shift / full)), "{shift} of {full}");
    assert_says(&said, "gives no latitude_sigma_deg");
}

fn report(folder: &Folder) -> CalibrationReport {
    folder.json("o.json")
}

#[test]
fn the_filter_of_the_paper_does_not_fit_what_it_did_not_simulate() {
    let folder = folder();
    let said = folder.succeed(format!("{JSON} --paper"));
    assert_says(
        &said,
        "The innovations are larger than the declared noise: the sigmas are too small.",
    );
    let json: Value = folder.json("o.json");
    assert_eq!(json["verdict"], "too-large");
    assert!(json["nis_mean"].as_f64().unwrap() > 30.0);
}

#[test]
fn missing_values_and_other_priors_are_honoured() {
    let folder = folder();
    let mut record = Record::parse(&example("three_days.csv"), "r.csv").unwrap();
    for row in (0..record.len()).step_by(3) {
        record.accel_g[row] = [f64::NAN; 3];
    }
    record.write(&folder.path("r.csv")).unwrap();
    let bench = Bench::parse(&example("three_days.bench.toml"), "b.toml").unwrap();
    let mut narrow = bench.clone();
    narrow.prior.gg_sigma_deg_per_h_per_g2 = [1e-6; 3];
    narrow.write(&folder.path("b.toml")).unwrap();
    folder.succeed(JSON);
    let report: CalibrationReport = folder.json("o.json");
    // Every third row of 4321, the first included, has no value.
    assert_eq!(report.rows, 2880);
    for (i, coefficient) in report.coefficients.iter().enumerate() {
        // What the prior knows to 1e-6 the record does not improve.
        assert_eq!(coefficient.determined, i % 3 != 2, "{}", coefficient.name);
    }
}

#[test]
fn verbose_tells_more() {
    let folder = folder();
    let [plain, detailed, reporting] = ["--color=auto", "-v", "-vv"].map(|more| {
        let output = folder.run(format!("{PLAIN} {more}"));
        let errors = String::from_utf8(output.stderr).unwrap();
        (String::from_utf8(output.stdout).unwrap(), errors)
    });
    assert_eq!((&*plain.1, &*detailed.1), ("", ""));
    assert!(reporting.1.contains("calibrated"), "{}", reporting.1);
    assert_eq!(detailed.0, reporting.0);
    let (screen, _) = plain
        .0
        .split_once("all tables and tests: --verbose")
        .unwrap();
    assert!(detailed.0.starts_with(screen), "{}", detailed.0);
    assert!(
        detailed.0.contains("Sensitivity to errors of the site"),
        "{}",
        detailed.0
    );
}

#[test]
fn a_wrong_command_line_is_a_usage_error() {
    let folder = folder();
    let cases: [(&str, &str); 14] = [
        ("calibrate", "required"),
        ("calibrate r.csv", "required"),
        (
            "calibrate r.csv --bench b.toml --json ./r.csv",
            "would overwrite",
        ),
        (
            "calibrate r.csv --bench b.toml --json b.toml",
            "would overwrite",
        ),
        (
            "calibrate r.csv --bench b.toml --bench b.toml",
            "2 bench files for 1 record:",
        ),
        (
            "calibrate a.csv b.csv c.csv --bench b.toml --bench b.toml",
            "2 bench files for 3 records",
        ),
        (
            "calibrate r.csv ./r.csv --bench b.toml",
            "r.csv and ./r.csv are the same file",
        ),
        (
            "calibrate a.csv b.csv --bench b.toml --streaming",
            "--streaming reads one record, 2",
        ),
        (
            "calibrate r.csv --bench b.toml --paper --streaming",
            "cannot be used with",
        ),
        (
            "calibrate r.csv --bench b.toml --factorised",
            "--streaming or --paper",
        ),
        (
            "calibrate r.csv --bench b.toml --paper --robust",
            "--robust goes with the batch",
        ),
        (
            "calibrate r.csv --bench b.toml --streaming --no-noise",
            "--no-noise goes with the batch",
        ),
        (
            "calibrate --robust r.csv --bench b.toml",
            "put records before --robust",
        ),
        (
            "calibrate r.csv --bench b.toml --average 0",
            "a number greater than 0",
        ),
    ];
    for (line, message) in cases {
        let arguments: Vec<&str> = line.split(' ').collect();
        let output = folder.run(&arguments);
        assert_eq!(output.status.code(), Some(2), "{line}");
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(said.contains(message), "{line}: {said}");
        assert_eq!(folder.names(), ["b.toml", "r.csv"]);
    }
    assert_eq!(folder.text("r.csv"), example("three_days.csv"));
}
