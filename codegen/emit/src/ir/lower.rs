use super::{Binary, Call, Expressions, Graph, Node, NodeId, Type, Unary};
use crate::program::{BinaryOperation, Function, Instruction, UnaryOperation};

/// Largest magnitude of an integer exponent that becomes a product: up to it the product is
/// shorter than what a power function does, and its error stays within some ulp.
const LARGEST_PRODUCT: f64 = 32.0;

/// Turns the instructions of a function into its graph, operation by operation.
///
/// Operations that the scalar trait lacks are expressed by others: logic on the numbers 0 and 1,
/// and powers with integer exponents as products.
#[must_use]
pub fn lower(function: &Function) -> Expressions {
    let mut graph = Graph::default();
    let zero = graph.constant(0.0);
    let mut work = vec![zero; function.work_size.max(1)];
    let mut outputs: Vec<Vec<NodeId>> = function
        .outputs
        .iter()
        .map(|output| vec![zero; output.nonzeros.len()])
        .collect();
    for &instruction in &function.instructions {
        match instruction {
            Instruction::Input { to, input, element } => {
                work[to] = graph.add(Node::Input { input, element });
            }
            Instruction::Output {
                output,
                nonzero,
                from,
            } => {
                outputs[output][nonzero] = work[from];
            }
            Instruction::Constant { to, value } => work[to] = graph.constant(value),
            Instruction::Call {
                external,
                to,
                operands,
                count,
            } => {
                let operands = operands.map(|operand| work[operand]);
                work[to] = graph.add(Node::Call(Call::new(external, &operands[..count])));
            }
            Instruction::Unary {
                operation,
                to,
                operand,
            } => {
                work[to] = unary(&mut graph, operation, work[operand]);
            }
            Instruction::Binary {
                operation,
                to,
                left,
                right,
            } => {
                work[to] = binary(&mut graph, operation, work[left], work[right]);
            }
        }
    }
    Expressions { graph, outputs }
}

fn unary(graph: &mut Graph, operation: UnaryOperation, x: NodeId) -> NodeId {
    let function = match operation {
        UnaryOperation::Copy => return x,
        UnaryOperation::Square => return graph.add(Node::Binary(Binary::Mul, x, x)),
        UnaryOperation::Twice => return graph.add(Node::Binary(Binary::Add, x, x)),
        UnaryOperation::Not => return is_zero(graph, x),
        UnaryOperation::Negate => Unary::Negate,
        UnaryOperation::Reciprocal => Unary::Reciprocal,
        UnaryOperation::Sqrt => Unary::Sqrt,
        UnaryOperation::Exp => Unary::Exp,
        UnaryOperation::Log => Unary::Log,
        UnaryOperation::Sin => Unary::Sin,
        UnaryOperation::Cos => Unary::Cos,
        UnaryOperation::Tan => Unary::Tan,
        UnaryOperation::Asin => Unary::Asin,
        UnaryOperation::Acos => Unary::Acos,
        UnaryOperation::Atan => Unary::Atan,
        UnaryOperation::Sinh => Unary::Sinh,
        UnaryOperation::Cosh => Unary::Cosh,
        UnaryOperation::Tanh => Unary::Tanh,
        UnaryOperation::Asinh => Unary::Asinh,
        UnaryOperation::Acosh => Unary::Acosh,
        UnaryOperation::Atanh => Unary::Atanh,
        UnaryOperation::Expm1 => Unary::Expm1,
        UnaryOperation::Log1p => Unary::Log1p,
        UnaryOperation::Erf => Unary::Erf,
        UnaryOperation::ErfInv => Unary::ErfInv,
        UnaryOperation::Floor => Unary::Floor,
        UnaryOperation::Ceil => Unary::Ceil,
        UnaryOperation::Abs => Unary::Abs,
        UnaryOperation::Sign => Unary::Sign,
    };
    graph.add(Node::Unary(function, x))
}

fn binary(graph: &mut Graph, operation: BinaryOperation, x: NodeId, y: NodeId) -> NodeId {
    let function = match operation {
        BinaryOperation::Pow => return power(graph, x, y),
        BinaryOperation::NotEqual => {
            let equal = graph.add(Node::Binary(Binary::Equal, x, y));
            return is_zero(graph, equal);
        }
        BinaryOperation::And => {
            let y = truth(graph, y);
            return graph.add(Node::Binary(Binary::IfElseZero, x, y));
        }
        BinaryOperation::Or => {
            let (x, y) = (truth(graph, x), truth(graph, y));
            return graph.add(Node::Binary(Binary::Max, x, y));
        }
        BinaryOperation::Add => Binary::Add,
        BinaryOperation::Sub => Binary::Sub,
        BinaryOperation::Mul => Binary::Mul,
        BinaryOperation::Div => Binary::Div,
        BinaryOperation::Atan2 => Binary::Atan2,
        BinaryOperation::Fmod => Binary::Fmod,
        BinaryOperation::Remainder => Binary::Remainder,
        BinaryOperation::Hypot => Binary::Hypot,
        BinaryOperation::CopySign => Binary::CopySign,
        BinaryOperation::Min => Binary::Min,
        BinaryOperation::Max => Binary::Max,
        BinaryOperation::Less => Binary::Less,
        BinaryOperation::LessOrEqual => Binary::LessOrEqual,
        BinaryOperation::Equal => Binary::Equal,
        BinaryOperation::IfElseZero => Binary::IfElseZero,
    };
    graph.add(Node::Binary(function, x, y))
}

/// 1 where `x` is 0, else 0.
fn is_zero(graph: &mut Graph, x: NodeId) -> NodeId {
    let zero = graph.constant(0.0);
    graph.add(Node::Binary(Binary::Equal, x, zero))
}

/// 0 where `x` is 0, else 1.
fn truth(graph: &mut Graph, x: NodeId) -> NodeId {
    if graph.type_of(x) == Type::Truth {
        return x;
    }
    let not = is_zero(graph, x);
    is_zero(graph, not)
}

fn power(graph: &mut Graph, x: NodeId, exponent: NodeId) -> NodeId {
    match graph.constant_value(exponent) {
        Some(0.5) => graph.add(Node::Unary(Unary::Sqrt, x)),
        Some(n) if n.fract() == 0.0 && n.abs() <= LARGEST_PRODUCT => {
            let product = integer_power(graph, x, n.abs() as u32);
            if n < 0.0 {
                graph.add(Node::Unary(Unary::Reciprocal, product))
            } else {
                product
            }
        }
        _ => graph.add(Node::Binary(Binary::Power, x, exponent)),
    }
}

/// Repeated squaring.
fn integer_power(graph: &mut Graph, x: NodeId, n: u32) -> NodeId {
    match n {
        0 => graph.constant(1.0),
        1 => x,
        _ => {
            let half = integer_power(graph, x, n / 2);
            let square = graph.add(Node::Binary(Binary::Mul, half, half));
            if n.is_multiple_of(2) {
                square
            } else {
                graph.add(Node::Binary(Binary::Mul, square, x))
            }
        }
    }
}
