//! Choice of the nodes of a function that become variables, with their order and names.

use std::collections::HashMap;

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use super::expression::Printer;
use super::items::ident;
use super::local::Locals;
use crate::Program;
use crate::ir::{Expressions, Node, NodeId, Unary};
use crate::program::Function;

/// Most operations in one statement: more do not read well on one line.
const STATEMENT_OPERATIONS: usize = 8;

/// Most operations of an element that is written inside the array of an output.
const OUTPUT_OPERATIONS: usize = 4;

/// Statements of a function, and the expressions of its outputs' nonzeros.
pub(super) struct Body {
    /// A name that no statement uses, for the place of the results.
    pub(super) out: Ident,
    pub(super) statements: Vec<TokenStream>,
    pub(super) outputs: Vec<Vec<TokenStream>>,
}

/// Plans and prints a function; `expressions` are without dead code.
pub(super) fn body(
    program: &Program,
    function: &Function,
    expressions: &Expressions,
    fused: bool,
) -> Body {
    let (mut locals, elements) = Locals::new(program, function);
    let outputs = output_places(expressions);
    let is_variable = variables(function, expressions);
    let mut statements = arguments(program, function, expressions, &elements);
    let mut printer = Printer::new(&program.externals, expressions, fused);
    for (id, node) in expressions.graph.iter() {
        if let Node::Input { input, element } = node {
            printer.name(id, elements[input][element].clone());
        }
    }
    for id in order(expressions, &is_variable) {
        if printer.is_named(id) {
            continue;
        }
        let node = expressions.graph.node(id);
        if let Node::Unary(Unary::Sin | Unary::Cos, x) = node {
            statements.push(sine_and_cosine(expressions, &mut printer, &mut locals, x));
            continue;
        }
        let value = printer.print(id);
        let name = output_name(function, expressions, &outputs, &mut locals, id)
            .or_else(|| value_name(&printer, &mut locals, node))
            .unwrap_or_else(|| locals.temporary());
        let variable = ident(&name);
        statements.push(quote!(let #variable = #value;));
        printer.name(id, name);
    }
    let outputs = expressions
        .outputs
        .iter()
        .map(|output| output.iter().map(|&id| printer.print(id)).collect())
        .collect();
    Body {
        out: ident(&locals.unique("out")),
        statements,
        outputs,
    }
}

/// Nodes that are used more than once, that are too long to stand inside another
/// expression, or that a sine and cosine are taken of.
fn variables(function: &Function, expressions: &Expressions) -> Vec<bool> {
    let graph = &expressions.graph;
    let uses = expressions.uses();
    let mut is_variable = vec![false; graph.len()];
    // Operations that would stand in the place where the node is used.
    let mut size = vec![0_usize; graph.len()];
    for (id, node) in graph.iter() {
        match node {
            Node::Input { .. } => continue,
            Node::Constant(_) => {
                is_variable[id.index()] = uses[id.index()] > 1;
                continue;
            }
            Node::Unary(Unary::Sin | Unary::Cos, x) => {
                let is_leaf = matches!(graph.node(x), Node::Input { .. });
                is_variable[x.index()] |= !is_leaf;
                is_variable[id.index()] = true;
                continue;
            }
            Node::Unary(..) | Node::Binary(..) | Node::Call(_) => {}
        }
        loop {
            let inside: usize = node
                .operands()
                .filter(|operand| !is_variable[operand.index()])
                .map(|operand| size[operand.index()])
                .sum();
            size[id.index()] = 1 + inside;
            if size[id.index()] <= STATEMENT_OPERATIONS {
                break;
            }
            let largest = node
                .operands()
                .filter(|operand| !is_variable[operand.index()])
                .max_by_key(|operand| size[operand.index()]);
            let Some(largest) = largest else { break };
            is_variable[largest.index()] = true;
        }
        is_variable[id.index()] |= uses[id.index()] > 1;
    }
    for (output, nodes) in function.outputs.iter().zip(&expressions.outputs) {
        let is_named_vector = output.columns == 1 && !output.row_names.is_empty();
        let limit = if is_named_vector {
            1
        } else {
            OUTPUT_OPERATIONS
        };
        for id in nodes {
            is_variable[id.index()] |= size[id.index()] > limit;
        }
    }
    is_variable
}

/// Constants, then sines and cosines of inputs, then the rest as it was derived.
fn order(expressions: &Expressions, is_variable: &[bool]) -> Vec<NodeId> {
    let graph = &expressions.graph;
    let mut ids: Vec<NodeId> = graph
        .iter()
        .map(|(id, _)| id)
        .filter(|id| is_variable[id.index()])
        .collect();
    ids.sort_by_key(|&id| match graph.node(id) {
        Node::Constant(_) => 0,
        Node::Unary(Unary::Sin | Unary::Cos, x) if matches!(graph.node(x), Node::Input { .. }) => 1,
        _ => 2,
    });
    ids
}

/// Takes the arguments apart into named elements.
fn arguments(
    program: &Program,
    function: &Function,
    expressions: &Expressions,
    elements: &[Vec<String>],
) -> Vec<TokenStream> {
    program
        .inputs_of(function)
        .enumerate()
        .map(|(input, group)| {
            let argument = ident(&group.name);
            let patterns = elements[input].iter().enumerate().map(|(element, name)| {
                match expressions.graph.find(Node::Input { input, element }) {
                    Some(_) => {
                        let name = ident(name);
                        quote!(#name)
                    }
                    None => quote!(_),
                }
            });
            quote!(let [#(#patterns),*] = *#argument;)
        })
        .collect()
}

/// `let (sin_x, cos_x) = x.sin_cos();`, with `_` for the one that is not needed.
fn sine_and_cosine(
    expressions: &Expressions,
    printer: &mut Printer<'_>,
    locals: &mut Locals,
    x: NodeId,
) -> TokenStream {
    let argument = printer.print_receiver(x);
    let base = printer
        .name_of(x)
        .map_or_else(|| "angle".to_owned(), str::to_owned);
    let mut pattern =
        |function, prefix: &str| match expressions.graph.find(Node::Unary(function, x)) {
            Some(id) => {
                let name = locals.unique(&format!("{prefix}_{base}"));
                let variable = ident(&name);
                printer.name(id, name);
                quote!(#variable)
            }
            None => quote!(_),
        };
    let (sine, cosine) = (pattern(Unary::Sin, "sin"), pattern(Unary::Cos, "cos"));
    quote!(let (#sine, #cosine) = #argument.sin_cos();)
}

/// For each node the outputs that have it, with its first nonzero in each.
fn output_places(expressions: &Expressions) -> HashMap<NodeId, Vec<(usize, usize)>> {
    let mut places: HashMap<NodeId, Vec<(usize, usize)>> = HashMap::new();
    for (output, nodes) in expressions.outputs.iter().enumerate() {
        for (nonzero, &id) in nodes.iter().enumerate() {
            let of_node = places.entry(id).or_default();
            if of_node.last().is_none_or(|&(last, _)| last != output) {
                of_node.push((output, nonzero));
            }
        }
    }
    places
}

/// The name of the first output element that the node is.
fn output_name(
    function: &Function,
    expressions: &Expressions,
    places: &HashMap<NodeId, Vec<(usize, usize)>>,
    locals: &mut Locals,
    id: NodeId,
) -> Option<String> {
    if matches!(expressions.graph.node(id), Node::Constant(_)) {
        return None;
    }
    let mut of_node = places.get(&id)?.iter();
    of_node.find_map(|&(output, nonzero)| locals.of_output(&function.outputs[output], nonzero))
}

/// A name that describes the value of a simple node.
fn value_name(printer: &Printer<'_>, locals: &mut Locals, node: Node) -> Option<String> {
    match node {
        Node::Constant(constant) => Some(locals.unique(match constant.value() {
            0.0 => "zero",
            0.5 => "half",
            1.0 => "one",
            2.0 => "two",
            _ => "constant",
        })),
        Node::Unary(Unary::Reciprocal, x) => printer
            .name_of(x)
            .map(|name| locals.unique(&format!("inverse_{name}"))),
        Node::Binary(crate::ir::Binary::Mul, x, y) if x == y => printer
            .name_of(x)
            .map(|name| locals.unique(&format!("{name}_squared"))),
        _ => None,
    }
}
