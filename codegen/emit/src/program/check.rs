//! From the JSON form to the checked one: names, groups, functions, shapes.

use std::collections::BTreeSet;

use super::context::{Context, DERIVE_AGAIN};
use super::instructions::Instructions;
use super::schema::{RawFunction, RawGroup, RawOutput, RawProgram};
use super::{
    Element, External, Function, Group, LARGEST_OUTPUT, MOST_INSTRUCTIONS, Output, Program,
    external, model, table,
};
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
    let externals = raw.externals.iter().map(|raw| raw.name.as_str());
    context.names("external functions", externals)?;
    let externals = raw
        .externals
        .into_iter()
        .map(|raw| external::external(&context, raw))
        .collect::<Result<Vec<_>, _>>()?;
    let functions = raw
        .functions
        .into_iter()
        .map(|raw| function(&context, raw, &groups, &externals))
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
        externals,
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

fn function(
    context: &Context<'_>,
    raw: RawFunction,
    groups: &[Group],
    externals: &[External],
) -> Result<Function, Error> {
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
    if raw.work_size > MOST_INSTRUCTIONS {
        return Err(context.error(
            &place,
            format!("a work vector of {} scalars", raw.work_size),
            format!("at most {MOST_INSTRUCTIONS}, one for each instruction that there can be"),
            DERIVE_AGAIN,
        ));
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
        externals,
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
    if raw
        .rows
        .checked_mul(raw.columns)
        .is_none_or(|all| all > LARGEST_OUTPUT)
    {
        return Err(context.error(
            &place,
            format!("{} rows and {} columns", raw.rows, raw.columns),
            format!("at most {LARGEST_OUTPUT} elements"),
            "split the output; if the derivation did not write it, derive the program again",
        ));
    }
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
