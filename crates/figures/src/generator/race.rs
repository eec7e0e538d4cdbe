//! Emitted functions against those of wrenfold, SymForce and CasADi's C, in one program: value and
//! Jacobians by reference, interleaved, minima over rounds.
//!
//! `peers.py` writes the functions with every generator, and the program. Generators come from PyPI
//! into an environment of their own; where they cannot be had, nothing is judged.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use gyrocal_codegen::{Header, Program, emit_module};

use crate::error::Error;
use crate::figure::Figure;
use crate::kernel::instructions::{output, root};

const PEERS: &str = include_str!("peers.py");
const PACKAGES: [&str; 3] = ["wrenfold==0.5.3", "symforce==0.12.0", "casadi==3.8.2"];
const COMPETITORS: [&str; 3] = ["wrenfold", "symforce", "casadi"];
const ROUNDS: usize = 1000;
/// Calls that callgrind counts, beyond those of a run without any.
const COUNTED: usize = 1;
/// Functions on which the least ratio at 0.6 rad is judged: without the cart and pole.
const FIVE_LEAST: f64 = 1.25;
const LEAST: f64 = 1.0;
const MEAN: f64 = 1.4;
const INSTRUCTIONS: f64 = 0.75;
/// Relative to the largest element; roundings of some hundred operations, and of sines near poles.
const APART: f64 = 1e-10;

/// A line of the program: a function at an angle, with times in ns.
struct Timed {
    function: String,
    angle: String,
    ns: BTreeMap<String, f64>,
}

impl Timed {
    /// The least time of a competitor over another time.
    fn ratio(&self, ours: &str) -> f64 {
        let best = COMPETITORS.iter().filter_map(|name| self.ns.get(*name));
        best.copied().fold(f64::INFINITY, f64::min) / self.ns[ours]
    }
}

pub(crate) fn figures() -> Result<Vec<Figure>, Error> {
    let directory = root().join("target/figures/generator");
    let python = match environment(&directory) {
        Ok(python) => python,
        Err(error) => {
            let reason = format!("competitors cannot be had: {error}");
            return Ok(vec![Figure::note("generators not compared", reason)]);
        }
    };
    let (program, target) = built(&directory, &python)?;
    let printed = output(Command::new(&program).arg(ROUNDS.to_string()))?;
    let timed: Vec<Timed> = printed.lines().filter_map(parsed).collect();
    if timed.is_empty() {
        return Err(format!("no times in: {printed}").into());
    }
    let mut figures = vec![Figure::note("target of the compared functions", target)];
    figures.extend(of_times(&timed));
    figures.extend(of_instructions(&program, &timed)?);
    Ok(figures)
}

/// The interpreter of the private environment.
fn environment(directory: &Path) -> Result<PathBuf, Error> {
    let environment = directory.join("env");
    let python = environment.join("bin/python");
    let done = environment.join("complete");
    if !done.is_file() {
        std::fs::create_dir_all(directory)?;
        output(
            Command::new("python3")
                .args(["-m", "venv"])
                .arg(&environment),
        )?;
        output(
            Command::new(&python)
                .args([
                    "-m",
                    "pip",
                    "install",
                    "--quiet",
                    "--disable-pip-version-check",
                ])
                .args(PACKAGES),
        )?;
        std::fs::write(done, "")?;
    }
    Ok(python)
}

/// Writes and builds the program; returns its path and the processor that it is for.
fn built(directory: &Path, python: &Path) -> Result<(PathBuf, String), Error> {
    let source = directory.join("race");
    std::fs::create_dir_all(source.join("src"))?;
    let script = directory.join("peers.py");
    std::fs::write(&script, PEERS)?;
    let exporter = root().join("codegen/emit/exporter");
    output(
        Command::new(python)
            .arg(&script)
            .arg(exporter)
            .arg(source.join("src")),
    )?;
    let text = std::fs::read_to_string(source.join("src/ours.json"))?;
    let header = Header {
        rebuild_command: "cargo figures generator".into(),
        source: "peers.py".into(),
        fingerprint: "none".into(),
    };
    let module = emit_module(&Program::from_json(&text, "ours.json")?, &header)?;
    std::fs::write(source.join("src/ours.rs"), module)?;
    let target = if has_v3() { "x86-64-v3" } else { "native" };
    let (object, library) = (
        source.join("casadi_peer.o"),
        source.join("libcasadi_peer.a"),
    );
    output(
        Command::new("gcc")
            .args(["-O3", &format!("-march={target}"), "-c", "-o"])
            .args([&object, &source.join("src/casadi_peer.c")]),
    )?;
    output(Command::new("ar").arg("rcs").args([&library, &object]))?;
    let scalar = root().join("crates/scalar").canonicalize()?;
    std::fs::write(
        source.join("Cargo.toml"),
        format!(
            "[package]\nname = \"race\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
             [dependencies]\ngyrocal-scalar = {{ path = {scalar:?} }}\nnalgebra = \"0.35\"\n\n\
             [profile.release]\ncodegen-units = 1\n\n[workspace]\n"
        ),
    )?;
    output(
        Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .current_dir(&source)
            .args(["build", "--release", "--quiet"])
            .env("CARGO_TARGET_DIR", source.join("target"))
            .env_remove("CARGO_ENCODED_RUSTFLAGS")
            .env(
                "RUSTFLAGS",
                format!("-C target-cpu={target} -L native={}", source.display()),
            ),
    )?;
    Ok((source.join("target/release/race"), target.to_owned()))
}

