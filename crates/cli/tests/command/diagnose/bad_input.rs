//! Refused inputs of `gyrocal diagnose`: exit code 1 or 2, one message, no output.

use gyrocal_answer::{NotTestedReason, ResidualVerdict, Verdict};

use super::{BENCH, RECORD, folder};
use crate::folder::assert_says;

#[test]
fn an_effect_that_cannot_be_looked_for_is_refused() {
    let folder = folder();
    let cases = [
        (
            "gyro_y.gz",
            "there is no effect `gyro_y.gz` in the catalogue; the nearest are `gyro_y.g_z`",
        ),
        (
            "gyro_xy.axis_misalignment,gyro_x.temperature",
            "`gyro_x.temperature` cannot be looked for: the record has no column `temperature_c`",
        ),
        (
            "gyro_x.magnetic",
            "`gyro_x.magnetic` cannot be looked for: the bench file has no `magnetic_field_gauss`",
        ),
    ];
    for (effects, message) in cases {
        let errors = folder.fail([
            "diagnose",
            RECORD,
            "--bench",
            BENCH,
            "--json",
            "o.json",
            "--effects",
            effects,
        ]);
        assert!(errors.contains(message), "{message}\nis not in\n{errors}");
        assert_says(&errors, "help: ");
    }
}

#[test]
fn a_temperature_that_never_changes_explains_nothing() {
    let folder = shortened(720);
    let constant: String = folder
        .text(RECORD)
        .lines()
        .enumerate()
        .map(|(line, text)| {
            format!(
                "{text},{}\n",
                if line == 0 { "temperature_c" } else { "20" }
            )
        })
        .collect();
    folder.put(RECORD, constant);
    let command = ["diagnose", RECORD, "--bench", BENCH];
    let asked = [&command[..], &["--effects", "gyro_x.temperature"]].concat();
    let errors = folder.fail(&asked);
    assert_says(
        &errors,
        "`gyro_x.temperature` cannot be looked for: the column `temperature_c` never",
    );
    folder.succeed([&command[..], &["--json", "o.json"]].concat());
    let report = super::report(&folder, "o.json");
    let why = report
        .not_searched
        .iter()
        .find(|e| e.effect == "gyro_x.temperature");
    assert!(why.unwrap().why.contains("never changes"), "{why:?}");
    let mut against = report.residuals.unwrap().against.into_iter();
    assert!(against.all(|against| against.abscissa != "temperature_c"));
}

/// The record with its first rows only.
pub(super) fn shortened(rows: usize) -> crate::folder::Folder {
    let folder = folder();
    let whole = folder.text(RECORD);
    let lines: Vec<&str> = whole.lines().take(rows + 1).collect();
    folder.put(RECORD, lines.join("\n") + "\n");
    folder
}

#[test]
fn a_record_shorter_than_the_state_is_refused() {
    let errors = shortened(11).fail(["diagnose", RECORD, "--bench", BENCH]);
    assert_says(
        &errors,
        "found 11 rows after the header, expected at least 12 rows",
    );
}

#[test]
fn a_short_record_says_what_it_could_not_show() {
    let folder = shortened(240);
    let said = folder.succeed(["diagnose", RECORD, "--bench", BENCH, "--json", "o.json"]);
    assert_says(&said, ", as the record is short: ");
    let report = super::report(&folder, "o.json");
    // In four hours the platform turns by a sixth of the circle: no cross-axis term of 0.05
    // deg/h/g is told from drift and attitude.
    let unseen = report
        .not_searched
        .iter()
        .find(|entry| entry.effect == "gyro_y.g_z")
        .unwrap();
    assert_eq!(unseen.reason, NotTestedReason::LowPower);
    assert!(unseen.why.contains("too short"), "{unseen:?}");
    let power = report
        .power
        .iter()
        .find(|p| p.effect == "gyro_y.g_z")
        .unwrap();
    assert!(power.power.is_none_or(|power| power < 0.85), "{power:?}");
}

