//! Builds of a copy of the whole workspace with cargo, as a user starts them.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, MutexGuard, PoisonError};

use gyrocal_codegen::build::{Settings, Variant};
use gyrocal_testkit::{
    Outcome, WorkspaceCopy, cargo, fresh_directory, real_environments, run, snapshot,
};

use crate::SCRATCH;
use crate::no_python::tools_only;
use crate::own_terms::{add_own_terms, add_probe, add_program, code_block, find_own_terms};

/// Prints the rates of drift by the squares of specific force alone, each with its
/// derivatives by the coefficients.
const PROBE: &str = r#"
use gyrocal::generated::platform::{dynamics, dynamics_jacobian};

fn main() {
    let theta = [0.3, -0.2, 0.5];
    let drift = [0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0, -1.0];
    let (omega_0, f_0) = ([0.0; 3], [0.0, 0.6, 0.8]);
    let rates: [f64; 3] = dynamics(&theta, &drift, &omega_0, &f_0);
    let by_drift = dynamics_jacobian(&theta, &drift, &omega_0, &f_0).theta_dot_d_drift_dense();
    for (rate, row) in rates.iter().zip(by_drift) {
        print!("{rate:e}");
        for entry in row {
            print!(" {entry:e}");
        }
        println!();
    }
}
"#;

/// The one copy, equal to the workspace but for the probe. The tests take turns: cargo
/// names artefacts by paths inside a workspace, so that several copies would only undo
/// each other's builds.
fn take_copy() -> (WorkspaceCopy, MutexGuard<'static, ()>) {
    static TURN: Mutex<()> = Mutex::new(());
    let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
    let copy = WorkspaceCopy::make(SCRATCH, "builds");
    add_probe(&copy, PROBE);
    (copy, turn)
}

fn target(name: &str) -> PathBuf {
    Path::new(SCRATCH).join("builds").join(name)
}

/// Cargo with all optimisation off: these builds are made once and run once.
fn quick_cargo(copy: &WorkspaceCopy, target: &Path, action: &str) -> Command {
    let mut command = cargo(&copy.root, target);
    command.args([
        action,
        "--offline",
        "--config",
        "profile.dev.package.'*'.opt-level=0",
    ]);
    command
        .env("CARGO_PROFILE_DEV_OPT_LEVEL", "0")
        .env("CARGO_PROFILE_DEV_DEBUG", "0");
    command
}

fn build(copy: &WorkspaceCopy, target: &Path) -> Command {
    let mut command = quick_cargo(copy, target, "build");
    command.args(["--package", "gyrocal"]);
    command
}

/// Rows of the probe, and the output of cargo.
fn probe(copy: &WorkspaceCopy) -> (Vec<Vec<f64>>, String) {
    let mut command = quick_cargo(copy, &target("target"), "run");
    let Outcome { stdout, stderr, .. } = run(command.args(["--package", "probe"])).succeeded();
    assert!(!stderr.contains("unexpected `cfg`"), "{stderr}");
    let number = |text: &str| text.parse::<f64>().unwrap();
    let rows = stdout
        .lines()
        .map(|line| line.split(' ').map(number).collect());
    (rows.collect(), stderr)
}