#[cfg(target_arch = "x86_64")]
fn has_v3() -> bool {
    std::arch::is_x86_feature_detected!("avx2") && std::arch::is_x86_feature_detected!("fma")
}

#[cfg(not(target_arch = "x86_64"))]
fn has_v3() -> bool {
    false
}

fn parsed(line: &str) -> Option<Timed> {
    let mut words = line.split_whitespace();
    let (function, angle) = (words.next()?.to_owned(), words.next()?.to_owned());
    let pairs = words.map(|word| {
        let (name, number) = word.split_once('=')?;
        Some((name.to_owned(), number.parse().ok()?))
    });
    Some(Timed {
        function,
        angle,
        ns: pairs.collect::<Option<_>>()?,
    })
}

fn of_times(timed: &[Timed]) -> Vec<Figure> {
    let mut figures = Vec::new();
    let mut product = 1.0;
    for line in timed {
        let ratio = line.ratio("ours");
        product *= ratio;
        let what = format!(
            "{}, {} rad: best competitor / ours",
            line.function, line.angle
        );
        let is_one_of_five = line.angle == "0.6" && line.function != "cart_pole";
        let least = if is_one_of_five { FIVE_LEAST } else { LEAST };
        figures.push(Figure::within(&what, [least, f64::INFINITY], ratio).over(ROUNDS, ""));
        let what = format!(
            "{}, {} rad: the same, ours by value",
            line.function, line.angle
        );
        let ratio = line.ratio("value");
        figures.push(Figure::within(&what, [LEAST, f64::INFINITY], ratio).over(ROUNDS, ""));
        let times = ["ours", "value"].iter().chain(&COMPETITORS);
        let times = times.filter_map(|name| Some(format!("{:.1}", line.ns.get(*name)?)));
        let text = format!(
            "{} ns; sines {:.0} %",
            times.collect::<Vec<_>>().join(", "),
            100.0 * line.ns["sines"] / line.ns["ours"]
        );
        let names = "ours, by value, wrenfold, SymForce, CasADi's C";
        let what = format!("{}, {} rad: {names}", line.function, line.angle);
        figures.push(Figure::note(&what, text).over(ROUNDS, ""));
    }
    let mean = f64::powf(product, 1.0 / timed.len() as f64);
    let what = "all functions and angles, geometric mean: best competitor / ours";
    figures.push(Figure::within(what, [MEAN, f64::INFINITY], mean));
    let apart = timed
        .iter()
        .map(|line| line.ns["apart"])
        .fold(0.0, f64::max);
    let what = "largest difference between generators, over the largest element";
    let mut figure = Figure::within(what, [0.0, APART], apart);
    figure.measured = format!("{apart:.1e}");
    figures.push(figure);
    figures
}

/// Instructions of ours over those of the best competitor, of all calls of a run.
fn of_instructions(program: &Path, timed: &[Timed]) -> Result<Vec<Figure>, Error> {
    if output(Command::new("valgrind").arg("--version")).is_err() {
        let reason = "valgrind is not installed".to_owned();
        return Ok(vec![Figure::note("instructions not counted", reason)]);
    }
    let count = |function: &str, contender: &str| -> Result<f64, Error> {
        let report = output(
            Command::new("valgrind")
                .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
                .arg(program)
                .args([&COUNTED.to_string(), function, contender]),
        )?;
        let line = report
            .lines()
            .find_map(|line| line.split_once("Collected :"));
        let (_, count) = line.ok_or("callgrind printed no line `Collected :`")?;
        Ok(count.trim().parse()?)
    };
    let mut figures = Vec::new();
    for line in timed.iter().filter(|line| line.angle == "0.6") {
        let nothing = count(&line.function, "nothing")?;
        let ours = count(&line.function, "ours")? - nothing;
        let mut best = f64::INFINITY;
        for name in COMPETITORS
            .iter()
            .filter(|name| line.ns.contains_key(**name))
        {
            best = best.min(count(&line.function, name)? - nothing);
        }
        let what = format!(
            "{}, 0.6 rad: instructions, ours / best competitor",
            line.function
        );
        figures.push(Figure::within(&what, [0.0, INSTRUCTIONS], ours / best));
    }
    Ok(figures)
}
