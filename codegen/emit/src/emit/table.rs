//! A table: the type of its records, and the records as a static array.

use proc_macro2::{Literal, TokenStream};
use quote::quote;

use super::doc::{self, Doc};
use super::items::{Items, Namespace, ident, integer};
use crate::Error;
use crate::program::{Kind, Table, Value, screaming_case};

pub(super) fn emit(table: &Table, items: &mut Items<'_>) -> Result<Vec<TokenStream>, Error> {
    let place = format!("table `{}`", table.name);
    let name = items.claim(Namespace::Value, &screaming_case(&table.name), &place)?;
    let row = items.claim(Namespace::Type, &table.row, &place)?;
    let row_doc = Doc::of(&format!("A row of [`{name}`].")).tokens();
    let docs = table
        .fields
        .iter()
        .map(|field| Doc::of(&doc::sentence(&field.doc)).tokens());
    let fields: Vec<_> = table
        .fields
        .iter()
        .map(|field| ident(&field.name))
        .collect();
    let kinds = table.fields.iter().map(|field| kind(field.kind));
    let doc = Doc::of(&doc::sentence(&table.doc)).tokens();
    let count = integer(table.rows.len());
    let rows = table.rows.iter().map(|values| {
        let values = values.iter().map(value);
        quote!(#row { #(#fields: #values),* })
    });
    Ok(vec![
        quote! {
            #row_doc
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct #row {
                #(#docs pub #fields: #kinds,)*
            }
        },
        quote! {
            #doc
            pub static #name: [#row; #count] = [#(#rows),*];
        },
    ])
}

fn kind(kind: Kind) -> TokenStream {
    match kind {
        Kind::Text => quote!(&'static str),
        Kind::Number => quote!(f64),
        Kind::Truth => quote!(bool),
        Kind::Texts => quote!(&'static [&'static str]),
    }
}

fn value(value: &Value) -> TokenStream {
    match value {
        Value::Text(text) => quote!(#text),
        Value::Truth(truth) => quote!(#truth),
        Value::Texts(texts) => quote!(&[#(#texts),*]),
        Value::Number(number) => {
            let sign = (*number < 0.0).then(|| quote!(-));
            // The literal of a finite number always parses.
            let digits = format!("{:e}", number.abs()).parse::<Literal>().ok();
            quote!(#sign #digits)
        }
    }
}
