//! Emitted functions against those of wrenfold, SymForce and CasADi's C, in one program: value and
//! Jacobians by reference, interleaved, minima over rounds.
//!
//! `peers.py` writes the functions with every generator, and the program. Ours are emitted in
//! two forms: with fused multiply-adds, as gcc contracts CasADi's C and the sines of the system's
//! library are, and with equal bits on every machine, the default.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use gyrocal_codegen::{Header, Options, Program, emit_module_with};
use gyrocal_testkit::{Tool, tool};

use crate::harness::{Error, Figure};
use crate::kernel::instructions::{cargo, instructions, output, root};
use crate::kernel::times::has_x86_64_v3;

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

/// How our functions are emitted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    /// `fused_multiply_add = true`, and the feature `fused` of `gyrocal-scalar`.
    Fused,
    /// The default.
    EqualBits,
}

impl Form {
    fn name(self) -> &'static str {
        match self {
            Self::Fused => "fused",
            Self::EqualBits => "equal bits",
        }
    }

    /// A ratio with the target of the fused form: the equal bits need not be faster than what gives them up.
    fn judged(self, name: &str, bounds: [f64; 2], ratio: f64) -> Figure {
        match self {
            Self::Fused => Figure::within(name, bounds, ratio),
            Self::EqualBits => Figure::note(name, format!("{ratio:.3}")),
        }
    }
}

/// A line of the program: a function at an angle, with times in ns.
struct Timed {
    function: String,
    angle: String,
    ns: BTreeMap<String, f64>,
}

impl Timed {
    fn parsed(line: &str) -> Option<Self> {
        let mut words = line.split_whitespace();
        let (function, angle) = (words.next()?.to_owned(), words.next()?.to_owned());
        let pairs = words.map(|word| {
            let (name, number) = word.split_once('=')?;
            Some((name.to_owned(), number.parse().ok()?))
        });
        Some(Self {
            function,
            angle,
            ns: pairs.collect::<Option<_>>()?,
        })
    }

    /// The competitors that the program has.
    fn competitors(&self) -> impl Iterator<Item = &'static str> {
        let all = COMPETITORS.into_iter();
        all.filter(|name| self.ns.contains_key(*name))
    }

    /// The least time of a competitor over another time.
    fn ratio(&self, ours: &str) -> f64 {
        let best = self.competitors().map(|name| self.ns[name]);
        best.fold(f64::INFINITY, f64::min) / self.ns[ours]
    }
}

/// The figures; the other generators are packages of this interpreter.
pub(super) fn figures(directory: &Path, python: &Path) -> Result<Vec<Figure>, Error> {
    let source = written(directory, python)?;
    let mut figures = Vec::new();
    for form in [Form::Fused, Form::EqualBits] {
        let (program, target) = built(&source, form)?;
        let printed = output(Command::new(&program).arg(ROUNDS.to_string()))?;
        let timed: Vec<Timed> = printed.lines().filter_map(Timed::parsed).collect();
        if timed.is_empty() {
            return Err(format!("no times in: {printed}").into());
        }
        let what = format!("{}: target of the compared functions", form.name());
        figures.push(Figure::note(&what, target.to_owned()));
        for line in &timed {
            figures.extend(of_times(form, line));
        }
        figures.extend(of_all(form, &timed));
        figures.extend(of_instructions(form, &program, &timed)?);
    }
    Ok(figures)
}

fn of_times(form: Form, line: &Timed) -> [Figure; 3] {
    let name = format!("{}: {}, {} rad", form.name(), line.function, line.angle);
    let is_one_of_five = line.angle == "0.6" && line.function != "cart_pole";
    let least = match form {
        Form::Fused if is_one_of_five => FIVE_LEAST,
        _ => LEAST,
    };
    let times = ["ours", "value"].into_iter().chain(line.competitors());
    let times: Vec<String> = times.map(|name| format!("{:.1}", line.ns[name])).collect();
    let sines = 100.0 * line.ns["sines"] / line.ns["ours"];
    let ratio = |what: &str, least: f64, ours: &str| {
        let name = format!("{name}: {what}");
        Figure::within(&name, [least, f64::INFINITY], line.ratio(ours))
    };
    let all = format!("{name}: ours, by value, wrenfold, SymForce, CasADi's C");
    let times = format!("{} ns; sines {sines:.0} %", times.join(", "));
    [
        ratio("best competitor / ours", least, "ours"),
        ratio("the same, ours by value", LEAST, "value"),
        Figure::note(&all, times),
    ]
    .map(|figure| figure.over(ROUNDS, ""))
}

