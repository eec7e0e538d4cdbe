//! Functions of the surrounding Rust that a program calls by name.

use super::context::Context;
use super::schema::RawExternal;
use crate::Error;

/// Most arguments of an external function.
pub const MOST_ARGUMENTS: usize = 4;

/// A scalar function that the user of the module provides.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct External {
    /// Name in instructions and in Rust.
    pub name: String,
    /// Path of the Rust function, `fn name<T: Scalar>(x: T) -> T`, generic as emitted code is.
    pub path: String,
    /// Meaning.
    pub doc: String,
    /// Number of arguments.
    pub arguments: usize,
}

pub(super) fn external(context: &Context<'_>, raw: RawExternal) -> Result<External, Error> {
    let place = format!("external function `{}`", raw.name);
    let path = syn::parse_str::<syn::Path>(&raw.path).ok().filter(|path| {
        let mut segments = path.segments.iter();
        segments.all(|segment| segment.arguments.is_none())
            && path
                .segments
                .last()
                .is_some_and(|last| last.ident == raw.name.as_str())
    });
    if path.is_none() {
        return Err(context.error(
            &place,
            format!("the path `{}`", raw.path),
            format!(
                "a path that ends in its name, such as `crate::{}`",
                raw.name
            ),
            "say in the derivation where the Rust function is",
        ));
    }
    if !(1..=MOST_ARGUMENTS).contains(&raw.arguments) {
        return Err(context.error(
            &place,
            format!("{} arguments", raw.arguments),
            format!("1 to {MOST_ARGUMENTS}"),
            "split the function, or write it with the operations of programs",
        ));
    }
    Ok(External {
        name: raw.name,
        path: raw.path,
        doc: raw.doc,
        arguments: raw.arguments,
    })
}
