//! Instructions of one step, counted by callgrind on the example `filter_steps`, and on
//! `factorised_steps` for information.
//!
//! The number belongs to a compiler version and a plain build; with another one the figure is
//! printed and not judged. `cargo figures kernel --part filter --write` renews the committed numbers.

use std::path::{Path, PathBuf};
use std::process::Command;

use gyrocal_testkit::{Tool, tool};
use serde::{Deserialize, Serialize};

use super::{Error, RULES};
use crate::figure::Figure;

const COMMITTED: &str = "tests/data/numerics/instructions.toml";
/// Multiples of 64, the number of turns after which a chart is orthonormalised.
const STEPS: [u32; 2] = [512, 2560];
/// Relative.
const TOLERANCE: f64 = 0.02;

/// Committed counts, with compiler and target.
#[derive(Debug, Deserialize, Serialize)]
struct Counts {
    /// `rustc --version`.
    rustc: String,
    /// Architecture and operating system.
    target: String,
    /// Instructions of an Euler step.
    euler: f64,
    /// Instructions of a Runge-Kutta step.
    rk4: f64,
}

/// Counts of both forms.
struct Counted {
    /// Counts of the default form, which are committed.
    counts: Counts,
    /// Instructions of an Euler and a Runge-Kutta step on the factors.
    factors: [f64; 2],
}

/// Counts and compares with the committed numbers; without valgrind a note with the reason.
pub(crate) fn figures() -> Result<Vec<Figure>, Error> {
    let Counted {
        counts: counted,
        factors,
    } = match counted()? {
        Ok(counted) => counted,
        Err(reason) => return Ok(vec![skipped(&reason)]),
    };
    let text = std::fs::read_to_string(root().join(COMMITTED)).map_err(|error| {
        format!("{COMMITTED}: {error}; cargo figures kernel --part filter --write makes it")
    })?;
    let committed: Counts =
        toml::from_str(&text).map_err(|error| format!("{COMMITTED}: {error}"))?;
    let same = committed.rustc == counted.rustc && committed.target == counted.target;
    let mut figures = Vec::new();
    for (rule, measured, expected) in [
        ("euler", counted.euler, committed.euler),
        ("rk4", counted.rk4, committed.rk4),
    ] {
        let what = format!("{rule} step: instructions under callgrind");
        figures.push(Figure {
            name: what,
            target: format!("{expected:.0} within {} %", TOLERANCE * 100.0),
            measured: format!("{measured:.0}"),
            runs: 1,
            seeds: String::new(),
            holds: same.then(|| (measured / expected - 1.0).abs() <= TOLERANCE),
            ..Figure::default()
        });
    }
    for ((rule, _), count) in RULES.iter().zip(factors) {
        let what = format!("{rule} step on the factors: instructions under callgrind");
        figures.push(Figure::note(&what, format!("{count:.0}")));
    }
    if !same {
        figures.push(skipped(&format!(
            "they belong to {} on {}, this is {} on {}; `cargo figures kernel --part filter --write` renews them",
            committed.rustc, committed.target, counted.rustc, counted.target
        )));
    }
    Ok(figures)
}

/// Counts and writes the committed numbers.
pub(crate) fn renewed() -> Result<Vec<Figure>, Error> {
    let Counted {
        counts: counted, ..
    } = counted()??;
    let text = format!(
        "# Instructions of one filter step under callgrind, in a plain release build by this\n\
         # compiler. `cargo figures kernel --part filter --write` renews them.\n{}",
        toml::to_string(&counted)?
    );
    std::fs::write(root().join(COMMITTED), text)?;
    let note = |rule: &str, count: f64| {
        Figure::note(
            &format!("{rule} step: instructions, written"),
            format!("{count:.0}"),
        )
    };
    Ok(vec![note("euler", counted.euler), note("rk4", counted.rk4)])
}

fn skipped(reason: &str) -> Figure {
    Figure::note("instructions not judged", reason.to_owned())
}

pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The counts, or the reason why they are not available here.
fn counted() -> Result<Result<Counted, String>, Error> {
    let flags = [
        "RUSTFLAGS",
        "CARGO_ENCODED_RUSTFLAGS",
        "CARGO_BUILD_RUSTFLAGS",
    ];
    if let Some(flags) = flags.iter().find(|flags| std::env::var_os(flags).is_some()) {
        return Ok(Err(format!(
            "they belong to a plain build, and {flags} is set"
        )));
    }
    let Some(valgrind) = tool(Tool::Valgrind) else {
        return Ok(Err(Tool::Valgrind.missing()));
    };
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let rustc = output(Command::new(compiler).arg("--version"))?
        .trim()
        .to_owned();
    let [euler, rk4] = counts_of(&valgrind, "filter_steps")?;
    let factors = counts_of(&valgrind, "factorised_steps")?;
    let target = format!("{} {}", std::env::consts::ARCH, std::env::consts::OS);
    let counts = Counts {
        rustc,
        target,
        euler,
        rk4,
    };
    Ok(Ok(Counted { counts, factors }))
}

/// Instructions of a step of an example, by rule.
fn counts_of(valgrind: &Path, example: &str) -> Result<[f64; 2], Error> {
    let program = built(example)?;
    let mut counts = [0.0_f64; 2];
    for (count, (rule, _)) in counts.iter_mut().zip(RULES) {
        let of = |steps: u32| instructions(valgrind, &program, &[rule, &steps.to_string()]);
        let [few, many] = [of(STEPS[0])?, of(STEPS[1])?];
        *count = ((many - few) / f64::from(STEPS[1] - STEPS[0])).round();
    }
    Ok(counts)
}

/// Builds an example; returns its path.
fn built(example: &str) -> Result<PathBuf, Error> {
    let messages = output(
        Command::new(cargo())
            .current_dir(root())
            .args(["build", "--release", "--quiet", "--package", "gyrocal"])
            .args(["--example", example, "--message-format", "json"]),
    )?;
    let path = messages.lines().find_map(|line| {
        let (_, rest) = line.split_once("\"executable\":\"")?;
        Some(PathBuf::from(rest.split('"').next()?))
    });
    path.ok_or_else(|| format!("cargo built no example {example}").into())
}

/// All instructions of a run of a program, counted by callgrind.
pub(crate) fn instructions(
    valgrind: &Path,
    program: &Path,
    arguments: &[&str],
) -> Result<f64, Error> {
    let report = output(
        Command::new(valgrind)
            .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
            .arg(program)
            .args(arguments),
    )?;
    let collected = report
        .lines()
        .find_map(|line| line.split_once("Collected :"));
    let (_, count) = collected.ok_or("callgrind printed no line `Collected :`")?;
    Ok(count.trim().parse()?)
}

/// The cargo that runs this program.
pub(crate) fn cargo() -> std::ffi::OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// Both outputs of a command that succeeds.
pub(crate) fn output(command: &mut Command) -> Result<String, Error> {
    let output = command
        .output()
        .map_err(|error| format!("{command:?}: {error}"))?;
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    if !output.status.success() {
        return Err(format!("{command:?} failed: {}", text(&output.stderr)).into());
    }
    Ok(text(&output.stdout) + &text(&output.stderr))
}
