//! Runs the instruction list of a program, one instruction after the other.
//!
//! Nothing is simplified or shared, and all elementary functions are those of the standard library,
//! so that errors of the emitter and of the project's own sine and cosine become visible.

use crate::OracleError;
use crate::program::{Binary, Function, Instruction, Unary};

impl Function {
    /// Structural nonzeros of all outputs, in the order of the program.
    ///
    /// `inputs` are the scalars of all groups, one group after the other.
    ///
    /// # Errors
    /// If the number of inputs is not [`Self::input_count`].
    pub fn evaluate(&self, inputs: &[f64]) -> Result<Vec<f64>, OracleError> {
        if inputs.len() != self.input_count() {
            return Err(OracleError::Inputs {
                function: self.name.clone(),
                expected: self.input_count(),
                found: inputs.len(),
            });
        }
        let mut work = vec![f64::NAN; self.work_size];
        // An output that no instruction writes stays NaN, which agrees with nothing.
        let mut outputs = vec![f64::NAN; self.nonzero_count()];
        for instruction in &self.instructions {
            match *instruction {
                Instruction::Const { to, value } => work[to] = value,
                Instruction::Input { to, scalar } => work[to] = inputs[scalar],
                Instruction::Output { nonzero, from } => outputs[nonzero] = work[from],
                Instruction::Unary {
                    operation,
                    to,
                    operand,
                } => {
                    work[to] = unary(operation, work[operand]);
                }
                Instruction::Binary {
                    operation,
                    to,
                    left,
                    right,
                } => {
                    work[to] = binary(operation, work[left], work[right]);
                }
            }
        }
        Ok(outputs)
    }
}

fn unary(operation: Unary, x: f64) -> f64 {
    match operation {
        Unary::Neg => -x,
        Unary::Sq => x * x,
        Unary::Twice => 2.0 * x,
        Unary::Inv => 1.0 / x,
        Unary::Sqrt => x.sqrt(),
        Unary::Exp => x.exp(),
        Unary::Log => x.ln(),
        Unary::Sin => x.sin(),
        Unary::Cos => x.cos(),
        Unary::Tan => x.tan(),
        Unary::Asin => x.asin(),
        Unary::Acos => x.acos(),
        Unary::Atan => x.atan(),
        Unary::Sinh => x.sinh(),
        Unary::Cosh => x.cosh(),
        Unary::Tanh => x.tanh(),
        Unary::Abs => x.abs(),
        // CasADi: sign(0) is 0 and sign(NaN) is NaN, unlike `f64::signum`.
        Unary::Sign if x.is_nan() => x,
        Unary::Sign => truth(x > 0.0) - truth(x < 0.0),
        Unary::Not => truth(x == 0.0),
        Unary::Copy => x,
    }
}

fn binary(operation: Binary, x: f64, y: f64) -> f64 {
    match operation {
        Binary::Add => x + y,
        Binary::Sub => x - y,
        Binary::Mul => x * y,
        Binary::Div => x / y,
        Binary::Pow => x.powf(y),
        Binary::Atan2 => x.atan2(y),
        Binary::Min => x.min(y),
        Binary::Max => x.max(y),
        Binary::Lt => truth(x < y),
        Binary::Le => truth(x <= y),
        Binary::Eq => truth(x == y),
        Binary::Ne => truth(x != y),
        Binary::And => truth(x != 0.0 && y != 0.0),
        Binary::Or => truth(x != 0.0 || y != 0.0),
        Binary::IfElseZero => {
            if x == 0.0 {
                0.0
            } else {
                y
            }
        }
    }
}

fn truth(holds: bool) -> f64 {
    if holds { 1.0 } else { 0.0 }
}
