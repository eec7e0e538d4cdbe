//! What a fleet shows, and the Python package: size of its wheel, import, first diagnosis without Rust,
//! overhead over the command, fleets of records on workers.

mod engine;
mod levels;
mod recurring;
mod whole;

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use gyrocal_record::write_json;
use gyrocal_testkit::{Tool, leave_out, system_python, timing, tool};
use serde::Deserialize;

use crate::error::Error;
use crate::figure::Figure;
use crate::kernel::instructions::{output, root};
use crate::truth::Extent;

const PACKAGE: &str = "crates/python";
const RECORD: &str = "examples/data/hidden_fault.csv";
const BENCH: &str = "examples/data/hidden_fault.bench.toml";

/// Exit code of the command with `--exit-code` if effects were found.
const EFFECTS_FOUND: i32 = 3;

/// All figures; with a number of records the statistics alone, over as many fleets of each kind at most.
pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let mut figures = levels::figures(extent)?;
    figures.extend(recurring::figures(extent)?);
    if !extent.small {
        figures.extend(whole::figures(extent)?);
    }
    if extent.most.is_none() {
        figures.extend(of_package(extent.small)?);
    }
    Ok(figures)
}

/// Those of the package. The small version repeats less and leaves the fleet to the tests of the package.
fn of_package(small: bool) -> Result<Vec<Figure>, Error> {
    let build = root().join(PACKAGE).join("build");
    if let Err(missing) = output(Command::new(build).arg("environment")) {
        leave_out(&missing.to_string());
        let reason = "crates/python/build failed".to_owned();
        return Ok(vec![Figure::note("the Python package: not judged", reason)]);
    }
    let wheel = wheel()?;
    let mut figures = vec![size(&wheel)?, import(if small { 3 } else { 15 })?];
    figures.push(first_diagnosis(&wheel)?);
    if !small {
        figures.push(spark(RECORDS_OF_SPARK)?);
        figures.push(overhead(15)?);
        figures.extend(engine::figures()?);
    }
    Ok(figures)
}

fn folder() -> PathBuf {
    root().join("target/python")
}

fn wheel() -> Result<PathBuf, Error> {
    let mut wheels = std::fs::read_dir(folder().join("wheels"))?;
    let wheel = wheels.next().ok_or("crates/python/build made no wheel")??;
    Ok(wheel.path())
}

fn size(wheel: &Path) -> Result<Figure, Error> {
    let megabytes = std::fs::metadata(wheel)?.len() as f64 / 1e6;
    Ok(Figure::at_most("wheel: size", 15.0, megabytes, "MB"))
}

/// The result of a measurement in Python.
#[derive(Deserialize)]
struct Seconds {
    seconds: f64,
}

fn measured<T: for<'a> Deserialize<'a>>(arguments: &[&str]) -> Result<T, Error> {
    measured_by(&folder().join("environment/bin/python"), arguments)
}

fn measured_by<T: for<'a> Deserialize<'a>>(python: &Path, arguments: &[&str]) -> Result<T, Error> {
    let mut python = Command::new(python);
    let script = root().join(PACKAGE).join("measure.py");
    let printed = output(python.current_dir(root()).arg(script).args(arguments))?;
    let json = printed.lines().find(|line| line.starts_with('{'));
    Ok(serde_json::from_str(
        json.ok_or("no measurement was printed")?,
    )?)
}

/// Files of the installed package. The wheel that they come in has a list of its parts with a number of its own.
fn installed() -> Result<Vec<PathBuf>, Error> {
    let mut pythons = std::fs::read_dir(folder().join("environment/lib"))?;
    let python = pythons.next().ok_or("the environment has no library")??;
    let package = python.path().join("site-packages/gyrocal");
    let files = std::fs::read_dir(package)?.map(|entry| Ok(entry?.path()));
    let mut files = files.collect::<Result<Vec<PathBuf>, Error>>()?;
    files.retain(|path| path.is_file());
    files.sort();
    Ok(files)
}

