//! Local rules, applied as nodes are added.
//!
//! Normal form: no negation below a sum, product, quotient or odd or even function; no
//! negative constant there either; sums of negatives are differences; of a - b and b - a
//! only the one that came first.

use std::collections::BTreeSet;

use crate::ir::{Binary, Graph, Node, NodeId, Type, Unary, evaluate_binary, evaluate_unary};

/// Powers of two up to this magnitude are divided by through their reciprocal, which is
/// exact in every scalar type, `f32` included.
const LARGEST_EXACT_DIVISOR: f64 = 18_446_744_073_709_551_616.0;

/// A graph that keeps the normal form.
#[derive(Default)]
pub(super) struct Rules {
    graph: Graph,
    /// Denominators whose reciprocal is computed once.
    shared: BTreeSet<NodeId>,
}

impl Rules {
    pub(super) fn into_graph(self) -> Graph {
        self.graph
    }

    /// From now on divisions by this node are products with its reciprocal.
    pub(super) fn share_reciprocal(&mut self, denominator: NodeId) {
        self.shared.insert(denominator);
    }

    /// Adds a node in normal form; its operands are in normal form.
    pub(super) fn add(&mut self, node: Node) -> NodeId {
        match node {
            Node::Constant(_) | Node::Input { .. } | Node::Call(_) => self.graph.add(node),
            Node::Unary(function, x) => self.unary(function, x),
            Node::Binary(function, x, y) => {
                self.folded(function, x, y)
                    .unwrap_or_else(|| match function {
                        Binary::Add => self.sum(x, y),
                        Binary::Sub => self.difference(x, y),
                        Binary::Mul => self.product(x, y),
                        Binary::Div => self.quotient(x, y),
                        Binary::Min | Binary::Max if x == y => x,
                        Binary::Equal => self.equal(x, y),
                        Binary::IfElseZero => self.if_else_zero(x, y),
                        _ => self.graph.add(node),
                    })
            }
        }
    }

    fn unary(&mut self, function: Unary, x: NodeId) -> NodeId {
        if function == Unary::Negate {
            let (negative, x) = self.sign(x);
            return self.signed(!negative, x);
        }
        let (is_odd, is_even) = match function {
            Unary::Reciprocal
            | Unary::Sin
            | Unary::Tan
            | Unary::Asin
            | Unary::Atan
            | Unary::Sinh
            | Unary::Tanh
            | Unary::Asinh
            | Unary::Atanh
            | Unary::Erf
            | Unary::ErfInv
            | Unary::Sign => (true, false),
            Unary::Cos | Unary::Cosh | Unary::Abs => (false, true),
            _ => (false, false),
        };
        let (negative, x) = if is_odd || is_even {
            self.sign(x)
        } else {
            (false, x)
        };
        let result = self
            .folded_unary(function, x)
            .unwrap_or_else(|| self.graph.add(Node::Unary(function, x)));
        self.signed(negative && is_odd, result)
    }

    fn sum(&mut self, x: NodeId, y: NodeId) -> NodeId {
        if self.is(x, 0.0) {
            return y;
        }
        if self.is(y, 0.0) {
            return x;
        }
        match (self.sign(x), self.sign(y)) {
            ((false, x), (false, y)) => self.graph.add(Node::Binary(Binary::Add, x, y)),
            ((false, x), (true, y)) => self.plain_difference(x, y),
            ((true, x), (false, y)) => self.plain_difference(y, x),
            ((true, x), (true, y)) => {
                let sum = self.graph.add(Node::Binary(Binary::Add, x, y));
                self.signed(true, sum)
            }
        }
    }

    fn difference(&mut self, x: NodeId, y: NodeId) -> NodeId {
        let (negative, y) = self.sign(y);
        let y = self.signed(!negative, y);
        self.sum(x, y)
    }

    /// x - y, or the negative of y - x where that is known.
    fn plain_difference(&mut self, x: NodeId, y: NodeId) -> NodeId {
        match self.graph.find(Node::Binary(Binary::Sub, y, x)) {
            Some(reverse) if x != y => self.signed(true, reverse),
            _ => self.graph.add(Node::Binary(Binary::Sub, x, y)),
        }
    }

    fn product(&mut self, x: NodeId, y: NodeId) -> NodeId {
        let ((x_negative, x), (y_negative, y)) = (self.sign(x), self.sign(y));
        let product = if self.is(x, 1.0) {
            y
        } else if self.is(y, 1.0) {
            x
        } else if self.is(x, 2.0) {
            self.sum(y, y)
        } else if self.is(y, 2.0) {
            self.sum(x, x)
        } else if let Some(denominator) = self.unshared_denominator(y) {
            self.quotient(x, denominator)
        } else if let Some(denominator) = self.unshared_denominator(x) {
            self.quotient(y, denominator)
        } else {
            self.graph.add(Node::Binary(Binary::Mul, x, y))
        };
        self.signed(x_negative != y_negative, product)
    }

