//! `gyrocal plant`: docs/any-plant.md shows what it prints (`documents.rs`).

use crate::folder::{Folder, assert_says, repository};

#[test]
fn a_missing_file_is_told() {
    let folder = Folder::new();
    let [plant, record] = ["plant.json", "record.csv"].map(|name| {
        repository(&format!("examples/duffing/{name}"))
            .display()
            .to_string()
    });
    let errors = folder.fail([
        "plant",
        "diagnose",
        &plant,
        &record,
        "--columns",
        "nothing.toml",
    ]);
    assert_says(&errors, "nothing.toml: cannot be read");
}

#[test]
fn the_answer_for_programs_names_the_cause_and_extends_its_plant_alone() {
    let folder = Folder::new();
    let example = |name: &str| {
        repository(&format!("examples/duffing/{name}"))
            .display()
            .to_string()
    };
    folder.succeed([
        "plant",
        "diagnose",
        &example("plant.json"),
        &example("record.csv"),
        "--columns",
        &example("columns.toml"),
        "--json",
        "o.json",
    ]);
    let mut answer: serde_json::Value = folder.json("o.json");
    // The simulator's spring softens by -0.05 x^3 (crates/truth).
    assert_eq!(answer["findings"][0]["effect"], "v_rate.x^3");

    folder.put("plant.py", std::fs::read(example("plant.py")).unwrap());
    for (subject, found) in [
        (
            serde_json::json!({ "plant": "Pump" }),
            "the answer of the plant Pump",
        ),
        (serde_json::json!("platform"), "the answer of a platform"),
    ] {
        answer["subject"] = subject;
        folder.put("other.json", answer.to_string());
        let errors = folder.fail("plant extend other.json");
        for words in [
            found,
            "an answer of the plant Duffing",
            "of this plant wrote",
        ] {
            assert!(errors.contains(words), "{errors}");
        }
    }
}

#[test]
fn a_new_package_is_written_once_and_names_its_tree() {
    let folder = Folder::new();
    let tree = repository("").display().to_string();
    folder.succeed(["new-plant", "oscillator", "--gyrocal", &tree]);
    assert_says(
        &folder.text("oscillator/Cargo.toml"),
        "name = \"oscillator\"",
    );
    let again = folder.fail(["new-plant", "oscillator", "--gyrocal", &tree]);
    assert_says(&again, "exists and is not empty");
    let nowhere = folder.fail("new-plant other --gyrocal oscillator");
    assert_says(&nowhere, "give the root of a tree of gyrocal");
}

