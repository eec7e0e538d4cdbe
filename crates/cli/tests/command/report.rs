//! `gyrocal report` and `--report` as a user runs them.

use crate::folder::{BENCH, CommandLine, Folder, RECORD, assert_says, hidden_fault as folder};

/// Runs a command whose command line is wrong; returns stderr.
fn wrong_usage(folder: &Folder, arguments: impl CommandLine) -> String {
    let output = folder.run(arguments);
    assert_eq!(output.status.code(), Some(2));
    String::from_utf8(output.stderr).unwrap()
}

/// A page that needs nothing else: whole, and without a reference to another place.
fn assert_page(folder: &Folder, name: &str, words: &[&str]) {
    let html = folder.text(name);
    assert!(
        html.starts_with("<!DOCTYPE html>") && html.trim_end().ends_with("</html>"),
        "{name}"
    );
    for reference in ["src=", "url(", "@import", "<link rel=\"stylesheet\""] {
        assert!(
            !html.contains(reference),
            "{name} refers to another file: {reference}"
        );
    }
    // The words of a command are apart, for the breaks of its lines.
    let text = html.replace("<span>", "").replace("</span>", "");
    for word in words {
        assert!(text.contains(word), "{name} lacks {word}");
    }
}

/// Every fact that the terminal shows stands in a card of the first screen of the page.
fn assert_same_screen(folder: &Folder, name: &str, said: &str) {
    let html = folder.text(name).replace("&#x2f;", "/");
    let (first, _) = html.split_once("</header>").unwrap();
    let (head, facts) = said.split_once('\n').unwrap();
    let (verdict, what) = head.split_once("  ").unwrap();
    for words in [format!("<h1>{verdict}</h1>"), format!("<p>{what}</p>")] {
        assert!(first.contains(&words), "{name} lacks {words}");
    }
    let mut seen = 0;
    for line in facts.lines().take_while(|line| !line.is_empty()) {
        let Some((label, words)) = line.split_once("  ") else {
            continue;
        };
        if first.contains(&format!("<h2>{label}</h2>\n<p>{}</p>", words.trim_start())) {
            seen += 1;
        } else {
            // Tables and commands are laid out otherwise.
            let is_fact = [
                "how large",
                "how sure",
                "may also be",
                "left over",
                "noise",
                "record",
            ];
            assert!(!is_fact.contains(&label), "{name} lacks {line}");
        }
    }
    assert!(seen >= 3, "{seen} facts of {said}");
}

#[test]
fn reports_of_a_diagnosis_a_result_and_a_plan() {
    let folder = folder();
    let said = folder.succeed([
        "diagnose", RECORD, "--bench", BENCH, "--report", "r.html", "--json", "d.json",
    ]);
    assert_says(&said, "r.html: the report");
    assert_same_screen(&folder, "r.html", &said);
    let words = [
        "<h1>FAULT</h1>",
        "6f95ed38b7e3fa6c70e6801692d87e3f9055ab2afb8feafe2898256599469b0b",
        "gyrocal diagnose hidden_fault.csv --bench hidden_fault.bench.toml --report r.html",
        "gyrocal plan hidden_fault.csv --bench hidden_fault.bench.toml",
        "Simulation against measurement",
        "95 % band of a right model",
        "Convergence of each coefficient",
        "What cannot be told apart",
        "detection threshold",
        "latitude +1.000 arcsec",
    ];
    assert_page(&folder, "r.html", &words);
    let result: serde_json::Value = folder.json("d.json");
    let none = result["findings"][0]["none_of_these"].as_f64().unwrap();
    let unlisted = format!("gyro_y.g_z: probability {:.1} %", 100.0 * none);
    assert_page(&folder, "r.html", &[&unlisted]);

    folder.succeed(format!("plan {RECORD} --bench {BENCH} --diagnosis d.json --hours 24 --aim sigmas --json p.json --report p.html --figures pictures"));
    assert_picture(&folder, "pictures/proposals.svg", &["Proposals"]);
    assert_page(&folder, "p.html", &["<h1>NEXT RUN</h1>"]);

    folder.succeed("report d.json p.json --out both.html");
    let words = ["2 records", "<h1>FAULT</h1>", "<h1>NEXT RUN</h1>"];
    assert_page(&folder, "both.html", &words);
}

