//! Time of reading, simplifying and emitting large programs, and of refusing those that are too large.

use std::fmt::Write as _;
use std::time::Instant;

use gyrocal_codegen::{Header, Program, emit_module};

use crate::error::Error;
use crate::figure::Figure;

const INSTRUCTIONS: usize = 37_000;
const MOST_S: f64 = 2.0;
/// The most that is accepted, and what the emitter is to refuse.
const HUGE: [usize; 2] = [gyrocal_codegen::program::MOST_INSTRUCTIONS, 10_000_000];

/// Seconds for a program of one function with some constants, sums and products.
pub(crate) fn figure() -> Result<Figure, Error> {
    let text = program(INSTRUCTIONS);
    let begin = Instant::now();
    let module = emitted(&text)?;
    let seconds = begin.elapsed().as_secs_f64();
    let name = format!(
        "reading and emission of {INSTRUCTIONS} instructions, {} kB of Rust",
        module.len() / 1000
    );
    Ok(Figure::at_most(&name, MOST_S, seconds, "s"))
}

/// Time and memory of the largest program that is accepted, and of one that is refused.
pub(crate) fn of_huge_programs() -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for count in HUGE {
        let text = program(count);
        let before = peak_mb(true);
        let begin = Instant::now();
        let result = emitted(&text);
        let seconds = begin.elapsed().as_secs_f64();
        let memory = match (before, peak_mb(false)) {
            (Some(before), Some(after)) => format!(", {} MB beside the text", after - before),
            _ => String::new(),
        };
        let answer = match &result {
            Ok(module) => format!("{} MB of Rust", module.len() / 1_000_000),
            Err(error) => error.to_string(),
        };
        let megabytes = text.len() / 1_000_000;
        let what = format!("program of {count} instructions, {megabytes} MB");
        let measured = format!("{seconds:.1} s{memory}: {answer}");
        let is_accepted = count <= gyrocal_codegen::program::MOST_INSTRUCTIONS;
        let mut figure = Figure::truth(&what, result.is_ok() == is_accepted);
        figure.target = if is_accepted { "emitted" } else { "refused" }.to_owned();
        figure.measured = measured;
        figures.push(figure);
    }
    Ok(figures)
}

/// The largest memory of this process, MB, where the system tells it; from now on with `reset`.
fn peak_mb(reset: bool) -> Option<u64> {
    if reset {
        std::fs::write("/proc/self/clear_refs", "5").ok()?;
    }
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes / 1000)
}

fn emitted(text: &str) -> Result<String, Error> {
    let program = Program::from_json(text, "large.json")?;
    let header = Header {
        rebuild_command: "none".into(),
        source: "none".into(),
        fingerprint: "none".into(),
    };
    Ok(emit_module(&program, &header)?)
}

/// A function of 20 inputs whose instructions each take two results before them.
fn program(count: usize) -> String {
    let mut instructions = String::new();
    let mut state = 1_u64;
    let mut draw = |below: usize| {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % below
    };
    let outputs = 200;
    for place in 0..count - outputs {
        let _ = match place {
            0..20 => write!(instructions, r#"["input",{place},0,{place}],"#),
            _ if draw(20) == 0 => {
                write!(instructions, r#"["const",{place},{}.37],"#, draw(1000))
            }
            _ => {
                let name = ["add", "sub", "mul", "mul", "atan2"][draw(5)];
                // Of the last hundred, so that little is dead.
                let mut operand = || place - 1 - draw(place.min(100));
                let (left, right) = (operand(), operand());
                write!(instructions, r#"["{name}",{place},{left},{right}],"#)
            }
        };
    }
    for nonzero in 0..outputs {
        let from = count - outputs - 1 - nonzero;
        let comma = if nonzero + 1 < outputs { "," } else { "" };
        let _ = write!(instructions, r#"["output",0,{nonzero},{from}]{comma}"#);
    }
    let elements: Vec<String> = (0..20)
        .map(|i| format!(r#"{{"name":"x{i}","unit":"1","doc":"element"}}"#))
        .collect();
    let nonzeros: Vec<String> = (0..outputs).map(|row| format!("[{row},0]")).collect();
    format!(
        r#"{{"schema_version":1,"name":"large","doc":"","casadi_version":"none",
            "groups":[{{"name":"x","doc":"inputs","elements":[{}]}}],
            "functions":[{{"name":"f","doc":"function","source":"","domain":"",
                "inputs":[{{"group":"x"}}],
                "outputs":[{{"name":"y","doc":"results","unit":"1","rows":{outputs},"columns":1,
                    "row_names":[],"column_names":[],"nonzeros":[{}]}}],
                "work_size":{},"instructions":[{instructions}]}}],
            "model":null}}"#,
        elements.join(","),
        nonzeros.join(","),
        count.min(HUGE[0]),
    )
}
