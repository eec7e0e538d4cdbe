//! Templates, and the pieces of an answer in words that they show.

use gyrocal_document::Words;
use gyrocal_record::printable;
use minijinja::{AutoEscape, Environment, context};
use serde_json::{Value, json};

use crate::error::Error;

/// The templates, all HTML: minijinja escapes by the name.
const TEMPLATES: [(&str, &str); 4] = [
    ("page.html", include_str!("../../assets/page.html")),
    ("summary.html", include_str!("../../assets/summary.html")),
    ("command.html", include_str!("../../assets/command.html")),
    ("items.html", include_str!("../../assets/items.html")),
];

/// An answer in words as HTML without a style, to be shown inside another page.
///
/// # Errors
/// [`Error::Template`].
pub fn words_to_html(pieces: &[Words]) -> Result<String, Error> {
    let environment = environment()?;
    let items = environment.get_template("items.html").map_err(template)?;
    let shown = pieces.iter().map(|piece| {
        let mut item = of_words(piece);
        make_printable(&mut item);
        items.render(context! { item => item }).map_err(template)
    });
    shown.collect()
}

/// What pages are made from.
pub(super) fn environment() -> Result<Environment<'static>, Error> {
    let mut environment = Environment::new();
    environment.set_auto_escape_callback(|_| AutoEscape::Html);
    for (name, text) in TEMPLATES {
        environment.add_template(name, text).map_err(template)?;
    }
    Ok(environment)
}

pub(super) fn template(reason: minijinja::Error) -> Error {
    Error::Template {
        reason: format!("{reason:#}"),
    }
}

/// A piece for the template of items.
pub(super) fn of_words(words: &Words) -> Value {
    match words {
        Words::Paragraph(text) => json!({ "kind": "text", "text": text }),
        Words::Command(text) => json!({ "kind": "command", "text": text }),
        Words::List(list) => json!({ "kind": "list", "list": list }),
        Words::Table(table) => json!({ "kind": "table", "table": table }),
    }
}

/// Escapes what a reader would not see in all texts of a value: HTML would drop it or obey it.
pub(super) fn make_printable(value: &mut Value) {
    match value {
        Value::String(text) => *text = printable(text).into_owned(),
        Value::Array(values) => values.iter_mut().for_each(make_printable),
        Value::Object(fields) => fields.values_mut().for_each(make_printable),
        _ => (),
    }
}
