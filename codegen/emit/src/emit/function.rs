//! A function: its struct of outputs, if it needs one, and the function itself.

use proc_macro2::TokenStream;
use quote::quote;

use super::count::Count;
use super::doc::{self, Doc};
use super::items::{Items, Namespace, ident, integer};
use super::{output, plan};
use crate::ir::{Expressions, Node};
use crate::program::{Function, Group, pascal_case};
use crate::{Error, Program};

/// Functions up to this many operations are always inlined: for them a call that passes
/// arrays through memory costs a noticeable part of the work. Larger ones are left to the
/// compiler, which sees them in the caller's crate anyway, as they are generic.
const ALWAYS_INLINED_OPERATIONS: usize = 64;

/// Arguments that clippy takes without a word.
const FEW_ARGUMENTS: usize = 7;

/// Results of more scalars than these are written through a reference by the function that computes
/// them: compilers copy larger ones through memory when a result is assigned to a place that exists
/// already, which can take as long as the function.
const FEW_SCALARS: usize = 16;

/// Functions with such results are inlined up to this many operations: where they are not, their
/// results are copied once more, which takes a noticeable part of the time of smaller ones only.
const INLINED_OPERATIONS_OF_LARGE_RESULTS: usize = 512;

/// Attributes for the inlining of a function.
fn inlining(operations: usize, scalars: usize) -> TokenStream {
    if operations <= ALWAYS_INLINED_OPERATIONS {
        quote!(#[inline(always)])
    } else if scalars > FEW_SCALARS && operations <= INLINED_OPERATIONS_OF_LARGE_RESULTS {
        // Where there is no operating system code counts more than a copy.
        quote! {
            #[cfg_attr(target_os = "none", inline)]
            #[cfg_attr(not(target_os = "none"), inline(always))]
        }
    } else {
        quote!(#[inline])
    }
}

pub(super) fn emit(
    program: &Program,
    function: &Function,
    expressions: &Expressions,
    fused: bool,
    items: &mut Items<'_>,
) -> Result<Vec<TokenStream>, Error> {
    let mut result = output::structure(function, items)?;
    let place = format!("function `{}`", function.name);
    let name = items.claim(Namespace::Value, &function.name, &place)?;
    let count = Count::of(expressions);
    let doc = documentation(program, function, count);
    let inline = inlining(count.total(), output::scalars(function));
    let allowances = allowances(function, expressions);
    let arguments: Vec<TokenStream> = program.inputs_of(function).map(parameter).collect();
    let return_type = output::return_type(function);
    let body = plan::body(program, function, expressions, fused);
    let statements = &body.statements;
    if output::scalars(function) <= FEW_SCALARS {
        let value = output::return_value(function, &body.outputs);
        let doc = doc.tokens();
        result.push(quote! {
            #doc
            #inline
            #[must_use]
            #allowances
            pub fn #name<T: Scalar>(#(#arguments),*) -> #return_type {
                #(#statements)*
                #value
            }
        });
        return Ok(result);
    }
    let into_name = format!("{}_into", function.name);
    let into = items.claim(Namespace::Value, &into_name, &place)?;
    let out = &body.out;
    let assignments = output::assignments(function, out, &body.outputs);
    let names = program.inputs_of(function).map(|group| ident(&group.name));
    let zeros = output::zeros(function);
    let mut doc = doc;
    doc.paragraph("# Results");
    doc.lines_of(&format!(
        "Returned by value. To write them to a place that exists already, call [`{into_name}`]: \
         assigning them copies them through memory."
    ));
    let doc = doc.tokens();
    let into_doc = format!("[`{name}`], written to `{out}`: every element is, at every call.");
    let into_doc = Doc::of(&into_doc).tokens();
    let few = function.inputs.len() == FEW_ARGUMENTS;
    let into_allowance = few.then(too_many_arguments);
    // A result of an element at least is there, so every statement has a scalar of type `T`.
    result.push(quote! {
        #doc
        #[inline(always)]
        #[must_use]
        #allowances
        pub fn #name<T: Scalar>(#(#arguments),*) -> #return_type {
            let zero = T::from_f64(0e0);
            let mut #out = #zeros;
            #into(#(#names,)* &mut #out);
            #out
        }
    });
    result.push(quote! {
        #into_doc
        #inline
        #allowances
        #into_allowance
        pub fn #into<T: Scalar>(#(#arguments,)* #out: &mut #return_type) {
            #(#statements)*
            #assignments
        }
    });
    Ok(result)
}

fn documentation(program: &Program, function: &Function, count: Count) -> Doc {
    let mut doc = Doc::of(&doc::sentence(&function.doc));
    if !function.source.is_empty() {
        doc.paragraph(&format!("Source: {}", without_capital(&function.source)));
    }
    let arguments: Vec<String> = program.inputs_of(function).map(argument).collect();
    if !arguments.is_empty() {
        doc.list("Arguments", &arguments);
    }
    let structure = output::structure_name(function);
    let outputs: Vec<String> = function
        .outputs
        .iter()
        .map(|output| format!("`{}`: {}", output.name, output::meaning(output, &structure)))
        .collect();
    doc.list("Returns", &outputs);
    if !function.domain.is_empty() {
        doc.paragraph("# Domain");
        doc.lines_of(&doc::sentence(&function.domain));
    }
    doc.paragraph("# Cost");
    doc.lines_of(&count.text());
    doc
}

/// Name and type of an argument.
fn parameter(group: &Group) -> TokenStream {
    let (argument, length) = (ident(&group.name), integer(group.elements.len()));
    quote!(#argument: &[T; #length])
}

/// Meaning, unit, shape and order of an argument.
fn argument(group: &Group) -> String {
    let mut meaning = doc::sentence(&group.doc);
    if meaning.ends_with('.') {
        meaning.pop();
    }
    format!(
        "`{}`: {meaning} \\[{}\\], {} in the order of [`{}`].",
        group.name,
        doc::units(group),
        group.elements.len(),
        pascal_case(&group.name)
    )
}

/// A source reads on after a colon: "equations (7) and (9)".
fn without_capital(text: &str) -> String {
    let text = doc::escape(text);
    if text.ends_with('.') {
        text
    } else {
        format!("{text}.")
    }
}

/// Lints that the numbers or the interface of a model would set off.
fn allowances(function: &Function, expressions: &Expressions) -> TokenStream {
    let has_fraction = expressions.graph.iter().any(
        |(_, node)| matches!(node, Node::Constant(constant) if constant.value().fract() != 0.0),
    );
    let constants = has_fraction.then(|| {
        quote!(#[allow(
            clippy::approx_constant,
            reason = "constants are those of the derivation, to the last digit"
        )])
    });
    let arguments = (function.inputs.len() > FEW_ARGUMENTS).then(too_many_arguments);
    quote!(#constants #arguments)
}

fn too_many_arguments() -> TokenStream {
    quote!(#[allow(
        clippy::too_many_arguments,
        reason = "one argument for each group of the derivation"
    )])
}
