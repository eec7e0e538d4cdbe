//! Long functions and long files.

use std::path::{Path, PathBuf};

use syn::spanned::Spanned as _;
use syn::visit::{self, Visit};

use super::source::{Crate, of_tests};

/// Lines that a function may have, from its signature to its closing brace.
const FUNCTION: usize = 80;

/// Lines that a file may have.
const FILE: usize = 450;

/// A function or a file above its limit.
pub(crate) struct Long {
    pub(crate) file: PathBuf,
    /// Name of the function; empty for a file.
    pub(crate) function: String,
    pub(crate) lines: usize,
}

/// Everything too long in a crate.
pub(crate) fn long(of: &Crate) -> Vec<Long> {
    let mut found = Vec::new();
    for module in &of.modules {
        if module.lines > FILE {
            found.push(Long {
                file: module.file.clone(),
                function: String::new(),
                lines: module.lines,
            });
        }
        let mut functions = Functions {
            file: &module.file,
            found: &mut found,
        };
        for item in &module.items {
            functions.visit_item(item);
        }
    }
    found
}

struct Functions<'a> {
    file: &'a Path,
    found: &'a mut Vec<Long>,
}

impl Functions<'_> {
    fn judge(&mut self, signature: &syn::Signature, block: &syn::Block) {
        let first = signature.span().start().line;
        let last = block.brace_token.span.close().end().line;
        let lines = last + 1 - first;
        if lines > FUNCTION {
            self.found.push(Long {
                file: self.file.to_owned(),
                function: signature.ident.to_string(),
                lines,
            });
        }
    }
}

impl<'a> Visit<'a> for Functions<'_> {
    fn visit_item_fn(&mut self, function: &'a syn::ItemFn) {
        if !of_tests(&function.attrs) {
            self.judge(&function.sig, &function.block);
            visit::visit_item_fn(self, function);
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'a syn::ImplItemFn) {
        self.judge(&function.sig, &function.block);
        visit::visit_impl_item_fn(self, function);
    }

    fn visit_trait_item_fn(&mut self, function: &'a syn::TraitItemFn) {
        if let Some(block) = &function.default {
            self.judge(&function.sig, block);
        }
        visit::visit_trait_item_fn(self, function);
    }
}
