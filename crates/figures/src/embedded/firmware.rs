//! `tests/firmware` on the target and on the host: a record of three days.

use std::path::Path;
use std::process::Command;

use super::RECORD;
use super::target::{Tools, build_on_host};
use crate::harness::{Error, Figure};
use crate::kernel::instructions::output;

const PACKAGE: &str = "tests/firmware";
const PROGRAM: &str = "gyrocal-firmware-test";
const WATCH_PROGRAM: &str = "gyrocal-watch-test";

/// Instructions of a step with Runge-Kutta and with Euler, and their largest spread between steps, %.
const INSTRUCTIONS: [(&str, f64); 2] = [("rk4", 9000.0), ("euler", 6500.0)];
const SPREAD: f64 = 2.0;

/// Bytes that the firmware prints, by the beginning of their line, with their limits.
const BYTES: [(&str, &str, Option<f64>); 8] = [
    ("f32: filter state", "size filter", Some(2700.0)),
    ("f32 rk4: stack of a step", STACK_OF_A_STEP, Some(1300.0)),
    ("f32: stack of construction", STACK_OF_START, Some(1500.0)),
    ("f32 rk4: stack of update", "stack update", None),
    ("f32 rk4: stack of coast", "stack coast", None),
    ("f32 rk4: stack of save", "stack save", None),
    ("f32 rk4: stack of restore", "stack restore", None),
    ("f32: saved state", "size saved", None),
];
const STACK_OF_A_STEP: &str = "stack step";
const STACK_OF_START: &str = "stack start";

/// What the watch takes more than the filter alone: its line, that of the filter, and the limit.
const OF_WATCH: [(&str, &str, &str, f64); 3] = [
    ("instructions, mean", "instructions mean", MEAN, 12_000.0),
    (
        "instructions, worst step",
        "instructions most",
        MEAN,
        20_000.0,
    ),
    ("RAM, bytes", "size watched", "size filter", 16_000.0),
];
const MEAN: &str = "instructions mean";

pub(super) fn figures(tools: &Tools, small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for (number, features) in [("f32", &[][..]), ("f64", &["--features", "double"])] {
        // The linker finds a panic; what it says then is the error here.
        let firmware = tools.build(PACKAGE, features)?.join(PROGRAM);
        let host = build_on_host(PACKAGE, features)?.join(PROGRAM);
        let name = format!("{number}: links with a panic handler that does not exist");
        figures.push(Figure::truth(&name, true));
        let is_single = number == "f32";
        if is_single {
            figures.push(soft_double(tools, &firmware, number)?);
        }
        for (rule, limit) in INSTRUCTIONS {
            let short = if small && !is_single { " short" } else { "" };
            let words = format!("{rule}{short}");
            let lines = Lines(tools.run(&firmware, &words)?);
            // Software for double precision takes as long as its operands need.
            let limits = is_single.then_some([limit, SPREAD]);
            figures.extend(of_rule(&format!("{number} {rule}"), &lines, limits)?);
            let name = format!("{number} {rule}: all bits on the target are those of the host");
            figures.push(equal(&name, &words, &lines, &host)?);
            if rule == "rk4" {
                figures.push(bad_input(number, &lines));
                if is_single {
                    figures.extend(memory(&lines)?);
                }
            }
        }
    }
    figures.extend(watch(tools)?);
    figures.push(example(tools)?);
    Ok(figures)
}

/// The watch beside the filter: what it takes more than the filter alone.
fn watch(tools: &Tools) -> Result<Vec<Figure>, Error> {
    let features = ["--features", "watch"];
    let built = tools.build(PACKAGE, &features)?;
    let host = build_on_host(PACKAGE, &features)?.join(WATCH_PROGRAM);
    let alone = Lines(tools.run(&built.join(PROGRAM), "rk4")?);
    let firmware = built.join(WATCH_PROGRAM);
    let lines = Lines(tools.run(&firmware, "")?);
    let effects = lines.number("effects")?;
    let mut figures = Vec::new();
    for (what, watched, filter, limit) in OF_WATCH {
        let name = format!("f32: watch of {effects} effects alone: {what}");
        let more = lines.number(watched)? - alone.number(filter)?;
        figures.push(Figure::at_most(&name, limit, more, "").over(lines.steps(), RECORD));
    }
    let name = "f32: watch: all bits on the target are those of the host";
    figures.push(equal(name, "", &lines, &host)?);
    figures.push(soft_double(tools, &firmware, "f32: watch")?);
    Ok(figures)
}

/// The lines of numbers that the Rust filter prints on the host in single precision, without bad
/// input.
pub(super) fn on_host() -> Result<Vec<String>, Error> {
    let host = build_on_host(PACKAGE, &[])?.join(PROGRAM);
    let lines = Lines(output(Command::new(host).arg("rk4"))?);
    let mut numbers = lines.compared();
    numbers.retain(|line| !line.starts_with("bad_input "));
    Ok(numbers.into_iter().map(str::to_owned).collect())
}

