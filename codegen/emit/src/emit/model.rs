//! The model: its type, inputs, state and the implementation of `Model`.

mod complete;
mod form;
mod methods;

use proc_macro2::TokenStream;
use quote::quote;

use super::doc::{self, Doc};
use super::items::{Items, Namespace, ident, integer};
use super::{group, noise};
use crate::ir::Expressions;
use crate::program::{Element, Function, Group, Model, ModelFunction, Output};
use crate::{Error, Program};
use methods::Methods;

/// Data of the items of a model.
struct Parts<'a> {
    program: &'a Program,
    model: &'a Model,
    lowered: &'a [Expressions],
}

impl<'a> Parts<'a> {
    fn function(&self, index: usize) -> &'a Function {
        &self.program.functions[index]
    }

    fn moving(&self) -> &'a Group {
        &self.program.groups[self.model.moving]
    }

    fn parameters(&self) -> &'a [Element] {
        self.model
            .parameters
            .map_or(&[], |index| &self.program.groups[index].elements)
    }

    fn parameters_name(&self) -> Option<&'a str> {
        self.model
            .parameters
            .map(|index| self.program.groups[index].name.as_str())
    }

    fn inputs(&self) -> impl Iterator<Item = &'a Group> {
        self.model
            .inputs
            .iter()
            .map(|&index| &self.program.groups[index])
    }

    /// The Jacobian with respect to a group, with its index among the outputs.
    fn jacobian(&self, function: ModelFunction, group: &str) -> Option<(usize, &'a Output)> {
        let outputs = &self.function(function.jacobian).outputs;
        let name = format!("{}_d_{group}", outputs[0].name);
        outputs
            .iter()
            .enumerate()
            .find(|(_, output)| output.name == name)
    }

    /// Number of leading parameters up to the last one that enters the output.
    fn output_parameters(&self) -> usize {
        let entering = complete::elements_of(self, self.model.output.value, self.model.parameters);
        let derivatives = self
            .parameters_name()
            .and_then(|name| self.jacobian(self.model.output, name))
            .map(|(_, output)| output.nonzeros.iter().map(|&(_, column)| column))
            .into_iter()
            .flatten();
        entering
            .into_iter()
            .chain(derivatives)
            .max()
            .map_or(0, |last| last + 1)
    }

    fn noise_parameters(&self) -> Option<Vec<usize>> {
        let rates = self.model.rates;
        let noise = self.jacobian(rates, self.model.noise.as_deref()?)?;
        let parameters = self.jacobian(rates, self.parameters_name()?)?;
        let found = noise::parameters(&self.lowered[rates.jacobian], parameters, noise)?;
        (found.len() == self.moving().elements.len()).then_some(found)
    }
}

pub(super) fn emit(
    program: &Program,
    model: &Model,
    lowered: &[Expressions],
    items: &mut Items<'_>,
) -> Result<Vec<TokenStream>, Error> {
    let parts = Parts {
        program,
        model,
        lowered,
    };
    complete::check(&parts)?;
    let mut result = vec![model_type(&parts, items)?, constants(&parts)];
    result.extend(inputs(&parts, items)?);
    result.extend(state(&parts, items)?);
    result.push(Methods::new(&parts).implementation());
    if model.flat {
        result.push(flat(&parts));
    }
    Ok(result)
}

fn model_type(parts: &Parts<'_>, items: &mut Items<'_>) -> Result<TokenStream, Error> {
    let place = format!("model `{}`", parts.model.name);
    let name = items.claim(Namespace::Type, &parts.model.name, &place)?;
    items.claim(Namespace::Value, &parts.model.name, &place)?;
    let doc = Doc::of(&doc::sentence(&parts.model.doc)).tokens();
    Ok(quote! {
        #doc
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        pub struct #name;
    })
}