#[test]
fn reports_of_a_calibration() {
    let folder = folder();
    let bench = folder.text(BENCH);
    let identity = "[identification]\nreport_number = \"R 17\"\nserial_number = \"00<7>\"\n";
    folder.put(BENCH, format!("{bench}\n{identity}"));
    let said = folder.succeed(format!(
        "calibrate {RECORD} --bench {BENCH} --report c.html --json c.json --figures pictures"
    ));
    for name in ["residual", "convergence", "coefficients"] {
        assert_picture(&folder, &format!("pictures/{name}.svg"), &["gyro"]);
    }
    let words = [
        "Simulation against measurement",
        "Drift coefficients",
        "hidden_fault.bench.toml",
    ];
    assert_page(&folder, "c.html", &words);
    // The verdict in a sentence, with the band of its test.
    assert_page(&folder, "c.html", &["Mean NIS"]);
    assert_same_screen(&folder, "c.html", &said);
    // A written result has the verdict of the command, also where its coefficients mean nothing.
    folder.succeed("report c.json");
    assert_page(
        &folder,
        "report.html",
        &["Drift coefficients", "<h1>FAULT</h1>"],
    );
    let identity = &folder.json::<serde_json::Value>("c.json")["manifest"]["inputs"][1];
    assert_eq!(identity["identification"]["serial_number"], "00<7>");
    for name in ["c.html", "report.html"] {
        let words = [
            "<dt>report number</dt> <dd>R 17</dd>",
            "· report number R 17 · serial number 00&lt;7&gt; · gyrocal ",
        ];
        assert_page(&folder, name, &words);
    }
    let written = folder.text("c.json");
    let gross = written.replace("\"usable\": true", "\"usable\": false");
    assert_ne!(gross, written);
    folder.put("c.json", gross);
    folder.succeed("report c.json --out gross.html");
    assert_page(&folder, "gross.html", &["<h1>NOT USABLE</h1>"]);
}

#[test]
fn reports_and_pictures_of_many_runs_and_of_a_noise() {
    let folder = folder();
    folder.put_example("hidden_fault.scenario.toml");
    let arguments =
        "monte-carlo hidden_fault.scenario.toml --seeds 0..2 --report m.html --figures runs";
    let said = folder.succeed(arguments);
    assert_says(&said, "m.html: the report");
    let words = ["runs in their band", "gyro_x.bias", "seeds 0 to 1"];
    assert_page(&folder, "m.html", &words);
    assert_picture(
        &folder,
        "runs/coefficients.svg",
        &["Errors over sigmas", "gyro_z.g_zz"],
    );
    assert_picture(&folder, "runs/coefficients-2.svg", &["share of runs"]);

    let rows = (0..2000_u32).map(|row| format!("{}\n", row.wrapping_mul(2_654_435_761) >> 8));
    folder.put("l.csv", "rate\n".to_owned() + &rows.collect::<String>());
    let allan = "allan l.csv --columns rate --rate-hz 10 --report a.html --figures noise";
    folder.succeed(allan);
    assert_page(&folder, "a.html", &["averaging time"]);
    assert_picture(
        &folder,
        "noise/deviation.svg",
        &["averaging time [s]", "rate"],
    );
}

/// A picture with these words.
fn assert_picture(folder: &Folder, name: &str, words: &[&str]) {
    let svg = folder.text(name);
    assert!(svg.starts_with("<svg") && !svg.contains("NaN"), "{name}");
    for word in words {
        assert!(svg.contains(word), "{name} lacks {word}");
    }
}

