//! A whole map for a file, from the names and the values in it.

mod layout;
mod numbers;
mod sensors;
mod time;

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use gyrocal_record::{SourceText, is_encoding, read_content};
use toml::Value;

use self::layout::Table;
use self::time::Stamps;
use crate::error::{InstrumentError, Unfit};
use crate::file_format::{Decimal, Delimiter, FileFormat};
use crate::log_lines::log_lines;
use crate::remedy::word_of;

/// Words for missing values that a map lists at most.
const MOST_WORDS: usize = 20;

/// The text of a map (TOML) by which a file is read as the record of a stable platform.
///
/// Separator, decimal mark and encoding are those in which most fields are numbers; the time is a column of dates or
/// one that rises; specific force has the names of accelerometers or a magnitude that hardly changes, which tells its
/// unit.
///
/// # Errors
///
/// [`InstrumentError::File`] if the file cannot be read; [`Unfit::NoAccelerometers`] if no three columns can be
/// specific force.
pub fn propose_map(path: &Path) -> Result<String, InstrumentError> {
    let bytes = read_content(path)?;
    let format = FileFormat {
        encoding: encoding(&bytes).map(str::to_owned),
        ..FileFormat::default()
    };
    let source = format.read(path)?;
    let none = |found: &str| {
        InstrumentError::unfit(
            Unfit::NoAccelerometers,
            found,
            "rows of a time and three accelerometers, whose magnitude is gravity",
            "write the map by hand: docs/formats.md has every key",
        )
    };
    let table =
        Table::of(&source, &format).ok_or_else(|| none("no lines with three numbers each"))?;
    let stamps = time::stamps(&table);
    let mut taken = stamps.columns();
    let force = sensors::force(&table, &taken)
        .ok_or_else(|| none("no three columns of numbers whose magnitude hardly changes"))?;
    taken.extend(force.columns);
    let warmth = sensors::warmth(&table, &taken);
    let mut values = force.columns.to_vec();
    values.extend(warmth.as_ref().map(|warmth| warmth.column));
    taken.extend(&values);
    let mut writer = Writer::new(&source, &table, &taken);
    writer.file(&source, &values);
    writer.time(&stamps);
    writer.force(&force);
    if let Some(warmth) = &warmth {
        let name = writer.name(warmth.column);
        let _ = write!(
            writer.text,
            "\n[temperature]\ncolumn = {name}\nunit = \"{}\"\n",
            warmth.unit
        );
    }
    if matches!(force.unit, "m/s2" | "ft/s2") {
        let in_m = if force.unit == "m/s2" { 1.0 } else { 0.3048 };
        let _ = write!(
            writer.text,
            "\n[site]\n# Mean magnitude of this file: replace it by local gravity.\ngravity_m_per_s2 = {:.5}\n",
            force.magnitude * in_m
        );
    }
    Ok(writer.text)
}

/// The encoding of some bytes by its label; `None` of UTF-8, and where a byte-order mark tells it.
fn encoding(bytes: &[u8]) -> Option<&'static str> {
    let start = &bytes[..bytes.len().min(4096)];
    let is_marked = start.starts_with(&[0xff, 0xfe]) || start.starts_with(&[0xfe, 0xff]);
    let zeros = |parity: usize| {
        start
            .iter()
            .skip(parity)
            .step_by(2)
            .filter(|byte| **byte == 0)
            .count()
    };
    let label = match (zeros(0), zeros(1)) {
        _ if is_marked => return None,
        (even, odd) if odd > start.len() / 4 && even < odd => "utf-16le",
        (even, odd) if even > start.len() / 4 && odd < even => "utf-16be",
        _ if core::str::from_utf8(bytes).is_ok() => return None,
        _ => "latin1",
    };
    is_encoding(label).then_some(label)
}

/// The text of a map.
struct Writer<'t, 'a> {
    table: &'t Table<'a>,
    format: FileFormat,
    by_name: bool,
    text: String,
}

impl<'t, 'a> Writer<'t, 'a> {
    /// A map that calls the columns `used` by their names, if it can.
    fn new(source: &SourceText, table: &'t Table<'a>, used: &[usize]) -> Self {
        let mut format = table.format.clone();
        let by_name = used.iter().all(|column| table.has_name(*column));
        if format.header && !by_name {
            // The rows begin behind the header and the units.
            let header = log_lines(source, &format).find(|line| {
                line.fields
                    .iter()
                    .map(|(_, text)| *text)
                    .eq(table.names.iter().map(String::as_str))
            });
            let line = header.map_or(0, |line| source.line_and_column(line.span.start).0);
            format.header = false;
            format.skip_lines = line + format.skip_rows;
            format.skip_rows = 0;
        }
        Self {
            table,
            by_name: by_name && format.header,
            format,
            text: "# Proposed from names and values: check units, signs and the order of axes.\n"
                .to_owned(),
        }
    }

