//! The Python package: size of its wheel, import, first diagnosis without Rust, overhead over the command,
//! and fleets of records on workers.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use serde::Deserialize;

use crate::error::Error;
use crate::figure::Figure;
use crate::kernel::instructions::{output, root};

const PACKAGE: &str = "crates/python";
const RECORD: &str = "examples/data/hidden_fault.csv";
const BENCH: &str = "examples/data/hidden_fault.bench.toml";

/// Exit code of the command with `--exit-code` if effects were found.
const EFFECTS_FOUND: i32 = 3;

/// Records of the fleet.
const RECORDS: usize = 400;

/// All figures. The small version repeats less and leaves the fleet to the tests of the package; without
/// Python, or where its packages cannot be had, nothing is judged.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let build = root().join(PACKAGE).join("build");
    if let Err(missing) = output(Command::new(build).arg("environment")) {
        eprintln!("NOTHING OF THE PYTHON PACKAGE IS MEASURED: {missing}");
        let first = missing.to_string();
        let line = first.lines().last().unwrap_or_default().to_owned();
        return Ok(vec![Figure::note("the Python package: not judged", line)]);
    }
    let wheel = wheel()?;
    let mut figures = vec![size(&wheel)?, import(if small { 3 } else { 15 })?];
    figures.push(first_diagnosis(&wheel)?);
    figures.push(overhead(if small { 3 } else { 15 })?);
    if !small {
        figures.extend(fleet(RECORDS)?);
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
    let mut python = Command::new(folder().join("environment/bin/python"));
    let script = root().join(PACKAGE).join("measure.py");
    let printed = output(python.current_dir(root()).arg(script).args(arguments))?;
    let json = printed.lines().find(|line| line.starts_with('{'));
    Ok(serde_json::from_str(
        json.ok_or("no measurement was printed")?,
    )?)
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
    let python = output(Command::new("python3").args(["-c", "import sys; print(sys.executable)"]))?;
    let clean = |program: &Path| {
        let mut command = Command::new(program);
        command
            .current_dir(root())
            .env("PATH", path)
            .env_remove("CARGO_HOME");
        command
    };
    let started = Instant::now();
    output(
        clean(Path::new(python.trim()))
            .args(["-m", "venv"])
            .arg(place),
    )?;
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

/// A fleet of short records.
#[derive(Deserialize)]
struct Fleet {
    records: usize,
    library_s: f64,
    batches_s: f64,
    two_workers_s: f64,
    equal: bool,
    worker_mb: f64,
    largest_result_bytes: f64,
    kills: usize,
    lost: usize,
    repeated: usize,
}

fn fleet(records: usize) -> Result<Vec<Figure>, Error> {
    let found: Fleet = measured(&["fleet", &records.to_string()])?;
    let records = found.records;
    let seeds = format!("0..{records}");
    let rate = found.library_s / found.two_workers_s;
    let overhead = 100.0 * (found.batches_s / found.library_s - 1.0);
    let name = "two workers: records a second over the library in one process with one thread";
    let batches = "batches of Arrow over the library, one process: overhead a record";
    let killed = format!(
        "one worker killed {} times: lost, and repeated after it",
        found.kills
    );
    let lost = found.lost + found.repeated;
    let figures = vec![
        Figure::within(name, [1.6, f64::INFINITY], rate),
        Figure::at_most(batches, 5.0, overhead, "%"),
        Figure::truth(
            "1, 2, 4 workers, three partitionings, killed workers: equal bits",
            found.equal,
        ),
        Figure {
            target: "0 and 0".to_owned(),
            measured: format!("{} and {}", found.lost, found.repeated),
            ..Figure::within(&killed, [0.0, 0.0], lost as f64)
        },
        Figure::at_most("memory of a worker, most", 1000.0, found.worker_mb, "MB"),
        Figure::at_most(
            "largest result of a record",
            200.0,
            found.largest_result_bytes / 1e3,
            "kB",
        ),
        Figure::note(
            "cost of a record, one thread",
            format!("{:.1} ms", 1e3 * found.library_s / records as f64),
        ),
    ];
    let over = figures
        .into_iter()
        .map(|figure| figure.over(records, seeds.clone()));
    Ok(over.collect())
}
