//! `gyrocal diagnose` as a user runs it.

mod bad_input;
mod sealed;
mod setup;
mod several;
mod validation;

use std::fs;
use std::sync::OnceLock;

use gyrocal_answer::{
    AllanCourse, AlternativeKind, Answer, FindingKind, ResidualVerdict, SCHEMA_VERSION, Verdict,
};

use crate::folder::{BENCH, Folder, RECORD, assert_says, hidden_fault as folder, repository};

/// Width of the PNGs that the command writes, px.
const PNG_WIDTH_PX: u32 = 1200;

/// A written result.
fn report(folder: &Folder, name: &str) -> Answer {
    folder.json(name)
}

/// One run with all outputs, used by several tests: stdout and files.
fn whole() -> &'static (String, Folder) {
    static WHOLE: OnceLock<(String, Folder)> = OnceLock::new();
    WHOLE.get_or_init(|| {
        let folder = folder();
        let said = folder.succeed(format!(
            "diagnose {RECORD} --bench {BENCH} --json o.json --figures figures --filter euler"
        ));
        (said, folder)
    })
}

/// The result of that run for programs.
pub(crate) fn hidden_fault() -> String {
    whole().1.text("o.json")
}

#[test]
fn the_hidden_fault_is_named_with_its_size() {
    let (said, folder) = whole();
    let report = report(folder, "o.json");
    assert_eq!(report.schema_version, SCHEMA_VERSION);
    assert_eq!(report.verdict, Verdict::EffectsFound);
    assert_eq!(report.false_alarm_probability, 0.01);
    let finding = &report.findings[0];
    assert_eq!(finding.effect, "gyro_y.g_z");
    assert_eq!(finding.kind, FindingKind::Cause);
    assert!(finding.z > 12.0 && finding.p_value.unwrap() < 1e-20);
    let size = &finding.parameters[0];
    let sigma = size.sigma.unwrap();
    // The truth of the scenario; the record is fixed, and an error of four sigmas is one in
    // sixteen thousand.
    assert!((size.estimate - 0.0012).abs() < 4.0 * sigma, "{size:?}");
    assert!(said.starts_with("FAULT  2 effects: gyro_y.g_z, "), "{said}");
    for words in [
        "\n - gyro_y.g_z: mass unbalance of gyro y",
        "all residual tests together                          white ",
    ] {
        assert!(said.contains(words), "{words}\n{said}");
    }
    assert_eq!(report.remainder.verdict, ResidualVerdict::White);
}

#[test]
fn residuals_of_the_nominal_model_are_told_and_written() {
    let (said, folder) = whole();
    let shown = report(folder, "o.json").residuals.unwrap();
    // The residual of the nominal model with the cross-axis term exceeds the noise.
    let nis = shown.nis.unwrap();
    assert!(nis.mean > 3.0 && nis.p_value < 0.01, "{nis:?}");
    // Three values a row are expected, in the 99.9 % band.
    assert!(nis.band[0] < 3.0 && 3.0 < nis.band[1], "{nis:?}");
    // No value is missing.
    assert_eq!([nis.rows, nis.values], [4321, 3 * 4321], "{nis:?}");
    assert_eq!(shown.autocorrelation.unwrap().correlation.len(), 20);
    assert!(shown.lines.unwrap()[0].p_value < 1e-6);
    assert!(shown.free_run_rms_g.iter().all(|rms_g| *rms_g > 2e-5));
    let abscissae: Vec<&str> = shown.against.iter().map(|a| a.abscissa.as_str()).collect();
    assert_eq!(abscissae, ["force_x_g", "force_y_g", "force_z_g", "time_s"]);
    for against in &shown.against {
        assert!(against.at.iter().all(|at| at.is_sorted()), "{against:?}");
        assert!(against.mean.iter().all(|mean| mean.len() == 12));
    }
    assert_says(
        said,
        "mean normalised innovation squared                   3.1",
    );
}

