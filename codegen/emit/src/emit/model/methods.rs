//! The implementation of `Model`: calls of the functions, and the nonzeros of their
//! Jacobians put into the caller's buffers by constant indices.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::Parts;
use super::form::Form;
use crate::emit::items::{ident, integer};
use crate::emit::output::Layout;
use crate::program::Function;

pub(super) struct Methods<'a> {
    parts: &'a Parts<'a>,
    moving: usize,
    parameters: usize,
    outputs: usize,
}

/// The argument names of a method and what it does with them.
struct Arguments {
    moving: Ident,
    inputs: Ident,
    /// Checks the length of `parameters`, and makes an array of it where it is used.
    check: TokenStream,
    /// Calls the function with the groups it takes.
    call: TokenStream,
}

impl<'a> Methods<'a> {
    pub(super) fn new(parts: &'a Parts<'a>) -> Self {
        Self {
            parts,
            moving: parts.moving().elements.len(),
            parameters: parts.parameters().len(),
            outputs: parts.function(parts.model.output.value).outputs[0].rows,
        }
    }

    pub(super) fn implementation(&self) -> TokenStream {
        let name = ident(&self.parts.model.name);
        let [moving, outputs, parameters] =
            [self.moving, self.outputs, self.parameters].map(integer);
        let inputs_type = if self.parts.model.inputs.is_empty() {
            quote!(())
        } else {
            let inputs = format_ident!("{name}Inputs");
            quote!(#inputs<T>)
        };
        let output_parameters = self.parts.output_parameters();
        let noise_parameters = match self.parts.noise_parameters() {
            Some(indices) => {
                let indices = indices.into_iter().map(integer);
                quote!(Some([#(#indices),*]))
            }
            None => quote!(None),
        };
        let rates = self.rates();
        let (of_rates, of_output) = (self.parts.model.rates, self.parts.model.output);
        let rates_jacobian = self.rates_jacobian(&Form::full(self.parts, of_rates));
        let rates_at_origin =
            Form::at_origin(self.parts, of_rates).map(|form| self.rates_jacobian(&form));
        let nonzeros_at_origin = self.nonzeros_at_origin();
        let output = self.output();
        let output_jacobian =
            self.output_jacobian(&Form::full(self.parts, of_output), output_parameters);
        let output_at_origin = Form::at_origin(self.parts, of_output)
            .map(|form| self.output_jacobian(&form, output_parameters));
        let output_parameters = integer(output_parameters);
        quote! {
            impl<T: Scalar> Model<T, #moving, #outputs> for #name {
                type Inputs = #inputs_type;

                #[inline(always)]
                fn parameters(&self) -> usize {
                    #parameters
                }

                #[inline(always)]
                fn output_parameters(&self) -> usize {
                    #output_parameters
                }

                #[inline(always)]
                fn noise_parameters(&self) -> Option<[usize; #moving]> {
                    #noise_parameters
                }

                #rates
                #rates_jacobian
                #rates_at_origin
                #nonzeros_at_origin
                #output
                #output_jacobian
                #output_at_origin
            }
        }
    }

    fn rates(&self) -> TokenStream {
        let function = self.parts.function(self.parts.model.rates.value);
        self.value(&ident("rates"), function, self.moving)
    }

    fn output(&self) -> TokenStream {
        let function = self.parts.function(self.parts.model.output.value);
        self.value(&ident("output"), function, self.outputs)
    }

    fn value(&self, name: &Ident, function: &Function, rows: usize) -> TokenStream {
        let (count, rows) = (integer(self.moving), integer(rows));
        let Arguments {
            moving,
            inputs,
            check,
            call,
        } = self.arguments(function);
        quote! {
            #[inline]
            fn #name(
                &self,
                #moving: &[T; #count],
                parameters: &[T],
                #inputs: &Self::Inputs,
            ) -> [T; #rows] {
                #check
                #call
            }
        }
    }

    fn rates_jacobian(&self, form: &Form<'_>) -> TokenStream {
        let count = integer(self.moving);
        let Arguments {
            moving,
            inputs,
            check,
            call,
        } = self.arguments(form.given);
        let noise = self.parts.model.noise.as_deref();
        let moving_group = &self.parts.moving().name;
        let (d_moving, d_noise) = (quote!(jacobian.moving), quote!(jacobian.noise));
        let d_moving = self.matrix(form, moving_group, &d_moving, &d_moving);
        let d_noise = noise.map(|noise| self.matrix(form, noise, &d_noise, &d_noise));
        let (d_parameters_check, d_parameters) = self.parameters_jacobian(
            form,
            self.moving,
            self.parameters,
            &quote!(jacobian.parameters),
            &quote!(&mut *jacobian.parameters),
        );
        let (name, moving) = form.method("rates_jacobian", &quote!(#moving: &[T; #count],));
        let result = form.result(&call);
        let value = form.value();
        quote! {
            #[inline(always)]
            fn #name(
                &self,
                #moving
                parameters: &[T],
                #inputs: &Self::Inputs,
                jacobian: &mut RatesJacobian<'_, T, #count>,
            ) -> [T; #count] {
                #check
                #d_parameters_check
                #result
                #d_moving
                #d_noise
                #d_parameters
                #value
            }
        }
    }

    /// Structural nonzeros of the derivatives at the origin: of the rates by parameters and by
    /// moving states, and of the output by moving states. Empty for a function without a form at
    /// the origin.
    fn nonzeros_at_origin(&self) -> TokenStream {
        let (of_rates, of_output) = (self.parts.model.rates, self.parts.model.output);
        let moving = Some(self.parts.moving().name.as_str());
        [
            ("enters_at_origin", of_rates, self.parts.parameters_name()),
            ("moves_at_origin", of_rates, moving),
            ("shows_at_origin", of_output, moving),
        ]
        .into_iter()
        .filter_map(|(name, function, group)| {
            let form = Form::at_origin(self.parts, function)?;
            let jacobian = form.jacobian(group?)?.given;
            let rows = (0..jacobian.rows).map(|row| {
                let columns = 0..jacobian.columns;
                let entries = columns.map(|column| jacobian.nonzero_at(row, column).is_some());
                quote!([#(#entries),*])
            });
            let (name, [rows_count, columns]) =
                (ident(name), [jacobian.rows, jacobian.columns].map(integer));
            Some(quote! {
                #[inline(always)]
                fn #name(&self, i: usize, j: usize) -> bool {
                    const NONZERO: [[bool; #columns]; #rows_count] = [#(#rows),*];
                    NONZERO[i][j]
                }
            })
        })
        .collect()
    }

    fn output_jacobian(&self, form: &Form<'_>, output_parameters: usize) -> TokenStream {
        let (count, outputs) = (integer(self.moving), integer(self.outputs));
        let Arguments {
            moving,
            inputs,
            check,
            call,
        } = self.arguments(form.given);
        let moving_group = &self.parts.moving().name;
        let d_moving = self.matrix(form, moving_group, &quote!(d_moving), &quote!(*d_moving));
        let d_moving_name = ident(if d_moving.is_empty() {
            "_d_moving"
        } else {
            "d_moving"
        });
        let (d_parameters_check, d_parameters) = self.parameters_jacobian(
            form,
            self.outputs,
            output_parameters,
            &quote!(d_parameters),
            &quote!(d_parameters),
        );
        let (name, moving) = form.method("output_jacobian", &quote!(#moving: &[T; #count],));
        let result = form.result(&call);
        let value = form.value();
        quote! {
            #[inline]
            fn #name(
                &self,
                #moving
                parameters: &[T],
                #inputs: &Self::Inputs,
                #d_moving_name: &mut [[T; #count]; #outputs],
                d_parameters: &mut [T],
            ) -> [T; #outputs] {
                #check
                #d_parameters_check
                #result
                #d_moving
                #d_parameters
                #value
            }
        }
    }

    /// The arguments of a method, and the call of a function with those it takes.
    fn arguments(&self, function: &Function) -> Arguments {
        let model = self.parts.model;
        let takes = |group: usize| function.inputs.contains(&group);
        let takes_inputs = model.inputs.iter().any(|&input| takes(input));
        let group_name = |group: usize| ident(&self.parts.program.groups[group].name);
        let parameters = self.parameters;
        let message = format!("expected {parameters} parameters");
        let message_with_count = format!("expected {parameters} parameters, found {{}}");
        let parameters = integer(parameters);
        let check = if model.parameters.is_some_and(takes) {
            quote! {
                let Ok(parameters) = <&[T; #parameters]>::try_from(parameters) else {
                    panic!(#message_with_count, parameters.len())
                };
            }
        } else {
            quote!(assert_eq!(parameters.len(), #parameters, #message);)
        };
        let name = ident(&function.name);
        let arguments = function.inputs.iter().map(|&group| {
            if group == model.moving {
                quote!(moving)
            } else if Some(group) == model.parameters {
                quote!(parameters)
            } else {
                let field = group_name(group);
                quote!(&inputs.#field)
            }
        });
        // Nothing but the result would say which scalar a function without arguments is of.
        let scalar = function.inputs.is_empty().then(|| quote!(::<T>));
        let call = quote!(#name #scalar(#(#arguments),*));
        Arguments {
            moving: ident(if takes(model.moving) {
                "moving"
            } else {
                "_moving"
            }),
            inputs: ident(if takes_inputs { "inputs" } else { "_inputs" }),
            check,
            call,
        }
    }

    /// Assigns the Jacobian with respect to a group to a matrix; `whole` is its place when
    /// all of it is assigned.
    fn matrix(
        &self,
        form: &Form<'_>,
        group: &str,
        matrix: &TokenStream,
        whole: &TokenStream,
    ) -> TokenStream {
        let Some(jacobian) = form.jacobian(group) else {
            return TokenStream::new();
        };
        let given = jacobian.given;
        if Layout::of(given) == Layout::Matrix && given.columns == self.moving {
            let field = ident(&given.name);
            return quote!(#whole = result.#field;);
        }
        let entries = jacobian.entries().map(|(row, column, value)| {
            let (row, column) = (integer(row), integer(column));
            quote!(#matrix[#row][#column] = #value;)
        });
        quote!(#(#entries)*)
    }

    /// The check of the length of a row-major parameter Jacobian with some columns, and
    /// its assignments.
    fn parameters_jacobian(
        &self,
        form: &Form<'_>,
        rows: usize,
        columns: usize,
        slice: &TokenStream,
        reborrowed: &TokenStream,
    ) -> (TokenStream, TokenStream) {
        let length = integer(rows * columns);
        let message = format!("expected {length} derivatives by parameters");
        let message_with_count = format!("{message}, found {{found}}");
        let found = self
            .parts
            .parameters_name()
            .and_then(|name| form.jacobian(name));
        match found.filter(|jacobian| !jacobian.written.nonzeros.is_empty()) {
            None => (
                quote!(assert_eq!(#slice.len(), #length, #message);),
                TokenStream::new(),
            ),
            Some(jacobian) => {
                let assignments = jacobian.entries().map(|(row, column, value)| {
                    let place = integer(row * columns + column);
                    quote!(d_parameters[#place] = #value;)
                });
                let check = quote! {
                    let found = #slice.len();
                    let Ok(d_parameters) = <&mut [T; #length]>::try_from(#reborrowed) else {
                        panic!(#message_with_count)
                    };
                };
                (check, quote!(#(#assignments)*))
            }
        }
    }
}
