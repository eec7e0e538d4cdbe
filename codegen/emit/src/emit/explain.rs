//! An account of one function: operations before and after simplification, critical path, what is
//! shared, structure of the outputs.

use std::collections::BTreeMap;

use super::count::Count;
use super::expression::{Printer, binary_method, unary_method};
use super::local::Locals;
use crate::ir::{Expressions, Node, NodeId, Unary, lower};
use crate::program::{Function, Output};
use crate::simplify::stages;
use crate::{Error, Program};

/// Shared subexpressions that are listed.
const MOST_SHARED: usize = 20;
/// Longest text of a subexpression.
const LONGEST: usize = 72;
/// Widest and highest picture of a structure.
const LARGEST_PICTURE: usize = 120;

/// An account of the function called `name`, as text for people.
///
/// # Errors
/// If the program has no function of that name.
pub fn explain(program: &Program, name: &str) -> Result<String, Error> {
    let Some(function) = program.functions.iter().find(|f| f.name == name) else {
        let names = program.functions.iter().map(|f| f.name.as_str());
        return Err(Error::Program {
            origin: program.origin.clone(),
            place: "explain".to_owned(),
            found: format!("the function `{name}`"),
            expected: format!("one of {}", names.collect::<Vec<_>>().join(", ")),
            remedy: "name one of them".to_owned(),
        });
    };
    let stages = stages(&lower(function));
    let mut text = format!(
        "{name}: {} instructions\n\noperations\n",
        function.instructions.len()
    );
    for (stage, expressions) in &stages {
        let count = Count::of(expressions);
        line(
            &mut text,
            &format!("{:>7}  {stage}: {}", count.total(), count.text()),
        );
    }
    let [.., (_, expressions)] = &stages;
    by_operation(&mut text, program, expressions);
    critical_path(&mut text, function, expressions);
    shared(&mut text, program, function, expressions);
    for output in &function.outputs {
        structure(&mut text, output);
    }
    Ok(text)
}

fn line(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

fn by_operation(text: &mut String, program: &Program, expressions: &Expressions) {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    for (_, node) in expressions.graph.iter() {
        let name = match node {
            Node::Constant(_) | Node::Input { .. } => continue,
            Node::Unary(Unary::Sin | Unary::Cos, x) => {
                let pair = expressions.graph.find(Node::Unary(Unary::Sin, x)).is_some();
                if pair && matches!(node, Node::Unary(Unary::Cos, _)) {
                    continue;
                }
                "sin_cos"
            }
            Node::Unary(function, _) => unary_method(function),
            Node::Binary(function, ..) => binary_method(function),
            Node::Call(call) => &program.externals[call.external()].name,
        };
        *counts.entry(name).or_default() += 1;
    }
    let mut counts: Vec<_> = counts.into_iter().collect();
    counts.sort_by_key(|&(name, count)| (std::cmp::Reverse(count), name));
    line(text, "\nby operation");
    for (name, count) in counts {
        line(text, &format!("{count:>7}  {name}"));
    }
}

/// The longest chain of operations, by the names of what it passes.
fn critical_path(text: &mut String, function: &Function, expressions: &Expressions) {
    let graph = &expressions.graph;
    let mut depth = vec![0_usize; graph.len()];
    let mut before: Vec<Option<NodeId>> = vec![None; graph.len()];
    for (id, node) in graph.iter() {
        let deepest = node.operands().max_by_key(|operand| depth[operand.index()]);
        if let Some(operand) = deepest {
            depth[id.index()] = depth[operand.index()] + 1;
            before[id.index()] = Some(operand);
        }
    }
    let ends = function.outputs.iter().zip(&expressions.outputs);
    let ends =
        ends.flat_map(|(output, ids)| ids.iter().enumerate().map(move |(k, id)| (output, k, *id)));
    let Some((output, nonzero, end)) = ends.max_by_key(|(.., id)| depth[id.index()]) else {
        return;
    };
    let mut steps = Vec::new();
    let mut place = Some(end);
    while let Some(id) = place {
        match graph.node(id) {
            Node::Unary(function, _) => steps.push(unary_method(function)),
            Node::Binary(function, ..) => steps.push(binary_method(function)),
            Node::Call(_) => steps.push("call"),
            Node::Constant(_) | Node::Input { .. } => {}
        }
        place = before[id.index()];
    }
    steps.reverse();
    let (row, column) = output.nonzeros[nonzero];
    let heading = format!(
        "\ncritical path: {} operations, to row {row}, column {column} of `{}`",
        depth[end.index()],
        output.name
    );
    line(text, &heading);
    for steps in steps.chunks(12) {
        line(text, &format!("         {}", steps.join(" ")));
    }
}

/// What is computed once and used more often, those first that save the most operations.
fn shared(text: &mut String, program: &Program, function: &Function, expressions: &Expressions) {
    let graph = &expressions.graph;
    let (_, elements) = Locals::new(program, function);
    let mut printer = Printer::new(&program.externals, expressions, false);
    let uses = expressions.uses();
    // Operations of a node but for those inside of shared ones, which stand in it by their names.
    let mut size = vec![0_usize; graph.len()];
    let mut found = Vec::new();
    for (id, node) in graph.iter() {
        match node {
            Node::Input { input, element } => printer.name(id, elements[input][element].clone()),
            Node::Constant(_) => {}
            _ => {
                let inside: usize = node.operands().map(|operand| size[operand.index()]).sum();
                size[id.index()] = inside + 1;
                if uses[id.index()] > 1 {
                    let name = format!("s{}", found.len() + 1);
                    let expression = text_of(&printer, id);
                    found.push((uses[id.index()], inside + 1, name.clone(), expression));
                    printer.name(id, name);
                    size[id.index()] = 0;
                }
            }
        }
    }
    let total = found.len();
    found.sort_by_key(|(uses, size, ..)| std::cmp::Reverse((uses - 1) * size));
    let heading = "uses, operations of each, expression";
    line(
        text,
        &format!("\nshared subexpressions: {total}; {heading}"),
    );
    for (uses, size, name, expression) in found.iter().take(MOST_SHARED) {
        line(text, &format!("{uses:>7} {size:>6}  {name} = {expression}"));
    }
}

fn text_of(printer: &Printer<'_>, id: NodeId) -> String {
    let text = printer.print(id).to_string();
    // Spaces that stand between all tokens, and the marks of constants.
    let text = text
        .replace(" . ", ".")
        .replace(" ()", "()")
        .replace("( ", "(")
        .replace(" )", ")");
    let text = text.replace("T :: from_f64 ", "").replace(" (", "(");
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}

/// A cross for each structural nonzero.
fn structure(text: &mut String, output: &Output) {
    let (rows, columns) = (output.rows, output.columns);
    let heading = format!(
        "\noutput `{}`: {rows} x {columns}, {} of {} structural nonzeros",
        output.name,
        output.nonzeros.len(),
        rows * columns
    );
    line(text, &heading);
    if rows > LARGEST_PICTURE || columns > LARGEST_PICTURE {
        return;
    }
    let places = output.places();
    for row in 0..rows {
        let marks: String = (0..columns)
            .map(|column| {
                if places.contains_key(&(row, column)) {
                    'x'
                } else {
                    '.'
                }
            })
            .collect();
        let name = output.row_names.get(row).map_or("", String::as_str);
        line(text, format!("         {marks}  {name}").trim_end());
    }
}