/// The firmware of `examples/controller`, which ends well only if its filter is healthy.
fn example(tools: &Tools) -> Result<Figure, Error> {
    let firmware = tools.build("examples/controller", &[])?;
    let text = tools.run(&firmware.join("gyrocal-controller"), "")?;
    let name = "examples/controller: three days with a reset and a bad sample";
    let figure = Figure::truth(name, text.contains("all minutes done, filter healthy"));
    Ok(figure.over(1, RECORD))
}

/// What a firmware printed.
struct Lines(String);

impl Lines {
    /// The largest number of the lines that begin so.
    fn number(&self, name: &str) -> Result<f64, Error> {
        let rests = self.0.lines().filter_map(|line| line.strip_prefix(name));
        let numbers = rests.filter_map(|rest| rest.trim().parse::<f64>().ok());
        let largest = numbers.reduce(f64::max);
        largest.ok_or_else(|| format!("the firmware printed no `{name}`:\n{}", self.0).into())
    }

    /// Lines of numbers that the host prints too.
    fn compared(&self) -> Vec<&str> {
        let kinds = ["bad_input ", "digest ", "number ", "error "];
        let is_compared = |line: &&str| kinds.iter().any(|kind| line.starts_with(kind));
        self.0.lines().filter(is_compared).collect()
    }

    fn steps(&self) -> usize {
        self.number("steps").unwrap_or(0.0) as usize
    }
}

/// Instructions of a step, and their spread.
fn of_rule(name: &str, lines: &Lines, limits: Option<[f64; 2]>) -> Result<[Figure; 2], Error> {
    let [mean, least, most] =
        ["mean", "least", "most"].map(|what| lines.number(&format!("instructions {what}")));
    let (mean, spread) = (mean?, most? - least?);
    let of = |place: usize, what: &str, measured: f64, unit: &str| {
        let limit = limits.map(|limits| limits[place]);
        let figure = limited(&format!("{name} step: {what}"), limit, measured, unit);
        figure.over(lines.steps(), RECORD)
    };
    let percent = 100.0 * spread / mean;
    Ok([
        of(0, "instructions, mean", mean, ""),
        of(1, "spread of instructions between steps", percent, "%"),
    ])
}

/// A cost, with a limit or without.
fn limited(name: &str, limit: Option<f64>, measured: f64, unit: &str) -> Figure {
    let figure = Figure::at_most(name, limit.unwrap_or(f64::INFINITY), measured, unit);
    match limit {
        Some(_) => figure,
        None => Figure::note(name, figure.measured),
    }
}

fn equal(name: &str, words: &str, lines: &Lines, host: &Path) -> Result<Figure, Error> {
    let on_host = Lines(output(Command::new(host).args(words.split_whitespace()))?);
    let (here, there) = (on_host.compared(), lines.compared());
    let figure = Figure::truth(name, here == there && !there.is_empty());
    Ok(figure.over(lines.steps(), RECORD))
}

fn bad_input(number: &str, lines: &Lines) -> Figure {
    let answers = lines
        .0
        .lines()
        .filter(|line| line.starts_with("bad_input "));
    let all = answers.clone().count();
    let right = answers.filter(|line| line.ends_with(" 1")).count();
    let name = format!("{number}: bad input answered as documented, state unchanged");
    let (target, measured) = (format!("{all} of {all}"), format!("{right} of {all}"));
    Figure::told(&name, &target, measured, right == all && all > 0).over(all, "cases")
}

fn memory(lines: &Lines) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for (name, line, limit) in BYTES {
        figures.push(limited(name, limit, lines.number(line)?, "bytes"));
    }
    let name = "f32: construction needs no more stack than a step";
    let [start, step] = [STACK_OF_START, STACK_OF_A_STEP].map(|line| lines.number(line));
    figures.push(Figure::truth(name, start? <= step?));
    Ok(figures)
}

/// Calls of software for double precision: there must be none where all numbers are single.
fn soft_double(tools: &Tools, firmware: &Path, program: &str) -> Result<Figure, Error> {
    let is_double = |name: &String| {
        let rest = name.strip_prefix("__aeabi_").unwrap_or_default();
        rest.starts_with('d') && !rest.starts_with("div")
            || rest.ends_with("2d")
            || rest.starts_with("cd")
            || name.ends_with("df3")
            || name.ends_with("df2")
    };
    let symbols = tools.symbols(firmware)?;
    if symbols.is_empty() {
        return Err(format!("no symbols in {}", firmware.display()).into());
    }
    let found = symbols.iter().filter(|name| is_double(name)).count();
    let name = format!("{program}: functions of software for double precision in the firmware");
    Ok(Figure::at_most(&name, 0.0, found as f64, ""))
}
