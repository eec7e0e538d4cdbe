//! From the JSON form to the checked one: names, groups, functions, shapes.

use std::collections::BTreeSet;

use super::context::{Context, DERIVE_AGAIN};
use super::operation::Instructions;
use super::schema::{RawFunction, RawGroup, RawOutput, RawProgram};
use super::{Element, Function, Group, Output, Program, model, table};
use crate::Error;

pub(super) fn program(raw: RawProgram, origin: &str) -> Result<Program, Error> {
    let context = Context { origin };
    context.names("program", [raw.name.as_str()].into_iter())?;
    context.names("groups", raw.groups.iter().map(|group| group.name.as_str()))?;
    context.names(
        "functions",
        raw.functions.iter().map(|function| function.name.as_str()),
    )?;
    let groups = raw
        .groups
        .into_iter()
        .map(|raw| group(&context, raw))
        .collect::<Result<Vec<_>, _>>()?;
    let functions = raw
        .functions
        .into_iter()
        .map(|raw| function(&context, raw, &groups))
        .collect::<Result<Vec<_>, _>>()?;
    let model = raw
        .model
        .map(|raw| model::check(&context, raw, &groups, &functions))
        .transpose()?;
    context.names("tables", raw.tables.iter().map(|table| table.name.as_str()))?;
    let tables = raw
        .tables
        .into_iter()
        .map(|raw| table::table(&context, raw))
        .collect::<Result<_, _>>()?;
    Ok(Program {
        origin: origin.to_owned(),
        name: raw.name,
        doc: raw.doc,
        casadi_version: raw.casadi_version,
        groups,
        functions,
        model,
        tables,
    })
}

fn group(context: &Context<'_>, raw: RawGroup) -> Result<Group, Error> {
    let place = format!("group `{}`", raw.name);
    if raw.elements.is_empty() {
        return Err(context.error(
            &place,
            "no elements",
            "one at least",
            "declare elements, or leave the group out",
        ));
    }
    context.names(
        &place,
        raw.elements.iter().map(|element| element.name.as_str()),
    )?;
    let elements = raw
        .elements
        .into_iter()
        .map(|raw| Element {
            id: if raw.id.is_empty() {
                raw.name.clone()
            } else {
                raw.id
            },
            name: raw.name,
            unit: raw.unit,
            doc: raw.doc,
        })
        .collect();
    Ok(Group {
        name: raw.name,
        doc: raw.doc,
        elements,
    })
}

fn function(context: &Context<'_>, raw: RawFunction, groups: &[Group]) -> Result<Function, Error> {
    let place = format!("function `{}`", raw.name);
    context.names(
        &format!("{place}, inputs"),
        raw.inputs.iter().map(|input| input.group.as_str()),
    )?;
    context.names(
        &format!("{place}, outputs"),
        raw.outputs.iter().map(|output| output.name.as_str()),
    )?;
    let mut inputs = Vec::new();
    for input in &raw.inputs {
        let index = groups.iter().position(|group| group.name == input.group);
        inputs.push(index.ok_or_else(|| {
            context.error(
                &format!("{place}, inputs"),
                format!("the group `{}`", input.group),
                "a group of the program",
                DERIVE_AGAIN,
            )
        })?);
    }
    if raw.outputs.is_empty() {
        return Err(context.error(&place, "no outputs", "one at least", "give it an output"));
    }
    let outputs = raw
        .outputs
        .into_iter()
        .map(|raw| output(context, &place, raw))
        .collect::<Result<Vec<_>, _>>()?;
    let lengths: Vec<usize> = inputs
        .iter()
        .map(|&index| groups[index].elements.len())
        .collect();
    let instructions = Instructions {
        context,
        place: &place,
        input_lengths: &lengths,
        outputs: &outputs,
        work_size: raw.work_size,
    }
    .check(&raw.instructions)?;
    Ok(Function {
        name: raw.name,
        doc: raw.doc,
        source: raw.source,
        domain: raw.domain,
        inputs,
        outputs,
        work_size: raw.work_size,
        instructions,
    })
}

fn output(context: &Context<'_>, place: &str, raw: RawOutput) -> Result<Output, Error> {
    let place = format!("{place}, output `{}`", raw.name);
    for (kind, names, count) in [
        ("row", &raw.row_names, raw.rows),
        ("column", &raw.column_names, raw.columns),
    ] {
        context.names(
            &format!("{place}, {kind} names"),
            names.iter().map(String::as_str),
        )?;
        if !names.is_empty() && names.len() != count {
            return Err(context.error(
                &place,
                format!("{} {kind} names", names.len()),
                format!("{count}, one for each {kind}, or none"),
                "name every one or none",
            ));
        }
    }
    let mut seen = BTreeSet::new();
    for &(row, column) in &raw.nonzeros {
        if row >= raw.rows || column >= raw.columns {
            return Err(context.error(
                &place,
                format!("a nonzero at row {row}, column {column}"),
                format!(
                    "places inside {} rows and {} columns",
                    raw.rows, raw.columns
                ),
                DERIVE_AGAIN,
            ));
        }
        if !seen.insert((row, column)) {
            return Err(context.error(
                &place,
                format!("two nonzeros at row {row}, column {column}"),
                "each place once",
                DERIVE_AGAIN,
            ));
        }
    }
    Ok(Output {
        name: raw.name,
        doc: raw.doc,
        unit: raw.unit,
        rows: raw.rows,
        columns: raw.columns,
        row_names: raw.row_names,
        column_names: raw.column_names,
        nonzeros: raw.nonzeros,
    })
}
