//! Prediction of a later record with the model of the first.

use super::{BENCH, RECORD, folder, report};

const SCENARIO: &str = "hidden_fault.scenario.toml";

#[test]
fn a_later_record_tells_what_the_extended_model_wins() {
    let folder = folder();
    folder.put_example(SCENARIO);
    folder.succeed(["simulate", SCENARIO, "--seed", "40", "--out", "later.csv"]);
    let command = ["diagnose", RECORD, "--bench", BENCH, "--json", "o.json"];
    let later = ["--validate", "later.csv", "--validate-bench", BENCH];
    let said = folder.succeed([&command[..], &later].concat());
    let report = report(&folder, "o.json");
    assert_eq!(report.manifest.inputs.len(), 4);
    let finding = &report.findings[0];
    assert_eq!(finding.accepted, Some(true));
    let gain = report.gain.unwrap();
    // One cause: its gain is that of the model.
    let all = gain.cross_validated_log_score_nats;
    assert!((finding.gain_nats.unwrap() - all).abs() < 1e-3 * all);
    assert_eq!(gain.effects, ["gyro_y.g_z"]);
    let validation = gain.validation.unwrap();
    // Fifteen sigmas, at an attitude like the first.
    assert!(validation.log_score_nats > 8.0, "{validation:?}");
    assert_eq!(validation.compensation.unwrap().after_h, 24.0);
    for words in [
        " attitude error in the later record after 24.0 h ",
        " predictive log score of the later record, extended less nominal ",
    ] {
        assert!(said.contains(words), "{words}\n{said}");
    }
}

#[test]
fn a_sound_platform_has_one_model_to_validate() {
    let folder = folder();
    for name in ["three_days.csv", "three_days.bench.toml"] {
        folder.put_example(name);
    }
    let said = folder.succeed(format!(
        "diagnose three_days.csv --bench three_days.bench.toml --validate {RECORD} --validate-bench {BENCH}"
    ));
    let expected = "The later record was predicted with the nominal model only: no effect is in";
    assert!(said.replace('\n', " ").contains(expected), "{said}");
}
