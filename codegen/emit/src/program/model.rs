//! The model section: existence of its parts, and their consistency.

use super::context::Context;
use super::names::is_pascal_case;
use super::schema::{RawModel, RawModelFunction};
use super::{Function, Group, Model, ModelFunction, Output};
use crate::Error;

pub(super) fn check(
    context: &Context<'_>,
    raw: RawModel,
    groups: &[Group],
    functions: &[Function],
) -> Result<Model, Error> {
    if !is_pascal_case(&raw.name) {
        return Err(context.name("model", &raw.name, "a Rust type name, such as `Pendulum`"));
    }
    let group = |part: &str, name: &str| {
        groups
            .iter()
            .position(|group| group.name == name)
            .ok_or_else(|| {
                context.error(
                    &format!("model, {part}"),
                    format!("the group `{name}`"),
                    "a group that a function takes",
                    "name one of the groups, or add it to the inputs of a function",
                )
            })
    };
    let moving = group("moving", &raw.moving)?;
    let parameters = raw
        .parameters
        .as_deref()
        .map(|name| group("parameters", name))
        .transpose()?;
    let inputs = raw
        .inputs
        .iter()
        .map(|name| group("inputs", name))
        .collect::<Result<Vec<_>, _>>()?;
    let checker = Checker {
        context,
        groups,
        functions,
        moving,
        parameters,
        inputs: &inputs,
    };
    checker.parts_differ(raw.noise.as_deref())?;
    let rates = checker.function("rates", &raw.rates)?;
    let output = checker.function("output", &raw.output)?;
    checker.value_has_rows("rates", rates, groups[moving].elements.len())?;
    checker.jacobians("rates", rates, raw.noise.as_deref(), true)?;
    checker.jacobians("output", output, raw.noise.as_deref(), false)?;
    checker.at_origin("model, rates, jacobian_at_origin", rates)?;
    checker.at_origin("model, output, jacobian_at_origin", output)?;
    Ok(Model {
        name: raw.name,
        doc: raw.doc,
        moving,
        parameters,
        noise: raw.noise,
        inputs,
        rates,
        output,
        flat: raw.flat,
    })
}

struct Checker<'a> {
    context: &'a Context<'a>,
    groups: &'a [Group],
    functions: &'a [Function],
    moving: usize,
    parameters: Option<usize>,
    inputs: &'a [usize],
}

