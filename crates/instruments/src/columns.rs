//! Some columns of a CSV file, by name.

use gyrocal_record::{Error, InputErrorKind, SourceText};

/// Reads the columns `names`, in that order, from text with a header row. Values are finite.
///
/// # Errors
///
/// [`Error::Input`], at its place, for a column that is absent or double, a row with more or
/// fewer fields than the header, a field that is no finite number, or a file without rows.
pub fn read_columns(source: &SourceText, names: &[&str]) -> Result<Vec<Vec<f64>>, Error> {
    let mut lines = lines(source.text());
    let header = lines.next().unwrap_or_default();
    let places = names
        .iter()
        .map(|name| place(source, &header, name))
        .collect::<Result<Vec<usize>, Error>>()?;
    let mut columns = vec![Vec::new(); names.len()];
    let mut end = header.start;
    for line in lines {
        if line.fields.len() != header.fields.len() {
            return Err(source.error(
                InputErrorKind::FieldCount,
                line.start..line.start + line.text.len(),
                format!("{} fields", line.fields.len()),
                format!("{} fields, as the header has", header.fields.len()),
                "decimal numbers have a point, and fields are separated by commas",
            ));
        }
        for (column, &place) in columns.iter_mut().zip(&places) {
            column.push(number(source, &line, place)?);
        }
        end = line.start;
    }
    if columns.iter().all(Vec::is_empty) {
        return Err(source.error(
            InputErrorKind::TooFewRows,
            end..end,
            "a header without rows",
            "samples",
            "check that the program that wrote the log had finished",
        ));
    }
    Ok(columns)
}

/// One line that has something in it.
#[derive(Debug, Default)]
struct Line<'a> {
    start: usize,
    text: &'a str,
    fields: Vec<&'a str>,
}

fn lines(text: &str) -> impl Iterator<Item = Line<'_>> {
    let mut next = 0;
    text.split_inclusive('\n')
        .map(move |whole| {
            let start = next;
            next += whole.len();
            let text = whole.trim_end();
            let fields = text.split(',').collect();
            Line {
                start,
                text,
                fields,
            }
        })
        .filter(|line| !line.text.trim().is_empty())
}

fn bare(field: &str) -> &str {
    field.trim().trim_matches('"')
}

fn place(source: &SourceText, header: &Line<'_>, name: &str) -> Result<usize, Error> {
    let names: Vec<&str> = header.fields.iter().map(|field| bare(field)).collect();
    let mut places = (0..names.len()).filter(|place| names[*place] == name);
    let advice = format!("the columns are {}", names.join(", "));
    let error = |found: String, expected: String| {
        let span = header.start..header.start + header.text.len();
        source.error(InputErrorKind::Header, span, found, expected, &*advice)
    };
    match (places.next(), places.next()) {
        (Some(place), None) => Ok(place),
        (None, _) => Err(error(
            "a header without it".to_owned(),
            format!("a column `{name}`"),
        )),
        (Some(_), Some(_)) => Err(error(
            format!("the column `{name}` twice"),
            "each column once".to_owned(),
        )),
    }
}

fn number(source: &SourceText, line: &Line<'_>, place: usize) -> Result<f64, Error> {
    let field = line.fields[place];
    let number = bare(field).parse::<f64>().ok();
    number.filter(|value| value.is_finite()).ok_or_else(|| {
        // A comma before each field but the first.
        let before: usize = line.fields[..place]
            .iter()
            .map(|field| field.len() + 1)
            .sum();
        let start = line.start + before;
        source.error(
            InputErrorKind::NotANumber,
            start..start + field.len(),
            format!("`{}`", field.trim()),
            "a finite number",
            "cut the log before the first sample that is missing",
        )
    })
}