#[test]
fn without_python_an_unchanged_copy_builds_and_an_edited_one_says_what_to_do() {
    let (copy, _turn) = take_copy();
    let path = tools_only(Path::new(SCRATCH).join("tools-only"));
    let environments = fresh_directory(Path::new(SCRATCH).join("no-python-environments"));
    let build = || {
        let mut command = build(&copy, &target("target"));
        command
            .env("PATH", &path)
            .env("GYROCAL_CODEGEN_ENV_DIR", &environments);
        command
    };
    let first = run(&mut build()).succeeded();
    assert!(!first.stderr.contains("is stale"), "{}", first.stderr);
    // Nothing that the build script watches makes it run again.
    let second = run(build().arg("--verbose")).succeeded();
    assert!(
        second.stderr.contains("Fresh gyrocal v"),
        "{}",
        second.stderr
    );

    // An edit that no other test makes: a model that was derived once needs no Python either.
    copy.edit(
        "codegen/derive/drift.py",
        "square * a**2",
        "3 * square * a**2",
    );
    let before = snapshot(&copy.root);
    run(&mut build()).failed_with(&[
        "`src/generated/platform.rs` is stale",
        "no suitable Python: found none in PATH",
        "export GYROCAL_PYTHON=",
    ]);
    assert_eq!(snapshot(&copy.root), before, "something was written");
    assert!(
        snapshot(&environments).is_empty(),
        "an environment was begun"
    );

    // Embedders compile the committed model, whatever was edited, and no emitter.
    let embedded = run(build().args(["--no-default-features", "--verbose"])).succeeded();
    assert!(
        !embedded.stderr.contains("gyrocal-codegen"),
        "{}",
        embedded.stderr
    );
    assert!(
        !embedded.stderr.contains("unexpected `cfg`"),
        "{}",
        embedded.stderr
    );
}

#[test]
fn an_edited_derivation_changes_the_compiled_dynamics() {
    let (copy, _turn) = take_copy();
    let (before, _) = probe(&copy);
    let committed = snapshot(&copy.root.join("src"));

    copy.edit(
        "codegen/derive/drift.py",
        "square * a**2",
        "2 * square * a**2",
    );
    let sources = snapshot(&copy.derivation());
    let (after, warnings) = probe(&copy);
    assert!(warnings.contains("is stale"), "{warnings}");
    assert!(warnings.contains("cargo codegen write"), "{warnings}");
    for (before, after) in before.iter().zip(&after) {
        for (column, (before, after)) in before.iter().zip(after).enumerate() {
            // Column 0 is the rate; every third coefficient multiplies a square.
            let factor = if column % 3 == 0 { 2.0 } else { 1.0 };
            // Regrouping of products may change the last bits of a double.
            let tolerance = 1e-14 * before.abs();
            assert!(
                (after - factor * before).abs() <= tolerance,
                "{before} {after}"
            );
        }
        assert!(before[0] != 0.0);
    }
    assert_eq!(
        snapshot(&copy.root.join("src")),
        committed,
        "the build wrote into the sources"
    );
    assert_eq!(
        snapshot(&copy.derivation()),
        sources,
        "byte code in the sources"
    );
    let again = run(build(&copy, &target("target")).arg("--verbose")).succeeded();
    assert!(again.stderr.contains("Fresh gyrocal v"), "{}", again.stderr);

    copy.edit(
        "codegen/derive/drift.py",
        "2 * square * a**2",
        "square * a**2",
    );
    let (restored, warnings) = probe(&copy);
    assert_eq!(restored, before);
    assert!(!warnings.contains("is stale"), "{warnings}");

    // A hand edit of the committed file does not reach the library, and is reported.
    copy.edit(
        "src/generated/platform.rs",
        "pub fn dynamics<",
        "pub fn dinamics<",
    );
    let (repaired, warnings) = probe(&copy);
    assert_eq!(repaired, before);
    assert!(
        warnings.contains("src/generated/platform.rs` is damaged"),
        "{warnings}"
    );
}

/// Prints the term of docs/adding-a-term.md as it is in the catalogue: its row, and the derivatives
/// of the drift of gyro x by its two parameters, over its period.
const LINE_PROBE: &str = r#"
use gyrocal::generated::catalogue::{CatalogueInputs, PARAMETERS, conditions_index};
use gyrocal::scalar::{Model, NamedInputs, RatesJacobian};
use gyrocal::{Catalogue, EFFECTS};