#[test]
fn a_report_that_cannot_be_written_is_told_before_the_work() {
    let folder = folder();
    let refused = folder.fail(format!(
        "diagnose {RECORD} --bench {BENCH} --report nowhere/r.html"
    ));
    assert_says(&refused, "nowhere/r.html");
    assert!(!folder.path("nowhere").exists());
    let refused = wrong_usage(
        &folder,
        ["report", RECORD, "--bench", BENCH, "--out", BENCH],
    );
    assert_says(&refused, "would overwrite the input");
    let refused = wrong_usage(&folder, ["report", RECORD]);
    assert_says(&refused, "0 of --bench for 1 of records");
}

#[test]
fn results_of_other_versions_and_other_files_are_refused() {
    let folder = folder();
    folder.put("old.json", r#"{"schema_version": 1, "findings": []}"#);
    let refused = folder.fail("report old.json");
    assert_says(&refused, "schema_version 1");
    assert_says(&refused, "3, the version");
    folder.put("new.json", r#"{"schema_version": 99, "verdict_text": ""}"#);
    let refused = folder.fail("report new.json");
    assert_says(&refused, "schema_version 99, expected 2");
    folder.put("other.json", "{}");
    let refused = folder.fail("report other.json");
    assert_says(&refused, "not a result of diagnose, calibrate or plan");
    assert!(!folder.path("report.html").exists());
}

#[test]
fn an_uncertainty_budget_of_two_runs_conforms_to_its_schema() {
    let folder = folder();
    for name in [
        "three_days.csv",
        "three_days.bench.toml",
        "rivals.scenario.toml",
    ] {
        folder.put_example(name);
    }
    let rivals = ["rivals.csv", "--bench-out", "rivals.bench.toml"];
    let simulate = ["simulate", "rivals.scenario.toml", "--out"];
    folder.succeed_as_is([&simulate[..], &rivals].concat());
    let output = folder.run_on_a_terminal("report rivals.csv three_days.csv --bench rivals.bench.toml --bench three_days.bench.toml --uncertainty --json budget.json --verbose --out u.html");
    assert_eq!(output.status.code(), Some(0));
    let said = String::from_utf8(output.stdout).unwrap();
    crate::contract::assert_conforms(&folder, &["report", "--json", "budget.json"]);
    let found: serde_json::Value = folder.json("budget.json");
    let records = found["records"].as_array().unwrap();
    // A fault of several explanations leaves models open, whose estimates scatter.
    assert!(records[0]["models"].as_array().unwrap().len() > 1);
    let choice = |record: &serde_json::Value| -> f64 {
        let coefficients = record["coefficients"].as_array().unwrap();
        let lines = coefficients
            .iter()
            .flat_map(|one| one["contributions"].as_array().unwrap());
        lines
            .filter(|line| line["source"] == "choice of the model")
            .map(|line| line["contribution"].as_f64().unwrap())
            .sum()
    };
    assert!(choice(&records[0]) > 0.0);
    assert_eq!(choice(&records[1]), 0.0);
    assert_eq!(found["spread"]["runs"], 2);
    let head: Vec<&str> = said.lines().take(3).collect();
    assert!(
        head[0].contains("coefficients over 2 runs") && head[1].contains("mean "),
        "{said}"
    );
    for words in ["Scatter over 2 runs", "D_II", "Only a laboratory certifies"] {
        assert!(said.contains(words), "{said}");
    }
    for line in said.lines() {
        assert!(line.chars().count() <= 80, "{line}");
    }
    let words = [
        "Scatter over runs",
        "Test conditions",
        "choice of the model",
        "<td class=\"num\">not declared</td>",
    ];
    assert_page(&folder, "u.html", &words);
    let wrong = ["report", RECORD, "--bench", BENCH, "--json", "b.json"];
    assert!(wrong_usage(&folder, wrong).contains("--uncertainty"));

    // A record is one run, also under another name.
    folder.put("copy.csv", folder.text("rivals.csv"));
    let twice = folder.fail("report rivals.csv copy.csv --bench rivals.bench.toml --uncertainty");
    assert_says(
        &twice,
        "copy.csv: found 1081 consecutive rows that rivals.csv has too",
    );
}