fn constants(parts: &Parts<'_>) -> TokenStream {
    let name = ident(&parts.model.name);
    let moving = parts.moving().elements.len();
    let parameters = parts.parameters().len();
    let outputs = parts.function(parts.model.output.value).outputs[0].rows;
    let [moving, parameters, states, outputs] =
        [moving, parameters, moving + parameters, outputs].map(integer);
    quote! {
        impl #name {
            /// Number of moving states.
            pub const MOVING: usize = #moving;
            /// Number of constant parameters.
            pub const PARAMETERS: usize = #parameters;
            /// Number of states: moving ones, then parameters.
            pub const STATES: usize = #states;
            /// Number of outputs.
            pub const OUTPUTS: usize = #outputs;
        }
    }
}

/// Corrections are added to the states: the defaults of the trait.
fn flat(parts: &Parts<'_>) -> TokenStream {
    let name = ident(&parts.model.name);
    let moving = parts.moving().elements.len();
    let outputs = parts.function(parts.model.output.value).outputs[0].rows;
    let [moving, outputs] = [moving, outputs].map(integer);
    quote!(impl<T: Scalar> Recentre<T, #moving, #outputs> for #name {})
}

fn inputs(parts: &Parts<'_>, items: &mut Items<'_>) -> Result<Vec<TokenStream>, Error> {
    if parts.model.inputs.is_empty() {
        return Ok(Vec::new());
    }
    let place = format!("model `{}`, inputs", parts.model.name);
    let name = items.claim(
        Namespace::Type,
        &format!("{}Inputs", parts.model.name),
        &place,
    )?;
    let doc = Doc::of(&format!(
        "Inputs of [`{}`] besides its state, held over a step.",
        parts.model.name
    ))
    .tokens();
    let fields = parts.inputs().map(|group| {
        let mut meaning = doc::sentence(&group.doc);
        if meaning.ends_with('.') {
            meaning.pop();
        }
        let doc = Doc::of(&format!("{meaning} \\[{}\\].", doc::units(group))).tokens();
        let (field, length) = (ident(&group.name), integer(group.elements.len()));
        quote!(#doc pub #field: [T; #length],)
    });
    let names: Vec<_> = parts.inputs().map(|group| ident(&group.name)).collect();
    let texts = parts.inputs().map(|group| &group.name);
    Ok(vec![
        quote! {
            #doc
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct #name<T> {
                #(#fields)*
            }
        },
        quote! {
            impl<T: Copy> NamedInputs<T> for #name<T> {
                #[inline(always)]
                fn filled(value: T) -> Self {
                    Self { #(#names: [value; _]),* }
                }

                #[inline(always)]
                fn group_mut(&mut self, name: &str) -> Option<&mut [T]> {
                    match name {
                        #(#texts => Some(&mut self.#names),)*
                        _ => None,
                    }
                }
            }
        },
    ])
}

fn state(parts: &Parts<'_>, items: &mut Items<'_>) -> Result<Vec<TokenStream>, Error> {
    let place = format!("model `{}`, state", parts.model.name);
    let elements: Vec<&Element> = parts
        .moving()
        .elements
        .iter()
        .chain(parts.parameters())
        .collect();
    for (index, element) in elements.iter().enumerate() {
        if elements[..index]
            .iter()
            .any(|other| other.name == element.name)
        {
            return Err(Error::Name {
                origin: parts.program.origin.clone(),
                place,
                name: element.name.clone(),
                expected: "names that differ between moving states and parameters".to_owned(),
            });
        }
    }
    let name = items.claim(
        Namespace::Type,
        &format!("{}State", parts.model.name),
        &place,
    )?;
    let index = items.claim(
        Namespace::Type,
        &format!("{}_index", snake_case(&parts.model.name)),
        &place,
    )?;
    let doc = Doc::of(&format!(
        "The state of [`{}`]: moving states, then parameters.",
        parts.model.name
    ));
    let mut result = group::structure_items(&name, &doc, &elements);
    result.push(group::index_module(
        &index,
        &elements,
        &format!("[`{name}`]"),
    ));
    Ok(result)
}

/// `TwoTanks` to `two_tanks`.
fn snake_case(pascal: &str) -> String {
    let mut result = String::new();
    for letter in pascal.chars() {
        if letter.is_ascii_uppercase() && !result.is_empty() {
            result.push('_');
        }
        result.push(letter.to_ascii_lowercase());
    }
    result
}