fn main() {
    let row = EFFECTS.iter().find(|row| row.id == "gyro_x.line").unwrap();
    let places: Vec<usize> = row.model_parameters().collect();
    let ids: Vec<&str> = places.iter().map(|place| PARAMETERS[*place].id).collect();
    println!("{:?} {:?} {}", row.kind, row.enters, ids.join(" "));
    let mut inputs = CatalogueInputs::filled(1.0);
    for part in 0..8 {
        inputs.conditions[conditions_index::TIME_S] = 5.3 * 3600.0 * f64::from(part) / 8.0;
        let mut parameters = vec![0.0; 3 * PARAMETERS.len()];
        let mut jacobian = RatesJacobian {
            moving: [[0.0; 3]; 3],
            noise: [[0.0; 3]; 3],
            parameters: &mut parameters,
        };
        let none = [0.0; PARAMETERS.len()];
        Catalogue.rates_jacobian(&[0.0; 3], &none, &inputs, &mut jacobian);
        let of = |rate: usize, place: usize| jacobian.parameters[rate * PARAMETERS.len() + place];
        println!("{:e} {:e} {:e}", of(0, places[0]), of(0, places[1]), of(1, places[0]));
    }
}
"#;

/// Hides that line in a record of two days and prints the diagnosis: its verdict, each finding with
/// its parameters and sigmas, and the gain.
const LINE_FINDER: &str = r#"
use gyrocal_diagnosis::{DiagnoseOptions, diagnose};
use gyrocal_truth::{Coefficients, Hidden, InitialAttitude, Scenario, simulate};

fn main() {
    let line = [("size", 0.02), ("period_h", 5.3), ("phase_deg", 30.0)];
    let simulation = simulate(&Scenario {
        seed: 3,
        coefficients: Coefficients::PAPER_LIKE,
        initial: InitialAttitude::Random,
        duration_s: 2.0 * 86_400.0,
        interval_s: 240.0,
        hidden: vec![Hidden::new("gyro_x.tone", &line).unwrap()],
        ..Scenario::default()
    })
    .unwrap();
    let options = DiagnoseOptions::default();
    let found = diagnose(&simulation.record, &simulation.bench, &options).unwrap().result;
    println!("{:?} {}", found.verdict, found.is_unexplained());
    for finding in &found.findings {
        print!("{}", finding.effect);
        for parameter in &finding.parameters {
            print!(" {} {:e} {:e}", parameter.name, parameter.estimate, parameter.sigma.unwrap());
        }
        println!();
    }
    let gain = found.gain.unwrap();
    let rms_g = gain.free_run_rms_g.unwrap();
    let nats = gain.cross_validated_log_score_nats;
    println!("{nats:e} {:e} {:e} {:e}", rms_g.before, rms_g.after, rms_g.noise);
}
"#;

