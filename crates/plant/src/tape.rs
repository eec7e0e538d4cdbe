//! A function of a program as a flat list of operations on one array of numbers.
//!
//! It is compiled once. An array holds constants, then inputs, then the value of each operation; the
//! constants are written when the array is made, so that an evaluation copies inputs and runs the list.

mod narrowed;

use gyrocal_codegen::ir::{Binary, Expressions, Node, Unary, lower};
use gyrocal_codegen::program::Function;
use gyrocal_codegen::simplify;
use gyrocal_scalar::Scalar;

/// An operation; numbers are places in the array.
#[derive(Clone, Copy, Debug)]
enum Operation {
    Add(u32, u32),
    Sub(u32, u32),
    Mul(u32, u32),
    Div(u32, u32),
    Negate(u32),
    Unary(Unary, u32),
    Binary(Binary, u32, u32),
}

/// A compiled function.
#[derive(Clone, Debug)]
pub(crate) struct Tape {
    constants: Vec<f64>,
    /// For each input that is read: input of the function, element.
    inputs: Vec<(usize, usize)>,
    operations: Vec<Operation>,
    /// For each output the place of each nonzero.
    outputs: Vec<Vec<usize>>,
}

impl Tape {
    /// `None` if the function calls functions of the surrounding Rust.
    pub(crate) fn new(function: &Function) -> Option<Self> {
        let expressions = simplify(&lower(function));
        Self::of(&expressions)
    }

    fn of(expressions: &Expressions) -> Option<Self> {
        let live = expressions.live();
        let mut places: Vec<u32> = vec![0; expressions.graph.len()];
        let (mut constants, mut inputs) = (Vec::new(), Vec::new());
        let nodes = || {
            let all = expressions.graph.iter();
            all.filter(|(id, _)| live[id.index()])
        };
        for (id, node) in nodes() {
            if let Node::Constant(constant) = node {
                places[id.index()] = constants.len() as u32;
                constants.push(constant.value());
            }
        }
        for (id, node) in nodes() {
            if let Node::Input { input, element } = node {
                places[id.index()] = (constants.len() + inputs.len()) as u32;
                inputs.push((input, element));
            }
        }
        let first = constants.len() + inputs.len();
        let mut operations = Vec::new();
        for (id, node) in nodes() {
            let operation = match node {
                Node::Constant(_) | Node::Input { .. } => continue,
                Node::Call(_) => return None,
                Node::Unary(Unary::Negate, x) => Operation::Negate(places[x.index()]),
                Node::Unary(unary, x) => Operation::Unary(unary, places[x.index()]),
                Node::Binary(binary, x, y) => {
                    let (x, y) = (places[x.index()], places[y.index()]);
                    match binary {
                        Binary::Add => Operation::Add(x, y),
                        Binary::Sub => Operation::Sub(x, y),
                        Binary::Mul => Operation::Mul(x, y),
                        Binary::Div => Operation::Div(x, y),
                        other => Operation::Binary(other, x, y),
                    }
                }
            };
            places[id.index()] = (first + operations.len()) as u32;
            operations.push(operation);
        }
        let place = |nodes: &Vec<_>| {
            let all = nodes.iter();
            all.map(|id: &gyrocal_codegen::ir::NodeId| places[id.index()] as usize)
                .collect()
        };
        Some(Self {
            outputs: expressions.outputs.iter().map(place).collect(),
            constants,
            inputs,
            operations,
        })
    }

    /// An array for evaluations.
    pub(crate) fn array(&self) -> Vec<f64> {
        let mut array = self.constants.clone();
        array.resize(
            self.constants.len() + self.inputs.len() + self.operations.len(),
            0.0,
        );
        array
    }

    /// Evaluates; `input` gives an element of an input of the function.
    pub(crate) fn evaluate(&self, array: &mut [f64], input: impl Fn(usize, usize) -> f64) {
        let first = self.constants.len();
        for (slot, (group, element)) in array[first..].iter_mut().zip(&self.inputs) {
            *slot = input(*group, *element);
        }
        let first = first + self.inputs.len();
        for (index, operation) in self.operations.iter().enumerate() {
            array[first + index] = value(*operation, array);
        }
    }

    /// Places of the nonzeros of an output.
    pub(crate) fn output(&self, index: usize) -> &[usize] {
        &self.outputs[index]
    }
}

/// The value of an operation.
#[inline(always)]
fn value(operation: Operation, array: &[f64]) -> f64 {
    let at = |place: u32| array[place as usize];
    match operation {
        Operation::Add(x, y) => at(x) + at(y),
        Operation::Sub(x, y) => at(x) - at(y),
        Operation::Mul(x, y) => at(x) * at(y),
        Operation::Div(x, y) => at(x) / at(y),
        Operation::Negate(x) => -at(x),
        Operation::Unary(function, x) => unary(function, at(x)),
        Operation::Binary(function, x, y) => binary(function, at(x), at(y)),
    }
}

/// The functions of one number, those of generated code.
fn unary(function: Unary, x: f64) -> f64 {
    match function {
        Unary::Negate => -x,
        Unary::Reciprocal => 1.0 / x,
        Unary::Sqrt => Scalar::sqrt(x),
        Unary::Exp => Scalar::exp(x),
        Unary::Log => Scalar::ln(x),
        Unary::Sin => Scalar::sin_cos(x).0,
        Unary::Cos => Scalar::sin_cos(x).1,
        Unary::Tan => Scalar::tan(x),
        Unary::Asin => Scalar::asin(x),
        Unary::Acos => Scalar::acos(x),
        Unary::Atan => Scalar::atan(x),
        Unary::Sinh => Scalar::sinh(x),
        Unary::Cosh => Scalar::cosh(x),
        Unary::Tanh => Scalar::tanh(x),
        Unary::Asinh => Scalar::asinh(x),
        Unary::Acosh => Scalar::acosh(x),
        Unary::Atanh => Scalar::atanh(x),
        Unary::Expm1 => Scalar::exp_m1(x),
        Unary::Log1p => Scalar::ln_1p(x),
        Unary::Erf => Scalar::erf(x),
        Unary::ErfInv => Scalar::erf_inv(x),
        Unary::Floor => Scalar::floor(x),
        Unary::Ceil => Scalar::ceil(x),
        Unary::Abs => Scalar::abs(x),
        Unary::Sign => Scalar::sign(x),
    }
}

/// The functions of two numbers.
fn binary(function: Binary, x: f64, y: f64) -> f64 {
    match function {
        Binary::Add => x + y,
        Binary::Sub => x - y,
        Binary::Mul => x * y,
        Binary::Div => x / y,
        Binary::Power => Scalar::powf(x, y),
        Binary::Atan2 => Scalar::atan2(x, y),
        Binary::Fmod => Scalar::fmod(x, y),
        Binary::Remainder => Scalar::remainder(x, y),
        Binary::Hypot => Scalar::hypot(x, y),
        Binary::CopySign => Scalar::copysign(x, y),
        Binary::Min => Scalar::min(x, y),
        Binary::Max => Scalar::max(x, y),
        Binary::Less => Scalar::less(x, y),
        Binary::LessOrEqual => Scalar::less_or_equal(x, y),
        Binary::Equal => Scalar::equal(x, y),
        Binary::IfElseZero => Scalar::if_else_zero(x, y),
    }
}
