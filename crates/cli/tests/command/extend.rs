//! `gyrocal extend`: from findings, or a list of effects, to a model file.

use gyrocal_answer::SCHEMA_VERSION;
use gyrocal_record::{KnownEffect, ModelFile, Standing};
use gyrocal_truth::units::strapdown::UnitRun;
use serde_json::{Value, json};

use crate::folder::{Folder, assert_says};

const MODEL: [&str; 4] = ["extend", "d.json", "--out", "extended.model.toml"];

fn finding(effect: &str, parameters: &[(&str, f64)]) -> Value {
    let parameters = parameters.iter().map(|(name, estimate)| {
        json!({ "name": name, "estimate": estimate, "sigma": 1e-4, "unit": "?" })
    });
    json!({
        "effect": effect,
        "parameters": parameters.collect::<Vec<_>>(),
        "name": "?", "kind": "cause", "z": 18.9, "p_value": 1e-12, "coverage": 0.95,
        "alternatives": [], "separations": []
    })
}

/// A result of `gyrocal diagnose --json`.
fn diagnosis(verdict: &str, findings: &[Value]) -> String {
    let result = json!({
        "schema_version": SCHEMA_VERSION,
        "manifest": {
            "program": "gyrocal", "version": "0.1.0", "model_hash": "00",
            "inputs": [], "seed": 0, "command": "gyrocal diagnose r.csv --bench b.toml"
        },
        "record": {
            "rows": 100, "duration_s": 6000.0,
            "gaps": { "count": 0, "missing_s": 0.0, "longest_s": 60.0, "missing_values": 0.0 }
        },
        "subject": "platform",
        "verdict": verdict,
        "false_alarm_probability": 0.01,
        "false_alarm_shares": {
            "noise_audit": 1e-3, "gyro_noise": 1e-4, "search": 7e-3, "random_walk": 0.0,
            "residual_test": 1e-3,
            "magnitude_test": 1e-3, "allan_test": 1e-3
        },
        "setup": [],
        "findings": findings,
        "remainder": { "verdict": "white", "p_value": 0.4, "description": "",
            "outputs": [], "unmodelled": []
        },
        "open_loop": [],
        "still_inputs": [],
        "undetermined": [],
        "noise": [],
        "search_complete": true,
        "next_runs": [],
        "ranking": [],
        "power": [],
        "not_searched": []
    });
    serde_json::to_string_pretty(&result).unwrap()
}

/// The message for this diagnosis.
fn refused(text: &str) -> String {
    let folder = Folder::new();
    folder.put("d.json", text);
    folder.fail(MODEL)
}

#[test]
fn terms_that_were_found_are_in_the_model_and_the_rest_is_explained() {
    let folder = Folder::new();
    let findings = [
        finding("accel_x.noise", &[("ratio", 1.4)]),
        finding("gyro_y.g_z", &[("size", 0.05)]),
        finding("gyro_x.warmup", &[("size", 0.1), ("time_constant_h", 3.5)]),
        finding("platform.knock", &[("x", 0.1), ("onset_s", 7200.0)]),
    ];
    folder.put("d.json", diagnosis("effects-found", &findings));
    let arguments: Vec<&str> = MODEL.into_iter().chain(["--json", "o.json"]).collect();
    let said = folder.succeed(&arguments);
    assert_eq!(
        folder.text("extended.model.toml"),
        "# Effects of an extended model, after the nine drift coefficients; docs/extending.md.\n\
         schema_version = 1\n\
         effects = [\"gyro_y.g_z\", \"gyro_x.warmup\"]\n\
         \n\
         # constants of the model; shapes that are not listed are inputs\n\
         [shapes]\n\
         \"gyro_x.warmup.time_constant_h\" = 3.5\n\
         \n\
         # initial values of filters\n\
         [estimates]\n\
         \"gyro_y.g_z\" = { value = 0.05, sigma = 0.0001 }\n\
         \"gyro_x.warmup\" = { value = 0.1, sigma = 0.0001 }\n"
    );
    assert_says(&said, "gyro_y.g_z starts at 5.000e-2 ± 1.0e-4");
    assert_says(&said, "left out     accel_x.noise is noise and not a term");
    assert_says(&said, "left out     platform.knock concerns the attitude");
    let report: Value = folder.json("o.json");
    assert_eq!(report["effects"], json!(["gyro_y.g_z", "gyro_x.warmup"]));
    assert_eq!(report["left_out"][1]["effect"], "platform.knock");
    assert_eq!(report["manifest"]["inputs"][0]["path"], "d.json");
}