/// The same of a measurement that takes minutes: what was measured of this package by these scripts, with these
/// other packages on this processor, is kept.
fn measured_once<T: for<'a> Deserialize<'a>>(arguments: &[&str]) -> Result<T, Error> {
    let mut measures = DefaultHasher::new();
    timing::processor().hash(&mut measures);
    let files = ["measure.py", "measure_fleet.py", "requirements-test.lock"];
    let files = files.map(|name| root().join(PACKAGE).join(name));
    for file in files.into_iter().chain(installed()?) {
        std::fs::read(file)?.hash(&mut measures);
    }
    let name = format!(
        "fleet-{}-{:016x}.json",
        arguments.join("-"),
        measures.finish()
    );
    let kept = root().join("target/figures").join(name);
    if let Ok(text) = std::fs::read_to_string(&kept)
        && let Ok(found) = serde_json::from_str(&text)
    {
        eprintln!("measured before: {}", kept.display());
        return Ok(found);
    }
    let found: serde_json::Value = measured(arguments)?;
    write_json(&kept, &found)?;
    Ok(serde_json::from_value(found)?)
}

/// Records that Spark maps.
const RECORDS_OF_SPARK: usize = 60;

/// What Spark gave.
#[derive(Deserialize)]
struct Spark {
    equal: bool,
}

/// The documented lines for Spark: rows of the same bits.
fn spark(records: usize) -> Result<Figure, Error> {
    let name = "Spark maps the records by the lines of docs/python.md: equal bits";
    let Some(python) = tool(Tool::Spark) else {
        return Ok(Figure::note(name, Tool::Spark.missing()));
    };
    let found: Spark = measured_by(&python, &["spark", &records.to_string()])?;
    Ok(Figure::truth(name, found.equal).over(records, format!("0..{records}")))
}

fn import(rounds: usize) -> Result<Figure, Error> {
    let mut seconds = Vec::with_capacity(rounds);
    for _ in 0..rounds {
        seconds.push(measured::<Seconds>(&["import"])?.seconds);
    }
    seconds.sort_by(f64::total_cmp);
    let name = "import of the package, NumPy included: median";
    Ok(Figure::at_most(name, 0.3, seconds[rounds / 2], "s").over(rounds, ""))
}

/// A new environment, the wheel with what it needs, and the command, where no Rust can be found.
fn first_diagnosis(wheel: &Path) -> Result<Figure, Error> {
    let environment = tempfile::tempdir()?;
    let place = environment.path();
    let path = "/usr/local/bin:/usr/bin:/bin";
    let clean = |program: &Path| {
        let mut command = Command::new(program);
        command
            .current_dir(root())
            .env("PATH", path)
            .env_remove("CARGO_HOME");
        command
    };
    let started = Instant::now();
    output(clean(&system_python()).args(["-m", "venv"]).arg(place))?;
    let pip = [
        "-m",
        "pip",
        "install",
        "--quiet",
        "--disable-pip-version-check",
    ];
    output(clean(&place.join("bin/python")).args(pip).arg(wheel))?;
    let command = place.join("bin/gyrocal");
    let arguments = ["diagnose", RECORD, "--exit-code", "--bench", BENCH];
    let diagnosed = clean(&command).args(arguments).output()?;
    let seconds = started.elapsed().as_secs_f64();
    let found = diagnosed.status.code() == Some(EFFECTS_FOUND);
    let name = "first diagnosis of the example in a new environment without Rust, with install";
    let seconds = if found { seconds } else { f64::NAN };
    Ok(Figure::at_most(name, 60.0, seconds, "s"))
}

/// The call on columns in memory over the command on the file, whole process; minima, taken in turns.
fn overhead(rounds: usize) -> Result<Figure, Error> {
    let mut build = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    let build = build.current_dir(root());
    output(build.args(["build", "--release", "--quiet", "--package", "gyrocal-cli"]))?;
    let target = std::env::current_exe()?;
    let command = target
        .parent()
        .ok_or("no folder of this program")?
        .join("gyrocal");
    let (mut by_command, mut by_call) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..rounds {
        let started = Instant::now();
        let mut command = Command::new(&command);
        output(
            command
                .current_dir(root())
                .args(["diagnose", RECORD, "--bench", BENCH]),
        )?;
        by_command = by_command.min(started.elapsed().as_secs_f64());
        by_call = by_call.min(measured::<Seconds>(&["diagnosis"])?.seconds);
    }
    let percent = 100.0 * (by_call / by_command - 1.0);
    let name = "diagnosis from Python over the command, minima in turns: overhead";
    Ok(Figure {
        target: "<= 5 %".to_owned(),
        measured: format!("{percent:.1} % of {by_command:.2} s"),
        ..Figure::within(name, [f64::NEG_INFINITY, 5.0], percent)
    }
    .over(rounds, ""))
}