#[test]
fn what_a_record_is_too_short_to_be_tested_for_is_named() {
    // Half an hour: rows are apart by the platform's steady turn, which is no lattice.
    let folder = shortened(29);
    let said = folder.succeed(["diagnose", RECORD, "--bench", BENCH, "--json", "o.json"]);
    let report = super::report(&folder, "o.json");
    assert_eq!(report.verdict, Verdict::Clean);
    assert_eq!(report.findings, []);
    assert_eq!(report.remainder.verdict, ResidualVerdict::NotTested);
    assert_eq!(
        report.remainder.description,
        "correlation of neighbouring rows"
    );
    for words in [
        "not tested (the record is too short for a spectrum of its noise): ",
        "together not tested for correlation of neighbouring rows",
        "deviation not computed: no stretch of rows without a gap and with all axes is long",
    ] {
        let told: Vec<&str> = said.split_whitespace().collect();
        assert!(told.join(" ").contains(words), "{words}\n{said}");
    }
    assert!(
        !said.contains("  white ") && !said.contains("innovations white"),
        "{said}"
    );
    let why = |effect: &str| {
        let mut all = report.not_searched.iter();
        all.find(|entry| entry.effect == effect)
            .map_or("", |entry| &entry.why)
            .to_owned()
    };
    assert!(why("accel_x.noise").contains("too short for a spectrum"));
    assert!(why("gyro_y.g_z").contains("too short"));
}

#[test]
fn a_record_without_an_axis_is_diagnosed_and_drawn_as_far_as_it_goes() {
    let folder = shortened(1441);
    let text = folder.text(RECORD);
    let mut lines = text.lines();
    let mut without_z = lines.next().unwrap().to_owned();
    for line in lines {
        let (rest, _) = line.rsplit_once(',').unwrap();
        without_z.push_str(&format!("\n{rest},nan"));
    }
    folder.put(RECORD, without_z + "\n");
    let command = ["diagnose", RECORD, "--bench", BENCH, "--json", "o.json"];
    let said = folder.succeed([&command[..], &["--figures", "figures"]].concat());
    assert!(said.replace('\n', " ").contains("all three axes"), "{said}");
    assert!(folder.path("figures/residual.svg").exists(), "{said}");
    // Two axes have correlations, the third is empty; a spectrum needs all.
    let correlations = folder.text("figures/residuals.svg");
    assert!(correlations.contains("of 80 autocorrelations"));
    assert_eq!(correlations.matches("no data").count(), 1);
    assert!(!folder.path("figures/residuals-2.svg").exists());
    let report = super::report(&folder, "o.json");
    assert_eq!(report.setup.len(), 1);
    assert_eq!(report.setup[0].kind, "missing");
}

#[test]
fn the_record_itself_validates_nothing() {
    let folder = folder();
    let later = ["--validate", RECORD, "--validate-bench", BENCH];
    let command = ["diagnose", RECORD, "--bench", BENCH];
    let output = folder.run([&command[..], &later].concat());
    assert_eq!(output.status.code(), Some(2));
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_says(&errors, "is the record itself");
}

#[test]
fn the_filter_of_the_paper_needs_an_attitude() {
    let folder = folder();
    folder.forget_attitude(BENCH);
    let errors = folder.fail(["diagnose", RECORD, "--bench", BENCH, "--filter", "euler"]);
    assert_says(&errors, "leave out --filter");
}

#[test]
fn a_wrong_command_line_is_a_usage_error() {
    let folder = folder();
    let cases: [(&[&str], &str); 5] = [
        (&["--false-alarm", "0"], "greater than 0 and less than 1"),
        (&["--filter", "rk4"], "[possible values: euler]"),
        (&["--effects", "filter.discretisation"], "--filter euler"),
        (&["--json", RECORD], "would overwrite the input"),
        (
            &["--figures", "new", "--json", "./new/residuals.svg"],
            "--json ./new/residuals.svg is among the pictures of --figures new",
        ),
    ];
    for (more, message) in cases {
        let arguments = [&["diagnose", RECORD, "--bench", BENCH], more].concat();
        let output = folder.run(&arguments);
        assert_eq!(output.status.code(), Some(2), "{more:?}");
        let errors = String::from_utf8(output.stderr).unwrap();
        assert!(errors.contains(message), "{message}\nis not in\n{errors}");
    }
}

#[test]
fn a_result_that_cannot_be_written_is_told_before_the_record_is_read() {
    let folder = folder();
    for command in ["calibrate", "diagnose", "plan"] {
        let mut line = vec![command, "nowhere.csv", "--bench", BENCH];
        line.extend(["--json", "nowhere/o.json"]);
        if command == "diagnose" {
            // No folder of them is left behind either.
            line.extend(["--figures", "figures"]);
        }
        let errors = folder.fail(&line);
        let expected = "nowhere/o.json: cannot be written";
        assert!(errors.contains(expected), "{errors}");
    }
}

#[test]
fn a_folder_that_cannot_be_is_refused() {
    let folder = folder();
    folder.put("taken", "");
    let errors = folder.fail(format!(
        "diagnose {RECORD} --bench {BENCH} --json o.json --figures taken"
    ));
    assert_says(&errors, "--figures taken: cannot be made");
}
