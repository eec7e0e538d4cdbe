//! Runs the instruction list of a program, one instruction after the other.
//!
//! Nothing is simplified or shared, and all elementary functions are those of the standard library,
//! so that errors of the emitter and of the project's own sine and cosine become visible.

use crate::OracleError;
use crate::error_function;
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
        Unary::Asinh => x.asinh(),
        Unary::Acosh => x.acosh(),
        Unary::Atanh => x.atanh(),
        Unary::Erf => error_function::erf(x),
        Unary::Erfinv => error_function::erf_inv(x),
        Unary::Floor => x.floor(),
        Unary::Ceil => x.ceil(),
        Unary::Log1p => x.ln_1p(),
        Unary::Expm1 => x.exp_m1(),
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
        Binary::Fmod => x % y,
        Binary::Remainder => remainder(x, y),
        Binary::Hypot => x.hypot(y),
        Binary::Copysign => x.copysign(y),
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

/// What x / y, rounded to the nearest integer and half to even, leaves: exact.
fn remainder(x: f64, y: f64) -> f64 {
    if x.abs() < 0.5 * y.abs() {
        return x;
    }
    // Room for 2 |y|; nothing here is so small that the scale would round it.
    let scale = if y.abs() > f64::MAX / 4.0 { 0.25 } else { 1.0 };
    let (size, step) = (x.abs() * scale, y.abs() * scale);
    // An even number of steps away from x. Differences of numbers within a factor of two are exact.
    let mut rest = size % (2.0 * step);
    if rest + rest > step {
        rest -= step;
        if rest + rest >= step {
            rest -= step;
        }
    }
    rest / scale * 1.0_f64.copysign(x)
}

fn truth(holds: bool) -> f64 {
    if holds { 1.0 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::remainder;

    #[test]
    fn remainders_are_those_of_the_standard() {
        let cases = [
            (5.0, 3.0, -1.0),
            (-5.0, 3.0, 1.0),
            (2.5, 1.0, 0.5),
            (3.5, 1.0, -0.5),
            (1e300, 7.0, 1.0),
            (f64::MAX, 0.75 * f64::MAX, f64::MAX - 0.75 * f64::MAX),
            (1e-310, f64::MAX, 1e-310),
            (1.0, f64::INFINITY, 1.0),
        ];
        for (x, y, expected) in cases {
            assert_eq!(remainder(x, y), expected, "{x:e}, {y:e}");
        }
        assert!(remainder(1.0, 0.0).is_nan() && remainder(f64::INFINITY, 1.0).is_nan());
        assert!(remainder(-3.0, 3.0).is_sign_negative());
    }
}
