use std::path::Path;

use super::lines::{of_page, of_terminal};
use super::values::{command, plain};
use super::{Moves, Shown, answers, read, workspace};

const SCREEN: &str = "\
FAULT  gyro_y.g_z, mass unbalance of gyro y (D_O or D_S)
how large  (1.328 ± 0.076)e-3 deg/h/g, 17.6 sigma, p = 1e-30
next       gyrocal plan %r.csv --bench %r.toml   # the run that would distinguish them

6-fold blocked cross-validation: gyro_y.g_z improves the predictive log
score by 69.4 nats. Open-loop simulation error: 1.77e-5 g rms.

 coefficient   nominal model         change
────────────────────────────────────────────
 gyro_x.bias   0.411948 ± 0.000084     +0.4
 gyro_y.bias   -0.28690 ± 0.00010      -3.0
";

const PAGE: &str = "<style>p { margin: 12 px }</style><h1>Fault found: gyro_y.g_z</h1>
<p>17.6 sigma, <b>p</b> = 1e-30</p>
<table><thead><tr><th>coefficient</th><th>95 % interval</th></tr></thead>
<tr><td>gyro_x.bias</td><td>−0.41 ± 0.02</td><td>deg&#x2f;h</td></tr>
<tr><th>lag-1 correlation</th><td>3.1·10⁻⁶</td></tr></table>
<h3>36 µg rms for the nominal model</h3><script>{\"data\": [7, 8, 9]}</script>";

fn shown(screen: &str, page: &str) -> Shown {
    let [screen, details] = of_terminal(screen);
    Shown([screen, details, of_page(page)])
}

/// Facts that an edited screen or page lacks.
fn missing(from: &str, to: &str) -> Vec<String> {
    assert!(SCREEN.contains(from) || PAGE.contains(from), "{from}");
    let now = shown(&SCREEN.replace(from, to), &PAGE.replace(from, to));
    let stored = shown(SCREEN, PAGE).facts();
    let missing = stored.iter().filter(|fact| !now.has(fact));
    missing.map(|fact| fact.join(": ")).collect()
}

#[test]
fn facts_are_numbers_ids_verdicts_and_commands_with_their_subjects() {
    let facts = shown(SCREEN, PAGE).facts();
    let facts: Vec<String> = facts.iter().map(|fact| fact.join(": ")).collect();
    for expected in [
        "screen: : FAULT",
        "page: : Fault found",
        "page: : gyro_y.g_z",
        "screen: : 1.328e-3",
        "screen: : 0.076e-3 deg/h/g",
        "page: : 17.6 sigma",
        "screen: : gyrocal plan %r.csv --bench %r.toml",
        "verbose: gyro_y.g_z: 69.4 nats",
        "verbose: : 1.77e-5 g",
        "verbose: gyro_y.bias: -0.28690",
        "page: gyro_x.bias: -0.41",
        "page: lag-1 correlation: 3.1e-6",
        "page: : 36 µg",
    ] {
        assert!(
            facts.iter().any(|one| one == expected),
            "{expected} of {facts:#?}"
        );
    }
    assert!(facts.contains(&"page: : 95 %".to_owned()));
    // Styles, and what charts draw.
    assert!(
        !facts
            .iter()
            .any(|one| one.contains(": 12") || one.ends_with(": 8"))
    );
}

#[test]
fn what_is_worded_otherwise_or_written_otherwise_is_found() {
    let same: [(&str, &str); 7] = [
        ("", ""),
        (
            "gyro_y.g_z improves the predictive log\nscore by 69.4 nats",
            "the gain of 69.4 nats is that\nof gyro_y.g_z",
        ),
        ("(1.328 ± 0.076)e-3 deg/h/g", "0.001328 ± 0.000076 deg/h/g"),
        ("how large  (1.328", "size  (1.3284"),
        ("1.77e-5 g rms", "0.0000177 g"),
        ("# the run", "# what"),
        (
            "<p>17.6 sigma, <b>p</b> = 1e-30</p>",
            "<li>p 1e-30</li><li>17.6 σ</li>",
        ),
    ];
    for (from, to) in same {
        assert_eq!(missing(from, to), [""; 0], "{from}");
    }
    // A line that moves from the screen to what `--verbose` shows.
    let line = "how large  (1.328 ± 0.076)e-3 deg/h/g, 17.6 sigma, p = 1e-30\n";
    let moved = format!("{}\n{line}", SCREEN.replace(line, ""));
    let now = shown(&moved, PAGE);
    assert!(now.has(&["screen", "", "1.328e-3"].map(str::to_owned)));
}

#[test]
fn what_is_changed_dropped_or_of_another_subject_is_missed() {
    for (from, to, expected) in [
        (
            "69.4 nats",
            "69.5 nats",
            vec!["verbose: gyro_y.g_z: 69.4 nats"],
        ),
        (
            "69.4 nats",
            "69 nats",
            vec!["verbose: gyro_y.g_z: 69.4 nats"],
        ),
        (
            "69.4 nats",
            "69.4 sigma",
            vec!["verbose: gyro_y.g_z: 69.4 nats"],
        ),
        ("1.77e-5", "1.77e-6", vec!["verbose: : 1.77e-5 g"]),
        ("-3.0", "3.0", vec!["verbose: gyro_y.bias: -3.0"]),
        ("FAULT", "DOUBT", vec!["screen: : FAULT"]),
        (
            "--bench %r",
            "--bench %q",
            vec!["screen: : gyrocal plan %r.csv --bench %r.toml"],
        ),
        (
            " gyro_x.bias   0.411948 ± 0.000084     +0.4\n",
            "",
            vec![
                "verbose: : gyro_x.bias",
                "verbose: gyro_x.bias: 0.000084",
                "verbose: gyro_x.bias: 0.4",
                "verbose: gyro_x.bias: 0.411948",
            ],
        ),
        (
            "gyro_y.bias   -0",
            "gyro_z.bias   -0",
            vec![
                "verbose: : gyro_y.bias",
                "verbose: gyro_y.bias: -0.28690",
                "verbose: gyro_y.bias: -3.0",
                "verbose: gyro_y.bias: 0.00010",
            ],
        ),
        (
            "<tr><th>lag-1 correlation</th><td>3.1·10⁻⁶</td></tr>",
            "",
            vec!["page: lag-1 correlation: 3.1e-6"],
        ),
        ("<h3>36 µg", "<h3>37 µg", vec!["page: : 36 µg"]),
    ] {
        assert_eq!(missing(from, to), expected, "{from}");
    }
}

#[test]
fn texts_have_one_way_to_write_a_number() {
    assert_eq!(plain("(−1.3 ± 0.1)e-3, 2σ"), "-1.3e-3 ± 0.1e-3, 2 sigma");
    assert_eq!(plain("2.5·10¹² of 1\u{a0}000"), "2.5e12 of 1000");
    assert_eq!(plain("(its) estimate, f(x)e"), "(its) estimate, f(x)e");
    assert_eq!(command("run gyrocal plan, which finds it"), "");
    assert_eq!(command("gyrocal 0.1.0"), "");
    let long = "gyrocal plant diagnose %p.json %r.csv --columns %c.toml --seed 3";
    assert_eq!(command(&format!("next {long} # why")), long);
}

#[test]
fn the_stored_facts_are_those_of_the_table() {
    let folder = workspace().join("tests/data/facts");
    let stored = read(&folder).unwrap();
    let all = answers(&folder, false).unwrap();
    assert_eq!(stored.len(), all.len());
    assert!(all.iter().all(|one| !stored[&one.key].is_empty()));
    assert!(
        answers(&folder, true)
            .unwrap()
            .iter()
            .all(|one| stored.contains_key(&one.key))
    );
    let size = |file: &Path| std::fs::metadata(file).unwrap().len();
    assert!(size(&folder.join("shown.txt.gz")) < 600_000);
    Moves::read(&folder).unwrap();
}
