//! The typed expression graph of one function.
//!
//! Nodes are hash-consed: an expression that was added before, with the operands of a
//! commutative operation in either order, is the same node. Operands precede their users,
//! so the order of nodes is an order of evaluation.

mod evaluate;
mod lower;

pub use evaluate::evaluate;
pub(crate) use evaluate::{binary as evaluate_binary, unary as evaluate_unary};
pub use lower::lower;

use std::collections::HashMap;

use crate::program::MOST_ARGUMENTS;

/// A node of a [`Graph`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct NodeId(u32);

impl NodeId {
    /// Position of the node in its graph.
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// Operation of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A finite number.
    Constant(Constant),
    /// An element of an input of the function.
    Input {
        /// Index of the input.
        input: usize,
        /// Index of the element.
        element: usize,
    },
    /// A function of one node.
    Unary(Unary, NodeId),
    /// A function of two nodes.
    Binary(Binary, NodeId, NodeId),
    /// A function of the surrounding Rust.
    Call(Call),
}

/// A call of a function of the surrounding Rust.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Call {
    /// Index of the function among those of the program.
    external: u32,
    count: u32,
    arguments: [NodeId; MOST_ARGUMENTS],
}

impl Call {
    /// A call of the external function with this index.
    ///
    /// # Panics
    /// If there are more arguments than [`MOST_ARGUMENTS`].
    #[must_use]
    pub fn new(external: usize, arguments: &[NodeId]) -> Self {
        let mut all = [NodeId(0); MOST_ARGUMENTS];
        all[..arguments.len()].copy_from_slice(arguments);
        Self {
            external: external as u32,
            count: arguments.len() as u32,
            arguments: all,
        }
    }

    /// Index of the function among those of the program.
    #[must_use]
    pub fn external(&self) -> usize {
        self.external as usize
    }

    /// Its arguments.
    #[must_use]
    pub fn arguments(&self) -> &[NodeId] {
        &self.arguments[..self.count as usize]
    }

    /// The same call of other arguments.
    pub(crate) fn map(mut self, argument: impl Fn(NodeId) -> NodeId) -> Self {
        for id in &mut self.arguments[..self.count as usize] {
            *id = argument(*id);
        }
        self
    }
}

/// A finite number, equal when its bits are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Constant(u64);

impl Constant {
    /// The number.
    #[must_use]
    pub fn value(self) -> f64 {
        f64::from_bits(self.0)
    }
}

/// Functions of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names of the functions of mathematics")]
pub enum Unary {
    Negate,
    Reciprocal,
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
    Expm1,
    Log1p,
    Erf,
    ErfInv,
    Floor,
    Ceil,
    Abs,
    Sign,
}

/// Functions of two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(missing_docs, reason = "the names of the functions of mathematics")]
pub enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    Power,
    Atan2,
    Fmod,
    Remainder,
    Hypot,
    CopySign,
    Min,
    Max,
    Less,
    LessOrEqual,
    Equal,
    IfElseZero,
}

impl Binary {
    /// The order of the operands does not matter.
    #[must_use]
    pub fn is_commutative(self) -> bool {
        matches!(
            self,
            Self::Add | Self::Mul | Self::Min | Self::Max | Self::Equal | Self::Hypot
        )
    }
}

/// Known properties of the value of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// Any number.
    Number,
    /// 0 for false or 1 for true.
    Truth,
}

/// An arena of expressions.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    nodes: Vec<Node>,
    types: Vec<Type>,
    ids: HashMap<Node, NodeId>,
}

impl Graph {
    /// The node, added if it is new.
    pub fn add(&mut self, node: Node) -> NodeId {
        if let Some(found) = self.find(node) {
            return found;
        }
        // A program of 2^32 instructions does not fit into memory.
        let id = NodeId(self.nodes.len() as u32);
        self.types.push(self.type_of_new(node));
        self.nodes.push(node);
        self.ids.insert(node, id);
        id
    }