#[test]
fn a_member_of_a_set_takes_the_place_of_the_effect_that_is_named() {
    let folder = Folder::new();
    let mut found = finding("gyro_y.g_z", &[("size", 0.05)]);
    found["alternatives"] = json!([{
        "effect": "gyro_y.ramp", "kind": "not-excluded", "log_likelihood_deficit": 0.7, "parameters": []
    }]);
    let findings = [found, finding("gyro_x.g_y", &[("size", 0.1)])];
    folder.put("d.json", diagnosis("effects-found", &findings));
    let with = |member| {
        MODEL
            .into_iter()
            .chain(["--member", member])
            .collect::<Vec<_>>()
    };
    folder.succeed(with("gyro_y.ramp"));
    let text = folder.text("extended.model.toml");
    assert_says(&text, "effects = [\"gyro_y.ramp\", \"gyro_x.g_y\"]\n");
    // The diagnosis estimates the named effect only.
    assert!(!text.contains("\"gyro_y.ramp\" = {"), "{text}");
    assert_says(&text, "\"gyro_x.g_y\" = { value = 0.1, sigma = 0.0001 }");
    let said = folder.fail(with("gyro_y.step"));
    assert_says(&said, "found no alternative `gyro_y.step`");
    assert_says(&said, "expected `gyro_y.ramp`");
}

#[test]
fn a_list_of_effects_is_a_model_without_estimates() {
    let folder = Folder::new();
    let said = folder.succeed("extend --effects gyro_z.step,gyro_x.g_yy --out m.model.toml");
    assert_says(
        &folder.text("m.model.toml"),
        "effects = [\"gyro_z.step\", \"gyro_x.g_yy\"]\n",
    );
    assert_says(&said, "gyro_z.step.onset_s is an input of the model");
    assert_says(&said, "exact equivalents of gyro_x.g_yy: gyro_x.g_zz");
}

#[test]
fn what_gives_no_model_says_why() {
    assert_says(&refused(&diagnosis("clean", &[])), "the verdict `clean`");
    assert_says(
        &refused(&diagnosis("unexplained", &[])),
        "docs/adding-a-term.md",
    );
    let noise = finding("accel_x.noise", &[("ratio", 1.4)]);
    let said = refused(&diagnosis("effects-found", &[noise]));
    assert_says(
        &said,
        "d.json: found no finding that is a term of the model",
    );
    assert_says(&said, "`accel_x.noise` is noise and not a term");
    let unknown = finding("gyro_y.gz", &[("size", 0.05)]);
    let said = refused(&diagnosis("effects-found", &[unknown]));
    assert_says(&said, "the nearest are `gyro_y.g_z`");
    let other = finding("gyro_y.g_z", &[("length", 0.05)]);
    let said = refused(&diagnosis("effects-found", &[other]));
    assert_says(
        &said,
        "the parameter `length` of `gyro_y.g_z`, expected size",
    );
}

#[test]
fn a_file_that_is_no_diagnosis_is_shown_where_it_is_wrong() {
    let good = diagnosis("clean", &[]);
    let said = refused(&good.replace("\"findings\": []", "\"findings\": 3"));
    // Keys are written in the order of the alphabet: after `false_alarm_shares` with its six.
    assert_says(&said, "d.json:12:");
    assert_says(&said, "expected the result of `gyrocal diagnose --json`");
    let said = refused(&good.replace("\"schema_version\": 3", "\"schema_version\": 2"));
    assert_says(&said, "found schema_version 2, expected 3");
    assert_says(
        &said,
        "write it again with `gyrocal diagnose` of this version",
    );
    // A result of another version may have other fields; the version is reported.
    let said = refused("{ \"schema_version\": 4 }");
    assert_says(&said, "found schema_version 4, expected 3");
    let said = refused(&good.replace("\"clean\"", "\"fine\""));
    assert_says(&said, "unknown variant `fine`");
    assert_says(
        &refused("{"),
        "d.json:1:1: found JSON that is not the result",
    );
}

#[test]
fn lists_that_no_model_can_have_are_refused() {
    let cases = [
        ("gyro_y.gz", "the nearest are `gyro_y.g_z`"),
        (
            "gyro_x.bias",
            "`gyro_x.bias` is one of the nine coefficients",
        ),
        ("gyro_y.g_z,gyro_y.g_z", "found `gyro_y.g_z` twice"),
        (
            "gyro_x.g_yy,gyro_x.g_zz",
            "`gyro_x.g_zz` and `gyro_x.g_yy` are exact equivalents",
        ),
        ("accel.outliers", "`[noise]` of the bench file"),
    ];
    for (effects, message) in cases {
        let folder = Folder::new();
        let said = folder.fail(["extend", "--effects", effects, "--out", "m.toml"]);
        assert_says(&said, message);
    }
}