#[test]
fn terms_of_ones_own_are_entries_of_the_catalogue_and_a_build() {
    let (copy, _turn) = take_copy();
    let page = copy.root.join("docs/adding-a-term.md");
    let page = std::fs::read_to_string(page).unwrap();
    let entry = code_block(&page, "# Adding a term\n");
    // One build for the line and for the terms of each kind.
    add_own_terms(&copy, &entry);
    add_probe(&copy, LINE_PROBE);
    let mut command = quick_cargo(&copy, &target("target"), "run");
    command.args(["--package", "probe", "--features", "gyrocal/catalogue"]);
    let outcome = run(&mut command).succeeded();
    assert!(outcome.stderr.contains("is stale"), "{}", outcome.stderr);
    let mut lines = outcome.stdout.lines();
    assert_eq!(
        lines.next(),
        Some("Periodic Rates([0]) gyro_x.line.sine gyro_x.line.cosine")
    );
    let deg_per_h = (1.0_f64 / 3600.0).to_radians();
    for part in 0..8 {
        let numbers = lines.next().unwrap().split(' ');
        let numbers: Vec<f64> = numbers.map(|text| text.parse().unwrap()).collect();
        let (sine, cosine) = (f64::from(part) * std::f64::consts::TAU / 8.0).sin_cos();
        for (given, expected) in numbers.iter().zip([sine, cosine, 0.0]) {
            // Numbers of 5e-6; a phase of up to 6 rad is right to some 1e-15.
            let difference = (given - expected * deg_per_h).abs();
            assert!(difference < 1e-14 * deg_per_h, "part {part}: {numbers:?}");
        }
    }

    // It is found in data, with its size, and predicts them better.
    add_program(
        &copy,
        "finder",
        &[
            // With its default features: those that derive.
            ("gyrocal", "../.."),
            ("gyrocal-diagnosis", "../diagnosis"),
            ("gyrocal-truth", "../truth"),
        ],
        LINE_FINDER,
    );
    let mut command = quick_cargo(&copy, &target("target"), "run");
    let found = run(command.args(["--package", "finder"]))
        .succeeded()
        .stdout;
    let lines: Vec<&str> = found.lines().collect();
    assert_eq!(lines.len(), 3, "{found}");
    assert_eq!(lines[0], "EffectsFound false");
    let words: Vec<&str> = lines[1].split(' ').collect();
    assert_eq!(
        [words[0], words[1], words[4]],
        ["gyro_x.line", "sine", "cosine"]
    );
    let number = |text: &str| text.parse::<f64>().unwrap();
    let (sine, cosine) = 30.0_f64.to_radians().sin_cos();
    for (place, truth) in [(2, 0.02 * cosine), (5, 0.02 * sine)] {
        // One in sixteen thousand is farther off than four sigmas.
        let [estimate, sigma] = [place, place + 1].map(|place| number(words[place]));
        assert!((estimate - truth).abs() < 4.0 * sigma, "{found}");
    }
    let gain: Vec<f64> = lines[2].split(' ').map(number).collect();
    // A line of some 30 sigmas of a sample in the readings: hundreds of nats, and a free run that
    // misses by little more than noise where it missed by several times that.
    assert!(gain[0] > 100.0 && gain[2] < 0.5 * gain[1], "{found}");
    assert!(gain[2] < 3.0 * gain[3], "{found}");

    // Terms of each kind, with their onsets and time constants.
    let found = find_own_terms(&copy, |_| quick_cargo(&copy, &target("target"), "run"));
    assert_eq!(found.len(), 4, "{found:?}");
    for term in &found {
        assert!(term.is_within(3.0), "{found:#?}");
    }

    // A model of one's own can have it too.
    let file = copy.root.join("with_line.model.toml");
    let text = "schema_version = 1\neffects = [\"gyro_x.line\"]\n";
    std::fs::write(&file, text).unwrap();
    let mut settings = Settings::from_env();
    settings.environments = Some(real_environments());
    settings.offline = false;
    let out_dir = fresh_directory(Path::new(SCRATCH).join("with-line"));
    let variant = Variant::open(copy.derivation(), &file).unwrap();
    variant.with_settings(settings).build(&out_dir).unwrap();
    let module = std::fs::read_to_string(out_dir.join("with_line.rs")).unwrap();
    assert!(module.contains("pub const GYRO_X_LINE_COSINE: usize = 10;"));
}

/// Two builds with directories of their own (one of them for a named target) that need the
/// same environment at the same time.
#[test]
fn two_cargo_processes_at_once() {
    let (copy, _turn) = take_copy();
    let environments = fresh_directory(Path::new(SCRATCH).join("two-cargos-environments"));
    let host = run(Command::new("rustc").args(["--print", "host-tuple"]))
        .succeeded()
        .stdout;
    let builds = || {
        let mut plain = build(&copy, &target("target"));
        let mut named = build(&copy, &target("other-target"));
        named.args(["--target", host.trim()]);
        for command in [&mut plain, &mut named] {
            command.env("GYROCAL_CODEGEN_ENV_DIR", &environments);
        }
        [plain, named]
    };
    // Everything else first, so that both come to the environment together.
    for mut command in builds() {
        run(&mut command).succeeded();
    }
    assert!(
        snapshot(&environments).is_empty(),
        "an unchanged copy needs no environment"
    );
    copy.edit(
        "codegen/derive/drift.py",
        "square * a**2",
        "2 * square * a**2",
    );
    std::thread::scope(|scope| {
        let running = builds().map(|mut command| scope.spawn(move || run(&mut command)));
        for process in running {
            let outcome = process.join().unwrap().succeeded();
            assert!(outcome.stderr.contains("is stale"), "{}", outcome.stderr);
        }
    });
    std::fs::remove_dir_all(environments).unwrap(); // 375 MB
}
