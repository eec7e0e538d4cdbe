//! The tables `[[hidden]]` of a scenario file.

use std::fmt::Write as _;
use std::ops::Range;

use gyrocal_record::{Error as FileError, InputErrorKind, SourceText};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use crate::error::Error;
use crate::hidden::Hidden;

/// The key of the array of tables.
pub(crate) const HIDDEN: &str = "hidden";

/// A table with the key of the effect's id and one key for each parameter.
const EFFECT: &str = "effect";

/// A hidden effect and where in the file its id stands.
#[derive(Debug)]
pub(crate) struct Located {
    pub(crate) hidden: Hidden,
    pub(crate) span: Range<usize>,
}

/// Reads the hidden effects of a scenario file, which is known to be TOML.
///
/// # Errors
///
/// [`FileError::Input`] for a fault in them.
pub(crate) fn read_hidden(source: &SourceText) -> Result<Vec<Located>, FileError> {
    const EXPECTED: &str = "tables `[[hidden]]`, one for each effect";
    let Ok(root) = DeTable::parse(source.text()) else {
        return Ok(Vec::new());
    };
    let mut keys = root.get_ref().iter();
    let Some((_, value)) = keys.find(|(key, _)| key.get_ref() == HIDDEN) else {
        return Ok(Vec::new());
    };
    let Some(items) = value.get_ref().as_array() else {
        return Err(wrong_type(source, value.span(), EXPECTED));
    };
    let read = |item: &Spanned<DeValue<'_>>| match item.get_ref().as_table() {
        Some(table) => read_one(source, table, item.span()),
        None => Err(wrong_type(source, item.span(), EXPECTED)),
    };
    items.iter().map(read).collect()
}

/// The table of an effect; all parameters are written.
pub(crate) fn to_toml(hidden: &Hidden) -> String {
    let mut text = format!("\n[[{HIDDEN}]]\n{EFFECT} = \"{}\"\n", hidden.id());
    for (name, value, _) in hidden.parameters() {
        let _ = writeln!(text, "{name} = {value:?}");
    }
    text
}

fn read_one(
    source: &SourceText,
    table: &DeTable<'_>,
    span: Range<usize>,
) -> Result<Located, FileError> {
    let effect = table.iter().find(|(key, _)| key.get_ref() == EFFECT);
    let Some((_, effect)) = effect else {
        return Err(source.error(
            InputErrorKind::MissingKey,
            span,
            "`[[hidden]]` without it",
            "`effect = ` the id of an effect",
            "add the line, say `effect = \"gyro_y.g_z\"`",
        ));
    };
    let Some(id) = effect.get_ref().as_str() else {
        let expected = "the id of an effect in quotes";
        return Err(wrong_type(source, effect.span(), expected));
    };
    let mut parameters: Vec<(&str, f64)> = Vec::new();
    let others = table.iter().filter(|(key, _)| key.get_ref() != EFFECT);
    for (key, value) in others {
        let number = number(value.get_ref())
            .ok_or_else(|| not_a_number(source, value.span(), "a finite number"))?;
        parameters.push((key.get_ref().as_ref(), number));
    }
    let hidden = Hidden::new(id, &parameters).map_err(|error| {
        let place = |parameter: &str| {
            let found = table.iter().find(|(key, _)| key.get_ref() == parameter);
            found.map_or((effect.span(), effect.span()), |(key, value)| {
                (key.span(), value.span())
            })
        };
        located(source, error, &effect.span(), place)
    })?;
    Ok(Located {
        hidden,
        span: effect.span(),
    })
}

/// The error with its place: that of the id, or of the key or value of a parameter.
fn located(
    source: &SourceText,
    error: Error,
    id: &Range<usize>,
    place: impl Fn(&str) -> (Range<usize>, Range<usize>),
) -> FileError {
    let there =
        |span: &Range<usize>| format!("`{}`", source.text().get(span.clone()).unwrap_or_default());
    match error {
        Error::UnknownEffect { advice, .. } => source.error(
            InputErrorKind::OutOfRange,
            id.clone(),
            format!("the unknown effect {}", there(id)),
            "the id of an effect",
            advice,
        ),
        Error::UnknownParameter {
            effect,
            parameter,
            expected,
        } => source.error(
            InputErrorKind::UnknownKey,
            place(&parameter).0,
            format!("the unknown key `{parameter}`"),
            format!("{expected}, the parameters of {effect}"),
            "remove it, or see the effects in the documentation",
        ),
        Error::MissingParameter {
            effect,
            parameter,
            expected,
        } => source.error(
            InputErrorKind::MissingKey,
            id.clone(),
            format!("{effect} without it"),
            format!("`{parameter} = ` {expected}"),
            "add the line",
        ),
        Error::InvalidParameter {
            parameter,
            expected,
            ..
        } => {
            let span = place(parameter).1;
            let found = there(&span);
            source.error(InputErrorKind::OutOfRange, span, found, expected, "")
        }
        other @ (Error::InvalidScenario { .. } | Error::Stopped) => source.error(
            InputErrorKind::OutOfRange,
            id.clone(),
            there(id),
            other.to_string(),
            "",
        ),
    }
}

fn number(value: &DeValue<'_>) -> Option<f64> {
    match value {
        DeValue::Float(float) => float.as_str().parse().ok(),
        DeValue::Integer(integer) => {
            let read = i64::from_str_radix(integer.as_str(), integer.radix());
            read.ok().map(|integer| integer as f64)
        }
        _ => None,
    }
}

fn wrong_type(source: &SourceText, span: Range<usize>, expected: &str) -> FileError {
    not_of(source, InputErrorKind::WrongType, span, expected)
}

fn not_a_number(source: &SourceText, span: Range<usize>, expected: &str) -> FileError {
    not_of(source, InputErrorKind::NotANumber, span, expected)
}

fn not_of(
    source: &SourceText,
    kind: InputErrorKind,
    span: Range<usize>,
    expected: &str,
) -> FileError {
    let there = source.text().get(span.clone()).unwrap_or_default();
    let found = format!("`{}`", there.lines().next().unwrap_or_default());
    source.error(kind, span, found, expected, "")
}
