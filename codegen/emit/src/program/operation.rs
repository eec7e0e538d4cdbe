//! Operations by their names in the file, and lists of instructions: checks that operations are
//! known, places are within bounds and written before they are read, and every nonzero is written
//! once.

use std::collections::BTreeSet;

use serde_json::Value;

use super::context::{Context, DERIVE_AGAIN};
use super::{Instruction, Output};
use crate::Error;

macro_rules! operations {
    ($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $variant:ident = $text:literal),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum $name { $($(#[$variant_doc])* $variant),* }

        impl $name {
            /// The names in program files.
            pub const NAMES: &[&str] = &[$($text),*];

            /// The operation of a name.
            #[must_use]
            pub fn from_name(name: &str) -> Option<Self> {
                match name {
                    $($text => Some(Self::$variant),)*
                    _ => None,
                }
            }
        }
    };
}

operations! {
    /// Functions of one scalar.
    UnaryOperation {
        /// The operand itself.
        Copy = "copy",
        /// -x.
        Negate = "neg",
        /// x x.
        Square = "sq",
        /// x + x.
        Twice = "twice",
        /// 1 / x.
        Reciprocal = "inv",
        /// Square root.
        Sqrt = "sqrt",
        /// Natural exponential.
        Exp = "exp",
        /// Natural logarithm.
        Log = "log",
        /// Sine.
        Sin = "sin",
        /// Cosine.
        Cos = "cos",
        /// Tangent.
        Tan = "tan",
        /// Inverse sine.
        Asin = "asin",
        /// Inverse cosine.
        Acos = "acos",
        /// Inverse tangent.
        Atan = "atan",
        /// Hyperbolic sine.
        Sinh = "sinh",
        /// Hyperbolic cosine.
        Cosh = "cosh",
        /// Hyperbolic tangent.
        Tanh = "tanh",
        /// Absolute value.
        Abs = "abs",
        /// -1, 0 or 1.
        Sign = "sign",
        /// 1 where x is 0, else 0.
        Not = "not",
    }
}

operations! {
    /// Functions of two scalars.
    BinaryOperation {
        /// x + y.
        Add = "add",
        /// x - y.
        Sub = "sub",
        /// x y.
        Mul = "mul",
        /// x / y.
        Div = "div",
        /// x to the power y.
        Pow = "pow",
        /// Angle of the point (y, x), x being the first operand.
        Atan2 = "atan2",
        /// The smaller.
        Min = "min",
        /// The larger.
        Max = "max",
        /// 1 where x < y, else 0.
        Less = "lt",
        /// 1 where x <= y, else 0.
        LessOrEqual = "le",
        /// 1 where x = y, else 0.
        Equal = "eq",
        /// 1 where x and y differ, else 0.
        NotEqual = "ne",
        /// 1 where neither is 0, else 0.
        And = "and",
        /// 1 where one is not 0, else 0.
        Or = "or",
        /// y where x is not 0, else 0.
        IfElseZero = "if_else_zero",
    }
}

/// Sizes of the objects that the instructions of a function may refer to.
pub(super) struct Instructions<'a> {
    pub(super) context: &'a Context<'a>,
    pub(super) place: &'a str,
    pub(super) input_lengths: &'a [usize],
    pub(super) outputs: &'a [Output],
    pub(super) work_size: usize,
}

impl Instructions<'_> {
    pub(super) fn check(&self, raw: &[Vec<Value>]) -> Result<Vec<Instruction>, Error> {
        let mut set = BTreeSet::new();
        let mut written: Vec<Vec<bool>> = self
            .outputs
            .iter()
            .map(|output| vec![false; output.nonzeros.len()])
            .collect();
        let mut result = Vec::with_capacity(raw.len());
        for (index, values) in raw.iter().enumerate() {
            let place = format!("{}, instruction {index}", self.place);
            let instruction = self.instruction(&place, values)?;
            for operand in operands(instruction) {
                if !set.contains(&operand) {
                    return Err(self.context.error(
                        &place,
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
                        return Err(self.context.error(
                            &place,
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
                | Instruction::Binary { to, .. } => {
                    set.insert(to);
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

    fn instruction(&self, place: &str, values: &[Value]) -> Result<Instruction, Error> {
        let Some(name) = values.first().and_then(Value::as_str) else {
            return Err(self.context.error(
                place,
                Value::from(values),
                "a list that begins with the name of an operation",
                DERIVE_AGAIN,
            ));
        };
        let operands = &values[1..];
        match name {
            "input" => {
                let [to, input, element] = self.indices(place, operands)?;
                let length = self.within(place, "input", input, self.input_lengths.len(), |i| {
                    self.input_lengths[i]
                })?;
                self.within(place, "element of the input", element, length, |_| ())?;
                Ok(Instruction::Input {
                    to: self.work(place, to)?,
                    input,
                    element,
                })
            }
            "output" => {
                let [output, nonzero, from] = self.indices(place, operands)?;
                let count = self.within(place, "output", output, self.outputs.len(), |i| {
                    self.outputs[i].nonzeros.len()
                })?;
                self.within(place, "nonzero of the output", nonzero, count, |_| ())?;
                Ok(Instruction::Output {
                    output,
                    nonzero,
                    from: self.work(place, from)?,
                })
            }
            "const" => self.constant(place, operands),
            _ => {
                if let Some(operation) = UnaryOperation::from_name(name) {
                    let [to, operand] = self.indices(place, operands)?;
                    let (to, operand) = (self.work(place, to)?, self.work(place, operand)?);
                    Ok(Instruction::Unary {
                        operation,
                        to,
                        operand,
                    })
                } else if let Some(operation) = BinaryOperation::from_name(name) {
                    let [to, left, right] = self.indices(place, operands)?;
                    let to = self.work(place, to)?;
                    let (left, right) = (self.work(place, left)?, self.work(place, right)?);
                    Ok(Instruction::Binary {
                        operation,
                        to,
                        left,
                        right,
                    })
                } else {
                    let mut known = [UnaryOperation::NAMES, BinaryOperation::NAMES].concat();
                    known.sort_unstable();
                    Err(Error::Operation {
                        origin: self.context.origin.to_owned(),
                        place: place.to_owned(),
                        operation: name.to_owned(),
                        known: known.join(", "),
                    })
                }
            }
        }
    }

    fn constant(&self, place: &str, operands: &[Value]) -> Result<Instruction, Error> {
        let [to, value] = operands else {
            return Err(self.count(place, 2, operands.len()));
        };
        let [to] = self.indices(place, std::slice::from_ref(to))?;
        let to = self.work(place, to)?;
        match value.as_f64() {
            Some(value) if value.is_finite() => Ok(Instruction::Constant { to, value }),
            _ => Err(self.context.error(
                place,
                format!("the constant {value}"),
                "a finite number",
                "look for a division by zero or an overflow in the derivation",
            )),
        }
    }

    fn indices<const N: usize>(&self, place: &str, values: &[Value]) -> Result<[usize; N], Error> {
        if values.len() != N {
            return Err(self.count(place, N, values.len()));
        }
        let mut indices = [0; N];
        for (index, value) in indices.iter_mut().zip(values) {
            *index = value
                .as_u64()
                .and_then(|value| usize::try_from(value).ok())
                .ok_or_else(|| {
                    self.context.error(
                        place,
                        format!("the operand {value}"),
                        "a count from 0 on",
                        DERIVE_AGAIN,
                    )
                })?;
        }
        Ok(indices)
    }

    fn count(&self, place: &str, expected: usize, found: usize) -> Error {
        self.context.error(
            place,
            format!("{found} operands"),
            format!("{expected} operands"),
            DERIVE_AGAIN,
        )
    }

    fn work(&self, place: &str, index: usize) -> Result<usize, Error> {
        self.within(place, "work element", index, self.work_size, |index| index)
    }

    fn within<R>(
        &self,
        place: &str,
        what: &str,
        index: usize,
        count: usize,
        then: impl FnOnce(usize) -> R,
    ) -> Result<R, Error> {
        if index < count {
            return Ok(then(index));
        }
        Err(self.context.error(
            place,
            format!("{what} {index}"),
            format!("below {count}"),
            DERIVE_AGAIN,
        ))
    }
}

/// The places that an instruction reads.
fn operands(instruction: Instruction) -> impl Iterator<Item = usize> {
    let (first, second) = match instruction {
        Instruction::Input { .. } | Instruction::Constant { .. } => (None, None),
        Instruction::Output { from, .. } => (Some(from), None),
        Instruction::Unary { operand, .. } => (Some(operand), None),
        Instruction::Binary { left, right, .. } => (Some(left), Some(right)),
    };
    first.into_iter().chain(second)
}
