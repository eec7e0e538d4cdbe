//! Records of other programs: `--columns`, `import csv`, and tables of results.

use crate::folder::{Folder, assert_says, example};

const MAP: &str = "[file]\ndelimiter = \"semicolon\"\ndecimal = \"comma\"\n[time]\ncolumn = \"Zeit\"\n\
                   unit = \"min\"\n[accel]\ncolumns = [\"aX\", \"aY\", \"aZ\"]\nunit = \"mg\"\n";

/// The example `three_days` as another program would have written it, with its bench and map.
fn folder() -> Folder {
    let folder = Folder::new();
    let text = example("three_days.csv");
    let mut other = "Zeit;aX;aY;aZ\n".to_owned();
    for line in text.lines().skip(1) {
        let mut numbers = line.split(',').map(|field| field.parse::<f64>().unwrap());
        let time_min = numbers.next().unwrap() / 60.0;
        let mg = numbers.take(3).map(|g| format!(";{}", g * 1e3));
        other += &format!("{time_min}{}\n", mg.collect::<String>()).replace('.', ",");
    }
    folder.put("l.csv", other);
    folder.put("map.toml", MAP);
    folder.put("b.toml", example("three_days.bench.toml"));
    folder
}

/// Rows of a table, split at commas.
fn cells(text: &str) -> Vec<Vec<String>> {
    let rows = text.lines().skip(1);
    rows.map(|row| row.split(',').map(str::to_owned).collect())
        .collect()
}

#[test]
fn a_mapped_record_has_the_coefficients_of_the_record() {
    let folder = folder();
    folder.succeed("calibrate l.csv --bench b.toml --columns map.toml --no-noise --json mapped.json --coefficients mapped.csv");
    folder.put_example("three_days.csv");
    folder.succeed("calibrate three_days.csv --bench b.toml --no-noise --coefficients plain.csv");
    let [mapped, plain] = ["mapped.csv", "plain.csv"].map(|name| cells(&folder.text(name)));
    assert_eq!((mapped.len(), mapped[0].len()), (9, 5));
    for (mapped, plain) in mapped.iter().zip(&plain) {
        assert_eq!(mapped[1], plain[1]);
        let [a, b, sigma] = [&mapped[2], &plain[2], &plain[3]].map(|it| it.parse::<f64>().unwrap());
        // Units were converted there and back: the last bits of samples differ, with noise of 1e-5 g.
        assert!((a - b).abs() < 1e-6 * sigma, "{mapped:?} {plain:?}");
    }
    let json: serde_json::Value = folder.json("mapped.json");
    assert_eq!(json["manifest"]["inputs"][2]["path"], "map.toml");
}

#[test]
#[cfg(target_os = "linux")]
fn a_pipe_is_read_once_and_whole() {
    let folder = Folder::new();
    folder.put_example("three_days.csv");
    folder.put("b.toml", example("three_days.bench.toml"));
    let of = |record: &str, table: &str| {
        let all = format!("calibrate {record} --bench b.toml --json r.json --coefficients {table}");
        let output = folder.run_with_stdin(all, "three_days.csv");
        assert!(output.status.success(), "{output:?}");
        let json: serde_json::Value = folder.json("r.json");
        let hash = json["manifest"]["inputs"][0]["sha256"].clone();
        (folder.text(table), hash)
    };
    assert_eq!(
        of("/dev/stdin", "pipe.csv"),
        of("three_days.csv", "file.csv")
    );
}

#[test]
fn a_record_without_its_map_is_refused_with_one() {
    let folder = folder();
    let errors = folder.fail("diagnose l.csv --bench b.toml");
    let command = "gyrocal import csv l.csv --propose MAP.toml";
    let told = errors
        .split_whitespace()
        .filter(|word| *word != "│")
        .collect::<Vec<_>>()
        .join(" ");
    assert!(
        told.contains(command) && told.contains("l.csv:1:5"),
        "{errors}"
    );
    // Followed to the letter.
    let proposed = folder.succeed(command.trim_start_matches("gyrocal "));
    assert_says(&proposed, "MAP PROPOSED");
    assert_says(&proposed, "4321 rows");
    for line in ["unit = \"mg\"", "unit = \"min\"", "decimal = \"comma\""] {
        assert!(
            folder.text("MAP.toml").contains(line),
            "{}",
            folder.text("MAP.toml")
        );
    }
    folder.succeed("calibrate l.csv --bench b.toml --columns MAP.toml --no-noise");
    folder.put("map.toml", MAP.replace("decimal = \"comma\"\n", ""));
    let arguments = "diagnose l.csv --bench b.toml --columns map.toml";
    let errors = folder.fail(arguments);
    assert_says(&errors, "`decimal = \"comma\"`");
    folder.put("map.toml", MAP.replace("aZ", "az"));
    let errors = folder.fail(arguments);
    assert_says(&errors, "a column `az`");
    assert_says(&errors, "Zeit, aX, aY, aZ");
}

#[test]
fn an_imported_record_is_read_by_every_command() {
    let folder = folder();
    let import = "import csv l.csv --columns map.toml --out r.csv";
    let text = folder.succeed(import);
    assert_says(&text, "4321 rows");
    folder.succeed("calibrate r.csv --bench b.toml --no-noise");
    let errors = folder.fail(format!("{import} --average 60"));
    assert_says(&errors, "calibrate --average");
}

#[test]
fn a_clock_that_begins_again_is_split_to_the_letter() {
    let folder = Folder::new();
    let text = example("three_days.csv");
    let mut parts = text
        .lines()
        .take(1)
        .map(str::to_owned)
        .collect::<Vec<String>>();
    for (row, line) in text.lines().skip(1).enumerate() {
        let (time, rest) = line.split_once(',').unwrap();
        let back_s = if row < 2000 { 0.0 } else { 120_000.0 };
        parts.push(format!("{},{rest}", time.parse::<f64>().unwrap() - back_s));
    }
    folder.put("logged.csv", parts.join("\n") + "\n");
    let bench = example("three_days.bench.toml");
    folder.put("BENCH.toml", &bench);
    folder.put("FREE.toml", &bench);
    folder.forget_attitude("FREE.toml");
    for command in ["diagnose", "calibrate"] {
        let said = folder.run([command, "logged.csv", "--bench", "BENCH.toml"]);
        let said = [said.stdout, said.stderr]
            .map(|text| String::from_utf8(text).unwrap())
            .concat();
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert_says(&said, "logged.csv:2002");
        assert_says(
            &said,
            "gyrocal import csv logged.csv --split --out PART.csv",
        );
    }
    let answer = folder.succeed("import csv logged.csv --split --out PART.csv");
    let answer = answer.split_whitespace().collect::<Vec<_>>().join(" ");
    let next = "calibrate PART.1.csv PART.2.csv --bench BENCH.toml --bench FREE.toml";
    assert!(answer.contains(next), "{answer}");
    folder.succeed(next);
    assert_eq!(folder.text("PART.2.csv").lines().count(), 2322);
}

#[test]
fn findings_are_a_table_of_their_parameters() {
    let folder = Folder::new();
    folder.put_example("hidden_fault.csv");
    folder.put_example("hidden_fault.bench.toml");
    folder.succeed("diagnose hidden_fault.csv --bench hidden_fault.bench.toml --findings f.csv --coefficients c.csv");
    let findings = cells(&folder.text("f.csv"));
    assert_eq!(findings[0][0], "gyro_y.g_z");
    let coefficients = cells(&folder.text("c.csv"));
    let of = |model: &str| coefficients.iter().filter(|row| row[0] == model).count();
    assert_eq!([of("nominal"), of("extended")], [9, 9]);
}