#[test]
fn several_records_have_one_answer_and_a_report() {
    let folder = Folder::new();
    let example = |name: &str| {
        repository(&format!("examples/duffing/{name}"))
            .display()
            .to_string()
    };
    let [plant, record, later, columns] =
        ["plant.json", "record.csv", "later.csv", "columns.toml"].map(example);
    let common = ["plant", "diagnose", &plant, &record, "--columns", &columns];
    fn with<'a>(common: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
        [common, more].concat()
    }
    folder.succeed(with(
        &common,
        &[
            &later,
            "--json",
            "o.json",
            "--report",
            "r.html",
            "--figures",
            "f",
        ],
    ));
    let answer: serde_json::Value = folder.json("o.json");
    assert_eq!(answer["findings"][0]["effect"], "v_rate.x^3");
    let records = answer["records"].as_array().unwrap();
    // The simulator begins both with 0.2 m.
    for one in records {
        let initial = &one["initial"]["extended"][0];
        let [value, sigma] = ["estimate", "sigma"].map(|name| initial[name].as_f64().unwrap());
        assert!((value - 0.2).abs() < 4.5 * sigma, "{initial}");
    }
    assert_eq!(records.len(), 2);
    let inputs = answer["manifest"]["inputs"].as_array().unwrap();
    assert_eq!(inputs.len(), 4, "two records, the map and the plant");

    let page = folder.text("r.html");
    let hash = inputs[1]["sha256"].as_str().unwrap();
    for word in [
        "lacks one effect: v_rate.x^3",
        hash,
        "Open-loop residual",
        "later.csv alone",
    ] {
        assert!(page.contains(word), "{word}");
    }
    for name in [
        "simulation",
        "residual",
        "ranking",
        "parameters",
        "residuals",
    ] {
        let picture = folder.text(&format!("f/{name}.svg"));
        assert!(picture.starts_with("<svg"), "{name}");
    }

    // What several records found extends the script as what one did.
    std::fs::copy(
        repository("examples/duffing/plant.py"),
        folder.path("plant.py"),
    )
    .unwrap();
    folder.succeed("plant extend o.json");
    assert_says(&folder.text("plant.py"), "plant.extend(\"v_rate.x^3\"");

    let twice = folder.fail(with(&common, &[&record]));
    assert_says(&twice, "would count twice");
    for (more, words) in [
        (["--validate", &record], "is the record itself"),
        (["--report", &record], "would overwrite"),
    ] {
        let refused = folder.run(with(&common, &more));
        let errors = String::from_utf8(refused.stderr).unwrap();
        // A contradictory command line.
        assert_eq!(refused.status.code(), Some(2), "{errors}");
        assert!(errors.contains(words), "{errors}");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_record_in_a_pipe_has_the_hash_of_its_file() {
    let folder = Folder::new();
    let example = |name: &str| repository(&format!("examples/duffing/{name}"));
    folder.put("record.csv", std::fs::read(example("record.csv")).unwrap());
    let [plant, columns] =
        ["plant.json", "columns.toml"].map(|name| example(name).display().to_string());
    let of = |record: &str| {
        let ends = ["--columns", &columns, "--json", "o.json"];
        let all = [&["plant", "diagnose", &plant, record][..], &ends].concat();
        let output = folder.run_with_stdin(&all, "record.csv");
        assert!(output.status.success(), "{output:?}");
        let answer: serde_json::Value = folder.json("o.json");
        let inputs = answer["manifest"]["inputs"].as_array().unwrap().iter();
        let hashes: Vec<serde_json::Value> = inputs.map(|one| one["sha256"].clone()).collect();
        (hashes, answer["findings"].clone())
    };
    assert_eq!(of("/dev/stdin"), of("record.csv"));
}

#[test]
fn a_wave_of_a_known_period_is_found() {
    let folder = Folder::new();
    let example = |name: &str| repository(&format!("examples/duffing/{name}"));
    let script = std::fs::read_to_string(example("plant.py")).unwrap();
    let end = "if __name__";
    assert!(script.contains(end));
    let script = script.replace(end, &format!("plant.period(\"shaft\", 3.0)\n\n{end}"));
    folder.put("plant.py", &script);
    folder.succeed("plant derive plant.py");
    let text = std::fs::read_to_string(example("record.csv")).unwrap();
    let mut lines = text.lines();
    let mut record = format!("{}\n", lines.next().unwrap());
    for line in lines {
        let values: Vec<f64> = line
            .split(',')
            .map(|value| value.parse().unwrap())
            .collect();
        let wave = 0.05 * (core::f64::consts::TAU * values[0] / 3.0 + 0.7).sin();
        record += &format!("{},{},{}\n", values[0], values[1], values[2] + wave);
    }
    folder.put("record.csv", &record);
    let columns = example("columns.toml").display().to_string();
    let arguments = [
        "plant",
        "diagnose",
        "plant.json",
        "record.csv",
        "--columns",
        &columns,
    ];
    folder.succeed([&arguments[..], &["--json", "o.json"]].concat());
    let answer: serde_json::Value = folder.json("o.json");
    let findings = answer["findings"].as_array().unwrap();
    let sets = findings.iter().map(|one| {
        let others = one["alternatives"].as_array().unwrap().iter();
        let others = others.filter(|other| other["kind"] == "not-excluded");
        let names = others.map(|other| &other["effect"]).chain([&one["effect"]]);
        names.map(|name| name.as_str().unwrap()).collect::<Vec<_>>()
    });
    let sets: Vec<Vec<&str>> = sets.collect();
    // A wave of the force does the same when the plant has settled, so that either may be named.
    for wave in ["y.shaft.sine", "y.shaft.cosine"] {
        assert!(sets.iter().any(|set| set.contains(&wave)), "{sets:?}");
    }
    assert_eq!(
        findings.len(),
        3,
        "the spring and two parts of the wave: {sets:?}"
    );
    // The sensor's noise of 0.01, and what an estimate of it from 800 rows may be off by.
    let left = answer["open_loop"][0]["extended"].as_f64().unwrap();
    assert!((0.0095..0.0115).contains(&left), "{left}");
}

#[test]
fn runs_that_could_be_made_next_are_compared() {
    let folder = Folder::new();
    let example = |name: &str| {
        repository(&format!("examples/duffing/{name}"))
            .display()
            .to_string()
    };
    let rows = |force: f64| {
        let row = |row: i32| {
            format!(
                "{},{}\n",
                0.05 * f64::from(row),
                force * f64::from(row % 40 / 20)
            )
        };
        format!("time_s,drive_n\n{}", (0..400).map(row).collect::<String>())
    };
    folder.put("weak.csv", rows(0.1));
    folder.put("strong.csv", rows(3.0));
    let [plant, record, columns] = ["plant.json", "record.csv", "columns.toml"].map(example);
    let arguments = [
        "plant",
        "diagnose",
        &plant,
        &record,
        "--columns",
        &columns,
        "--next",
        "weak.csv",
        "strong.csv",
    ];
    let printed = folder.succeed([&arguments[..], &["--json", "o.json"]].concat());
    assert_says(&printed, "brings standard deviations to");
    let answer: serde_json::Value = folder.json("o.json");
    let names = answer["next_runs"]
        .as_array()
        .unwrap()
        .iter()
        .map(|run| &run["name"]);
    assert_eq!(names.collect::<Vec<_>>(), ["strong.csv", "weak.csv"]);
    assert_eq!(
        answer["gain"]["block_log_score_nats"]
            .as_array()
            .unwrap()
            .len(),
        6
    );
}