    fn quotient(&mut self, x: NodeId, y: NodeId) -> NodeId {
        let ((x_negative, x), (y_negative, y)) = (self.sign(x), self.sign(y));
        let quotient = if self.is(x, 1.0) {
            self.unary(Unary::Reciprocal, y)
        } else if self.shared.contains(&y) || self.has_exact_reciprocal(y) {
            let reciprocal = self.unary(Unary::Reciprocal, y);
            self.product(x, reciprocal)
        } else if self.is(y, 1.0) {
            x
        } else {
            self.graph.add(Node::Binary(Binary::Div, x, y))
        };
        self.signed(x_negative != y_negative, quotient)
    }

    fn equal(&mut self, x: NodeId, y: NodeId) -> NodeId {
        // Not not t is t.
        if self.is(y, 0.0)
            && let Node::Binary(Binary::Equal, inner, zero) = self.graph.node(x)
            && self.is(zero, 0.0)
            && self.graph.type_of(inner) == Type::Truth
        {
            return inner;
        }
        self.graph.add(Node::Binary(Binary::Equal, x, y))
    }

    fn if_else_zero(&mut self, condition: NodeId, value: NodeId) -> NodeId {
        let (_, condition) = self.sign(condition);
        match self.graph.constant_value(condition) {
            Some(0.0) => return self.graph.constant(0.0),
            Some(_) => return value,
            None if self.is(value, 0.0) => return value,
            None if self.is(value, 1.0) && self.graph.type_of(condition) == Type::Truth => {
                return condition;
            }
            None => {}
        }
        let (negative, value) = self.sign(value);
        let chosen = self
            .graph
            .add(Node::Binary(Binary::IfElseZero, condition, value));
        self.signed(negative, chosen)
    }

    fn is(&self, x: NodeId, value: f64) -> bool {
        self.graph.constant_value(x) == Some(value)
    }

    /// Whether the node is a negative, and its value without the sign.
    fn sign(&mut self, x: NodeId) -> (bool, NodeId) {
        match self.graph.node(x) {
            Node::Unary(Unary::Negate, inner) => (true, inner),
            Node::Constant(constant) if constant.value() < 0.0 => {
                (true, self.graph.constant(-constant.value()))
            }
            _ => (false, x),
        }
    }

    fn signed(&mut self, negative: bool, x: NodeId) -> NodeId {
        match self.graph.constant_value(x) {
            _ if !negative => x,
            Some(value) => self.graph.constant(-value),
            None => self.graph.add(Node::Unary(Unary::Negate, x)),
        }
    }

    /// y, if the node is 1 / y and that is not to be shared.
    fn unshared_denominator(&self, x: NodeId) -> Option<NodeId> {
        match self.graph.node(x) {
            Node::Unary(Unary::Reciprocal, y) if !self.shared.contains(&y) => Some(y),
            _ => None,
        }
    }

    fn has_exact_reciprocal(&self, y: NodeId) -> bool {
        const MANTISSA: u64 = (1 << (f64::MANTISSA_DIGITS - 1)) - 1;
        self.graph.constant_value(y).is_some_and(|value| {
            value.to_bits() & MANTISSA == 0
                && (1.0 / LARGEST_EXACT_DIVISOR..=LARGEST_EXACT_DIVISOR).contains(&value.abs())
        })
    }

    /// The value of correctly rounded operations on constants, where it is finite. Others
    /// are left to run time: their last bits depend on the machine that folds.
    fn folded(&mut self, function: Binary, x: NodeId, y: NodeId) -> Option<NodeId> {
        if matches!(function, Binary::Power | Binary::Atan2 | Binary::Hypot) {
            return None;
        }
        let value = evaluate_binary(
            function,
            self.graph.constant_value(x)?,
            self.graph.constant_value(y)?,
        );
        value.is_finite().then(|| self.graph.constant(value))
    }

    fn folded_unary(&mut self, function: Unary, x: NodeId) -> Option<NodeId> {
        let argument = self.graph.constant_value(x)?;
        let is_exact = match function {
            Unary::Negate
            | Unary::Reciprocal
            | Unary::Sqrt
            | Unary::Floor
            | Unary::Ceil
            | Unary::Abs
            | Unary::Sign => true,
            // Zero is mapped to zero or one.
            Unary::Acos | Unary::Log | Unary::Acosh => false,
            _ => argument == 0.0,
        };
        let value = evaluate_unary(function, argument);
        (is_exact && value.is_finite()).then(|| self.graph.constant(value))
    }
}
