//! The two forms of a function with Jacobians, the full one and that at the origin, and how
//! their results are written into the caller's buffers.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Parts;
use crate::emit::items::{ident, integer};
use crate::emit::output::{Layout, is_returned_directly};
use crate::program::{Function, ModelFunction, Output};

/// A function with Jacobians, and what a method made of it has to write.
pub(super) struct Form<'a> {
    pub(super) given: &'a Function,
    /// The function whose nonzeros are written; where `given` has none of them, zeros are, as
    /// the caller's buffers may hold values that this function wrote before.
    full: &'a Function,
    is_at_origin: bool,
}

/// An output of a [`Form`].
pub(super) struct FormOutput<'a> {
    pub(super) given: &'a Output,
    pub(super) written: &'a Output,
}

impl<'a> Form<'a> {
    pub(super) fn full(parts: &Parts<'a>, function: ModelFunction) -> Self {
        let full = parts.function(function.jacobian);
        Self {
            given: full,
            full,
            is_at_origin: false,
        }
    }

    pub(super) fn at_origin(parts: &Parts<'a>, function: ModelFunction) -> Option<Self> {
        let given = parts.function(function.jacobian_at_origin?);
        let full = parts.function(function.jacobian);
        Some(Self {
            given,
            full,
            is_at_origin: true,
        })
    }

    /// The name of the method, and its argument of the moving states if it takes them.
    pub(super) fn method(&self, name: &str, moving: &TokenStream) -> (Ident, TokenStream) {
        if self.is_at_origin {
            (format_ident!("{name}_at_origin"), TokenStream::new())
        } else {
            (ident(name), moving.clone())
        }
    }

    fn outputs(&self) -> impl Iterator<Item = FormOutput<'a>> {
        let pairs = self.given.outputs.iter().zip(&self.full.outputs);
        pairs.map(|(given, written)| FormOutput { given, written })
    }

    /// The Jacobian with respect to a group.
    pub(super) fn jacobian(&self, group: &str) -> Option<FormOutput<'a>> {
        let name = format!("{}_d_{group}", self.full.outputs[0].name);
        self.outputs().find(|output| output.given.name == name)
    }

    /// The call, and the zero that is written where the result has no element.
    pub(super) fn result(&self, call: &TokenStream) -> TokenStream {
        let count = |function: &Function| -> usize {
            let outputs = function.outputs.iter();
            outputs.map(|output| output.nonzeros.len()).sum()
        };
        let zero =
            (count(self.given) < count(self.full)).then(|| quote!(let zero = T::from_f64(0e0);));
        if count(self.given) == 0 {
            return quote!(let _ = #call; #zero);
        }
        quote!(let result = #call; #zero)
    }

    /// The value among the results.
    pub(super) fn value(&self) -> TokenStream {
        if is_returned_directly(self.given) {
            return quote!(result);
        }
        let given = &self.given.outputs[0];
        if given.is_full() {
            let field = ident(&given.name);
            return quote!(result.#field);
        }
        let written = &self.full.outputs[0];
        let elements = FormOutput { given, written }
            .entries()
            .map(|(.., value)| value);
        quote!([#(#elements),*])
    }
}

impl FormOutput<'_> {
    /// Row, column and expression of each place that is written.
    pub(super) fn entries(self) -> impl Iterator<Item = (usize, usize, TokenStream)> {
        let field = ident(&self.given.name);
        let places = self.given.places();
        self.written.nonzeros.iter().map(move |&(row, column)| {
            let Some(&nonzero) = places.get(&(row, column)) else {
                return (row, column, quote!(zero));
            };
            let [i, j, k] = [row, column, nonzero].map(integer);
            let value = match Layout::of(self.given) {
                Layout::Vector => quote!(result.#field[#i]),
                Layout::Matrix => quote!(result.#field[#i][#j]),
                Layout::Sparse => quote!(result.#field[#k]),
            };
            (row, column, value)
        })
    }
}
