//! From the text of a program file to checked instructions.

use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::{Function, Group, Instruction, Output, Program};
use crate::OracleError;

const SCHEMA_VERSION: u64 = 1;

/// Reads a program and checks everything that its instructions refer to.
pub(super) fn program(text: &str) -> Result<Program, OracleError> {
    let raw: RawProgram = serde_json::from_str(text)?;
    if raw.schema_version != SCHEMA_VERSION {
        return Err(OracleError::Schema {
            program: raw.name,
            found: raw.schema_version,
            expected: SCHEMA_VERSION,
        });
    }
    let functions = raw
        .functions
        .into_iter()
        .map(|function| function.check(&raw.groups))
        .collect::<Result<_, _>>()?;
    Ok(Program {
        name: raw.name,
        functions,
    })
}

#[derive(Deserialize)]
struct RawProgram {
    schema_version: u64,
    name: String,
    groups: Vec<RawGroup>,
    functions: Vec<RawFunction>,
}

#[derive(Deserialize)]
struct RawGroup {
    name: String,
    elements: Vec<RawElement>,
}

#[derive(Deserialize)]
struct RawElement {
    name: String,
}

#[derive(Deserialize)]
struct RawInput {
    group: String,
}

#[derive(Deserialize)]
struct RawFunction {
    name: String,
    inputs: Vec<RawInput>,
    outputs: Vec<Output>,
    work_size: usize,
    instructions: Vec<Vec<Value>>,
}

impl RawFunction {
    fn check(self, groups: &[RawGroup]) -> Result<Function, OracleError> {
        let inputs = self
            .inputs
            .iter()
            .map(|input| {
                let group = groups.iter().find(|group| group.name == input.group);
                let group = group.ok_or_else(|| OracleError::Unknown {
                    kind: "group",
                    name: input.group.clone(),
                })?;
                Ok(Group {
                    name: group.name.clone(),
                    elements: group.elements.iter().map(|e| e.name.clone()).collect(),
                })
            })
            .collect::<Result<Vec<_>, OracleError>>()?;
        let mut function = Function {
            name: self.name,
            inputs,
            outputs: self.outputs,
            work_size: self.work_size,
            instructions: Vec::with_capacity(self.instructions.len()),
        };
        for (index, raw) in self.instructions.iter().enumerate() {
            let instruction =
                parse(&function, raw).map_err(|problem| OracleError::Instruction {
                    function: function.name.clone(),
                    index,
                    problem,
                })?;
            function.instructions.push(instruction);
        }
        Ok(function)
    }
}

fn parse(function: &Function, raw: &[Value]) -> Result<Instruction, String> {
    let operation = raw.first().and_then(Value::as_str).ok_or("no operation")?;
    let place = |at: usize| bounded(raw, at, function.work_size, "work vector");
    let input_sizes = || function.inputs.iter().map(|group| group.elements.len());
    let output_sizes = || function.outputs.iter().map(|output| output.nonzeros.len());
    let instruction = match operation {
        "const" => Instruction::Const {
            to: place(1)?,
            value: raw.get(2).and_then(Value::as_f64).ok_or("no constant")?,
        },
        "input" => Instruction::Input {
            to: place(1)?,
            scalar: flat(raw, 2, input_sizes())?,
        },
        "output" => Instruction::Output {
            nonzero: flat(raw, 1, output_sizes())?,
            from: place(3)?,
        },
        name if raw.len() == 3 => Instruction::Unary {
            operation: named(name)?,
            to: place(1)?,
            operand: place(2)?,
        },
        name => Instruction::Binary {
            operation: named(name)?,
            to: place(1)?,
            left: place(2)?,
            right: place(3)?,
        },
    };
    Ok(instruction)
}

/// The number at `at`, which must be below `limit`.
fn bounded(raw: &[Value], at: usize, limit: usize, of: &str) -> Result<usize, String> {
    let number = raw
        .get(at)
        .and_then(Value::as_u64)
        .ok_or(format!("no number at {at}"))?;
    usize::try_from(number)
        .ok()
        .filter(|&number| number < limit)
        .ok_or(format!("{number} is beyond the {of} of {limit}"))
}

/// Flat place of the pair (vector, element) that stands at `at`.
fn flat(raw: &[Value], at: usize, sizes: impl Iterator<Item = usize>) -> Result<usize, String> {
    let sizes: Vec<usize> = sizes.collect();
    let vector = bounded(raw, at, sizes.len(), "list of vectors")?;
    let element = bounded(raw, at + 1, sizes[vector], "vector")?;
    Ok(sizes[..vector].iter().sum::<usize>() + element)
}

fn named<T: DeserializeOwned>(name: &str) -> Result<T, String> {
    serde_json::from_value(Value::from(name)).map_err(|_| format!("unknown operation `{name}`"))
}
