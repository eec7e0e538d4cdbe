//! `tests/firmware` on the target and on the host: a record of three days.

use std::path::Path;
use std::process::Command;

use super::target::{Tools, build_on_host};
use crate::error::Error;
use crate::figure::Figure;
use crate::kernel::instructions::output;

const PACKAGE: &str = "tests/firmware";
const PROGRAM: &str = "gyrocal-firmware-test";
const WATCH_PROGRAM: &str = "gyrocal-watch-test";
/// Instructions of a step with Runge-Kutta and with Euler.
const INSTRUCTIONS: [(&str, f64); 2] = [("rk4", 9000.0), ("euler", 6500.0)];

pub(super) fn figures(tools: &Tools, small: bool) -> Result<Vec<Figure>, Error> {
    // The linker finds a panic; what it says then is the error here.
    let firmware = tools.build(PACKAGE, &[])?.join(PROGRAM);
    let host = build_on_host(PACKAGE, &[])?.join(PROGRAM);
    let mut figures = vec![Figure::truth(
        "f32: links with a panic handler that does not exist",
        true,
    )];
    figures.push(soft_double(tools, &firmware, "f32")?);
    for (rule, limit) in INSTRUCTIONS {
        let lines = Lines(tools.run(&firmware, rule)?);
        figures.extend(of_rule("f32", rule, &lines, Some(limit))?);
        figures.push(equal("f32", rule, &lines, &host)?);
        if rule == "rk4" {
            figures.push(bad_input("f32", &lines));
            figures.extend(memory(&lines)?);
        }
    }
    let double = ["--features", "double"];
    let firmware = tools.build(PACKAGE, &double)?.join(PROGRAM);
    let host = build_on_host(PACKAGE, &double)?.join(PROGRAM);
    figures.push(Figure::truth(
        "f64: links with a panic handler that does not exist",
        true,
    ));
    for (rule, _) in INSTRUCTIONS {
        let words = if small {
            format!("{rule} short")
        } else {
            rule.to_owned()
        };
        let lines = Lines(tools.run(&firmware, &words)?);
        figures.extend(of_rule("f64", rule, &lines, None)?);
        figures.push(equal("f64", &words, &lines, &host)?);
        if rule == "rk4" {
            figures.push(bad_input("f64", &lines));
        }
    }
    Ok(figures)
}

/// The watch beside the filter: what it takes more than the filter alone.
pub(super) fn watch(tools: &Tools) -> Result<Vec<Figure>, Error> {
    let features = ["--features", "watch"];
    let alone = Lines(tools.run(&tools.build(PACKAGE, &features)?.join(PROGRAM), "rk4")?);
    let firmware = tools.build(PACKAGE, &features)?.join(WATCH_PROGRAM);
    let lines = Lines(tools.run(&firmware, "")?);
    let host = build_on_host(PACKAGE, &features)?.join(WATCH_PROGRAM);
    let effects = lines.number("effects")?;
    let more = |watched: &str, filter: &str| -> Result<f64, Error> {
        Ok(lines.number(watched)? - alone.number(filter)?)
    };
    let count = |what: &str, limit: f64, measured: f64| {
        let name = format!("f32: watch of {effects} effects alone: {what}");
        Figure {
            measured: format!("{measured:.0}"),
            target: format!("<= {limit:.0}"),
            ..Figure::within(&name, [0.0, limit], measured)
        }
    };
    let on_host = Lines(output(&mut Command::new(host))?);
    let (here, there) = (on_host.compared(), lines.compared());
    let figures = [
        count(
            "instructions, mean",
            12_000.0,
            more("instructions mean", "instructions mean")?,
        ),
        count(
            "instructions, worst step",
            20_000.0,
            more("instructions most", "instructions mean")?,
        ),
        count("RAM, bytes", 16_000.0, more("size watched", "size filter")?),
        Figure::truth(
            "f32: watch: all bits on the target are those of the host",
            here == there && !here.is_empty(),
        ),
        soft_double(tools, &firmware, "f32: watch")?,
    ];
    Ok(figures
        .map(|figure| figure.over(lines.steps(), "examples/data/three_days.csv"))
        .into())
}

/// The lines of numbers that the Rust filter prints on the host in single precision, without bad
/// input.
pub(super) fn on_host() -> Result<Vec<String>, Error> {
    let host = build_on_host(PACKAGE, &[])?.join(PROGRAM);
    let lines = Lines(output(Command::new(host).arg("rk4"))?);
    let numbers = lines.compared().into_iter();
    Ok(numbers
        .filter(|line| !line.starts_with("bad_input "))
        .map(str::to_owned)
        .collect())
}

/// The firmware of `examples/controller`, which ends well only if its filter is healthy.
pub(super) fn example(tools: &Tools) -> Result<Figure, Error> {
    let firmware = tools.build("examples/controller", &[])?;
    let text = tools.run(&firmware.join("gyrocal-controller"), "")?;
    let name = "examples/controller: three days with a reset and a bad sample";
    let figure = Figure::truth(name, text.contains("all minutes done, filter healthy"));
    Ok(figure.over(1, "examples/data/three_days.csv"))
}

