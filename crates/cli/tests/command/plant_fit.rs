//! `gyrocal plant fit`, `compare` and `simulate`: docs/any-plant.md shows what the first prints (`documents.rs`).

use crate::folder::{Folder, assert_says, repository};

fn example(name: &str) -> String {
    repository(&format!("examples/duffing/{name}"))
        .display()
        .to_string()
}

#[test]
fn a_fit_tells_estimates_and_a_simulation_takes_them() {
    let folder = Folder::new();
    let [plant, record, later, columns] =
        ["plant.json", "record.csv", "later.csv", "columns.toml"].map(example);
    let fit = ["plant", "fit", &plant, &record, "--columns", &columns];
    let more = ["--later", &later, "--first-rows", "40", "--json", "f.json"];
    let printed = folder.succeed([&fit[..], &more].concat());
    for words in ["AIC", "in open loop", "condition number", "later record"] {
        assert!(printed.contains(words), "{words}: {printed}");
    }
    let answer: serde_json::Value = serde_json::from_str(&folder.text("f.json")).unwrap();
    assert_eq!(answer["manifest"]["inputs"].as_array().unwrap().len(), 4);
    let nominal = answer["coefficients"]["nominal"].as_array().unwrap();
    // Of the simulator (crates/truth): 4.6 and, without its softening spring, a stiffness some per cent off.
    let k = nominal[0]["estimate"].as_f64().unwrap();
    assert!((4.4..5.0).contains(&k), "{k}");

    let simulate = ["plant", "simulate", &plant, &later, "--columns", &columns];
    let more = ["--fit", "f.json", "--output", "s.csv"];
    folder.succeed([&simulate[..], &more].concat());
    let table = folder.text("s.csv");
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("time_s,x,x_sigma,v,v_sigma,y,y_sigma"));
    let first: Vec<f64> = lines
        .next()
        .unwrap()
        .split(',')
        .map(|value| value.parse().unwrap())
        .collect();
    let initial = &nominal[3];
    let expected = ["estimate", "sigma"].map(|name| initial[name].as_f64().unwrap());
    assert_eq!([first[1], first[2]], expected);
    assert_eq!(lines.count(), 799);

    folder.put("none.json", "{}");
    let more = ["--fit", "none.json", "--output", "n.csv"];
    let refused = folder.fail([&simulate[..], &more].concat());
    assert!(
        refused.contains("not the result of a fit of a plant"),
        "{refused}"
    );
    for (more, words) in [
        (["--first-rows", "800"], "the first 800 of its 800 rows"),
        (["--columns", "none.toml"], "none.toml: cannot be read"),
    ] {
        let arguments = ["plant", "fit", &plant, &record];
        let columns = ["--columns", &columns[..]];
        let columns = if more[0] == columns[0] {
            &columns[..0]
        } else {
            &columns[..]
        };
        let refused = folder.fail([&arguments[..], columns, &more].concat());
        assert!(refused.contains(words), "{words}: {refused}");
    }
    let itself = folder.run([&fit[..], &["--later", &record]].concat());
    assert_eq!(itself.status.code(), Some(2), "{itself:?}");
}

#[test]
fn a_comparison_is_one_table_and_refuses_another_plant() {
    let folder = Folder::new();
    let [plant, record, later, columns] =
        ["plant.json", "record.csv", "later.csv", "columns.toml"].map(example);
    // The spring of the simulator, as a rival script has it.
    let script = std::fs::read_to_string(example("plant.py")).unwrap();
    let (linear, softening) = ("- k * x -", "- k * x - s * x**3 -");
    assert!(script.contains(linear));
    let rival = script.replace(linear, softening).replace(
        "u = plant.input",
        "s = plant.parameter(\"s\", \"m^-2 s^-2\", -0.02)\nu = plant.input",
    );
    folder.put("rival.py", &rival);
    folder.succeed(["plant", "derive", "rival.py"]);
    let compare = ["plant", "compare", &plant, "rival.json"];
    let files = [
        record.as_str(),
        "--columns",
        &columns,
        "--later",
        &later,
        "--json",
        "c.json",
    ];
    let printed = folder.succeed([&compare[..], &files].concat());
    assert!(
        printed.starts_with("COMPARED  rival.json has the least BIC"),
        "{printed}"
    );
    let answer: serde_json::Value = serde_json::from_str(&folder.text("c.json")).unwrap();
    let [nominal, rival] = [0, 1].map(|place| &answer["models"][place]);
    assert_eq!(rival["name"], "rival.json");
    let number = |model: &serde_json::Value, place: &str| {
        model
            .pointer(place)
            .and_then(serde_json::Value::as_f64)
            .unwrap()
    };
    for place in ["/fit/bic", "/fit/aic", "/fit/later/outputs/0/open_loop/rms"] {
        assert!(number(rival, place) < number(nominal, place), "{place}");
    }
    let size = &rival["fit"]["coefficients"]["nominal"][3];
    let off = number(size, "/estimate") - 0.05;
    assert!(off.abs() < 4.0 * number(size, "/sigma"), "{size}");

    let servo = repository("examples/servo/plant.json")
        .display()
        .to_string();
    let files = [record.as_str(), "--columns", &columns];
    let refused = folder.fail([&["plant", "compare", &plant, &servo][..], &files].concat());
    assert!(refused.contains("it has the inputs"), "{refused}");
}

