//! Expressions with the fewest parentheses that keep their order of evaluation.

use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens, quote};

use super::items::ident;
use crate::ir::{Binary, Expressions, Node, NodeId, Unary};
use crate::program::External;

/// Precedence of an expression, from the loosest.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Negation,
    Atom,
}

type Printed = (TokenStream, Level);

/// Prints nodes of one function in terms of the variables named so far.
pub(super) struct Printer<'a> {
    externals: &'a [External],
    expressions: &'a Expressions,
    names: Vec<Option<String>>,
    /// The constant 1, if the function has it.
    one: Option<NodeId>,
    /// Products that are added become fused multiply-adds.
    fused: bool,
}

impl<'a> Printer<'a> {
    pub(super) fn new(
        externals: &'a [External],
        expressions: &'a Expressions,
        fused: bool,
    ) -> Self {
        let mut constants = expressions.graph.iter();
        let one = constants.find(|(id, _)| expressions.graph.constant_value(*id) == Some(1.0));
        Self {
            externals,
            expressions,
            names: vec![None; expressions.graph.len()],
            one: one.map(|(id, _)| id),
            fused,
        }
    }

    /// From now on the node is this variable.
    pub(super) fn name(&mut self, id: NodeId, name: String) {
        self.names[id.index()] = Some(name);
    }

    pub(super) fn name_of(&self, id: NodeId) -> Option<&str> {
        self.names[id.index()].as_deref()
    }

    pub(super) fn is_named(&self, id: NodeId) -> bool {
        self.names[id.index()].is_some()
    }

    /// The expression of a node.
    pub(super) fn print(&self, id: NodeId) -> TokenStream {
        self.at(id, Level::Sum)
    }

    /// The expression of a node that a method is called on.
    pub(super) fn print_receiver(&self, id: NodeId) -> TokenStream {
        self.at(id, Level::Atom)
    }

    /// The expression of a node, in parentheses if its precedence is below the needed one.
    fn at(&self, id: NodeId, needed: Level) -> TokenStream {
        parenthesised(self.printed(id), needed)
    }