#[test]
fn a_file_name_that_is_no_module_name_is_refused() {
    for (file, found) in [
        ("fn.model.toml", "`fn`"),
        ("a b;c.model.toml", "`a b;c`"),
        ("Extended.model.toml", "`Extended`"),
    ] {
        let folder = Folder::new();
        let said = folder.fail(["extend", "--effects", "gyro_y.g_z", "--out", file]);
        assert_says(&said, &format!("{file}: not written"));
        assert_says(&said, &format!("found the module name {found}"));
        assert_says(&said, "such as `extended.model.toml`");
    }
}

#[test]
fn a_diagnosis_or_a_list_is_asked_for() {
    let folder = Folder::new();
    folder.put("d.json", "{}");
    for arguments in [
        "extend --out m.toml",
        "extend d.json --effects gyro_y.g_z --out m.toml",
        "extend d.json --out ./d.json",
    ] {
        assert_eq!(
            folder.run(arguments).status.code(),
            Some(2),
            "{arguments:?}"
        );
    }
    assert_eq!(folder.text("d.json"), "{}");
}

#[test]
fn a_fault_of_a_strapdown_unit_goes_from_its_record_to_the_model_file() {
    // Some twenty standard deviations.
    const RAMP: f64 = 0.001;
    let folder = Folder::new();
    let gyro_error = |force: [f64; 3], days: f64| {
        let along = force.map(|force| 0.1 * force - 0.05 * force * force);
        [
            0.2 + along[0],
            -0.1 + along[1] + RAMP * days,
            0.05 + along[2],
        ]
    };
    let unit = UnitRun {
        attitude_rad: [1.3, -0.7, 2.1],
        turn_rad_per_s: [0.0; 3],
        interval_s: 300.0,
        rows: 576,
        seed: 1,
        gyro_error: &gyro_error,
        accel_error: &|_, _| [0.0; 3],
    }
    .simulate();
    unit.write(&folder.path("")).unwrap();
    let diagnosed = "diagnose record.csv --bench bench.toml --gyro-axes axes.csv --json d.json";
    folder.succeed(diagnosed);
    let said = folder.succeed("extend d.json --out unit.model.toml --json o.json");
    assert_says(&said, "gyros        fixed to a body");
    let text = folder.text("unit.model.toml");
    assert_says(
        &text,
        "\ngyros = \"strapdown\"\neffects = [\"gyro_y.ramp\"]\n",
    );
    let model = ModelFile::parse(&text, "unit.model.toml", &known()).unwrap();
    let [estimate] = &model.estimates[..] else {
        panic!("{text}");
    };
    assert_eq!(estimate.parameter, "gyro_y.ramp");
    assert!(
        (estimate.value - RAMP).abs() < 4.0 * estimate.sigma,
        "{text}"
    );
    let report: Value = folder.json("o.json");
    assert_eq!(report["strapdown"], json!(true));
    assert_eq!(report["effects"], json!(["gyro_y.ramp"]));
}

/// The one effect that the test above expects.
fn known() -> Vec<KnownEffect<'static>> {
    vec![KnownEffect {
        id: "gyro_y.ramp",
        standing: Standing::Term,
        states: vec!["gyro_y.ramp"],
        shapes: Vec::new(),
    }]
}

#[test]
fn a_list_of_effects_says_what_the_gyros_are_fixed_to() {
    let folder = Folder::new();
    let listed = "extend --effects gyro_y.ramp --out m.model.toml";
    folder.succeed(format!("{listed} --gyros strapdown"));
    assert_says(&folder.text("m.model.toml"), "gyros = \"strapdown\"\n");
    folder.succeed(format!("{listed} --gyros platform"));
    assert!(!folder.text("m.model.toml").contains("gyros"));
    // A diagnosis says it itself.
    let output = folder.run([&MODEL[..], &["--gyros", "strapdown"]].concat());
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn advice_on_a_strapdown_unit_is_for_such_a_unit() {
    let folder = Folder::new();
    let findings = [
        finding("gyro_y.ramp", &[("size", 0.05)]),
        finding("platform.knock", &[("x", 0.1), ("onset_s", 7200.0)]),
    ];
    let result = diagnosis("effects-found", &findings);
    let mut result: Value = serde_json::from_str(&result).unwrap();
    result["subject"] = json!("strapdown");
    folder.put("d.json", result.to_string());
    let said = folder.succeed(MODEL);
    assert_says(
        &folder.text("extended.model.toml"),
        "gyros = \"strapdown\"\n",
    );
    assert_says(&said, "left out     platform.knock concerns the attitude");
}
