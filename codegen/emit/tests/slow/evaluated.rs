//! Values of expression graphs in any scalar type, operation by operation as the program has them.

use gyrocal_codegen::ir::{Binary, Expressions, Node, Unary};
use gyrocal_scalar::Scalar;

/// Values of all nodes of a function of one group.
pub(crate) fn nodes<T: Scalar>(expressions: &Expressions, inputs: &[T]) -> Vec<T> {
    let mut values: Vec<T> = Vec::new();
    for (_, node) in expressions.graph.iter() {
        let value = |id: gyrocal_codegen::ir::NodeId| values[id.index()];
        values.push(match node {
            Node::Constant(constant) => T::from_f64(constant.value()),
            Node::Input { element, .. } => inputs[element],
            Node::Unary(function, x) => unary(function, value(x)),
            Node::Binary(function, x, y) => binary(function, value(x), value(y)),
            Node::Call(_) => T::from_f64(f64::NAN),
        });
    }
    values
}

/// The nonzeros of the first output among the values of all nodes.
pub(crate) fn output<T: Copy>(expressions: &Expressions, nodes: &[T]) -> Vec<T> {
    let ids = expressions.outputs[0].iter();
    ids.map(|id| nodes[id.index()]).collect()
}

/// For each node whether it depends on the sign of a zero, which simplification does not keep.
pub(crate) fn depends_on_zeros(expressions: &Expressions, values: &[f64]) -> Vec<bool> {
    let mut result: Vec<bool> = Vec::new();
    for (_, node) in expressions.graph.iter() {
        let inherited = node.operands().any(|operand| result[operand.index()]);
        let zero = |id: gyrocal_codegen::ir::NodeId| values[id.index()] == 0.0;
        result.push(
            inherited
                || match node {
                    Node::Unary(Unary::Reciprocal, x) => zero(x),
                    Node::Binary(Binary::Div, _, y) => zero(y),
                    // The sign of what is no number differs between processors.
                    Node::Binary(Binary::CopySign, _, y) => zero(y) || values[y.index()].is_nan(),
                    Node::Binary(Binary::Power, x, _) => zero(x),
                    Node::Binary(Binary::Atan2, x, y) => zero(x) || zero(y),
                    _ => false,
                },
        );
    }
    result
}

/// Whether a denominator divides more than once: simplification multiplies by its reciprocal.
pub(crate) fn shares_denominators(expressions: &Expressions) -> bool {
    let mut denominators: Vec<_> = expressions
        .graph
        .iter()
        .filter_map(|(_, node)| match node {
            Node::Unary(Unary::Reciprocal, y) | Node::Binary(Binary::Div, _, y) => Some(y),
            _ => None,
        })
        .collect();
    denominators.sort_unstable();
    denominators.windows(2).any(|pair| pair[0] == pair[1])
}

/// Whether a node jumps where a rounding moves its operands.
pub(crate) fn jumps(expressions: &Expressions) -> bool {
    expressions.graph.iter().any(|(_, node)| {
        matches!(
            node,
            Node::Unary(Unary::Floor | Unary::Ceil | Unary::Sign | Unary::Tan, _)
                | Node::Binary(
                    Binary::Less
                        | Binary::LessOrEqual
                        | Binary::Equal
                        | Binary::IfElseZero
                        | Binary::Fmod
                        | Binary::Remainder
                        | Binary::CopySign
                        | Binary::Atan2,
                    ..
                )
        )
    })
}

fn unary<T: Scalar>(function: Unary, x: T) -> T {
    match function {
        Unary::Negate => -x,
        Unary::Reciprocal => T::from_f64(1.0) / x,
        Unary::Sqrt => x.sqrt(),
        Unary::Exp => x.exp(),
        Unary::Log => x.ln(),
        Unary::Sin => x.sin_cos().0,
        Unary::Cos => x.sin_cos().1,
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
        Unary::Expm1 => x.exp_m1(),
        Unary::Log1p => x.ln_1p(),
        Unary::Erf => x.erf(),
        Unary::ErfInv => x.erf_inv(),
        Unary::Floor => x.floor(),
        Unary::Ceil => x.ceil(),
        Unary::Abs => x.abs(),
        Unary::Sign => x.sign(),
    }
}

fn binary<T: Scalar>(function: Binary, x: T, y: T) -> T {
    match function {
        Binary::Add => x + y,
        Binary::Sub => x - y,
        Binary::Mul => x * y,
        Binary::Div => x / y,
        Binary::Power => x.powf(y),
        Binary::Atan2 => x.atan2(y),
        Binary::Fmod => x.fmod(y),
        Binary::Remainder => x.remainder(y),
        Binary::Hypot => x.hypot(y),
        Binary::CopySign => x.copysign(y),
        Binary::Min => x.min(y),
        Binary::Max => x.max(y),
        Binary::Less => x.less(y),
        Binary::LessOrEqual => x.less_or_equal(y),
        Binary::Equal => x.equal(y),
        Binary::IfElseZero => x.if_else_zero(y),
    }
}
