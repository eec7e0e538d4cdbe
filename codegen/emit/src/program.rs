//! A checked program: the content of a derivation, in types.
//!
//! Everything that [`Program::from_json`] returns is consistent: names are fit for Rust,
//! instructions read only what was written, every output element is written once, and the
//! model refers to functions and groups that exist and fit together.

mod check;
mod context;
mod external;
mod instructions;
mod model;
mod names;
mod operation;
mod schema;
mod table;

pub use external::{External, MOST_ARGUMENTS};
pub use names::is_snake_case;
pub(crate) use names::{pascal_case, screaming_case};
pub use operation::{BinaryOperation, UnaryOperation};
pub use table::{Field, Kind, Table, Value};

use std::collections::BTreeMap;

use crate::Error;

/// Version of the program files that this crate reads.
pub const SCHEMA_VERSION: u32 = 1;

/// Most instructions of a function: what they become is more than a compiler takes.
pub const MOST_INSTRUCTIONS: usize = 1_000_000;

/// Most elements of an output, zeros included: rows by columns.
pub const LARGEST_OUTPUT: usize = 1 << 24;

/// Functions, the groups of scalars they take, and maybe a model made of them.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Program {
    /// File the program is from, for messages.
    pub origin: String,
    /// Name of the module.
    pub name: String,
    /// Meaning.
    pub doc: String,
    /// Version of CasADi that wrote it.
    pub casadi_version: String,
    /// Groups of inputs, in order of first use.
    pub groups: Vec<Group>,
    /// Functions, in the order of the derivation.
    pub functions: Vec<Function>,
    /// The model that the functions make up, if they do.
    pub model: Option<Model>,
    /// Facts for the code that uses the program.
    pub tables: Vec<Table>,
    /// Functions of the surrounding Rust that instructions call.
    pub externals: Vec<External>,
}

/// A named vector of scalar inputs.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Group {
    /// Name of the argument.
    pub name: String,
    /// Meaning.
    pub doc: String,
    /// Its scalars in order.
    pub elements: Vec<Element>,
}

/// One scalar of a group.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Element {
    /// Name in Rust.
    pub name: String,
    /// Public id; the name where the derivation gives none.
    pub id: String,
    /// Unit.
    pub unit: String,
    /// Meaning.
    pub doc: String,
}

/// A function of some groups, as a list of instructions.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Function {
    /// Name in Rust.
    pub name: String,
    /// Meaning.
    pub doc: String,
    /// Source of the formula.
    pub source: String,
    /// Inputs for which it holds.
    pub domain: String,
    /// The groups it takes: indices into [`Program::groups`].
    pub inputs: Vec<usize>,
    /// Outputs.
    pub outputs: Vec<Output>,
    /// Number of scalars the instructions work on.
    pub work_size: usize,
    /// Instructions, in order.
    pub instructions: Vec<Instruction>,
}

/// A vector or matrix that a function gives, by its structural nonzeros.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Output {
    /// Name of the field.
    pub name: String,
    /// Meaning.
    pub doc: String,
    /// Unit.
    pub unit: String,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns; 1 for a vector.
    pub columns: usize,
    /// Names of the rows, or nothing.
    pub row_names: Vec<String>,
    /// Names of the columns, or nothing.
    pub column_names: Vec<String>,
    /// Row and column of each structural nonzero, in the order of the instructions.
    pub nonzeros: Vec<(usize, usize)>,
}

/// One step of a function. `to`, `from` and operands are places in the work vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Instruction {
    /// Reads an element of an input.
    Input {
        /// Place to write.
        to: usize,
        /// Index of the input of the function.
        input: usize,
        /// Index of the element of the input.
        element: usize,
    },
    /// Writes a structural nonzero of an output.
    Output {
        /// Index of the output of the function.
        output: usize,
        /// Index of the nonzero of the output.
        nonzero: usize,
        /// Place to read.
        from: usize,
    },
    /// Writes a number.
    Constant {
        /// Place to write.
        to: usize,
        /// The number, finite.
        value: f64,
    },
    /// A function of one scalar.
    Unary {
        /// The function.
        operation: UnaryOperation,
        /// Place to write.
        to: usize,
        /// Its argument.
        operand: usize,
    },
    /// A function of two scalars.
    Binary {
        /// The function.
        operation: BinaryOperation,
        /// Place to write.
        to: usize,
        /// First argument.
        left: usize,
        /// Second argument.
        right: usize,
    },
    /// A function of the surrounding Rust.
    Call {
        /// Index of the function among [`Program::externals`].
        external: usize,
        /// Place to write.
        to: usize,
        /// Its arguments, as many as it has, then zeros.
        operands: [usize; MOST_ARGUMENTS],
        /// Number of its arguments.
        count: usize,
    },
}

/// A continuous model: the parts that groups and functions play in it.
///
/// Groups and functions are indices into those of the program.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Model {
    /// Name of the type in Rust.
    pub name: String,
    /// Meaning.
    pub doc: String,
    /// The states that move.
    pub moving: usize,
    /// The states that are constant, if there are any.
    pub parameters: Option<usize>,
    /// Name of the noise inputs, as in `rate_d_NOISE`; a group of that name need not exist.
    pub noise: Option<String>,
    /// Inputs of rates and outputs besides the state.
    pub inputs: Vec<usize>,
    /// Rates of the moving states.
    pub rates: ModelFunction,
    /// Outputs of sensors.
    pub output: ModelFunction,
    /// The state space is flat: corrections are added to the moving states. Otherwise they are
    /// coordinates in a chart, whose movement hand-written code defines.
    pub flat: bool,
}

/// A value and, by another function, the value with its Jacobians.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelFunction {
    /// Function with the value alone.
    pub value: usize,
    /// Function with the value first, then Jacobians named `VALUE_d_GROUP`.
    pub jacobian: usize,
    /// The same outputs where all moving states are zero, if there is a shorter form of them.
    pub jacobian_at_origin: Option<usize>,
}

impl Program {
    /// Reads and checks a program; `origin` is the file name that messages show.
    ///
    /// # Errors
    /// If the text is not a program of [`SCHEMA_VERSION`], or if it contradicts itself.
    pub fn from_json(text: &str, origin: &str) -> Result<Self, Error> {
        check::program(schema::parse(text, origin)?, origin)
    }

    /// The groups that a function takes, in the order of its arguments.
    pub fn inputs_of<'a>(&'a self, function: &'a Function) -> impl Iterator<Item = &'a Group> {
        function.inputs.iter().map(|&index| &self.groups[index])
    }
}

impl Output {
    /// Every entry is a structural nonzero.
    #[must_use]
    pub fn is_full(&self) -> bool {
        self.nonzeros.len() == self.rows * self.columns
    }

    /// Index of the nonzero at a row and column, if it is one.
    #[must_use]
    pub fn nonzero_at(&self, row: usize, column: usize) -> Option<usize> {
        self.nonzeros
            .iter()
            .position(|&place| place == (row, column))
    }

    /// Indices of the nonzeros by row and column.
    #[must_use]
    pub(crate) fn places(&self) -> BTreeMap<(usize, usize), usize> {
        self.nonzeros.iter().copied().zip(0..).collect()
    }
}
