//! The first screen of every command, on a terminal of 80 columns and 24 lines: it fits, with the
//! prompt, and its first three lines hold the verdict.

use crate::folder::{CommandLine, Folder, assert_says, example, repository, repository_argument};

const COLUMNS: usize = 80;

/// Lines of the terminal less the command and the prompt after it.
const LINES: usize = 22;

/// The screen of a command, which fits and has these words in its first three lines.
#[track_caller]
fn assert_screen(folder: &Folder, arguments: impl CommandLine, verdict: &[&str]) -> String {
    let output = folder.run_on_a_terminal(&arguments);
    let said = String::from_utf8(output.stdout).unwrap();
    let errors = String::from_utf8(output.stderr).unwrap();
    // Without a command there is no result.
    let expected = if arguments.words().is_empty() { 2 } else { 0 };
    assert_eq!(output.status.code(), Some(expected), "{errors}");
    assert!(said.lines().count() <= LINES, "{said}");
    for line in said.lines() {
        assert!(line.chars().count() <= COLUMNS, "{line}\n{said}");
    }
    let head: Vec<&str> = said.lines().take(3).collect();
    let head = head.join("\n");
    for words in verdict {
        assert!(head.contains(words), "{words}\nis not in\n{head}");
    }
    said
}

fn examples() -> Folder {
    let folder = Folder::new();
    for name in [
        "hidden_fault.csv",
        "hidden_fault.bench.toml",
        "three_days.csv",
        "three_days.bench.toml",
    ] {
        folder.put_example(name);
    }
    folder
}

#[test]
fn a_fault_is_told_with_size_significance_alternatives_and_next_step() {
    let folder = examples();
    let files = ["hidden_fault.csv", "--bench", "hidden_fault.bench.toml"];
    let mut arguments = vec!["diagnose"];
    arguments.extend(files);
    arguments.extend(["--json", "d.json"]);
    let said = assert_screen(
        &folder,
        &arguments,
        &[
            "FAULT  gyro_y.g_z, mass unbalance of gyro y along the cross axis z",
            "(1.328 ± 0.076)e-3 deg/h/g, 17.6 sigma, search-corrected p = 1e-30",
        ],
    );
    for words in [
        "\nmay also be   gyro_yz.axis_misalignment, gyro_y.magnetic\n",
        "open-loop error 35.5 → 17.7 µg",
        "\ncoefficients  change by gyro_z.g_zz +2.8",
        "\nnext          gyrocal plan hidden_fault.csv --bench hidden_fault.bench.toml",
        "\nd.json: the result for programs\n",
    ] {
        assert!(said.contains(words), "{words}\nis not in\n{said}");
    }
    // The command that it names runs, from the diagnosis too.
    let mut arguments = vec!["plan"];
    arguments.extend(files);
    assert_screen(
        &folder,
        &arguments,
        &["NEXT RUN  72 h from platform angles"],
    );
    arguments.extend(["--diagnosis", "d.json", "--hours", "6,72", "--one-name"]);
    assert_screen(
        &folder,
        &arguments,
        &["NEXT RUN  6.0 h from platform angles"],
    );
    let mut arguments = vec!["calibrate"];
    arguments.extend(files);
    arguments.extend(["--with", "gyro_y.g_z"]);
    assert_screen(&folder, &arguments, &["FAULT", "gyro_y.g_z, 17.6 sigma"]);
    let arguments = ["extend", "d.json", "--out", "x.model.toml"];
    assert_screen(&folder, arguments, &["MODEL FILE  x.model.toml"]);
}

#[test]
fn a_sound_record_is_told_as_such() {
    let folder = examples();
    let files = ["three_days.csv", "--bench", "three_days.bench.toml"];
    let clean = [&["diagnose"], &files[..]].concat();
    assert_screen(&folder, &clean, &["NO FAULT FOUND", "58 effects tested"]);
    let calibrated = [&["calibrate"], &files[..]].concat();
    let said = assert_screen(&folder, &calibrated, &["CALIBRATED", "mean NIS 3.021"]);
    assert_says(&said, " gyro_x.bias   0.41164 ± 0.00022 deg/h ");
}