impl Checker<'_> {
    fn parts_differ(&self, noise: Option<&str>) -> Result<(), Error> {
        let mut names: Vec<&str> = [Some(self.moving), self.parameters]
            .into_iter()
            .flatten()
            .chain(self.inputs.iter().copied())
            .map(|index| self.groups[index].name.as_str())
            .chain(noise)
            .collect();
        names.sort_unstable();
        match names.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(self.context.error(
                "model",
                format!("the group `{}` in two parts", pair[0]),
                "each group in one part",
                "split the group in the derivation",
            )),
            None => Ok(()),
        }
    }

    fn function(&self, part: &str, raw: &RawModelFunction) -> Result<ModelFunction, Error> {
        let find = |role: &str, name: &str| {
            let place = format!("model, {part}, {role}");
            let index = self
                .functions
                .iter()
                .position(|function| function.name == name)
                .ok_or_else(|| {
                    self.context.error(
                        &place,
                        format!("the function `{name}`"),
                        "a function of the program",
                        "name one of the functions",
                    )
                })?;
            let of = match role {
                "jacobian_at_origin" => "parameters and inputs",
                _ => "moving, parameters and inputs",
            };
            self.groups_fit(&place, &self.functions[index], of)?;
            Ok(index)
        };
        let function = ModelFunction {
            value: find("value", &raw.value)?,
            jacobian: find("jacobian", &raw.jacobian)?,
            jacobian_at_origin: raw
                .jacobian_at_origin
                .as_deref()
                .map(|name| find("jacobian_at_origin", name))
                .transpose()?,
        };
        let place = format!("model, {part}");
        let value = &self.functions[function.value];
        let output = &value.outputs[0];
        if value.outputs.len() != 1 || output.columns != 1 || !output.is_full() {
            return Err(self.context.error(
                &place,
                format!(
                    "the function `{}` with {}",
                    value.name,
                    shapes(&value.outputs)
                ),
                "one output, a column without structural zeros",
                "give the value a function of its own",
            ));
        }
        let first = &self.functions[function.jacobian].outputs[0];
        if (&first.name, first.rows, &first.nonzeros)
            != (&output.name, output.rows, &output.nonzeros)
        {
            return Err(self.context.error(
                &place,
                format!("the first output {} of `{}`", shape(first), raw.jacobian),
                format!("the value {}", shape(output)),
                "put the same value first, then its Jacobians",
            ));
        }
        Ok(function)
    }

    /// Checks that the form at the origin has the outputs of the full form and takes no moving
    /// states.
    fn at_origin(&self, place: &str, function: ModelFunction) -> Result<(), Error> {
        let Some(index) = function.jacobian_at_origin else {
            return Ok(());
        };
        let (full, origin) = (&self.functions[function.jacobian], &self.functions[index]);
        if origin.inputs.contains(&self.moving) {
            return Err(self.context.error(
                place,
                format!(
                    "the function `{}` of the group `{}`",
                    origin.name, self.groups[self.moving].name
                ),
                "functions of parameters and inputs alone",
                "put zeros in the place of the moving states, and take the group out of the function",
            ));
        }
        let names = |function: &Function| {
            let names = function.outputs.iter().map(|o| format!("`{}`", o.name));
            names.collect::<Vec<_>>().join(", ")
        };
        if names(origin) != names(full) {
            return Err(self.context.error(
                place,
                format!(
                    "the function `{}` with the outputs {}",
                    origin.name,
                    names(origin)
                ),
                format!("those of `{}`: {}", full.name, names(full)),
                "give both functions the same outputs in the same order",
            ));
        }
        for (output, of_full) in origin.outputs.iter().zip(&full.outputs) {
            if (output.rows, output.columns) != (of_full.rows, of_full.columns) {
                return Err(self.context.error(
                    place,
                    format!("the output {}", shape(output)),
                    format!("{} rows and {} columns", of_full.rows, of_full.columns),
                    "keep the rows and columns of the full form, zeros too",
                ));
            }
            let places = of_full.places();
            let extra = |place: &&(usize, usize)| !places.contains_key(*place);
            if let Some((row, column)) = output.nonzeros.iter().find(extra) {
                return Err(self.context.error(
                    &format!("{place}, output `{}`", output.name),
                    format!("a nonzero at row {row}, column {column}"),
                    format!("nonzeros only where `{}` has them", full.name),
                    "sparsify the output, or derive both functions from the same expressions",
                ));
            }
        }
        Ok(())
    }

    /// Checks that a function takes groups of the model only; `of` names them in the message. The
    /// group `moving` is not checked.
    fn groups_fit(&self, place: &str, function: &Function, of: &str) -> Result<(), Error> {
        for index in &function.inputs {
            if *index != self.moving
                && Some(*index) != self.parameters
                && !self.inputs.contains(index)
            {
                return Err(self.context.error(
                    place,
                    format!(
                        "the function `{}` of the group `{}`",
                        function.name, self.groups[*index].name
                    ),
                    format!("functions of {of} alone"),
                    "add the group to the inputs of the model, or take it out of the function",
                ));
            }
        }
        Ok(())
    }

    fn value_has_rows(
        &self,
        part: &str,
        function: ModelFunction,
        rows: usize,
    ) -> Result<(), Error> {
        let output = &self.functions[function.value].outputs[0];
        if output.rows == rows {
            return Ok(());
        }
        Err(self.context.error(
            &format!("model, {part}"),
            format!("the value {}", shape(output)),
            format!("{rows} rows, one for each moving state"),
            "return one rate for each moving state",
        ))
    }

    /// Shapes of the Jacobians that are there; a missing one is structurally zero.
    fn jacobians(
        &self,
        part: &str,
        function: ModelFunction,
        noise: Option<&str>,
        takes_noise: bool,
    ) -> Result<(), Error> {
        let outputs = &self.functions[function.jacobian].outputs;
        let value = &outputs[0];
        let moving = &self.groups[self.moving];
        for output in &outputs[1..] {
            let place = format!("model, {part}, output `{}`", output.name);
            let of = output
                .name
                .strip_prefix(&format!("{}_d_", value.name))
                .ok_or_else(|| {
                    self.context.error(
                        &place,
                        "its name",
                        format!("`{}_d_GROUP`", value.name),
                        "leave other outputs to functions of their own",
                    )
                })?;
            let count = self
                .groups
                .iter()
                .find(|group| group.name == of)
                .map(|g| g.elements.len());
            let is_state = of == moving.name
                || self
                    .parameters
                    .is_some_and(|index| self.groups[index].name == of);
            let is_noise = noise == Some(of);
            if !(is_state || is_noise && takes_noise) {
                return Err(self.context.error(
                    &place,
                    format!("a Jacobian with respect to `{of}`"),
                    if takes_noise {
                        "one with respect to moving, parameters or noise"
                    } else {
                        "one with respect to moving or parameters; an output has no noise inputs"
                    },
                    "take it out of the function",
                ));
            }
            if is_noise && output.columns > moving.elements.len() {
                return Err(self.context.error(
                    &place,
                    format!("{} noise inputs", output.columns),
                    format!(
                        "no more than the {} moving states, so that their Jacobian fits the matrix \
                         that a filter keeps",
                        moving.elements.len()
                    ),
                    "combine noise inputs, or add moving states",
                ));
            }
            if output.rows != value.rows || count.is_some_and(|count| output.columns != count) {
                return Err(self.context.error(
                    &place,
                    format!("{} rows and {} columns", output.rows, output.columns),
                    format!(
                        "{} rows and {} columns",
                        value.rows,
                        count.unwrap_or(output.columns)
                    ),
                    "differentiate the whole value with respect to the whole group",
                ));
            }
        }
        Ok(())
    }
}

fn shape(output: &Output) -> String {
    format!(
        "`{}` ({} rows, {} columns, {} nonzeros)",
        output.name,
        output.rows,
        output.columns,
        output.nonzeros.len()
    )
}

fn shapes(outputs: &[Output]) -> String {
    let shapes: Vec<String> = outputs.iter().map(shape).collect();
    format!("the outputs {}", shapes.join(", "))
}
