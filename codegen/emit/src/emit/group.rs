//! A group: its table of elements, its struct and its index constants.

use proc_macro2::TokenStream;
use quote::{format_ident, quote};

use super::doc::{self, Doc};
use super::items::{Items, Namespace, ident, integer};
use crate::Error;
use crate::program::{Element, Group, pascal_case, screaming_case};

pub(super) fn emit(group: &Group, items: &mut Items<'_>) -> Result<Vec<TokenStream>, Error> {
    let place = format!("group `{}`", group.name);
    let table = items.claim(Namespace::Value, &screaming_case(&group.name), &place)?;
    let structure = items.claim(Namespace::Type, &pascal_case(&group.name), &place)?;
    let index = items.claim(Namespace::Type, &format!("{}_index", group.name), &place)?;
    let count = integer(group.elements.len());
    let mut table_doc = Doc::of(&doc::sentence(&group.doc));
    table_doc.paragraph(&format!(
        "Names, ids and units of the elements of [`{structure}`]."
    ));
    let table_doc = table_doc.tokens();
    let entries = group.elements.iter().map(
        |Element {
             name,
             id,
             unit,
             doc,
         }| { quote!(Element { name: #name, id: #id, unit: #unit, doc: #doc }) },
    );
    let mut doc = Doc::of(&doc::sentence(&group.doc));
    doc.paragraph(&format!("As an array in this order; see [`{table}`]."));
    let elements: Vec<&Element> = group.elements.iter().collect();
    let indices = index_module(&index, &elements, &format!("[`{structure}`]"));
    Ok([
        vec![quote! {
            #table_doc
            pub const #table: [Element; #count] = [#(#entries),*];
        }],
        structure_items(&structure, &doc, &elements),
        vec![indices],
    ]
    .concat())
}

/// A struct of named scalars with its conversions from and to an array.
pub(super) fn structure_items(
    name: &proc_macro2::Ident,
    doc: &Doc,
    elements: &[&Element],
) -> Vec<TokenStream> {
    let doc = doc.tokens();
    let count = integer(elements.len());
    let fields: Vec<_> = elements
        .iter()
        .map(|element| ident(&element.name))
        .collect();
    let docs = elements
        .iter()
        .map(|element| doc::element(element).tokens());
    vec![
        quote! {
            #doc
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct #name<T> {
                #(#docs pub #fields: T,)*
            }
        },
        quote! {
            impl<T> #name<T> {
                /// The elements by name, from an array in the order of the fields.
                #[inline(always)]
                #[must_use]
                pub fn from_array(elements: [T; #count]) -> Self {
                    let [#(#fields),*] = elements;
                    Self { #(#fields),* }
                }
                /// The elements as an array in the order of the fields.
                #[inline(always)]
                #[must_use]
                pub fn to_array(self) -> [T; #count] {
                    [#(self.#fields),*]
                }
            }
        },
    ]
}

/// A module of index constants; `of` is a Markdown link to what they index.
pub(super) fn index_module(
    name: &proc_macro2::Ident,
    elements: &[&Element],
    of: &str,
) -> TokenStream {
    let doc = Doc::of(&format!("Indices into the array form of {of}.")).tokens();
    let constants = elements.iter().enumerate().map(|(index, element)| {
        let doc = Doc::of(&format!("Index of `{}`.", element.name)).tokens();
        let name = format_ident!("{}", screaming_case(&element.name));
        let index = integer(index);
        quote!(#doc pub const #name: usize = #index;)
    });
    quote! {
        #doc
        pub mod #name {
            #(#constants)*
        }
    }
}