#[test]
fn a_wrong_set_up_and_two_records_fit_too() {
    let folder = examples();
    let text = folder.text("three_days.csv");
    let lines: Vec<&str> = text.lines().collect();
    let cut = |rows: std::ops::Range<usize>| format!("{}\n{}\n", lines[0], lines[rows].join("\n"));
    folder.put("a.csv", cut(1..1500));
    folder.put("b.csv", cut(1500..3000));
    folder.forget_attitude("three_days.bench.toml");
    let bench = ["--bench", "three_days.bench.toml"];
    let two = [&["calibrate", "a.csv", "b.csv"], &bench[..]].concat();
    assert_screen(&folder, &two, &["CALIBRATED"]);
    let mut swapped = lines.clone();
    swapped.swap(5, 6);
    folder.put("s.csv", swapped.join("\n") + "\n");
    let wrong = [&["diagnose", "s.csv"], &bench[..]].concat();
    assert_screen(&folder, &wrong, &["SET-UP WRONG", "Time does not rise"]);
}

#[test]
fn simulations_fit() {
    let folder = Folder::new();
    let scenario = repository_argument("examples/data/three_days.scenario.toml");
    folder.put("s.toml", std::fs::read(scenario).unwrap());
    let arguments = "simulate s.toml --out r.csv --bench-out b.toml";
    assert_screen(&folder, arguments, &["SIMULATED  r.csv: 4321 rows"]);
    let arguments = ["monte-carlo", "s.toml", "--seeds", "0..4"];
    assert_screen(&folder, arguments, &["CONSISTENT  4 runs, 0 failed"]);
    let arguments = "characterise --cell d8 --runs 1 --method none";
    assert_screen(&folder, arguments, &["figures hold"]);
}

#[test]
fn tests_of_instruments_fit() {
    let folder = Folder::new();
    let data = |path: &str| repository(&format!("tests/data/measured/{path}"));
    for (from, to) in [
        ("xsens_38_positions/imu_counts.csv", "x.csv"),
        ("xsens_38_positions/log.toml", "x.toml"),
        ("ring_laser_static/imu.csv", "r.csv"),
        ("ring_laser_static/log.toml", "r.toml"),
    ] {
        folder.put(to, std::fs::read(data(from)).unwrap());
    }
    let tumble = ["tumble", "x.csv", "--log-description", "x.toml"];
    let verdict = [
        "TERMS MISSING  the nominal drift law lacks 6 terms",
        "gyro_z.g_y     -348 ± 14 deg/h/g, p = 2e-8; nothing else of the catalogue",
    ];
    assert_screen(&folder, tumble, &verdict);
    let allan = ["allan", "r.csv", "--log-description", "r.toml"];
    assert_screen(
        &folder,
        allan,
        &["NOISE NOT EXPLAINED", "in 3 of 3 columns"],
    );
    let import = "import strapdown r.csv --log-description r.toml --out p.csv --bench-out p.toml";
    let verdict = [
        "IMPORTED  61 rows",
        "horizontal rate  12.4247 ± 0.0025 deg/h",
    ];
    assert_screen(&folder, import, &verdict);
}

#[test]
fn the_catalogue_and_the_greeting_fit() {
    let folder = Folder::new();
    assert_screen(&folder, "", &["What people do first"]);
    assert_screen(&folder, ["effects"], &["EFFECTS  114 of the catalogue"]);
    for effect in gyrocal::EFFECTS.iter() {
        let said = assert_screen(&folder, ["effects", effect.id], &[effect.id]);
        assert!(
            said.contains("typical size") || effect.parameters.is_empty(),
            "{said}"
        );
    }
    let family = ["effects", "gyro_i.g_j"];
    assert_screen(&folder, family, &["family", "gyro_x.g_y, gyro_x.g_z"]);
    let errors = folder.fail("effects gyro_y.gz");
    assert_says(&errors, "the nearest are `gyro_y.g_z`");
    assert_screen(&folder, ["man", "pages"], &["WROTE"]);
    assert_says(&folder.text("pages/gyrocal-diagnose.1"), "Examples:");
}

