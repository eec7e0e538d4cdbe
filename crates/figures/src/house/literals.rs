//! Places that ask an effect's id or kind by a string literal.

use std::collections::BTreeSet;
use std::path::PathBuf;

use quote::ToTokens as _;
use syn::visit::{self, Visit};
use syn::{BinOp, Expr, ExprBinary, ExprLit, ExprMacro, ExprMethodCall, Lit, LitStr, Pat};

use super::source::{Crate, of_tests};

/// Methods of strings that compare.
const METHODS: [&str; 14] = [
    "contains",
    "ends_with",
    "eq",
    "eq_ignore_ascii_case",
    "find",
    "matches",
    "rsplit_once",
    "split_once",
    "starts_with",
    "strip_prefix",
    "strip_suffix",
    "trim_end_matches",
    "trim_matches",
    "trim_start_matches",
];

/// A comparison of an effect's id or kind with a string literal.
pub(crate) struct Place {
    pub(crate) file: PathBuf,
    pub(crate) line: usize,
    pub(crate) literal: String,
}

/// The words that catalogue entries are made of.
pub(crate) struct Words {
    /// Ids, their parts before and after the dot, with the dot and without.
    of_ids: BTreeSet<String>,
    /// Names of kinds.
    of_kinds: BTreeSet<String>,
}

impl Words {
    /// The words of ids and kinds.
    pub(crate) fn new<'a>(
        ids: impl Iterator<Item = &'a str>,
        kinds: impl Iterator<Item = String>,
    ) -> Self {
        let mut of_ids = BTreeSet::new();
        for id in ids {
            of_ids.insert(id.to_owned());
            let Some((place, name)) = id.split_once('.') else {
                continue;
            };
            let group = place.split_once('_').map_or(place, |(group, _)| group);
            for part in [
                place.to_owned(),
                format!("{place}."),
                format!("{group}_"),
                name.to_owned(),
                format!(".{name}"),
            ] {
                of_ids.insert(part);
            }
        }
        of_ids.insert(".".to_owned());
        Self {
            of_ids,
            of_kinds: kinds.collect(),
        }
    }

    /// Whether a comparison of `subject` with `literal` depends on an effect's id or kind.
    fn ask(&self, subject: &str, literal: &str) -> bool {
        let of_effect = |names: &[&str]| {
            subject
                .split(|letter: char| !letter.is_alphanumeric() && letter != '_')
                .any(|word| names.contains(&word))
        };
        let dotted = literal.contains('.') && literal.len() > 1;
        (dotted && self.of_ids.contains(literal))
            || (self.of_ids.contains(literal) && of_effect(&["effect", "effects", "id", "row"]))
            || (self.of_kinds.contains(literal)
                && of_effect(&["kind", "enters", "needs", "needed"]))
    }
}

/// All such places in a crate.
pub(crate) fn places(of: &Crate, words: &Words) -> Vec<Place> {
    let mut found = Vec::new();
    for module in &of.modules {
        let mut comparisons = Comparisons {
            words,
            file: &module.file,
            subjects: Vec::new(),
            found: &mut found,
        };
        for item in &module.items {
            comparisons.visit_item(item);
        }
    }
    found
}

struct Comparisons<'a> {
    words: &'a Words,
    file: &'a std::path::Path,
    /// Expressions that the enclosing patterns are compared with.
    subjects: Vec<String>,
    found: &'a mut Vec<Place>,
}

impl Comparisons<'_> {
    fn judge(&mut self, subject: &str, literal: &LitStr) {
        let value = literal.value();
        if self.words.ask(subject, &value) {
            self.found.push(Place {
                file: self.file.to_owned(),
                line: literal.span().start().line,
                literal: value,
            });
        }
    }
}

fn text(expression: &Expr) -> Option<&LitStr> {
    match expression {
        Expr::Lit(ExprLit {
            lit: Lit::Str(text),
            ..
        }) => Some(text),
        Expr::Reference(reference) => text(&reference.expr),
        Expr::Paren(paren) => text(&paren.expr),
        _ => None,
    }
}

impl<'a> Visit<'a> for Comparisons<'_> {
    fn visit_item_fn(&mut self, function: &'a syn::ItemFn) {
        if !of_tests(&function.attrs) {
            visit::visit_item_fn(self, function);
        }
    }

    fn visit_expr_binary(&mut self, binary: &'a ExprBinary) {
        if matches!(binary.op, BinOp::Eq(_) | BinOp::Ne(_)) {
            for (one, other) in [(&binary.left, &binary.right), (&binary.right, &binary.left)] {
                if let Some(literal) = text(one) {
                    self.judge(&other.to_token_stream().to_string(), literal);
                }
            }
        }
        visit::visit_expr_binary(self, binary);
    }

    fn visit_expr_method_call(&mut self, call: &'a ExprMethodCall) {
        if METHODS.iter().any(|method| call.method == method) {
            for argument in &call.args {
                if let Some(literal) = text(argument) {
                    self.judge(&call.receiver.to_token_stream().to_string(), literal);
                }
            }
        }
        visit::visit_expr_method_call(self, call);
    }

    fn visit_expr_match(&mut self, choice: &'a syn::ExprMatch) {
        self.visit_expr(&choice.expr);
        self.subjects
            .push(choice.expr.to_token_stream().to_string());
        for arm in &choice.arms {
            self.visit_pat(&arm.pat);
        }
        self.subjects.pop();
        for arm in &choice.arms {
            self.visit_expr(&arm.body);
        }
    }

    fn visit_expr_let(&mut self, choice: &'a syn::ExprLet) {
        self.visit_expr(&choice.expr);
        self.subjects
            .push(choice.expr.to_token_stream().to_string());
        self.visit_pat(&choice.pat);
        self.subjects.pop();
    }

    fn visit_pat(&mut self, pattern: &'a Pat) {
        if let Pat::Lit(literal) = pattern
            && let Lit::Str(literal) = &literal.lit
        {
            let subject = self.subjects.last().cloned().unwrap_or_default();
            self.judge(&subject, literal);
        }
        visit::visit_pat(self, pattern);
    }

    fn visit_expr_macro(&mut self, call: &'a ExprMacro) {
        if call.mac.path.is_ident("matches")
            && let Ok(matches) = call.mac.parse_body::<Matches>()
        {
            self.visit_expr(&matches.subject);
            self.subjects
                .push(matches.subject.to_token_stream().to_string());
            Comparisons {
                words: self.words,
                file: self.file,
                subjects: core::mem::take(&mut self.subjects),
                found: self.found,
            }
            .visit_pat(&matches.pattern);
        }
    }
}

/// The arguments of `matches!`.
struct Matches {
    subject: Expr,
    pattern: syn::Pat,
}

impl syn::parse::Parse for Matches {
    fn parse(input: syn::parse::ParseStream<'_>) -> syn::Result<Self> {
        let subject = input.parse()?;
        input.parse::<syn::Token![,]>()?;
        let pattern = syn::Pat::parse_multi_with_leading_vert(input)?;
        if input.parse::<Option<syn::Token![if]>>()?.is_some() {
            input.parse::<Expr>()?;
        }
        input.parse::<Option<syn::Token![,]>>()?;
        Ok(Self { subject, pattern })
    }
}
