//! The outputs of a function: their types, their struct, the positions of nonzeros.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::doc::{self, Doc};
use super::items::{Items, Namespace, ident, integer};
use crate::Error;
use crate::program::{Function, Output, pascal_case, screaming_case};

/// Memory layout of an output.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Layout {
    /// `[T; rows]`.
    Vector,
    /// `[[T; columns]; rows]`.
    Matrix,
    /// `[T; nonzeros]`.
    Sparse,
}

impl Layout {
    pub(super) fn of(output: &Output) -> Self {
        match (output.is_full(), output.columns) {
            (true, 1) => Self::Vector,
            (true, _) => Self::Matrix,
            (false, _) => Self::Sparse,
        }
    }
}

/// The function returns its one output itself and not a struct of outputs.
pub(super) fn is_returned_directly(function: &Function) -> bool {
    matches!(&function.outputs[..], [output] if output.is_full())
}

/// Return type of a function.
pub(super) fn return_type(function: &Function) -> TokenStream {
    match &function.outputs[..] {
        [output] if output.is_full() => array_type(output),
        _ => {
            let structure = structure_name(function);
            quote!(#structure<T>)
        }
    }
}

/// The value that the function returns, from the nonzeros of each output.
pub(super) fn return_value(function: &Function, nonzeros: &[Vec<TokenStream>]) -> TokenStream {
    if is_returned_directly(function) {
        return array_value(&function.outputs[0], &nonzeros[0]);
    }
    let structure = structure_name(function);
    let fields = function.outputs.iter().map(|output| ident(&output.name));
    let values = function
        .outputs
        .iter()
        .zip(nonzeros)
        .map(|(output, tokens)| array_value(output, tokens));
    quote!(#structure { #(#fields: #values),* })
}

/// Number of scalars that a function returns.
pub(super) fn scalars(function: &Function) -> usize {
    let outputs = function.outputs.iter();
    outputs.map(|output| output.nonzeros.len()).sum()
}

/// Statements that write the results to the place `out`, from the nonzeros of each output.
pub(super) fn assignments(
    function: &Function,
    out: &Ident,
    nonzeros: &[Vec<TokenStream>],
) -> TokenStream {
    if is_returned_directly(function) {
        let value = array_value(&function.outputs[0], &nonzeros[0]);
        return quote!(*#out = #value;);
    }
    let outputs = function.outputs.iter().zip(nonzeros);
    let statements = outputs.map(|(output, tokens)| {
        let (field, value) = (ident(&output.name), array_value(output, tokens));
        quote!(#out.#field = #value;)
    });
    quote!(#(#statements)*)
}

/// The results of a function, all zero.
pub(super) fn zeros(function: &Function) -> TokenStream {
    let zero = |output: &Output| {
        let [rows, columns, count] = [output.rows, output.columns, output.nonzeros.len()];
        let [rows, columns, count] = [rows, columns, count].map(integer);
        match Layout::of(output) {
            Layout::Vector => quote!([zero; #rows]),
            Layout::Matrix => quote!([[zero; #columns]; #rows]),
            Layout::Sparse => quote!([zero; #count]),
        }
    };
    if is_returned_directly(function) {
        return zero(&function.outputs[0]);
    }
    let structure = structure_name(function);
    let fields = function.outputs.iter().map(|output| {
        let (field, value) = (ident(&output.name), zero(output));
        quote!(#field: #value)
    });
    quote!(#structure { #(#fields),* })
}

/// The struct of a function with several outputs or a sparse one.
pub(super) fn structure(
    function: &Function,
    items: &mut Items<'_>,
) -> Result<Vec<TokenStream>, Error> {
    if is_returned_directly(function) {
        return Ok(Vec::new());
    }
    let place = format!("function `{}`", function.name);
    let name = items.claim(Namespace::Type, &pascal_case(&function.name), &place)?;
    let doc = Doc::of(&format!("Results of [`{}`].", function.name)).tokens();
    let fields = function.outputs.iter().map(|output| {
        let doc = Doc::of(&meaning(output, &name)).tokens();
        let (field, kind) = (ident(&output.name), array_type(output));
        quote!(#doc pub #field: #kind,)
    });
    let mut result = vec![quote! {
        #doc
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct #name<T> {
            #(#fields)*
        }
    }];
    let sparse: Vec<&Output> = function
        .outputs
        .iter()
        .filter(|output| Layout::of(output) == Layout::Sparse)
        .collect();
    if !sparse.is_empty() {
        let constants = sparse.iter().map(|output| positions(output));
        let methods = sparse.iter().map(|output| dense_method(output));
        result.push(quote! {
            impl<T> #name<T> {
                #(#constants)*
            }
        });
        result.push(quote! {
            impl<T: Scalar> #name<T> {
                #(#methods)*
            }
        });
    }
    Ok(result)
}

/// One line for an output: meaning, unit, shape and the order of its elements.
pub(super) fn meaning(output: &Output, structure: &Ident) -> String {
    let unit = doc::unit_text(&output.unit);
    let rows = doc::code_list(output.row_names.iter().map(String::as_str));
    let columns = doc::code_list(output.column_names.iter().map(String::as_str));
    let mut text = doc::sentence(&output.doc);
    if text.ends_with('.') {
        text.pop();
    }
    let shape = match Layout::of(output) {
        Layout::Vector => output.rows.to_string(),
        _ => format!("{} x {}", output.rows, output.columns),
    };
    text.push_str(&format!(" \\[{unit}\\], {shape}"));
    if Layout::of(output) == Layout::Sparse {
        text.push_str(&format!(
            ", {} structural nonzero{} at [`{structure}::{}`]",
            output.nonzeros.len(),
            if output.nonzeros.len() == 1 { "" } else { "s" },
            screaming_case(&output.name)
        ));
        return text + ".";
    }
    match (rows.is_empty(), Layout::of(output)) {
        (true, _) => {}
        (false, Layout::Vector) => text.push_str(&format!(": {rows}")),
        (false, _) if columns.is_empty() => text.push_str(&format!(": rows {rows}")),
        (false, _) => text.push_str(&format!(": rows {rows}; columns {columns}")),
    }
    text + "."
}

/// The name of the struct of a function.
pub(super) fn structure_name(function: &Function) -> Ident {
    format_ident!("{}", pascal_case(&function.name))
}

fn array_type(output: &Output) -> TokenStream {
    let (rows, columns) = (integer(output.rows), integer(output.columns));
    let nonzeros = integer(output.nonzeros.len());
    match Layout::of(output) {
        Layout::Vector => quote!([T; #rows]),
        Layout::Matrix => quote!([[T; #columns]; #rows]),
        Layout::Sparse => quote!([T; #nonzeros]),
    }
}

fn array_value(output: &Output, nonzeros: &[TokenStream]) -> TokenStream {
    match Layout::of(output) {
        Layout::Sparse => quote!([#(#nonzeros),*]),
        // Sorted by row, then column.
        Layout::Vector => {
            let rows = output
                .places()
                .into_values()
                .map(|nonzero| &nonzeros[nonzero]);
            quote!([#(#rows),*])
        }
        Layout::Matrix => {
            let places: Vec<usize> = output.places().into_values().collect();
            let rows = places.chunks(output.columns).map(|row| {
                let entries = row.iter().map(|&nonzero| &nonzeros[nonzero]);
                quote!([#(#entries),*])
            });
            quote!([#(#rows),*])
        }
    }
}

/// The constant with the row and column of each nonzero.
fn positions(output: &Output) -> TokenStream {
    let name = format_ident!("{}", screaming_case(&output.name));
    let count = integer(output.nonzeros.len());
    let mut doc = Doc::of(&format!(
        "Row and column of each element of `{}`.",
        output.name
    ));
    let row_name = |row: usize| output.row_names.get(row).map(String::as_str);
    let has_names = !output.row_names.is_empty() && !output.column_names.is_empty();
    if has_names && !output.nonzeros.is_empty() {
        let runs: Vec<String> = output
            .nonzeros
            .chunk_by(|left, right| left.1 == right.1)
            .scan(0, |start, run| {
                let first = *start;
                *start += run.len();
                let column = &output.column_names[run[0].1];
                let rows = doc::code_list(run.iter().filter_map(|&(row, _)| row_name(row)));
                Some(match run.len() {
                    1 => format!("{first}: column `{column}`, row {rows}"),
                    _ => format!("{first}-{}: column `{column}`, rows {rows}", *start - 1),
                })
            })
            .collect();
        doc.list("Layout", &runs);
    }
    let doc = doc.tokens();
    let (rows, columns): (Vec<_>, Vec<_>) = output
        .nonzeros
        .iter()
        .map(|&(row, column)| (integer(row), integer(column)))
        .unzip();
    quote! {
        #doc
        pub const #name: [(usize, usize); #count] = [#((#rows, #columns)),*];
    }
}

/// The method that puts zeros between the nonzeros.
fn dense_method(output: &Output) -> TokenStream {
    let method = format_ident!("{}_dense", output.name);
    let (name, field) = (
        format_ident!("{}", screaming_case(&output.name)),
        ident(&output.name),
    );
    let (rows, columns) = (integer(output.rows), integer(output.columns));
    let doc = Doc::of(&format!("`{}` with its zeros.", output.name)).tokens();
    quote! {
        #doc
        #[inline]
        #[must_use]
        pub fn #method(&self) -> [[T; #columns]; #rows] {
            let mut dense = [[T::from_f64(0e0); #columns]; #rows];
            for ((row, column), value) in Self::#name.into_iter().zip(self.#field) {
                dense[row][column] = value;
            }
            dense
        }
    }
}
