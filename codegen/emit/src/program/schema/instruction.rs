//! An instruction as it stands in the file, without a heap of its own in the usual case: programs
//! have many.

use serde::de::{Deserialize, Deserializer, SeqAccess, Visitor};
use serde_json::Value;

use crate::program::MOST_ARGUMENTS;
use crate::program::operation::Name;

/// Most operands that are kept in place: those of a call.
const FEW: usize = MOST_ARGUMENTS + 1;

/// The first element of an instruction, and the others.
pub(in crate::program) struct RawInstruction {
    pub(in crate::program) name: Result<Name, Box<Value>>,
    pub(in crate::program) operands: RawOperands,
}

/// Operands: counts, few of them, or anything.
pub(in crate::program) enum RawOperands {
    Counts([u32; FEW], u8),
    Others(Vec<Value>),
}

impl RawOperands {
    fn push(&mut self, value: Value) {
        if let Self::Counts(counts, length) = self
            && usize::from(*length) < FEW
            && let Some(count) = value.as_u64().and_then(|count| u32::try_from(count).ok())
        {
            counts[usize::from(*length)] = count;
            *length += 1;
            return;
        }
        if let Self::Others(values) = self {
            values.push(value);
            return;
        }
        let mut values = self.values();
        values.push(value);
        *self = Self::Others(values);
    }

    /// The operands as they stand in the file.
    pub(in crate::program) fn values(&self) -> Vec<Value> {
        match self {
            Self::Counts(counts, length) => counts[..usize::from(*length)]
                .iter()
                .map(|&count| Value::from(count))
                .collect(),
            Self::Others(values) => values.clone(),
        }
    }
}

impl<'de> Deserialize<'de> for RawInstruction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(InstructionVisitor)
    }
}

struct InstructionVisitor;

impl<'de> Visitor<'de> for InstructionVisitor {
    type Value = RawInstruction;

    fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("a list that begins with the name of an operation")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<RawInstruction, A::Error> {
        let first = list.next_element::<Value>()?.unwrap_or(Value::Null);
        let name = first.as_str().and_then(Name::from_text);
        let mut operands = RawOperands::Counts([0; FEW], 0);
        while let Some(value) = list.next_element::<Value>()? {
            operands.push(value);
        }
        Ok(RawInstruction {
            name: name.ok_or_else(|| Box::new(first)),
            operands,
        })
    }
}
