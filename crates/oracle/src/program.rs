//! Programs as the exporter writes them: named functions of flat scalar instructions.
//!
//! The schema is described in `codegen/emit/exporter/casadi_program.py`. Everything that
//! an instruction refers to is checked once, on reading.

mod parse;

use serde::Deserialize;

use crate::OracleError;

/// A set of functions.
#[derive(Clone, Debug)]
pub struct Program {
    /// Name of the program, which is that of the generated module.
    pub name: String,
    /// The functions, in the order of the file.
    pub functions: Vec<Function>,
}

/// A named function of groups of scalars.
#[derive(Clone, Debug)]
pub struct Function {
    /// Name of the function, which is that of the generated one.
    pub name: String,
    /// The groups of scalars that it takes.
    pub inputs: Vec<Group>,
    /// Its outputs.
    pub outputs: Vec<Output>,
    /// Scalars in the work vector.
    pub work_size: usize,
    /// Its instructions. Tests change them to show that an oracle can disagree.
    pub instructions: Vec<Instruction>,
}

/// A named vector of scalar inputs.
#[derive(Clone, Debug)]
pub struct Group {
    /// Name of the group.
    pub name: String,
    /// Names of its scalars.
    pub elements: Vec<String>,
}

/// A result: a matrix (a vector has one column) of which structural nonzeros are computed.
#[derive(Clone, Debug, Deserialize)]
pub struct Output {
    /// Name of the output.
    pub name: String,
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Names of the rows; may be empty.
    pub row_names: Vec<String>,
    /// Names of the columns; may be empty.
    pub column_names: Vec<String>,
    /// Row and column of each structural nonzero.
    pub nonzeros: Vec<(usize, usize)>,
}

/// One step of a function; `to`, `operand`, `left`, `right` are places in the work vector.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Instruction {
    /// `work[to] = value`.
    Const {
        /// Target.
        to: usize,
        /// The constant.
        value: f64,
    },
    /// `work[to] = inputs[scalar]`, inputs one group after the other.
    Input {
        /// Target.
        to: usize,
        /// Place in the flat inputs.
        scalar: usize,
    },
    /// `outputs[nonzero] = work[from]`, nonzeros one output after the other.
    Output {
        /// Place in the flat outputs.
        nonzero: usize,
        /// Source.
        from: usize,
    },
    /// `work[to] = operation(work[operand])`.
    Unary {
        /// Operation.
        operation: Unary,
        /// Target.
        to: usize,
        /// Operand.
        operand: usize,
    },
    /// `work[to] = operation(work[left], work[right])`.
    Binary {
        /// Operation.
        operation: Binary,
        /// Target.
        to: usize,
        /// First operand.
        left: usize,
        /// Second operand.
        right: usize,
    },
}

/// Operations on one scalar, by their names in the schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "the names say it")]
pub enum Unary {
    Neg,
    Sq,
    Twice,
    Inv,
    Sqrt,
    Exp,
    Log,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Asinh,
    Acosh,
    Atanh,
    Erf,
    Erfinv,
    Floor,
    Ceil,
    Log1p,
    Expm1,
    Abs,
    Sign,
    Not,
    Copy,
}

/// Operations on two scalars, by their names in the schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
#[expect(missing_docs, reason = "the names say it")]
pub enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Pow,
    Atan2,
    Fmod,
    Remainder,
    Hypot,
    Copysign,
    Min,
    Max,
    Lt,
    Le,
    Eq,
    Ne,
    And,
    Or,
    IfElseZero,
}

impl Program {
    /// Reads a program from the text of its file.
    ///
    /// # Errors
    /// If the text is not a program of the schema's version, or an instruction refers to something
    /// that does not exist.
    pub fn from_json(text: &str) -> Result<Self, OracleError> {
        parse::program(text)
    }

    /// The function called `name`.
    ///
    /// # Errors
    /// If there is none.
    pub fn function(&self, name: &str) -> Result<&Function, OracleError> {
        self.functions
            .iter()
            .find(|function| function.name == name)
            .ok_or_else(|| OracleError::Unknown {
                kind: "function",
                name: name.to_owned(),
            })
    }
}

impl Function {
    /// Scalars in all inputs together.
    #[must_use]
    pub fn input_count(&self) -> usize {
        self.inputs.iter().map(|group| group.elements.len()).sum()
    }

    /// Structural nonzeros of all outputs together.
    #[must_use]
    pub fn nonzero_count(&self) -> usize {
        self.outputs
            .iter()
            .map(|output| output.nonzeros.len())
            .sum()
    }

    /// Splits flat outputs (nonzeros, one output after the other) into one dense matrix,
    /// row by row, for each output, with `zero` for elements outside the structure.
    ///
    /// # Panics
    /// If `flat` is shorter than [`Self::nonzero_count`].
    #[must_use]
    pub fn dense_outputs<T: Copy>(&self, flat: &[T], zero: T) -> Vec<Vec<T>> {
        let mut rest = flat;
        self.outputs
            .iter()
            .map(|output| {
                let (own, others) = rest.split_at(output.nonzeros.len());
                rest = others;
                output.dense(own, zero)
            })
            .collect()
    }
}

impl Output {
    /// The dense matrix, row by row, from the structural nonzeros.
    #[must_use]
    pub fn dense<T: Copy>(&self, nonzeros: &[T], zero: T) -> Vec<T> {
        let mut dense = vec![zero; self.rows * self.columns];
        for (&(row, column), &value) in self.nonzeros.iter().zip(nonzeros) {
            dense[row * self.columns + column] = value;
        }
        dense
    }

    /// Name of a row, or its number where rows have no names.
    #[must_use]
    pub fn row_name(&self, row: usize) -> String {
        self.row_names
            .get(row)
            .cloned()
            .unwrap_or_else(|| row.to_string())
    }

    /// Name of a column, or its number where columns have no names.
    #[must_use]
    pub fn column_name(&self, column: usize) -> String {
        self.column_names
            .get(column)
            .cloned()
            .unwrap_or_else(|| column.to_string())
    }

    /// Name of a column, or nothing for the only column of a vector without names.
    #[must_use]
    pub fn column_label(&self, column: usize) -> String {
        if self.columns == 1 && self.column_names.is_empty() {
            String::new()
        } else {
            self.column_name(column)
        }
    }
}

#[cfg(test)]
mod tests;
