//! A table: the type of its records, and the records as a static array.

use std::collections::BTreeSet;

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, quote};

use super::doc::{self, Doc};
use super::items::{Items, Namespace, ident, integer};
use crate::Error;
use crate::program::{Kind, Table, Value, screaming_case};

pub(super) fn emit(table: &Table, items: &mut Items<'_>) -> Result<Vec<TokenStream>, Error> {
    let place = format!("table `{}`", table.name);
    let name = items.claim(Namespace::Value, &screaming_case(&table.name), &place)?;
    let rows = table.rows.iter().map(|values| {
        let fields = table.fields.iter().map(|field| ident(&field.name));
        let values = values.iter().map(literal);
        let row = ident(&table.row);
        quote!(#row { #(#fields: #values),* })
    });
    let doc = Doc::of(&doc::sentence(&table.doc)).tokens();
    let count = integer(table.rows.len());
    if table.module.is_some() {
        let row = ident(&table.row);
        return Ok(vec![quote! {
            #doc
            pub static #name: [#row; #count] = [#(#rows),*];
        }]);
    }
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
        // Refused where the emitter declares the type.
        Kind::Texts | Kind::Typed => quote!(&'static [&'static str]),
    }
}

#[expect(clippy::cognitive_complexity, reason = "one arm for each form")]
fn literal(value: &Value) -> TokenStream {
    match value {
        Value::Text(text) => quote!(#text),
        Value::Truth(truth) => quote!(#truth),
        Value::Texts(texts) => quote!(&[#(#texts),*]),
        Value::Index(index) => integer(*index).into_token_stream(),
        Value::Variant(path, arguments) => {
            let path = path.split("::").map(ident);
            if arguments.is_empty() {
                return quote!(#(#path)::*);
            }
            let arguments = arguments.iter().map(literal);
            quote!(#(#path)::*(#(#arguments),*))
        }
        Value::Record(name, fields) => {
            let name = ident(name);
            let fields = fields.iter().map(|(field, content)| {
                let (field, content) = (ident(field), literal(content));
                quote!(#field: #content)
            });
            quote!(#name { #(#fields),* })
        }
        Value::List(items) => {
            let items = items.iter().map(literal);
            quote!(&[#(#items),*])
        }
        Value::Number(number) => {
            let sign = (*number < 0.0).then(|| quote!(-));
            // The literal of a finite number always parses.
            let digits = format!("{:e}", number.abs()).parse::<Literal>().ok();
            quote!(#sign #digits)
        }
    }
}

/// Names of the types of a declared module that the rows of a table use, sorted.
pub(super) fn types(table: &Table) -> BTreeSet<&str> {
    let mut found = BTreeSet::from([table.row.as_str()]);
    for row in &table.rows {
        for value in row {
            collect(value, &mut found);
        }
    }
    found
}

fn collect<'a>(value: &'a Value, found: &mut BTreeSet<&'a str>) {
    match value {
        Value::Variant(path, arguments) => {
            // `Some` and `None` are Rust's own.
            if let Some((name, _)) = path.split_once("::") {
                found.insert(name);
            }
            arguments.iter().for_each(|value| collect(value, found));
        }
        Value::Record(name, fields) => {
            found.insert(name);
            fields.iter().for_each(|(_, value)| collect(value, found));
        }
        Value::List(items) => items.iter().for_each(|value| collect(value, found)),
        _ => {}
    }
}