#[test]
fn what_a_record_lacks_is_told() {
    let folder = Folder::new();
    let [plant, columns] = ["plant.json", "columns.toml"].map(example);
    let text = std::fs::read_to_string(example("record.csv")).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let put = |name: &str, lines: Vec<&str>| folder.put(name, lines.join("\n") + "\n");
    // Rows 1 to 98, of 0 to 4.85 s, then those from 19.95 s on.
    put("gap.csv", [&lines[..99], &lines[400..]].concat());
    put("three.csv", lines[..4].to_vec());
    put("one.csv", lines[..2].to_vec());
    let mut absurd = lines.clone();
    absurd[300] = "14.950,1.8e19,0.1";
    put("absurd.csv", absurd);
    let with = |command: &'static str, record: &'static str| {
        let more: &[&str] = match command {
            "simulate" => &["--output", "s.csv"],
            _ => &[],
        };
        let all = ["plant", command, &plant, record, "--columns", &columns];
        [&all[..], more].concat()
    };
    for command in ["fit", "simulate"] {
        let output = folder.run(with(command, "gap.csv"));
        assert!(output.status.success(), "{output:?}");
        assert_says(
            &String::from_utf8(output.stderr).unwrap(),
            "gap.csv: input `u` (column `drive_n`) is interpolated over gaps of the rows: 15.1 s between rows 98 and \
             99; if it moved there, cut the record",
        );
    }
    // A plant that holds the input fills the gap its way, another one as the first does.
    let program = std::fs::read_to_string(&plant).unwrap();
    let held = program.replace(r#"["u", "N", true]"#, r#"["u", "N", false]"#);
    assert_ne!(program, held);
    for (name, text) in [("same.json", program), ("held.json", held)] {
        folder.put(name, text);
        let compare = ["plant", "compare", &plant, name, "gap.csv"];
        let output = folder.run([&compare[..], &["--columns", &columns]].concat());
        let said = String::from_utf8(output.stderr).unwrap();
        let of = |plant: &str, how: &str| {
            format!("warning: {plant}gap.csv: input `u` (column `drive_n`) is {how} over gaps")
        };
        let told = match name {
            "same.json" => vec![of("", "interpolated")],
            _ => vec![
                of(&format!("{plant}: "), "interpolated"),
                of("held.json: ", "held at its last value"),
            ],
        };
        assert_eq!(said.matches("warning: ").count(), told.len(), "{said}");
        told.iter().for_each(|words| assert_says(&said, words));
    }
    let whole = folder.run(with("simulate", "three.csv"));
    assert!(
        whole.status.success() && whole.stderr.is_empty(),
        "{whole:?}"
    );
    for command in ["fit", "diagnose"] {
        assert_says(
            &folder.fail(with(command, "one.csv")),
            "it has 1 row, and 13 are needed: 3 parameters and 2 initial states are estimated, and 8 further rows \
             tell the noise",
        );
        assert_says(
            &folder.fail(with(command, "absurd.csv")),
            "input `u` is 1.8e19 in row 300",
        );
    }
    assert_says(
        &folder.fail(with("simulate", "one.csv")),
        "it has 1 row, and 2 are needed: a simulation goes from one row to the next",
    );
}

#[test]
fn a_fit_is_of_one_program_and_equal_plants_tie() {
    let folder = Folder::new();
    let [plant, record, columns] = ["plant.json", "record.csv", "columns.toml"].map(example);
    let files = [record.as_str(), "--columns", &columns];
    let fit = [&["plant", "fit", &plant], &files[..], &["--json", "f.json"]].concat();
    folder.succeed(&fit);
    let mut answer: serde_json::Value = folder.json("f.json");
    let manifest = &answer["manifest"];
    assert_eq!(manifest["model_hash"], manifest["inputs"][2]["sha256"]);

    let program = std::fs::read_to_string(&plant).unwrap();
    folder.put(
        "other.json",
        program.replacen("on a spring", "on a wire", 1),
    );
    let simulate = |plant, fit| {
        let more = ["--fit", fit, "--output", "s.csv"];
        [&["plant", "simulate", plant], &files[..], &more].concat()
    };
    let refused = folder.fail(simulate("other.json", "f.json"));
    for words in [
        "another program of the name Duffing: found the hash",
        "expected",
    ] {
        assert_says(&refused, words);
    }
    assert!(
        !folder
            .succeed(simulate(&plant, "f.json"))
            .contains("not checked")
    );
    answer["manifest"]["model_hash"] = "".into();
    folder.put("old.json", answer.to_string());
    assert_says(
        &folder.succeed(simulate("other.json", "old.json")),
        "not checked",
    );

    let compare = [&["plant", "compare", &plant, &plant], &files[..]].concat();
    assert_says(&folder.succeed(compare), "have the same BIC, the least.");
}