    /// The constant, added if it is new; both zeros are one.
    pub fn constant(&mut self, value: f64) -> NodeId {
        self.add(Node::Constant(Constant((value + 0.0).to_bits())))
    }

    /// The node, if it was added before.
    #[must_use]
    pub fn find(&self, node: Node) -> Option<NodeId> {
        let found = self.ids.get(&node);
        match node {
            Node::Binary(binary, left, right) if found.is_none() && binary.is_commutative() => {
                self.ids.get(&Node::Binary(binary, right, left)).copied()
            }
            _ => found.copied(),
        }
    }

    /// Operation of a node.
    #[must_use]
    pub fn node(&self, id: NodeId) -> Node {
        self.nodes[id.index()]
    }

    /// Known properties of its value.
    #[must_use]
    pub fn type_of(&self, id: NodeId) -> Type {
        self.types[id.index()]
    }

    /// Its value, if it is a constant.
    #[must_use]
    pub fn constant_value(&self, id: NodeId) -> Option<f64> {
        match self.node(id) {
            Node::Constant(constant) => Some(constant.value()),
            _ => None,
        }
    }

    /// Every node with its id, operands before users.
    #[must_use]
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = (NodeId, Node)> + '_ {
        self.nodes
            .iter()
            .enumerate()
            .map(|(index, &node)| (NodeId(index as u32), node))
    }

    /// Number of nodes.
    #[must_use]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// No nodes.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    fn type_of_new(&self, node: Node) -> Type {
        let truth = match node {
            Node::Constant(constant) => constant.value() == 0.0 || constant.value() == 1.0,
            Node::Binary(Binary::Less | Binary::LessOrEqual | Binary::Equal, ..) => true,
            Node::Binary(Binary::Mul | Binary::Min | Binary::Max, left, right) => {
                self.type_of(left) == Type::Truth && self.type_of(right) == Type::Truth
            }
            Node::Binary(Binary::IfElseZero, _, value) => self.type_of(value) == Type::Truth,
            _ => false,
        };
        if truth { Type::Truth } else { Type::Number }
    }
}

impl Node {
    /// The nodes it is computed from.
    #[must_use]
    pub fn operands(self) -> impl DoubleEndedIterator<Item = NodeId> {
        let mut operands = [NodeId(0); MOST_ARGUMENTS];
        let count = match self {
            Self::Constant(_) | Self::Input { .. } => 0,
            Self::Unary(_, operand) => {
                operands[0] = operand;
                1
            }
            Self::Binary(_, left, right) => {
                operands[..2].copy_from_slice(&[left, right]);
                2
            }
            Self::Call(call) => {
                operands = call.arguments;
                call.count as usize
            }
        };
        operands.into_iter().take(count)
    }
}

/// A function as a graph, with the node of each structural nonzero of each output.
#[derive(Clone, Debug)]
pub struct Expressions {
    /// The graph.
    pub graph: Graph,
    /// For each output the nodes of its nonzeros.
    pub outputs: Vec<Vec<NodeId>>,
}

impl Expressions {
    /// Whether each node is needed for an output.
    #[must_use]
    pub fn live(&self) -> Vec<bool> {
        let mut live = vec![false; self.graph.len()];
        for id in self.outputs.iter().flatten() {
            live[id.index()] = true;
        }
        for (id, node) in self.graph.iter().rev() {
            if live[id.index()] {
                for operand in node.operands() {
                    live[operand.index()] = true;
                }
            }
        }
        live
    }

    /// Number of uses of each node as operand or output; dead nodes count as users.
    #[must_use]
    pub fn uses(&self) -> Vec<usize> {
        let mut uses = vec![0; self.graph.len()];
        let operands = self.graph.iter().flat_map(|(_, node)| node.operands());
        for id in operands.chain(self.outputs.iter().flatten().copied()) {
            uses[id.index()] += 1;
        }
        uses
    }

    /// The inputs, as (input, element), of an expression without dead code.
    pub fn inputs(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.graph.iter().filter_map(|(_, node)| match node {
            Node::Input { input, element } => Some((input, element)),
            _ => None,
        })
    }
}
