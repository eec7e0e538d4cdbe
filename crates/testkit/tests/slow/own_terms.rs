//! The terms of docs/adding-a-term.md, one of each kind: added to a copy of the workspace, hidden in
//! simulated records and searched for; and programs in a copy.

use std::fs;
use std::path::Path;

use gyrocal_testkit::{Outcome, WorkspaceCopy, run};

/// Hides each effect in a record of three days of its own, diagnoses the records side by side and
/// prints a line for each: id, whether it is the one finding, and for each parameter its name and the distance of the
/// estimate from the truth in standard deviations.
const FINDER: &str = r#"
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_truth::{
    Coefficients, InitialAttitude, Moment, Scenario, Temperature, Term, simulate_with,
};

type Add = fn(&Moment) -> [f64; 3];

const HOUR_S: f64 = 3600.0;
const DAY_S: f64 = 86_400.0;

/// Id, whether it adds to a drift or to an output, the addition and the true parameters.
type Case = (&'static str, bool, Add, &'static [(&'static str, f64)]);

fn main() {
    let cases: [Case; 4] = [
        (
            "gyro_x.g_xyz",
            true,
            |m| [0.2 * m.accel_g[0] * m.accel_g[1] * m.accel_g[2], 0.0, 0.0],
            &[("size", 0.2)],
        ),
        (
            "gyro_y.late_ramp",
            true,
            |m| [0.0, 0.01 * (m.time_s - 30.0 * HOUR_S).max(0.0) / DAY_S, 0.0],
            &[("size", 0.01), ("onset_s", 30.0 * HOUR_S)],
        ),
        (
            "accel_z.warmup",
            false,
            |m| [0.0, 0.0, 2e-4 * (-m.time_s / (4.0 * HOUR_S)).exp()],
            &[("size", 2e-4), ("time_constant_h", 4.0)],
        ),
        (
            "gyro_z.g_x_temperature",
            true,
            |m| [0.0, 0.0, 0.02 * m.accel_g[0] * m.temperature_k],
            &[("size", 0.02)],
        ),
    ];
    std::thread::scope(|scope| {
        let searches = (5..).zip(cases).map(|(seed, case)| scope.spawn(move || search(seed, case)));
        for search in searches.collect::<Vec<_>>() {
            println!("{}", search.join().unwrap());
        }
    });
}

/// The line of one record.
fn search(seed: u64, (id, drift, add, truth): Case) -> String {
    let term = if drift {
        Term::Drift(Box::new(add))
    } else {
        Term::Output(Box::new(add))
    };
    let scenario = Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        duration_s: 3.0 * DAY_S,
        interval_s: 120.0,
        temperature: Some(Temperature::default()),
        ..Scenario::default()
    };
    let simulation = simulate_with(&scenario, &[term]).unwrap();
    let options = DiagnoseOptions::default();
    let found = diagnose(&simulation.record, &simulation.bench, &options).unwrap().result;
    let only = found.findings.len() == 1 && found.findings[0].effect == id;
    let mut line = format!("{id} {only}");
    for finding in found.findings.iter().filter(|finding| finding.effect == id) {
        for (name, truth) in truth {
            let parameter = finding.parameter(name).unwrap();
            let distance = (parameter.estimate - truth).abs() / parameter.sigma.unwrap_or(f64::NAN);
            line.push_str(&format!(" {name} {distance:e}"));
        }
    }
    let names: Vec<&str> = found.findings.iter().map(|f| f.effect.as_str()).collect();
    eprintln!("{id}: found {names:?}");
    line
}
"#;

/// One parameter of a term.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FoundParameter {
    /// Its name.
    pub(crate) name: String,
    distance: f64,
}

impl FoundParameter {
    /// Distance of the estimate from the truth in standard deviations.
    pub(crate) fn distance(&self) -> f64 {
        self.distance
    }
}

/// The diagnosis of a record with one hidden term.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FoundTerm {
    /// Public id of the term.
    pub(crate) id: String,
    /// Whether it is the one finding.
    pub(crate) only: bool,
    /// Its parameters; empty if it was not found.
    pub(crate) parameters: Vec<FoundParameter>,
}

impl FoundTerm {
    /// Whether it is the one finding, with every parameter within this number of standard
    /// deviations.
    pub(crate) fn is_within(&self, sigmas: f64) -> bool {
        let mut parameters = self.parameters.iter();
        self.only
            && !self.parameters.is_empty()
            && parameters.all(|parameter| parameter.distance() < sigmas)
    }
}

/// The code block of a page that follows a heading.
pub(crate) fn code_block(page: &str, heading: &str) -> String {
    let page = page.replace("\r\n", "\n");
    let (_, section) = page.split_once(heading).unwrap();
    let (_, entry) = section.split_once("```python\n").unwrap();
    entry.split_once("```").unwrap().0.to_owned()
}

/// Adds entries and those of the page to the catalogue of a copy.
pub(crate) fn add_own_terms(copy: &WorkspaceCopy, entries: &str) {
    let page = fs::read_to_string(copy.root.join("docs/adding-a-term.md")).unwrap();
    let of_page = code_block(&page, "## One of each kind\n");
    copy.edit(
        "codegen/derive/catalogue.py",
        "\nEFFECTS = [\n",
        &format!("\nEFFECTS = [\n{entries}{of_page}"),
    );
}

/// Builds a program in a copy with these terms that searches for them with `cargo`; its findings.
pub(crate) fn find_own_terms(
    copy: &WorkspaceCopy,
    cargo: impl FnOnce(&Path) -> std::process::Command,
) -> Vec<FoundTerm> {
    add_program(
        copy,
        "own-terms",
        &[
            // With its default features: those that derive.
            ("gyrocal", "../.."),
            ("gyrocal-diagnosis", "../diagnosis"),
            ("gyrocal-truth", "../truth"),
        ],
        FINDER,
    );
    let mut command = cargo(&copy.root);
    let Outcome { stdout, .. } = run(command.args(["--package", "own-terms"])).succeeded();
    stdout.lines().map(found_term).collect()
}

fn found_term(line: &str) -> FoundTerm {
    let words: Vec<&str> = line.split(' ').collect();
    let parameters = words[2..].chunks(2).map(|parameter| FoundParameter {
        name: parameter[0].to_owned(),
        distance: parameter[1].parse().unwrap(),
    });
    FoundTerm {
        id: words[0].to_owned(),
        only: words[1] == "true",
        parameters: parameters.collect(),
    }
}

/// Adds a program `probe` to a copy that uses the library.
pub(crate) fn add_probe(copy: &WorkspaceCopy, main: &str) {
    add_program(copy, "probe", &[("gyrocal", "../..")], main);
}

/// Adds a program to a copy that uses packages of it, by name and path from the program.
pub(crate) fn add_program(copy: &WorkspaceCopy, name: &str, packages: &[(&str, &str)], main: &str) {
    let package = copy.root.join("crates").join(name);
    fs::create_dir_all(package.join("src")).unwrap();
    let mut manifest =
        format!("[package]\nname = \"{name}\"\nedition = \"2024\"\n\n[dependencies]\n");
    for (package, path) in packages {
        manifest.push_str(&format!("{package} = {{ path = \"{path}\" }}\n"));
    }
    fs::write(package.join("Cargo.toml"), manifest).unwrap();
    fs::write(package.join("src/main.rs"), main).unwrap();
}
