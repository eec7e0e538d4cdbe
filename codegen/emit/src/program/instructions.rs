//! Lists of instructions: checks that operations are known, places are within bounds and written
//! before they are read, and every nonzero is written once.

use serde_json::Value;

use super::context::{Context, DERIVE_AGAIN};
use super::operation::{BinaryOperation, Name, UnaryOperation};
use super::schema::{RawInstruction, RawOperands};
use super::{External, Instruction, MOST_ARGUMENTS, MOST_INSTRUCTIONS, Output};
use crate::Error;

/// Sizes of the objects that the instructions of a function may refer to.
pub(super) struct Instructions<'a> {
    pub(super) context: &'a Context<'a>,
    pub(super) place: &'a str,
    pub(super) input_lengths: &'a [usize],
    pub(super) outputs: &'a [Output],
    pub(super) externals: &'a [External],
    pub(super) work_size: usize,
}

/// One instruction of a list, for messages.
struct At<'a> {
    list: &'a Instructions<'a>,
    index: usize,
}

impl Instructions<'_> {
    pub(super) fn check(&self, raw: &[RawInstruction]) -> Result<Vec<Instruction>, Error> {
        if raw.len() > MOST_INSTRUCTIONS {
            return Err(self.context.error(
                self.place,
                format!("{} instructions", raw.len()),
                format!("at most {MOST_INSTRUCTIONS}, what a compiler can take"),
                "split the function, or keep loops and tables in Rust (external functions)",
            ));
        }
        // Work elements written so far. No more than `to` of an instruction is ever allocated.
        let mut set: Vec<bool> = Vec::new();
        let mut written: Vec<Vec<bool>> = self
            .outputs
            .iter()
            .map(|output| vec![false; output.nonzeros.len()])
            .collect();
        let mut result = Vec::with_capacity(raw.len());
        for (index, raw) in raw.iter().enumerate() {
            let at = At { list: self, index };
            let instruction = at.instruction(raw)?;
            for operand in operands(instruction) {
                if set.get(operand) != Some(&true) {
                    return Err(at.error(
                        format!("a use of work element {operand}, which is not set yet"),
                        "elements that an earlier instruction wrote",
                        DERIVE_AGAIN,
                    ));
                }
            }
            match instruction {
                Instruction::Output {
                    output, nonzero, ..
                } => {
                    if std::mem::replace(&mut written[output][nonzero], true) {
                        return Err(at.error(
                            format!(
                                "a second write of nonzero {nonzero} of output `{}`",
                                self.outputs[output].name
                            ),
                            "one write for each nonzero",
                            DERIVE_AGAIN,
                        ));
                    }
                }
                Instruction::Input { to, .. }
                | Instruction::Constant { to, .. }
                | Instruction::Unary { to, .. }
                | Instruction::Binary { to, .. }
                | Instruction::Call { to, .. } => {
                    if set.len() <= to {
                        set.resize(to + 1, false);
                    }
                    set[to] = true;
                }
            }
            result.push(instruction);
        }
        for (output, written) in self.outputs.iter().zip(written) {
            if let Some(nonzero) = written.iter().position(|&written| !written) {
                return Err(self.context.error(
                    self.place,
                    format!("no write of nonzero {nonzero} of output `{}`", output.name),
                    "one write for each nonzero",
                    DERIVE_AGAIN,
                ));
            }
        }
        Ok(result)
    }
}

