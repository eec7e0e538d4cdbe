//! Simplification of expression graphs.
//!
//! Rules keep the order of every sum and product, so values keep their bits, with two
//! exceptions: the sign of a zero, and quotients of one denominator, which become products
//! with its reciprocal (one more rounding; CasADi turns x (1/y) into x / y and so loses a
//! division that a derivation shared). Nothing assumes that a value is finite: x - x and
//! 0 x stay.

mod rules;

use std::collections::BTreeSet;

use crate::ir::{Binary, Expressions, Graph, Node, NodeId, Unary};
use rules::Rules;

/// Longest chain of products through which a sign is passed down.
const SIGN_DEPTH: usize = 16;

/// The same function in fewer operations, without what no output needs.
///
/// Negations are pulled out of products, sums and odd functions, so that expressions that
/// differ in sign only are one node, and are then put where they cost nothing.
#[must_use]
pub fn simplify(expressions: &Expressions) -> Expressions {
    let [.., (_, last)] = stages(expressions);
    last
}

/// The function after each step of the simplification, with the name of the step; the last is
/// what [`simplify`] gives.
pub(crate) fn stages(expressions: &Expressions) -> [(&'static str, Expressions); 4] {
    let derived = without_dead_code(expressions);
    let by_rules = rewrite(expressions, &BTreeSet::new());
    let shared = shared_denominators(&by_rules);
    let with_reciprocals = without_dead_code(&rewrite(&by_rules, &shared));
    let settled = without_dead_code(&with_signs_settled(&with_reciprocals));
    [
        ("as derived, equal subexpressions joined", derived),
        (
            "folded, identities, negations pulled out",
            without_dead_code(&by_rules),
        ),
        (
            "reciprocals of common denominators shared",
            with_reciprocals,
        ),
        ("negations put where they cost nothing", settled),
    ]
}

/// Adds every live node again, by the rules; `shared` are denominators of the source.
fn rewrite(source: &Expressions, shared: &BTreeSet<NodeId>) -> Expressions {
    let mut rules = Rules::default();
    let outputs = rebuild(source, |old, node, _| {
        let new = rules.add(node);
        if shared.contains(&old) {
            rules.share_reciprocal(new);
        }
        new
    });
    Expressions {
        graph: rules.into_graph(),
        outputs,
    }
}

/// Denominators of more than one division.
fn shared_denominators(source: &Expressions) -> BTreeSet<NodeId> {
    let live = source.live();
    let mut seen = BTreeSet::new();
    let mut shared = BTreeSet::new();
    for (_, node) in source.graph.iter().filter(|(id, _)| live[id.index()]) {
        if let Node::Binary(Binary::Div, _, by) | Node::Unary(Unary::Reciprocal, by) = node
            && !seen.insert(by)
        {
            shared.insert(by);
        }
    }
    shared
}

/// Puts negations into differences, constants and factors that nothing else uses.
fn with_signs_settled(source: &Expressions) -> Expressions {
    let uses = source.uses();
    let mut graph = Graph::default();
    let outputs = rebuild(source, |old, node, map| {
        if let Node::Unary(Unary::Negate, inner) = source.graph.node(old)
            && let Some(negated) = negated(source, &uses, map, &mut graph, inner, 0)
        {
            return negated;
        }
        graph.add(node)
    });
    Expressions { graph, outputs }
}

/// The negative of a node of the source without a negation, if that is possible.
fn negated(
    source: &Expressions,
    uses: &[usize],
    map: &[NodeId],
    graph: &mut Graph,
    id: NodeId,
    depth: usize,
) -> Option<NodeId> {
    let node = source.graph.node(id);
    if let Node::Constant(constant) = node {
        return Some(graph.constant(-constant.value()));
    }
    if uses[id.index()] > 1 || depth == SIGN_DEPTH {
        return None;
    }
    match node {
        Node::Binary(Binary::Sub, left, right) => Some(graph.add(Node::Binary(
            Binary::Sub,
            map[right.index()],
            map[left.index()],
        ))),
        Node::Binary(binary @ (Binary::Mul | Binary::Div), left, right) => {
            let (mut new_left, mut new_right) = (map[left.index()], map[right.index()]);
            if let Some(left) = negated(source, uses, map, graph, left, depth + 1) {
                new_left = left;
            } else {
                new_right = negated(source, uses, map, graph, right, depth + 1)?;
            }
            Some(graph.add(Node::Binary(binary, new_left, new_right)))
        }
        _ => None,
    }
}

fn without_dead_code(source: &Expressions) -> Expressions {
    let mut graph = Graph::default();
    let outputs = rebuild(source, |_, node, _| graph.add(node));
    Expressions { graph, outputs }
}

/// Hands every live node, with operands in the new graph, to `add`, which gives its new id;
/// `add` also gets the old id and the new ids of all nodes before. Returns the outputs.
fn rebuild(
    source: &Expressions,
    mut add: impl FnMut(NodeId, Node, &[NodeId]) -> NodeId,
) -> Vec<Vec<NodeId>> {
    let live = source.live();
    // Dead nodes keep their old id, which nothing reads.
    let mut map: Vec<NodeId> = source.graph.iter().map(|(id, _)| id).collect();
    for (old, node) in source.graph.iter().filter(|(id, _)| live[id.index()]) {
        let node = match node {
            Node::Constant(_) | Node::Input { .. } => node,
            Node::Unary(unary, x) => Node::Unary(unary, map[x.index()]),
            Node::Binary(binary, x, y) => Node::Binary(binary, map[x.index()], map[y.index()]),
            Node::Call(call) => Node::Call(call.map(|id| map[id.index()])),
        };
        map[old.index()] = add(old, node, &map);
    }
    source
        .outputs
        .iter()
        .map(|output| output.iter().map(|id| map[id.index()]).collect())
        .collect()
}
