//! Emitted functions against those of wrenfold, SymForce and CasADi's C, in one program: value and
//! Jacobians by reference, interleaved, minima over rounds.
//!
//! `peers.py` writes the functions with every generator, and the program. Ours are emitted in
//! two forms: with fused multiply-adds, as gcc contracts CasADi's C and the sines of the system's
//! library are, and with equal bits on every machine, the default.

mod contest;

use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

use gyrocal_testkit::{Tool, tool};

use crate::error::Error;
use crate::figure::Figure;
use crate::kernel::instructions::{instructions, output};

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

    /// Target of a ratio: the equal bits need not be faster than what gives them up.
    fn least(self, line: &Timed) -> f64 {
        let is_one_of_five = line.angle == "0.6" && line.function != "cart_pole";
        match self {
            Self::Fused if is_one_of_five => FIVE_LEAST,
            _ => LEAST,
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
    /// The least time of a competitor over another time.
    fn ratio(&self, ours: &str) -> f64 {
        let best = COMPETITORS.iter().filter_map(|name| self.ns.get(*name));
        best.copied().fold(f64::INFINITY, f64::min) / self.ns[ours]
    }
}

/// The figures; the other generators are packages of this interpreter.
pub(crate) fn figures(directory: &Path, python: &Path) -> Result<Vec<Figure>, Error> {
    let source = contest::written(directory, python)?;
    let mut figures = Vec::new();
    for form in [Form::Fused, Form::EqualBits] {
        let contest = contest::built(&source, form)?;
        let printed = output(Command::new(&contest.program).arg(ROUNDS.to_string()))?;
        let timed: Vec<Timed> = printed.lines().filter_map(parsed).collect();
        if timed.is_empty() {
            return Err(format!("no times in: {printed}").into());
        }
        let what = format!("{}: target of the compared functions", form.name());
        figures.push(Figure::note(&what, contest.target.to_owned()));
        figures.extend(of_times(form, &timed));
        figures.extend(of_instructions(form, &contest.program, &timed)?);
    }
    Ok(figures)
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

fn of_times(form: Form, timed: &[Timed]) -> Vec<Figure> {
    let mut figures = Vec::new();
    let mut product = 1.0;
    for line in timed {
        let name = format!("{}: {}, {} rad", form.name(), line.function, line.angle);
        let ratio = line.ratio("ours");
        product *= ratio;
        let bounds = [form.least(line), f64::INFINITY];
        let what = format!("{name}: best competitor / ours");
        figures.push(Figure::within(&what, bounds, ratio).over(ROUNDS, ""));
        let what = format!("{name}: the same, ours by value");
        let by_value = Figure::within(&what, [LEAST, f64::INFINITY], line.ratio("value"));
        figures.push(by_value.over(ROUNDS, ""));
        let times = ["ours", "value"].iter().chain(&COMPETITORS);
        let times = times.filter_map(|name| Some(format!("{:.1}", line.ns.get(*name)?)));
        let text = format!(
            "{} ns; sines {:.0} %",
            times.collect::<Vec<_>>().join(", "),
            100.0 * line.ns["sines"] / line.ns["ours"]
        );
        let what = format!("{name}: ours, by value, wrenfold, SymForce, CasADi's C");
        figures.push(Figure::note(&what, text).over(ROUNDS, ""));
    }
    let mean = f64::powf(product, 1.0 / timed.len() as f64);
    let what = format!(
        "{}: geometric mean of all functions and angles",
        form.name()
    );
    figures.push(match form {
        Form::Fused => Figure::within(&what, [MEAN, f64::INFINITY], mean),
        Form::EqualBits => Figure::note(&what, format!("{mean:.3}")),
    });
    let apart = timed.iter().map(|line| line.ns["apart"]);
    let apart = apart.fold(0.0, f64::max);
    let what = format!(
        "{}: largest difference of a competitor, relative",
        form.name()
    );
    let mut figure = Figure::within(&what, [0.0, APART], apart);
    (figure.target, figure.measured) = (format!("<= {APART:e}"), format!("{apart:.1e}"));
    figures.push(figure);
    figures
}

/// Instructions of ours over those of the best competitor, of all calls of a run.
fn of_instructions(form: Form, program: &Path, timed: &[Timed]) -> Result<Vec<Figure>, Error> {
    let Some(valgrind) = tool(Tool::Valgrind) else {
        let what = format!("{}: instructions not counted", form.name());
        return Ok(vec![Figure::note(&what, Tool::Valgrind.missing())]);
    };
    let calls = COUNTED.to_string();
    let count = |function: &str, contender: &str| {
        instructions(&valgrind, program, &[&calls, function, contender])
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
        let (name, of) = (form.name(), &line.function);
        let what = format!("{name}: {of}, 0.6 rad: instructions, ours / best competitor");
        figures.push(match form {
            Form::Fused => Figure::within(&what, [f64::NEG_INFINITY, INSTRUCTIONS], ours / best),
            Form::EqualBits => Figure::note(&what, format!("{:.3}", ours / best)),
        });
    }
    Ok(figures)
}
