//! Instructions of one step, counted by callgrind on the example `filter_steps` of this package.
//!
//! The number belongs to a compiler version and a plain build; with another one the figure is
//! printed and not judged. `cargo figures kernel --part filter --write` renews the committed numbers.

use std::path::{Path, PathBuf};
use std::process::Command;

pub(crate) use gyrocal_testkit::workspace as root;
use gyrocal_testkit::{Tool, tool};
use serde::{Deserialize, Serialize};

use super::RULES;
use crate::harness::{Error, Figure};

const COMMITTED: &str = "tests/data/numerics/instructions.toml";
/// A multiple of 64, the number of turns after which a chart is orthonormalised.
const STEPS: u32 = 512;
/// Relative.
const TOLERANCE: f64 = 0.02;

/// Variables with flags of the compiler.
const FLAGS: &str = "RUSTFLAGS CARGO_ENCODED_RUSTFLAGS CARGO_BUILD_RUSTFLAGS";

/// Counts of a step by the rules, with compiler and target.
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

/// Counts and compares with the committed numbers, which `write` renews; without valgrind a note with the reason.
pub(crate) fn figures(write: bool) -> Result<Vec<Figure>, Error> {
    let not_judged = |reason| Figure::note("instructions not judged", reason);
    let counted = match counted()? {
        Ok(counted) => counted,
        Err(reason) => return Ok(vec![not_judged(reason)]),
    };
    let path = root().join(COMMITTED);
    if write {
        let text = toml::to_string(&counted)?;
        let text = format!(
            "# Instructions of one filter step under callgrind, in a plain release build by this\n\
             # compiler. `cargo figures kernel --part filter --write` renews them.\n{text}"
        );
        std::fs::write(&path, text)?;
    }
    let committed: Counts = toml::from_str(&std::fs::read_to_string(&path)?)?;
    let [here, there] = [&counted, &committed].map(|of| format!("{} on {}", of.rustc, of.target));
    let mut figures = Vec::new();
    for (rule, measured, expected) in [
        ("euler", counted.euler, committed.euler),
        ("rk4", counted.rk4, committed.rk4),
    ] {
        let range = [1.0 - TOLERANCE, 1.0 + TOLERANCE].map(|bound| bound * expected);
        let name = format!("{rule} step: instructions under callgrind");
        let target = format!("{expected:.0} within {} %", TOLERANCE * 100.0);
        let holds = (range[0]..=range[1]).contains(&measured);
        let figure = Figure::told(&name, &target, format!("{measured:.0}"), holds);
        figures.push(figure.judged(here == there));
    }
    if here != there {
        figures.push(not_judged(format!(
            "they belong to {there}, this is {here}; `cargo figures kernel --part filter --write` renews them"
        )));
    }
    Ok(figures)
}

/// The counts, or the reason why they are not available here.
fn counted() -> Result<Result<Counts, String>, Error> {
    let mut flags = FLAGS.split(' ');
    if let Some(flags) = flags.find(|flags| std::env::var_os(flags).is_some()) {
        let why = format!("they belong to a plain build, and {flags} is set");
        return Ok(Err(why));
    }
    let Some(valgrind) = tool(Tool::Valgrind) else {
        return Ok(Err(Tool::Valgrind.missing()));
    };
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let rustc = output(Command::new(compiler).arg("--version"))?;
    let program = filter_steps()?;
    let count =
        |rule: &str, steps: u32| instructions(&valgrind, &program, &[rule, &steps.to_string()]);
    let start = count("euler", 0)?;
    let of = |rule| Ok::<_, Error>(((count(rule, STEPS)? - start) / f64::from(STEPS)).round());
    let [(euler, _), (rk4, _)] = RULES;
    Ok(Ok(Counts {
        rustc: rustc.trim().to_owned(),
        target: format!("{} {}", std::env::consts::ARCH, std::env::consts::OS),
        euler: of(euler)?,
        rk4: of(rk4)?,
    }))
}

/// Builds the example; returns its path. What it depends on is built with this program.
fn filter_steps() -> Result<PathBuf, Error> {
    let build = "build --release --quiet --example filter_steps --message-format json --package";
    let mut command = Command::new(cargo());
    command.current_dir(root()).args(build.split(' '));
    let messages = output(command.arg(env!("CARGO_PKG_NAME")))?;
    let path = messages.lines().find_map(|line| {
        let (_, rest) = line.split_once("\"executable\":\"")?;
        Some(PathBuf::from(rest.split('"').next()?))
    });
    path.ok_or_else(|| "cargo built no example filter_steps".into())
}

/// All instructions of a run of a program, counted by callgrind.
pub(crate) fn instructions(
    valgrind: &Path,
    program: &Path,
    arguments: &[&str],
) -> Result<f64, Error> {
    let mut command = Command::new(valgrind);
    command.args(["--tool=callgrind", "--callgrind-out-file=/dev/null"]);
    let report = output(command.arg(program).args(arguments))?;
    let mut lines = report.lines();
    let collected = lines.find_map(|line| line.split_once("Collected :"));
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