#[test]
fn details_fit_the_width_and_a_pipe_has_whole_lines() {
    let folder = examples();
    let files = ["hidden_fault.csv", "--bench", "hidden_fault.bench.toml"];
    for command in ["diagnose", "calibrate", "plan"] {
        let arguments = [&[command], &files[..], &["--verbose"]].concat();
        let output = folder.run_on_a_terminal(&arguments);
        let said = String::from_utf8(output.stdout).unwrap();
        assert!(said.lines().count() > LINES, "{said}");
        for line in said.lines() {
            assert!(line.chars().count() <= COLUMNS, "{command}: {line}");
        }
    }
    let said = folder.succeed_as_is([&["diagnose"], &files[..]].concat());
    let fault = said
        .lines()
        .find(|line| line.starts_with("what it does"))
        .unwrap();
    assert!(fault.ends_with("nats on left-out blocks"), "{fault}");
    assert!(said.lines().count() < 15, "{said}");
}

#[test]
fn nothing_is_printed_if_asked_so_and_colours_on_request_only() {
    let folder = examples();
    let files = ["hidden_fault.csv", "--bench", "hidden_fault.bench.toml"];
    let quiet = [&["diagnose"], &files[..], &["--quiet", "--exit-code"]].concat();
    let output = folder.run(&quiet);
    assert_eq!(output.status.code(), Some(3));
    assert!(output.stdout.is_empty() && output.stderr.is_empty());
    let colour = |when: &str| {
        let color = format!("--color={when}");
        let said = folder.succeed_as_is(["effects", "gyro_y.g_z", &color]);
        said.contains('\u{1b}')
    };
    assert!(colour("always") && !colour("never") && !colour("auto"));
    let wrong = folder.run("diagnose --colour --color=always");
    assert!(String::from_utf8(wrong.stderr).unwrap().contains('\u{1b}'));
}

#[test]
fn a_record_that_can_show_little_is_too_short_to_tell() {
    let folder = examples();
    let rows: Vec<String> = folder
        .text("three_days.csv")
        .lines()
        .take(40)
        .map(str::to_owned)
        .collect();
    folder.put("short.csv", rows.join("\n") + "\n");
    let arguments = ["diagnose", "short.csv", "--bench", "three_days.bench.toml"];
    let said = assert_screen(&folder, arguments, &["TOO SHORT TO TELL"]);
    assert_says(&said, "record for a day or longer");
    assert!(!said.contains("NO FAULT FOUND"), "{said}");
}

#[test]
fn a_random_walk_is_told_with_its_interval_and_without_a_simulation() {
    let folder = examples();
    let hidden = "[[hidden]]\neffect = \"gyro_x.random_walk\"\nsize = 1e-3\n";
    let scenario = example("three_days.scenario.toml");
    folder.simulate(&format!("{scenario}\n{hidden}"));
    let arguments = ["diagnose", "r.csv", "--bench", "b.toml"];
    let said = assert_screen(&folder, arguments, &["gyro_x.random_walk", "(95 %: "]);
    assert!(!said.contains("open-loop"), "{said}");
    // A filter cannot have it: the next step is not to extend one.
    let arguments = "calibrate r.csv --bench b.toml --with gyro_x.random_walk";
    let said = assert_screen(&folder, arguments, &["FAULT"]);
    assert!(
        said.contains("next") && !said.contains("gyrocal extend"),
        "{said}"
    );
}

#[test]
fn what_to_do_about_a_wrong_set_up_goes_by_what_stops() {
    let folder = examples();
    // Zeros in a few rows, which can be left out, and a latitude of the wrong sign, which stops.
    let zero = |(index, line): (usize, &str)| match (100..130).contains(&index) {
        true => {
            let mut fields: Vec<&str> = line.split(',').collect();
            fields[1] = "0";
            fields.join(",")
        }
        false => line.to_owned(),
    };
    let text = folder.text("three_days.csv");
    let rows: Vec<String> = text.lines().enumerate().map(zero).collect();
    folder.put("zeros.csv", rows.join("\n") + "\n");
    let bench = folder
        .text("three_days.bench.toml")
        .replace("latitude_deg = ", "latitude_deg = -");
    folder.put("south.toml", bench);
    let arguments = ["diagnose", "zeros.csv", "--bench", "south.toml"];
    let said = assert_screen(&folder, arguments, &["SET-UP WRONG"]);
    assert_says(&said, "mend the record or its bench file");
    assert_says(&said, "can be mended");
}
