use gyrocal_scalar::Scalar;

use super::{Binary, Expressions, Node, Unary};

/// Values of every structural nonzero of every output at one point, in `f64`.
///
/// `inputs` are the elements of each input of the function; an element that is not given
/// is NaN, and so is a call of an external function, of which only the name is known.
#[must_use]
pub fn evaluate(expressions: &Expressions, inputs: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut values: Vec<f64> = Vec::with_capacity(expressions.graph.len());
    for (_, node) in expressions.graph.iter() {
        values.push(match node {
            Node::Constant(constant) => constant.value(),
            Node::Input { input, element } => inputs
                .get(input)
                .and_then(|input| input.get(element))
                .copied()
                .unwrap_or(f64::NAN),
            Node::Unary(function, x) => unary(function, values[x.index()]),
            Node::Binary(function, x, y) => binary(function, values[x.index()], values[y.index()]),
            Node::Call(_) => f64::NAN,
        });
    }
    expressions
        .outputs
        .iter()
        .map(|output| output.iter().map(|id| values[id.index()]).collect())
        .collect()
}

/// A function of one number.
pub(crate) fn unary(function: Unary, x: f64) -> f64 {
    match function {
        Unary::Negate => -x,
        Unary::Reciprocal => 1.0 / x,
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
        Unary::Asinh => Scalar::asinh(x),
        Unary::Acosh => Scalar::acosh(x),
        Unary::Atanh => Scalar::atanh(x),
        Unary::Expm1 => Scalar::exp_m1(x),
        Unary::Log1p => Scalar::ln_1p(x),
        Unary::Erf => Scalar::erf(x),
        Unary::ErfInv => Scalar::erf_inv(x),
        Unary::Floor => Scalar::floor(x),
        Unary::Ceil => Scalar::ceil(x),
        Unary::Abs => x.abs(),
        Unary::Sign => {
            if x > 0.0 {
                1.0
            } else if x < 0.0 {
                -1.0
            } else {
                x
            }
        }
    }
}

/// A function of two numbers.
pub(crate) fn binary(function: Binary, x: f64, y: f64) -> f64 {
    let truth = |condition: bool| if condition { 1.0 } else { 0.0 };
    match function {
        Binary::Add => x + y,
        Binary::Sub => x - y,
        Binary::Mul => x * y,
        Binary::Div => x / y,
        Binary::Power => x.powf(y),
        Binary::Atan2 => x.atan2(y),
        Binary::Fmod => Scalar::fmod(x, y),
        Binary::Remainder => Scalar::remainder(x, y),
        Binary::Hypot => Scalar::hypot(x, y),
        Binary::CopySign => x.copysign(y),
        Binary::Min => x.min(y),
        Binary::Max => x.max(y),
        Binary::Less => truth(x < y),
        Binary::LessOrEqual => truth(x <= y),
        Binary::Equal => truth(x == y),
        Binary::IfElseZero => {
            if x == 0.0 {
                0.0
            } else {
                y
            }
        }
    }
}