#[test]
fn magnitude_test_and_allan_test_are_reported() {
    let (said, folder) = whole();
    let report = report(folder, "o.json");
    let norm = report.norm.unwrap();
    assert!(!norm.accelerometers && norm.description.is_empty());
    // 2 sigma of a sample over twice the root of 4321 rows.
    assert!((norm.mean_sigma_g / 1.52e-7 - 1.0).abs() < 0.01);
    assert_says(said, "  gravity: mean offset ");
    let allan = report.allan.unwrap();
    assert_eq!(allan.course, AllanCourse::White);
    assert_eq!(allan.rows, 4321);
    for point in &allan.points[..6] {
        for (deviation, interval) in point.deviation.iter().zip(point.interval) {
            // Six octaves from a row on, with a hundred degrees of freedom and more.
            assert!((deviation / point.white - 1.0).abs() < 0.4, "{point:?}");
            assert!(interval[0] < *deviation && *deviation < interval[1]);
        }
    }
    assert!(said.contains("  white noise of the estimated level up to "));
}

#[test]
fn an_accelerometer_error_fails_the_magnitude_test() {
    let folder = bad_input::shortened(720);
    let biased: String = folder
        .text(RECORD)
        .lines()
        .enumerate()
        .map(|(line, text)| {
            let mut cells: Vec<String> = text.split(',').map(str::to_owned).collect();
            if line > 0 {
                cells[1] = (cells[1].parse::<f64>().unwrap() + 5e-5).to_string();
            }
            cells.join(",") + "\n"
        })
        .collect();
    folder.put(RECORD, biased);
    let said = folder.succeed(["diagnose", RECORD, "--bench", BENCH, "--json", "o.json"]);
    assert_says(&said, "  not gravity: ");
    // The nominal model follows it in half a day, as in a wave of more.
    assert_says(&said, "period longer than the record, ");
    assert!(report(&folder, "o.json").norm.unwrap().accelerometers);
}

#[test]
fn the_gain_is_reported() {
    let (said, folder) = whole();
    let report = report(folder, "o.json");
    let gain = report.gain.unwrap();
    let sum: f64 = gain.block_log_score_nats.iter().flatten().sum();
    // Sums of the same six numbers.
    assert!((gain.cross_validated_log_score_nats - sum).abs() < 1e-9);
    assert!(sum > 8.0);
    let rms = gain.free_run_rms_g.unwrap();
    assert!(rms.noise == 1e-5 && rms.after < 0.7 * rms.before, "{rms:?}");
    assert_eq!(gain.coefficient_shift.len(), 9);
    assert_says(said, "6-fold blocked cross-validation: gyro_y.g_z improves");
}

#[test]
fn near_twins_are_listed_with_what_would_separate_them() {
    let (said, folder) = whole();
    let finding = &report(folder, "o.json").findings[0];
    assert_eq!(finding.effect, "gyro_y.g_z");
    let mut twins = finding.of_kind(AlternativeKind::NotSearched);
    assert!(twins.any(|other| other.effect == "gyro_y.magnetic"));
    let mut separations = finding.separations.iter();
    let from_twins = separations.find(|one| one.from == AlternativeKind::NotSearched);
    assert!(
        from_twins
            .unwrap()
            .words
            .contains("another initial attitude")
    );
    assert_says(
        said,
        "\ngyro_y.g_z, gyro_yz.axis_misalignment, gyro_y.magnetic:\n - Why: near twins",
    );
}

#[test]
fn the_filter_of_the_paper_is_named_for_its_rule() {
    let (_, folder) = whole();
    let report = report(folder, "o.json");
    let last = report.findings.last().unwrap();
    assert_eq!(last.effect, "filter.discretisation");
    assert_eq!((last.kind, last.coverage), (FindingKind::Filter, None));
    let filter = report.filter.unwrap();
    assert_eq!(filter.name, "euler");
    // Exact data: the rule's error is as large as the noise, its NIS some hundreds.
    assert!(filter.nis_mean.unwrap() > 100.0);
    assert!(filter.reference_nis_mean < 4.0);
    let mut not_searched = report.not_searched.iter();
    assert!(not_searched.all(|entry| entry.effect != last.effect));
}

