//! A tape with less to do: inputs that are zero folded away, and outputs that nobody reads left out.
//!
//! Sizes of effects that a model does not have are zero, and a fit of it needs no derivatives by them: of the
//! terms of a catalogue those of one model are left. At finite numbers every value is the same to the last bit.

use std::collections::HashMap;

use gyrocal_codegen::ir::Binary;

use super::{Operation, Tape, value};

/// What is known of a place.
#[derive(Clone, Copy)]
enum Known {
    Constant(f64),
    /// The value of this place.
    Place(usize),
}

impl Operation {
    /// Places that it reads, twice the same of an operation of one number.
    fn reads(self) -> [usize; 2] {
        let both = match self {
            Self::Add(x, y) | Self::Sub(x, y) | Self::Mul(x, y) | Self::Div(x, y) => [x, y],
            Self::Binary(_, x, y) => [x, y],
            Self::Negate(x) | Self::Unary(_, x) => [x, x],
        };
        both.map(|place| place as usize)
    }

    /// The same with other places.
    fn reading(self, [x, y]: [u32; 2]) -> Self {
        match self {
            Self::Add(..) => Self::Add(x, y),
            Self::Sub(..) => Self::Sub(x, y),
            Self::Mul(..) => Self::Mul(x, y),
            Self::Div(..) => Self::Div(x, y),
            Self::Binary(function, ..) => Self::Binary(function, x, y),
            Self::Negate(_) => Self::Negate(x),
            Self::Unary(function, _) => Self::Unary(function, x),
        }
    }

    /// What its value is, if that takes no operation.
    fn folded(self, x: Known, y: Known) -> Option<Known> {
        let zero = |known: Known| matches!(known, Known::Constant(value) if value == 0.0);
        if let (Known::Constant(x), Known::Constant(y)) = (x, y) {
            return Some(Known::Constant(value(self.reading([0, 1]), &[x, y])));
        }
        match self {
            Self::Mul(..) if zero(x) || zero(y) => Some(Known::Constant(0.0)),
            Self::Div(..) | Self::Binary(Binary::IfElseZero, ..) if zero(x) => {
                Some(Known::Constant(0.0))
            }
            Self::Add(..) if zero(x) => Some(y),
            Self::Add(..) | Self::Sub(..) if zero(y) => Some(x),
            _ => None,
        }
    }
}

impl Tape {
    /// The tape with some inputs of the function zero; of each output the nonzeros that are kept.
    pub(crate) fn narrowed(
        &self,
        is_zero: impl Fn(usize, usize) -> bool,
        keep: impl Fn(usize, usize) -> bool,
    ) -> Self {
        let (first_input, first) = (
            self.constants.len(),
            self.constants.len() + self.inputs.len(),
        );
        let constants = self.constants.iter().map(|value| Known::Constant(*value));
        let inputs = self.inputs.iter().zip(first_input..);
        let inputs = inputs.map(|((group, element), place)| {
            if is_zero(*group, *element) {
                Known::Constant(0.0)
            } else {
                Known::Place(place)
            }
        });
        let mut known: Vec<Known> = constants.chain(inputs).collect();
        for operation in &self.operations {
            let [x, y] = operation.reads().map(|place| known[place]);
            let own = Known::Place(known.len());
            known.push(operation.folded(x, y).unwrap_or(own));
        }
        let outputs = self.outputs.iter().enumerate().map(|(output, places)| {
            let kept = places.iter().enumerate();
            kept.filter(|(index, _)| keep(output, *index))
                .map(|(_, place)| known[*place])
                .collect()
        });
        self.with(&known, first, &outputs.collect::<Vec<_>>())
    }

    /// A tape of what these outputs need.
    fn with(&self, known: &[Known], first: usize, outputs: &[Vec<Known>]) -> Self {
        let mut needed = vec![false; known.len()];
        let need = |known: Known, needed: &mut Vec<bool>| {
            if let Known::Place(place) = known {
                needed[place] = true;
            }
        };
        for output in outputs.iter().flatten() {
            need(*output, &mut needed);
        }
        for (index, operation) in self.operations.iter().enumerate().rev() {
            if needed[first + index] {
                for place in operation.reads() {
                    need(known[place], &mut needed);
                }
            }
        }
        let read = |place: &usize| needed[*place];
        let operations: Vec<usize> = (first..known.len()).filter(read).collect();
        let inputs: Vec<usize> = (self.constants.len()..first).filter(read).collect();
        let mut places = Places::default();
        let of_operations = operations
            .iter()
            .flat_map(|place| self.operations[place - first].reads())
            .map(|place| known[place]);
        for known in outputs.iter().flatten().copied().chain(of_operations) {
            places.add_constant(known);
        }
        let before = places.constants.len() as u32;
        let moved = inputs.iter().chain(&operations).copied();
        places.moved = moved.zip(before..).collect();
        let moved_operations = operations.iter().map(|place| {
            let operation = self.operations[place - first];
            operation.reading(operation.reads().map(|place| places.of(known[place])))
        });
        let nonzeros = |output: &Vec<Known>| {
            let all = output.iter();
            all.map(|known| places.of(*known) as usize).collect()
        };
        Self {
            operations: moved_operations.collect(),
            inputs: inputs
                .iter()
                .map(|place| self.inputs[place - self.constants.len()])
                .collect(),
            outputs: outputs.iter().map(nonzeros).collect(),
            constants: places.constants,
        }
    }
}

/// Places of a new tape.
#[derive(Default)]
struct Places {
    constants: Vec<f64>,
    /// Place of each constant, by its bits.
    known: HashMap<u64, u32>,
    /// New places of inputs and operations, by the old ones.
    moved: HashMap<usize, u32>,
}

impl Places {
    fn add_constant(&mut self, known: Known) {
        if let Known::Constant(value) = known {
            let next = self.constants.len() as u32;
            if *self.known.entry(value.to_bits()).or_insert(next) == next {
                self.constants.push(value);
            }
        }
    }

    fn of(&self, known: Known) -> u32 {
        match known {
            Known::Constant(value) => self.known[&value.to_bits()],
            Known::Place(place) => self.moved[&place],
        }
    }
}
