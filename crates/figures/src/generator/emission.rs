//! Time of reading, simplifying and emitting large programs, and of refusing those that are too large.

use std::fmt::Write as _;
use std::time::Instant;

use gyrocal_codegen::program::MOST_INSTRUCTIONS;
use gyrocal_codegen::{Header, Program, emit_module};

use crate::cost::Peak;
use crate::harness::{Error, Figure};

const INSTRUCTIONS: usize = 37_000;
const MOST_S: f64 = 2.0;

/// The most that is accepted, and what the emitter is to refuse.
const HUGE: [(usize, &str); 2] = [(MOST_INSTRUCTIONS, "emitted"), (10_000_000, "refused")];

/// Inputs and outputs of the programs.
const INPUTS: usize = 20;
const OUTPUTS: usize = 200;

/// Seconds for a program of one function with some constants, sums and products.
pub(super) fn figure() -> Result<Figure, Error> {
    let text = program(INSTRUCTIONS);
    let begin = Instant::now();
    let kilobytes = emitted(&text)?.len() / 1000;
    let seconds = begin.elapsed().as_secs_f64();
    let name =
        format!("reading and emission of {INSTRUCTIONS} instructions, {kilobytes} kB of Rust");
    Ok(Figure::at_most(&name, MOST_S, seconds, "s"))
}

/// Time and memory of the largest program that is accepted, and of one that is refused.
pub(super) fn of_huge_programs() -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for (count, target) in HUGE {
        let text = program(count);
        let peak = Peak::reset();
        let (before_mb, begin) = (peak.read_mb(), Instant::now());
        let result = emitted(&text);
        let (seconds, memory_mb) = (begin.elapsed().as_secs_f64(), peak.read_mb() - before_mb);
        let is_right = result.is_ok() == (target == "emitted");
        let answer = match result {
            Ok(module) => format!("{} MB of Rust", module.len() / 1_000_000),
            Err(error) => error.to_string(),
        };
        let megabytes = text.len() / 1_000_000;
        let name = format!("program of {count} instructions, {megabytes} MB");
        let measured = format!("{seconds:.1} s, {memory_mb:.0} MB beside the text: {answer}");
        figures.push(Figure::told(&name, target, measured, is_right));
    }
    Ok(figures)
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

/// A function whose instructions each take two results before them.
fn program(count: usize) -> String {
    let mut instructions = String::new();
    let mut state = 1_u64;
    let mut draw = |below: usize| {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        (state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % below
    };
    for place in 0..count - OUTPUTS {
        let _ = match place {
            0..INPUTS => write!(instructions, r#"["input",{place},0,{place}],"#),
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
    let joined =
        |count, text: &dyn Fn(usize) -> String| (0..count).map(text).collect::<Vec<_>>().join(",");
    let last = count - OUTPUTS - 1;
    let output = |nonzero| format!(r#"["output",0,{nonzero},{}]"#, last - nonzero);
    instructions += &joined(OUTPUTS, &output);
    let elements = joined(INPUTS, &|i| {
        format!(r#"{{"name":"x{i}","unit":"1","doc":"element"}}"#)
    });
    let nonzeros = joined(OUTPUTS, &|row| format!("[{row},0]"));
    format!(
        r#"{{"schema_version":1,"name":"large","doc":"","casadi_version":"none",
            "groups":[{{"name":"x","doc":"inputs","elements":[{elements}]}}],
            "functions":[{{"name":"f","doc":"function","source":"","domain":"",
                "inputs":[{{"group":"x"}}],
                "outputs":[{{"name":"y","doc":"results","unit":"1","rows":{OUTPUTS},"columns":1,
                    "row_names":[],"column_names":[],"nonzeros":[{nonzeros}]}}],
                "work_size":{},"instructions":[{instructions}]}}],
            "model":null}}"#,
        count.min(MOST_INSTRUCTIONS),
    )
}
