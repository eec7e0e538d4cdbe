//! The names of a module's items, each of which may be taken once.

use std::collections::BTreeMap;

use proc_macro2::{Ident, Literal, Span};

use crate::Error;

/// Names that emitted code uses and no item may take.
pub(super) const USED_TYPES: &[&str] = &[
    "T",
    "Scalar",
    "Model",
    "NamedInputs",
    "Element",
    "RatesJacobian",
    "Recentre",
    "Self",
    "Clone",
    "Copy",
    "Debug",
    "PartialEq",
    "Option",
    "TryFrom",
    "bool",
    "f64",
    "str",
];
const USED_VALUES: &[&str] = &["Some", "None", "Ok", "T"];

/// Namespace of a name in Rust.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Namespace {
    Type,
    Value,
}

pub(super) struct Items<'a> {
    origin: &'a str,
    taken: BTreeMap<(Namespace, String), String>,
}

impl<'a> Items<'a> {
    pub(super) fn new(origin: &'a str) -> Self {
        let used = |namespace, names: &[&str]| {
            names
                .iter()
                .map(|&name| {
                    (
                        (namespace, name.to_owned()),
                        "the emitted code itself".to_owned(),
                    )
                })
                .collect::<Vec<_>>()
        };
        let taken = used(Namespace::Type, USED_TYPES)
            .into_iter()
            .chain(used(Namespace::Value, USED_VALUES))
            .collect();
        Self { origin, taken }
    }

    /// Takes a name for an item that comes from `place`.
    pub(super) fn claim(
        &mut self,
        namespace: Namespace,
        name: &str,
        place: &str,
    ) -> Result<Ident, Error> {
        match self
            .taken
            .insert((namespace, name.to_owned()), place.to_owned())
        {
            None => Ok(ident(name)),
            Some(other) => Err(Error::Name {
                origin: self.origin.to_owned(),
                place: place.to_owned(),
                name: name.to_owned(),
                expected: format!("a name of a Rust item that {other} does not take"),
            }),
        }
    }
}

/// A number as one writes it, without the type.
pub(super) fn integer(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}

/// An identifier; the name was checked with the program, or is built of checked names.
pub(super) fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}