impl At<'_> {
    fn place(&self) -> String {
        format!("{}, instruction {}", self.list.place, self.index)
    }

    fn error(
        &self,
        found: impl std::fmt::Display,
        expected: impl std::fmt::Display,
        remedy: &str,
    ) -> Error {
        let context = self.list.context;
        context.error(&self.place(), found, expected, remedy)
    }

    fn instruction(&self, raw: &RawInstruction) -> Result<Instruction, Error> {
        let operands = &raw.operands;
        match &raw.name {
            Ok(Name::Input) => {
                let [to, input, element] = self.indices(operands)?;
                let lengths = self.list.input_lengths;
                let input = self.within("input", input, lengths.len())?;
                let element = self.within("element of the input", element, lengths[input])?;
                Ok(Instruction::Input {
                    to: self.work(to)?,
                    input,
                    element,
                })
            }
            Ok(Name::Output) => {
                let [output, nonzero, from] = self.indices(operands)?;
                let outputs = self.list.outputs;
                let output = self.within("output", output, outputs.len())?;
                let count = outputs[output].nonzeros.len();
                Ok(Instruction::Output {
                    output,
                    nonzero: self.within("nonzero of the output", nonzero, count)?,
                    from: self.work(from)?,
                })
            }
            Ok(Name::Constant) => self.constant(operands),
            Ok(Name::Call) => self.call(operands),
            Ok(Name::Unary(operation)) => {
                let [to, operand] = self.indices(operands)?;
                Ok(Instruction::Unary {
                    operation: *operation,
                    to: self.work(to)?,
                    operand: self.work(operand)?,
                })
            }
            Ok(Name::Binary(operation)) => {
                let [to, left, right] = self.indices(operands)?;
                Ok(Instruction::Binary {
                    operation: *operation,
                    to: self.work(to)?,
                    left: self.work(left)?,
                    right: self.work(right)?,
                })
            }
            Err(first) => Err(self.unknown(first, operands)),
        }
    }

    fn unknown(&self, first: &Value, operands: &RawOperands) -> Error {
        let Some(name) = first.as_str() else {
            let values: Vec<Value> = match first {
                Value::Null => Vec::new(),
                first => std::iter::once(first.clone())
                    .chain(operands.values())
                    .collect(),
            };
            return self.error(
                Value::from(values),
                "a list that begins with the name of an operation",
                DERIVE_AGAIN,
            );
        };
        let mut known = [UnaryOperation::NAMES, BinaryOperation::NAMES].concat();
        known.sort_unstable();
        Error::Operation {
            origin: self.list.context.origin.to_owned(),
            place: self.place(),
            operation: name.to_owned(),
            known: known.join(", "),
        }
    }

    fn constant(&self, operands: &RawOperands) -> Result<Instruction, Error> {
        let values = operands.values();
        let [to, value] = &values[..] else {
            return Err(self.count(2, values.len()));
        };
        let to = self.work(self.index(to)?)?;
        match value.as_f64() {
            Some(value) if value.is_finite() => Ok(Instruction::Constant { to, value }),
            _ => Err(self.error(
                format!("the constant {value}"),
                "a finite number",
                "look for a division by zero or an overflow in the derivation",
            )),
        }
    }

    /// `["call", w, NAME, operand, ...]`.
    fn call(&self, operands: &RawOperands) -> Result<Instruction, Error> {
        let values = operands.values();
        let name = values.get(1).and_then(Value::as_str).unwrap_or_default();
        let externals = self.list.externals;
        let Some(external) = externals.iter().position(|external| external.name == name) else {
            let found = values.get(1).map_or("nothing".to_owned(), Value::to_string);
            return Err(self.error(
                format!("a call of {found}"),
                "the name of an external function of the program",
                DERIVE_AGAIN,
            ));
        };
        let expected = externals[external].arguments;
        if values.len() != expected + 2 {
            return Err(self.error(
                format!("{} arguments of `{name}`", values.len() - 2),
                expected,
                DERIVE_AGAIN,
            ));
        }
        let mut places = [0; MOST_ARGUMENTS];
        for (place, value) in places.iter_mut().zip(&values[2..]) {
            *place = self.work(self.index(value)?)?;
        }
        Ok(Instruction::Call {
            external,
            to: self.work(self.index(&values[0])?)?,
            operands: places,
            count: expected,
        })
    }

    fn indices<const N: usize>(&self, operands: &RawOperands) -> Result<[usize; N], Error> {
        let mut indices = [0; N];
        if let RawOperands::Counts(counts, length) = operands
            && usize::from(*length) == N
        {
            for (index, &count) in indices.iter_mut().zip(counts) {
                *index = count as usize;
            }
            return Ok(indices);
        }
        let values = operands.values();
        if values.len() != N {
            return Err(self.count(N, values.len()));
        }
        for (index, value) in indices.iter_mut().zip(&values) {
            *index = self.index(value)?;
        }
        Ok(indices)
    }

    fn index(&self, value: &Value) -> Result<usize, Error> {
        let index = value.as_u64().and_then(|value| usize::try_from(value).ok());
        index.ok_or_else(|| {
            self.error(
                format!("the operand {value}"),
                "a count from 0 on",
                DERIVE_AGAIN,
            )
        })
    }

    fn count(&self, expected: usize, found: usize) -> Error {
        self.error(
            format!("{found} operands"),
            format!("{expected} operands"),
            DERIVE_AGAIN,
        )
    }

    fn work(&self, index: usize) -> Result<usize, Error> {
        self.within("work element", index, self.list.work_size)
    }

    fn within(&self, what: &str, index: usize, count: usize) -> Result<usize, Error> {
        if index < count {
            return Ok(index);
        }
        Err(self.error(
            format!("{what} {index}"),
            format!("below {count}"),
            DERIVE_AGAIN,
        ))
    }
}

/// The places that an instruction reads.
fn operands(instruction: Instruction) -> impl Iterator<Item = usize> {
    let mut places = [0; MOST_ARGUMENTS];
    let count = match instruction {
        Instruction::Input { .. } | Instruction::Constant { .. } => 0,
        Instruction::Output { from: place, .. } | Instruction::Unary { operand: place, .. } => {
            places[0] = place;
            1
        }
        Instruction::Binary { left, right, .. } => {
            places[..2].copy_from_slice(&[left, right]);
            2
        }
        Instruction::Call {
            operands, count, ..
        } => {
            places = operands;
            count
        }
    };
    places.into_iter().take(count)
}
