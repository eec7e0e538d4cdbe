//! What a fleet shows, and the Python package: size of its wheel, import, first diagnosis without Rust,
//! overhead over the command, fleets of records on workers.

mod engine;
mod levels;
mod recurring;
mod whole;

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use gyrocal_statistics::median;
use gyrocal_testkit::{Tool, leave_out, system_python, tool};
use serde_json::Value;

use crate::harness::{Context, Error, Figure, Population, Size, Sources, of};
use crate::kernel::instructions::{cargo, output, root};

const PACKAGE: &str = "crates/python";
const RECORD: &str = "examples/data/hidden_fault.csv";
const BENCH: &str = "examples/data/hidden_fault.bench.toml";

/// Exit code of the command with `--exit-code` if effects were found.
const EFFECTS_FOUND: i32 = 3;

/// Records that Spark maps.
const RECORDS_OF_SPARK: usize = 60;

/// All figures of the part; with a number of records the statistics alone.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = levels::figures(context)?;
    figures.extend(recurring::figures(context)?);
    figures.extend(whole::figures(context)?);
    if !matches!(context.size, Size::Most(_)) {
        figures.extend(of_package(context)?);
    }
    Ok(figures)
}

/// A population of fleets.
fn fleets<'a, R>(
    name: &str,
    seeds: [u64; 3],
    job: impl Fn(u64) -> Result<R, Error> + Sync + 'a,
) -> Population<'a, R> {
    const FILES: &[&str] = &["crates/figures/src/fleet.rs", "crates/figures/src/fleet"];
    const PACKAGES: &[&str] = &["crates/fleet", "crates/diagnosis", "crates/evaluation"];
    Population::new(format!("fleets {name}"), seeds, of(PACKAGES, FILES), job)
}

/// Those of the package. The small version repeats less and leaves the fleet to the tests of the package.
fn of_package(context: &Context) -> Result<Vec<Figure>, Error> {
    let small = context.is_small();
    let build = root().join(PACKAGE).join("build");
    if let Err(missing) = output(Command::new(build).arg("environment")) {
        leave_out(&missing.to_string());
        let reason = "crates/python/build failed".to_owned();
        return Ok(vec![Figure::note("the Python package: not judged", reason)]);
    }
    let mut wheels = std::fs::read_dir(folder().join("wheels"))?;
    let wheel = wheels.next().ok_or("crates/python/build made no wheel")?;
    let wheel = wheel?.path();
    let megabytes = std::fs::metadata(&wheel)?.len() as f64 / 1e6;
    let mut figures = vec![Figure::at_most("wheel: size", 15.0, megabytes, "MB")];
    figures.push(import(if small { 3 } else { 15 })?);
    figures.push(first_diagnosis(&wheel)?);
    if !small {
        figures.push(spark(RECORDS_OF_SPARK)?);
        figures.push(overhead(15)?);
        figures.extend(engine::figures(context)?);
    }
    Ok(figures)
}

fn folder() -> PathBuf {
    root().join("target/python")
}

/// The result of a measurement in Python.
struct Measured(Value);

impl Measured {
    /// A number; NaN, which no target is met by, if it was not measured.
    fn of(&self, key: &str) -> f64 {
        self.0[key].as_f64().unwrap_or(f64::NAN)
    }

    fn is(&self, key: &str) -> bool {
        self.0[key] == true
    }
}

fn measured(arguments: &[&str]) -> Result<Measured, Error> {
    measured_by(&folder().join("environment/bin/python"), arguments)
}

fn measured_by(python: &Path, arguments: &[&str]) -> Result<Measured, Error> {
    let mut python = Command::new(python);
    let script = root().join(PACKAGE).join("measure.py");
    let printed = output(python.current_dir(root()).arg(script).args(arguments))?;
    let json = printed.lines().find(|line| line.starts_with('{'));
    let json = json.ok_or("no measurement was printed")?;
    Ok(Measured(serde_json::from_str(json)?))
}