    fn printed(&self, id: NodeId) -> Printed {
        if let Some(name) = self.name_of(id) {
            return (ident(name).into_token_stream(), Level::Atom);
        }
        match self.expressions.graph.node(id) {
            Node::Constant(constant) => (constant_tokens(constant.value()), Level::Atom),
            // Every input has a name.
            Node::Input { input, element } => (
                quote!(compile_error!("input {} {}", #input, #element)),
                Level::Atom,
            ),
            Node::Unary(Unary::Negate, x) => self.negation(x),
            Node::Unary(Unary::Reciprocal, x) => {
                let one = self.one();
                let x = self.at(x, Level::Negation);
                (quote!(#one / #x), Level::Product)
            }
            Node::Unary(function, x) => {
                let receiver = self.at(x, Level::Atom);
                let method = ident(unary_method(function));
                (quote!(#receiver.#method()), Level::Atom)
            }
            Node::Binary(function, x, y) => self
                .fused(function, x, y)
                .unwrap_or_else(|| self.binary(function, x, y)),
            Node::Call(call) => {
                let function = ident(&self.externals[call.external()].name);
                let arguments = call.arguments().iter().map(|&id| self.print(id));
                (quote!(#function(#(#arguments),*)), Level::Atom)
            }
        }
    }

    /// A sum or difference of which one side is a product that has no name: `a.mul_add(b, c)`.
    fn fused(&self, function: Binary, x: NodeId, y: NodeId) -> Option<Printed> {
        if !self.fused || !matches!(function, Binary::Add | Binary::Sub) {
            return None;
        }
        let product = |id: NodeId| match self.expressions.graph.node(id) {
            Node::Binary(Binary::Mul, a, b) if !self.is_named(id) => Some((a, b)),
            _ => None,
        };
        let tokens = if let Some((a, b)) = product(y) {
            let (a, b, addend) = (self.at(a, Level::Atom), self.print(b), self.print(x));
            match function {
                Binary::Add => quote!(#a.mul_add(#b, #addend)),
                _ => quote!((-#a).mul_add(#b, #addend)),
            }
        } else {
            let (a, b) = product(x)?;
            let (a, b) = (self.at(a, Level::Atom), self.print(b));
            match function {
                Binary::Add => {
                    let addend = self.print(y);
                    quote!(#a.mul_add(#b, #addend))
                }
                _ => {
                    let addend = self.at(y, Level::Negation);
                    quote!(#a.mul_add(#b, -#addend))
                }
            }
        };
        Some((tokens, Level::Atom))
    }

    fn negation(&self, x: NodeId) -> Printed {
        if self.name_of(x).is_none()
            && !self.fused
            && let Node::Binary(Binary::Add, left, right) = self.expressions.graph.node(x)
        {
            // -(a + b) is -a - b, to the bit.
            let (first, level) = self.printed(left);
            if level >= Level::Product {
                let second = self.at(right, Level::Product);
                return (quote!(-#first - #second), Level::Sum);
            }
        }
        // -(a b) is -a b, to the bit.
        let (tokens, level) = self.printed(x);
        match level {
            Level::Product => (quote!(-#tokens), Level::Product),
            _ => {
                let tokens = parenthesised((tokens, level), Level::Atom);
                (quote!(-#tokens), Level::Negation)
            }
        }
    }

    fn binary(&self, function: Binary, x: NodeId, y: NodeId) -> Printed {
        let (level, right_level) = match function {
            Binary::Add | Binary::Sub => (Level::Sum, Level::Product),
            Binary::Mul | Binary::Div => (Level::Product, Level::Negation),
            _ => {
                let receiver = self.at(x, Level::Atom);
                let argument = self.print(y);
                let method = ident(binary_method(function));
                return (quote!(#receiver.#method(#argument)), Level::Atom);
            }
        };
        let (mut left, mut right) = (self.printed(x), self.printed(y));
        // a + (b + c) is b + c + a, to the bit; with the negative first, b - a.
        if function.is_commutative() && right.1 <= level && left.1 > level {
            std::mem::swap(&mut left, &mut right);
        }
        let (left, right) = (
            parenthesised(left, level),
            parenthesised(right, right_level),
        );
        let tokens = match function {
            Binary::Add => quote!(#left + #right),
            Binary::Sub => quote!(#left - #right),
            Binary::Mul => quote!(#left * #right),
            _ => quote!(#left / #right),
        };
        (tokens, level)
    }

    /// The number one, by the name that it may have.
    fn one(&self) -> TokenStream {
        match self.one.and_then(|id| self.name_of(id)) {
            Some(name) => ident(name).into_token_stream(),
            None => constant_tokens(1.0),
        }
    }
}

/// `T::from_f64(4.84813681109536e-6)`: the shortest digits that give the number back.
fn constant_tokens(value: f64) -> TokenStream {
    // The literal of a finite number always parses.
    let digits = format!("{:e}", value.abs()).parse::<Literal>().ok();
    let sign = (value < 0.0).then(|| quote!(-));
    quote!(T::from_f64(#sign #digits))
}

fn parenthesised((tokens, level): Printed, needed: Level) -> TokenStream {
    if level < needed {
        quote!((#tokens))
    } else {
        tokens
    }
}

pub(super) fn unary_method(function: Unary) -> &'static str {
    match function {
        Unary::Negate => "neg",
        Unary::Reciprocal => "recip",
        Unary::Sqrt => "sqrt",
        Unary::Exp => "exp",
        Unary::Log => "ln",
        Unary::Sin => "sin",
        Unary::Cos => "cos",
        Unary::Tan => "tan",
        Unary::Asin => "asin",
        Unary::Acos => "acos",
        Unary::Atan => "atan",
        Unary::Sinh => "sinh",
        Unary::Cosh => "cosh",
        Unary::Tanh => "tanh",
        Unary::Asinh => "asinh",
        Unary::Acosh => "acosh",
        Unary::Atanh => "atanh",
        Unary::Expm1 => "exp_m1",
        Unary::Log1p => "ln_1p",
        Unary::Erf => "erf",
        Unary::ErfInv => "erf_inv",
        Unary::Floor => "floor",
        Unary::Ceil => "ceil",
        Unary::Abs => "abs",
        Unary::Sign => "sign",
    }
}

pub(super) fn binary_method(function: Binary) -> &'static str {
    match function {
        Binary::Add => "add",
        Binary::Sub => "sub",
        Binary::Mul => "mul",
        Binary::Div => "div",
        Binary::Power => "powf",
        Binary::Atan2 => "atan2",
        Binary::Fmod => "fmod",
        Binary::Remainder => "remainder",
        Binary::Hypot => "hypot",
        Binary::CopySign => "copysign",
        Binary::Min => "min",
        Binary::Max => "max",
        Binary::Less => "less",
        Binary::LessOrEqual => "less_or_equal",
        Binary::Equal => "equal",
        Binary::IfElseZero => "if_else_zero",
    }
}