#[test]
fn pictures_are_written() {
    let (_, folder) = whole();
    let written = |name: &str| fs::read(folder.path("figures").join(name)).unwrap();
    for name in [
        "simulation",
        "residual",
        "residual-2",
        "ranking",
        "coefficients",
        "coefficients-2",
        "residuals",
        "residuals-2",
        "magnitude",
        "gain",
    ] {
        assert!(
            written(&format!("{name}.svg")).starts_with(b"<svg"),
            "{name}"
        );
        #[cfg(feature = "png")]
        assert!(
            written(&format!("{name}.png")).starts_with(b"\x89PNG"),
            "{name}"
        );
    }
    let residual = String::from_utf8(written("residual.svg")).unwrap();
    assert!(residual.contains("for the nominal model") && residual.contains("with gyro_y.g_z"));
    // Each tells what it is of.
    let source = format!("Open-loop residual: {RECORD}. ");
    assert!(residual.contains(&source), "no `{source}`");
    let text = |name: &str| String::from_utf8(written(name)).unwrap();
    let words = [
        ("residual-2.svg", "specific force z [g]"),
        ("residuals.svg", "autocorrelations outside the 95 % band"),
        ("residuals-2.svg", "detection threshold"),
        (
            "magnitude.svg",
            "Squared specific force less squared gravity",
        ),
        ("coefficients-2.svg", "Convergence of each coefficient"),
    ];
    for (name, words) in words {
        assert!(text(name).contains(words), "{name}: no `{words}`");
    }
    // The picture of the README is the one that its command draws, which tests no filter.
    folder.succeed(["diagnose", RECORD, "--bench", BENCH, "--figures", "plain"]);
    let residual = folder.text("plain/residual.svg");
    let shown = fs::read(repository("docs/pictures/hidden-fault.png")).unwrap();
    assert!(shown.len() < 200_000);
    assert!(
        shown == gyrocal_report::to_png(&residual, PNG_WIDTH_PX).unwrap(),
        "docs/pictures/hidden-fault.png differs: copy the residual.png that a build with --features \
         png draws there"
    );
}

#[test]
fn a_clean_record_is_called_clean() {
    let folder = Folder::new();
    for name in ["three_days.csv", "three_days.bench.toml"] {
        folder.put_example(name);
    }
    let arguments =
        "diagnose three_days.csv --bench three_days.bench.toml --json o.json --exit-code";
    let said = folder.succeed(arguments);
    assert!(said.starts_with("NO FAULT FOUND"), "{said}");
    let value: serde_json::Value = folder.json("o.json");
    assert_eq!(value["verdict"], "clean");
    assert_eq!(value["findings"], serde_json::json!([]));
    assert_eq!(value["gain"], serde_json::Value::Null);
    assert_eq!(value["remainder"]["verdict"], "white");
    assert_eq!(value["set_ups"], serde_json::Value::Null);
    let not_searched = value["not_searched"].as_array().unwrap();
    let filters = not_searched
        .iter()
        .find(|entry| entry["effect"] == "filter.discretisation");
    assert_eq!(
        filters.unwrap()["why"],
        "an error of a filter: --filter euler"
    );
    assert_eq!(
        value["manifest"]["inputs"][1]["path"],
        "three_days.bench.toml"
    );
}

#[test]
fn the_record_that_ships_is_what_its_scenario_gives() {
    let folder = Folder::new();
    let scenario = repository("examples/data/hidden_fault.scenario.toml");
    folder.succeed([
        "simulate",
        scenario.to_str().unwrap(),
        "--out",
        RECORD,
        "--bench-out",
        BENCH,
    ]);
    folder.assert_examples(&[RECORD, BENCH]);
}