    /// The name of a column in TOML.
    fn name(&self, column: usize) -> String {
        let name = match self.by_name {
            true => self.table.names[column].clone(),
            false => (column + 1).to_string(),
        };
        Value::String(name).to_string()
    }

    /// The format of the file, with the words for missing values in some columns.
    fn file(&mut self, source: &SourceText, values: &[usize]) {
        let format = &self.format;
        let mut lines = Vec::new();
        if let Some(encoding) = &format.encoding {
            lines.push(format!("encoding = \"{encoding}\""));
        }
        if format.delimiter != Delimiter::Comma {
            lines.push(format!("delimiter = \"{}\"", word_of(format.delimiter)));
        }
        if format.decimal == Decimal::Comma {
            lines.push("decimal = \"comma\"".to_owned());
        }
        if let Some(comment) = &format.comment {
            lines.push(format!("comment = {}", Value::String(comment.clone())));
        }
        if !format.header {
            lines.push("header = false".to_owned());
        }
        for (key, count) in [
            ("skip_lines", format.skip_lines),
            ("skip_rows", format.skip_rows),
        ] {
            if count > 0 {
                lines.push(format!("{key} = {count}"));
            }
        }
        let words = self.missing(source, values);
        if !words.is_empty() {
            let words = Value::Array(words.into_iter().map(Value::String).collect());
            lines.push(format!("missing = {words}"));
        }
        if !lines.is_empty() {
            let _ = write!(self.text, "\n[file]\n{}\n", lines.join("\n"));
        }
    }

    /// Words that stand for missing values.
    fn missing(&self, source: &SourceText, values: &[usize]) -> BTreeSet<String> {
        let mut words = BTreeSet::new();
        let count = self.table.names.len();
        let names: Vec<&str> = self.table.names.iter().map(String::as_str).collect();
        let mut begun = false;
        for line in log_lines(source, &self.format) {
            let is_title = |column: usize| line.fields[column].1 == names[column];
            if line.fields.len() != count
                || words.len() >= MOST_WORDS
                || values.iter().all(|it| is_title(*it))
            {
                continue;
            }
            let texts = values.iter().map(|column| line.fields[*column].1);
            let other = |text: &str| !text.is_empty() && self.format.decimal.number(text).is_none();
            // Lines in front of the first row are no rows.
            begun |= !texts.clone().all(other);
            if begun {
                words.extend(texts.filter(|text| other(text)).map(str::to_owned));
            }
        }
        words
    }

    fn time(&mut self, stamps: &Stamps) {
        let lines = match stamps {
            Stamps::Dates { columns, format } => {
                let unit = match format {
                    Some(format) => format!("format = {}", Value::String(format.clone())),
                    None => "unit = \"rfc3339\"".to_owned(),
                };
                let names: Vec<String> = columns.iter().map(|column| self.name(*column)).collect();
                match &names[..] {
                    [name] => format!("column = {name}\n{unit}"),
                    names => format!("columns = [{}]\n{unit}", names.join(", ")),
                }
            }
            Stamps::Numbers { column, unit_s } => {
                const WORDS: [(f64, &str); 6] =
                    [(1.0, "s"), (1e-3, "ms"), (1e-6, "us"), (1e-9, "ns"), (60.0, "min"), (3600.0, "h")];
                let word = WORDS.iter().find(|(value, _)| value == unit_s);
                let unit = match word {
                    Some((_, word)) => format!("unit = \"{word}\""),
                    None => format!("unit_s = {unit_s}"),
                };
                format!("column = {}\n{unit}", self.name(*column))
            }
            Stamps::Gps { column, week } => {
                let [column, week] = [column, week].map(|column| self.name(*column));
                format!("column = {column}\nunit = \"gps\"\nweek_column = {week}")
            }
            Stamps::Rate => "# No column rises: replace this by the number of samples in a second.\nrate_hz = 1.0".to_owned(),
        };
        let _ = write!(self.text, "\n[time]\n{lines}\n");
    }

    fn force(&mut self, force: &sensors::Force) {
        let names = force.columns.map(|column| self.name(column)).join(", ");
        let _ = write!(
            self.text,
            "\n[accel]\n# Mean magnitude in the file: {:.7}.\ncolumns = [{names}]\nunit = \"{}\"\n",
            force.magnitude, force.unit
        );
        if force.unit == "counts" {
            let _ = writeln!(self.text, "counts_per_g = {:?}", force.magnitude);
            if force.zero != 0.0 {
                let _ = writeln!(self.text, "zero_counts = {:?}", force.zero);
            }
        }
    }
}
