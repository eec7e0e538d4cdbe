//! Number of operations of emitted code.

use crate::ir::{Binary, Expressions, Node, Unary};

/// Operations by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Count {
    additions: usize,
    multiplications: usize,
    divisions: usize,
    negations: usize,
    sine_cosine_pairs: usize,
    others: usize,
}

impl Count {
    /// Counts expressions without dead code, each node of which is computed once.
    pub(super) fn of(expressions: &Expressions) -> Self {
        let mut count = Self::default();
        let graph = &expressions.graph;
        for (_, node) in graph.iter() {
            match node {
                Node::Constant(_) | Node::Input { .. } => {}
                Node::Unary(Unary::Negate, _) => count.negations += 1,
                Node::Unary(Unary::Reciprocal, _) => count.divisions += 1,
                Node::Unary(Unary::Sin, _) => count.sine_cosine_pairs += 1,
                Node::Unary(Unary::Cos, x) => {
                    let has_sine = graph.find(Node::Unary(Unary::Sin, x)).is_some();
                    count.sine_cosine_pairs += usize::from(!has_sine);
                }
                Node::Binary(Binary::Add | Binary::Sub, ..) => count.additions += 1,
                Node::Binary(Binary::Mul, ..) => count.multiplications += 1,
                Node::Binary(Binary::Div, ..) => count.divisions += 1,
                Node::Unary(..) | Node::Binary(..) | Node::Call(_) => count.others += 1,
            }
        }
        count
    }

    /// The sum of all kinds.
    pub(super) fn total(self) -> usize {
        self.additions
            + self.multiplications
            + self.divisions
            + self.negations
            + self.sine_cosine_pairs
            + self.others
    }

    /// In words.
    pub(super) fn text(self) -> String {
        let parts: Vec<String> = [
            (self.additions, "addition", "additions"),
            (self.multiplications, "multiplication", "multiplications"),
            (self.divisions, "division", "divisions"),
            (self.negations, "negation", "negations"),
            (
                self.sine_cosine_pairs,
                "sine-cosine pair",
                "sine-cosine pairs",
            ),
            (self.others, "other function", "other functions"),
        ]
        .into_iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, one, many)| format!("{count} {}", if count == 1 { one } else { many }))
        .collect();
        if parts.is_empty() {
            "No operations.".to_owned()
        } else {
            format!("{}.", parts.join(", "))
        }
    }
}