/// The same of a measurement that takes minutes, kept by the hash of the package.
fn measured_once(context: &Context, arguments: &[&str]) -> Result<Measured, Error> {
    const SOURCES: Sources = of(&[PACKAGE], &[file!()]);
    let name = format!("python {}", arguments.join(" "));
    let job = |_| Ok(measured(arguments)?.0);
    let kept = context.records(&Population::new(name, [0, 1, 0], SOURCES, job))?;
    let found = kept.records.first().cloned().ok_or_else(|| {
        let failures = kept.failures.iter();
        failures.map(|one| one.message.as_str()).collect::<String>()
    });
    Ok(Measured(found?))
}

/// The documented lines for Spark: rows of the same bits.
fn spark(records: usize) -> Result<Figure, Error> {
    let name = "Spark maps the records by the lines of docs/python.md: equal bits";
    let Some(python) = tool(Tool::Spark) else {
        return Ok(Figure::note(name, Tool::Spark.missing()));
    };
    let found = measured_by(&python, &["spark", &records.to_string()])?;
    Ok(Figure::truth(name, found.is("equal")).over(records, format!("0..{records}")))
}

fn import(rounds: usize) -> Result<Figure, Error> {
    let seconds = (0..rounds).map(|_| Ok(measured(&["import"])?.of("seconds")));
    let seconds: Vec<f64> = seconds.collect::<Result<_, Error>>()?;
    let name = "import of the package, NumPy included: median";
    Ok(Figure::at_most(name, 0.3, median(&seconds), "s").over(rounds, ""))
}

/// A new environment, the wheel with what it needs, and the command, where no Rust can be found.
fn first_diagnosis(wheel: &Path) -> Result<Figure, Error> {
    let environment = tempfile::tempdir()?;
    let place = environment.path();
    let clean = |program: &Path, arguments: &str| {
        let mut command = Command::new(program);
        command.env("PATH", "/usr/local/bin:/usr/bin:/bin");
        command.current_dir(root()).env_remove("CARGO_HOME");
        command.args(arguments.split(' '));
        command
    };
    let started = Instant::now();
    output(clean(&system_python(), "-m venv").arg(place))?;
    let pip = "-m pip install --quiet --disable-pip-version-check";
    output(clean(&place.join("bin/python"), pip).arg(wheel))?;
    let diagnose = format!("diagnose {RECORD} --exit-code --bench {BENCH}");
    let diagnosed = clean(&place.join("bin/gyrocal"), &diagnose).output()?;
    let seconds = started.elapsed().as_secs_f64();
    let found = diagnosed.status.code() == Some(EFFECTS_FOUND);
    let name = "first diagnosis of the example in a new environment without Rust, with install";
    let seconds = if found { seconds } else { f64::NAN };
    Ok(Figure::at_most(name, 60.0, seconds, "s"))
}

/// The call on columns in memory over the command on the file, whole process; minima, taken in turns.
fn overhead(rounds: usize) -> Result<Figure, Error> {
    let build = ["build", "--release", "--quiet", "--package", "gyrocal-cli"];
    output(Command::new(cargo()).current_dir(root()).args(build))?;
    let command = std::env::current_exe()?.with_file_name("gyrocal");
    let arguments = ["diagnose", RECORD, "--bench", BENCH];
    let (mut by_command, mut by_call) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..rounds {
        let started = Instant::now();
        output(Command::new(&command).current_dir(root()).args(arguments))?;
        by_command = by_command.min(started.elapsed().as_secs_f64());
        by_call = by_call.min(measured(&["diagnosis"])?.of("seconds"));
    }
    let percent = 100.0 * (by_call / by_command - 1.0);
    let name = "diagnosis from Python over the command, minima in turns: overhead";
    Ok(Figure::at_most(name, 5.0, percent, "%").over(rounds, ""))
}