fn of_all(form: Form, timed: &[Timed]) -> [Figure; 2] {
    let logarithms: f64 = timed.iter().map(|line| line.ratio("ours").ln()).sum();
    let mean = (logarithms / timed.len() as f64).exp();
    let apart = timed.iter().map(|line| line.ns["apart"]);
    let name = |what: &str| format!("{}: {what}", form.name());
    let what = name("geometric mean of all functions and angles");
    let largest = name("largest difference of a competitor, relative");
    [
        form.judged(&what, [MEAN, f64::INFINITY], mean),
        Figure::at_most_small(&largest, APART, apart.fold(0.0, f64::max)),
    ]
}

/// Instructions of ours over those of the best competitor, of all calls of a run.
fn of_instructions(form: Form, program: &Path, timed: &[Timed]) -> Result<Vec<Figure>, Error> {
    let Some(valgrind) = tool(Tool::Valgrind) else {
        let what = format!("{}: instructions not counted", form.name());
        return Ok(vec![Figure::note(&what, Tool::Valgrind.missing())]);
    };
    let mut figures = Vec::new();
    for line in timed.iter().filter(|line| line.angle == "0.6") {
        let calls = COUNTED.to_string();
        let count = |of: &str| instructions(&valgrind, program, &[&calls, &line.function, of]);
        let nothing = count("nothing")?;
        let mut best = f64::INFINITY;
        for name in line.competitors() {
            best = best.min(count(name)? - nothing);
        }
        let ratio = (count("ours")? - nothing) / best;
        let (form_name, function) = (form.name(), &line.function);
        let what =
            format!("{form_name}: {function}, 0.6 rad: instructions, ours / best competitor");
        figures.push(form.judged(&what, [f64::NEG_INFINITY, INSTRUCTIONS], ratio));
    }
    Ok(figures)
}

const PEERS: &str = include_str!("peers.py");

/// Functions by the other generators, and the program without ours; returns its directory.
fn written(directory: &Path, python: &Path) -> Result<PathBuf, Error> {
    let source = directory.join("race");
    std::fs::create_dir_all(source.join("src"))?;
    let script = directory.join("peers.py");
    std::fs::write(&script, PEERS)?;
    let exporter = root().join("codegen/emit/exporter");
    let mut command = Command::new(python);
    output(command.arg(&script).arg(exporter).arg(source.join("src")))?;
    Ok(source)
}

/// Adds our functions in a form, and builds the program; returns its path, and the processor that it is built for.
fn built(source: &Path, form: Form) -> Result<(PathBuf, &'static str), Error> {
    let header = Header {
        rebuild_command: "cargo figures kernel --part generator".into(),
        source: "peers.py".into(),
        fingerprint: "none".into(),
    };
    let mut options = Options::default();
    options.fused_multiply_add = form == Form::Fused;
    let text = std::fs::read_to_string(source.join("src/ours.json"))?;
    let program = Program::from_json(&text, "ours.json")?;
    let module = emit_module_with(&program, &header, &options)?;
    std::fs::write(source.join("src/ours.rs"), module)?;
    let target = if has_x86_64_v3() {
        "x86-64-v3"
    } else {
        "native"
    };
    let features = if form == Form::Fused { "\"fused\"" } else { "" };
    let object = source.join("casadi_peer.o");
    let mut gcc = Command::new("gcc");
    gcc.args(["-O3", &format!("-march={target}"), "-c", "-o"]);
    output(gcc.args([&object, &source.join("src/casadi_peer.c")]))?;
    let library = source.join("libcasadi_peer.a");
    output(Command::new("ar").arg("rcs").args([&library, &object]))?;
    let scalar = root().join("crates/scalar").canonicalize()?;
    let manifest = format!(
        "[package]\nname = \"race\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n\
         [dependencies]\ngyrocal-scalar = {{ path = {scalar:?}, features = [{features}] }}\n\
         nalgebra = \"0.35\"\n\n[profile.release]\ncodegen-units = 1\n\n[workspace]\n"
    );
    std::fs::write(source.join("Cargo.toml"), manifest)?;
    let flags = format!("-C target-cpu={target} -L native={}", source.display());
    output(
        Command::new(cargo())
            .current_dir(source)
            .args(["build", "--release", "--quiet"])
            .env("CARGO_TARGET_DIR", source.join("target"))
            .env_remove("CARGO_ENCODED_RUSTFLAGS")
            .env("RUSTFLAGS", flags),
    )?;
    let folder = source.join("target/release");
    let program = folder.join(form.name().replace(' ', "_"));
    std::fs::rename(folder.join("race"), &program)?;
    Ok((program, target))
}
