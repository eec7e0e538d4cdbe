//! Lines that compute: calls of mathematical functions, and uses of packages for computing.

use syn::visit::{self, Visit};
use syn::{ExprMethodCall, ItemUse, UseTree};

use super::source::{Crate, of_tests};

/// Methods of numbers that a statistic needs and a table does not.
const METHODS: [&str; 16] = [
    "acos", "asin", "atan", "atan2", "cos", "exp", "exp_m1", "hypot", "ln", "ln_1p", "log10",
    "powf", "powi", "sin", "sqrt", "tan",
];

/// Packages for computing.
const PACKAGES: [&str; 4] = ["libm", "nalgebra", "rustfft", "statrs"];

/// Names of `gyrocal_statistics` that print numbers.
const PRINTING: [&str; 1] = ["format"];

/// Such lines of a crate, with what they call.
pub(crate) fn lines(of: &Crate) -> Vec<String> {
    let mut found = Vec::new();
    for module in &of.modules {
        let mut calls = Calls {
            file: module.file.display().to_string(),
            found: &mut found,
        };
        for item in &module.items {
            calls.visit_item(item);
        }
    }
    found
}

/// The names at the ends of a tree of imports.
fn names_of(tree: &UseTree, names: &mut Vec<String>) {
    match tree {
        UseTree::Path(path) => names_of(&path.tree, names),
        UseTree::Name(name) => names.push(name.ident.to_string()),
        UseTree::Rename(rename) => names.push(rename.ident.to_string()),
        UseTree::Group(group) => group.items.iter().for_each(|tree| names_of(tree, names)),
        UseTree::Glob(_) => names.push("*".to_owned()),
    }
}

struct Calls<'a> {
    file: String,
    found: &'a mut Vec<String>,
}

impl<'a> Visit<'a> for Calls<'_> {
    fn visit_item_fn(&mut self, function: &'a syn::ItemFn) {
        if !of_tests(&function.attrs) {
            visit::visit_item_fn(self, function);
        }
    }

    fn visit_expr_method_call(&mut self, call: &'a ExprMethodCall) {
        if METHODS.iter().any(|method| call.method == method) {
            let line = call.method.span().start().line;
            self.found
                .push(format!("{}:{line} `{}`", self.file, call.method));
        }
        visit::visit_expr_method_call(self, call);
    }

    fn visit_item_use(&mut self, import: &'a ItemUse) {
        let UseTree::Path(path) = &import.tree else {
            return;
        };
        let line = path.ident.span().start().line;
        if PACKAGES.iter().any(|package| path.ident == package) {
            self.found
                .push(format!("{}:{line} `{}`", self.file, path.ident));
        }
        if path.ident == "gyrocal_statistics" {
            let mut names = Vec::new();
            names_of(&path.tree, &mut names);
            // Functions begin with a small letter, types that are only printed do not.
            for name in names
                .iter()
                .filter(|name| !PRINTING.contains(&name.as_str()))
            {
                if name.starts_with(|letter: char| letter.is_lowercase()) {
                    self.found.push(format!("{}:{line} `{name}`", self.file));
                }
            }
        }
    }
}
