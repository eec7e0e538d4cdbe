//! Completeness of the derivatives: a missing one would count as structurally zero.

use super::Parts;
use crate::Error;
use crate::program::ModelFunction;

pub(super) fn check(parts: &Parts<'_>) -> Result<(), Error> {
    for (part, function) in [("rates", parts.model.rates), ("output", parts.model.output)] {
        for group in [Some(parts.model.moving), parts.model.parameters]
            .into_iter()
            .flatten()
        {
            check_group(parts, part, function, group)?;
        }
    }
    Ok(())
}

fn check_group(
    parts: &Parts<'_>,
    part: &str,
    function: ModelFunction,
    group: usize,
) -> Result<(), Error> {
    let group_name = &parts.program.groups[group].name;
    let value = parts.function(function.value);
    let is_used = !elements_of(parts, function.value, Some(group)).is_empty();
    if is_used && parts.jacobian(function, group_name).is_none() {
        let expected = format!("`{}_d_{group_name}`", value.outputs[0].name);
        return Err(Error::Program {
            origin: parts.program.origin.clone(),
            place: format!("model, {part}"),
            found: format!(
                "no {expected} in `{}`, although `{}` depends on `{group_name}`",
                parts.function(function.jacobian).name,
                value.name
            ),
            expected: format!("the output {expected}"),
            remedy: "add that Jacobian to the function".to_owned(),
        });
    }
    Ok(())
}

/// The elements of a group that the outputs of a function depend on.
pub(super) fn elements_of(parts: &Parts<'_>, function: usize, group: Option<usize>) -> Vec<usize> {
    let inputs = &parts.function(function).inputs;
    let Some(argument) = inputs.iter().position(|&input| Some(input) == group) else {
        return Vec::new();
    };
    parts.lowered[function]
        .inputs()
        .filter(|(input, _)| *input == argument)
        .map(|(_, element)| element)
        .collect()
}