/// What a firmware printed.
struct Lines(String);

impl Lines {
    /// The largest number of the lines that begin so.
    fn number(&self, name: &str) -> Result<f64, Error> {
        let numbers = self.0.lines().filter_map(|line| {
            let rest = line.strip_prefix(name)?;
            rest.trim().parse::<f64>().ok()
        });
        numbers
            .reduce(f64::max)
            .ok_or_else(|| format!("the firmware printed no `{name}`:\n{}", self.0).into())
    }

    /// Lines of numbers that the host prints too.
    fn compared(&self) -> Vec<&str> {
        let kinds = ["bad_input ", "digest ", "number ", "error "];
        let lines = self.0.lines();
        lines
            .filter(|line| kinds.iter().any(|kind| line.starts_with(kind)))
            .collect()
    }

    fn steps(&self) -> usize {
        self.number("steps").unwrap_or(0.0) as usize
    }
}

fn of_rule(
    number: &str,
    rule: &str,
    lines: &Lines,
    limit: Option<f64>,
) -> Result<Vec<Figure>, Error> {
    let mean = lines.number("instructions mean")?;
    let (least, most) = (
        lines.number("instructions least")?,
        lines.number("instructions most")?,
    );
    let name = format!("{number} {rule} step: instructions, mean");
    let instructions = match limit {
        Some(limit) => Figure {
            measured: format!("{mean:.0}"),
            target: format!("<= {limit:.0}"),
            ..Figure::within(&name, [0.0, limit], mean)
        },
        None => Figure::note(&name, format!("{mean:.0}")),
    };
    let name = format!("{number} {rule} step: spread of instructions between steps");
    let percent = 100.0 * (most - least) / mean;
    let spread = match limit {
        Some(_) => Figure::at_most(&name, 2.0, percent, "%"),
        // Software for double precision takes as long as its operands need.
        None => Figure::note(&name, format!("{percent:.2} %")),
    };
    let seeds = "examples/data/three_days.csv";
    Ok([instructions, spread]
        .map(|figure| figure.over(lines.steps(), seeds))
        .into())
}

fn equal(number: &str, words: &str, lines: &Lines, host: &Path) -> Result<Figure, Error> {
    let on_host = Lines(output(Command::new(host).args(words.split(' ')))?);
    let (here, there) = (on_host.compared(), lines.compared());
    let rule = words.split(' ').next().unwrap_or_default();
    let name = format!("{number} {rule}: all bits on the target are those of the host");
    let figure = Figure::truth(&name, here == there && there.len() > 19);
    Ok(figure.over(lines.steps(), "examples/data/three_days.csv"))
}

fn bad_input(number: &str, lines: &Lines) -> Figure {
    let answers: Vec<bool> = lines
        .0
        .lines()
        .filter(|line| line.starts_with("bad_input "))
        .map(|line| line.ends_with(" 1"))
        .collect();
    let name = format!("{number}: bad input answered as documented, state unchanged");
    let right = answers.iter().filter(|answer| **answer).count();
    Figure {
        target: format!("{0} of {0}", answers.len()),
        measured: format!("{right} of {}", answers.len()),
        ..Figure::truth(&name, right == answers.len() && right > 0)
    }
    .over(answers.len(), "cases")
}

fn memory(lines: &Lines) -> Result<Vec<Figure>, Error> {
    let kilobytes = |name: &str, limit: f64, bytes: f64| {
        let figure = Figure::within(name, [0.0, 1000.0 * limit], bytes);
        Figure {
            target: format!("<= {:.0} bytes", 1000.0 * limit),
            measured: format!("{bytes:.0} bytes"),
            ..figure
        }
    };
    let stack_of_a_step = lines.number("stack step")?;
    let start = lines.number("stack start")?;
    let mut figures = vec![
        kilobytes("f32: filter state", 2.4, lines.number("size filter")?),
        kilobytes("f32 rk4: stack of a step", 1.3, stack_of_a_step),
        kilobytes("f32: stack of construction", 1.5, start),
        Figure::truth(
            "f32: construction needs no more stack than a step",
            start <= stack_of_a_step,
        ),
    ];
    for call in ["update", "coast", "save", "restore"] {
        let bytes = lines.number(&format!("stack {call}"))?;
        figures.push(Figure::note(
            &format!("f32 rk4: stack of {call}"),
            format!("{bytes:.0} bytes"),
        ));
    }
    let saved = lines.number("size saved")?;
    figures.push(Figure::note(
        "f32: saved state",
        format!("{saved:.0} bytes"),
    ));
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
    let found: Vec<&String> = symbols.iter().filter(|name| is_double(name)).collect();
    let measured = found.len().to_string();
    let name = format!("{program}: functions of software for double precision in the firmware");
    Ok(Figure {
        target: "0".to_owned(),
        measured,
        ..Figure::truth(&name, found.is_empty() && !symbols.is_empty())
    })
}
