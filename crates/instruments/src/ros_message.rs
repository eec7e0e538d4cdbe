//! Messages of ROS by their definitions: those of ROS 1, and of ROS 2 in the common data representation
//! (CDR, OMG DDSI-RTPS, 10.2: numbers stand at multiples of their length).

use std::collections::HashMap;

use crate::cell::OwnedCell;
use crate::file_format::{ByteOrder, NumberType};

/// Messages within messages.
const DEEPEST: usize = 16;

/// Most elements of an array of fixed length whose values have names.
const MOST_NAMED: usize = 1024;

/// A message, read for some columns.
#[derive(Debug)]
pub(crate) struct RosMessage {
    fields: Vec<Field>,
    is_aligned: bool,
}

#[derive(Debug)]
struct Field {
    /// The path to it.
    name: String,
    kind: Kind,
    count: Count,
    /// The column of a single value, and of each element of an array of fixed length.
    columns: Vec<Option<usize>>,
}

#[derive(Debug)]
enum Kind {
    Number(NumberType),
    /// Seconds and nanoseconds.
    Time,
    Text,
    Message(Vec<Field>),
}

#[derive(Debug, Clone, Copy)]
enum Count {
    One,
    Fixed(usize),
    /// As the message says.
    Any,
}

/// The definitions of a message and of those within it, by their names.
struct Definitions<'a> {
    named: HashMap<String, &'a str>,
    wanted: &'a [&'a str],
}

impl RosMessage {
    /// The message of a definition, which those of its parts follow behind lines of `=`; `None` if it has
    /// types that are not read. `names` are the columns; CDR is aligned.
    pub(crate) fn of(text: &str, names: &[&str], is_aligned: bool) -> Option<Self> {
        let mut parts = vec![String::new()];
        for line in text.lines() {
            if line.starts_with("=====") {
                parts.push(String::new());
            } else if let Some(part) = parts.last_mut() {
                part.push_str(line);
                part.push('\n');
            }
        }
        let (main, others) = parts.split_first()?;
        let named = others.iter().filter_map(|part| {
            let (title, body) = part.trim_start().split_once('\n')?;
            let name = title.strip_prefix("MSG:")?.trim().replace("/msg/", "/");
            Some((name, body))
        });
        let definitions = Definitions {
            named: named.collect(),
            wanted: names,
        };
        Some(Self {
            fields: definitions.fields(main, "", "", 0)?,
            is_aligned,
        })
    }

    /// Paths of the values that a column can be.
    pub(crate) fn names(&self) -> Vec<String> {
        let mut all = Vec::new();
        names_of(&self.fields, &mut all);
        all
    }

    /// The values of the columns in a message, of which there are so many; `None` if it is not whole.
    pub(crate) fn values(&self, data: &[u8], columns: usize) -> Option<Vec<Option<OwnedCell>>> {
        let (bytes, order) = match (self.is_aligned, data) {
            (false, _) => (data, ByteOrder::Little),
            (true, [0, 0, _, _, rest @ ..]) => (rest, ByteOrder::Big),
            (true, [0, 1, _, _, rest @ ..]) => (rest, ByteOrder::Little),
            _ => return None,
        };
        let mut reader = Reader {
            bytes,
            at: 0,
            order,
            is_aligned: self.is_aligned,
            found: vec![None; columns],
        };
        reader.message(&self.fields)?;
        Some(reader.found)
    }
}

fn names_of(fields: &[Field], all: &mut Vec<String>) {
    for field in fields {
        match (&field.kind, field.count) {
            (Kind::Message(inner), Count::One) => names_of(inner, all),
            (_, Count::One) => all.push(field.name.clone()),
            (Kind::Number(_), Count::Fixed(count)) => {
                let places = 0..count.min(MOST_NAMED);
                all.extend(places.map(|at| format!("{}.{at}", field.name)));
            }
            _ => {}
        }
    }
}

impl Definitions<'_> {
    /// The fields of a definition; `package` is that of its message, `prefix` the path to it.
    fn fields(&self, text: &str, package: &str, prefix: &str, depth: usize) -> Option<Vec<Field>> {
        let lines = text.lines().filter_map(|line| {
            let line = line.split('#').next()?.trim();
            let (kind, rest) = line.split_once(char::is_whitespace)?;
            let name = rest.trim().split([' ', '\t', '=']).next()?;
            // A constant is no part of a message; a default value has no sign before it.
            let is_constant = rest.trim()[name.len()..].trim_start().starts_with('=');
            (!is_constant).then_some((kind, name))
        });
        lines
            .map(|(kind, name)| self.field(kind, package, &format!("{prefix}{name}"), depth))
            .collect()
    }

    fn field(&self, kind: &str, package: &str, name: &str, depth: usize) -> Option<Field> {
        let (kind, count) = match kind.split_once('[') {
            None => (kind, Count::One),
            Some((kind, length)) => match length.strip_suffix(']')?.parse() {
                Ok(count) => (kind, Count::Fixed(count)),
                Err(_) => (kind, Count::Any),
            },
        };
        let column = |path: &str| self.wanted.iter().position(|name| *name == path);
        let columns = match count {
            Count::One => vec![column(name)],
            Count::Fixed(count) => (0..count.min(MOST_NAMED))
                .map(|at| column(&format!("{name}.{at}")))
                .collect(),
            Count::Any => Vec::new(),
        };
        Some(Field {
            name: name.to_owned(),
            kind: self.kind(kind, package, name, depth)?,
            count,
            columns,
        })
    }

    fn kind(&self, kind: &str, package: &str, name: &str, depth: usize) -> Option<Kind> {
        let number = match kind {
            "bool" | "byte" | "uint8" | "octet" => Some(NumberType::U8),
            "char" | "int8" => Some(NumberType::I8),
            "int16" => Some(NumberType::I16),
            "uint16" => Some(NumberType::U16),
            "int32" => Some(NumberType::I32),
            "uint32" => Some(NumberType::U32),
            "int64" => Some(NumberType::I64),
            "uint64" => Some(NumberType::U64),
            "float32" => Some(NumberType::F32),
            "float64" => Some(NumberType::F64),
            _ => None,
        };
        if let Some(number) = number {
            return Some(Kind::Number(number));
        }
        let bare = kind.replace("/msg/", "/");
        match &*bare {
            "time" | "duration" | "builtin_interfaces/Time" | "builtin_interfaces/Duration" => {
                return Some(Kind::Time);
            }
            text if text == "string" || text.starts_with("string<=") => return Some(Kind::Text),
            _ if depth == DEEPEST => return None,
            _ => {}
        }
        let full = match &*bare {
            "Header" => "std_msgs/Header".to_owned(),
            within if !within.contains('/') => format!("{package}/{within}"),
            _ => bare,
        };
        let (title, body) = self.find(&full)?;
        let inner = title.split('/').next().unwrap_or_default();
        let prefix = format!("{name}.");
        Some(Kind::Message(self.fields(
            body,
            inner,
            &prefix,
            depth + 1,
        )?))
    }

    /// The definition of a name, or of the same name in another package: the package of the whole message
    /// is not written.
    fn find(&self, full: &str) -> Option<(&str, &str)> {
        if let Some((title, body)) = self.named.get_key_value(full) {
            return Some((title, body));
        }
        let last = full.rsplit('/').next()?;
        let mut same = self.named.iter();
        let found = same.find(|(title, _)| title.rsplit('/').next() == Some(last));
        found.map(|(title, body)| (&**title, *body))
    }
}

/// The bytes of a message.
struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
    order: ByteOrder,
    is_aligned: bool,
    found: Vec<Option<OwnedCell>>,
}

impl Reader<'_> {
    fn message(&mut self, fields: &[Field]) -> Option<()> {
        if fields.is_empty() && self.is_aligned {
            // ROS 2 writes a byte for a message without fields.
            self.number(NumberType::U8)?;
        }
        for field in fields {
            let count = match field.count {
                Count::One => 1,
                Count::Fixed(count) => count,
                Count::Any => self.number(NumberType::U32)? as usize,
            };
            // Elements without bytes have no number that the length of the message bounds.
            if count > 1 && matches!(&field.kind, Kind::Message(inner) if inner.is_empty()) {
                return None;
            }
            for element in 0..count {
                let value = match &field.kind {
                    Kind::Message(inner) => {
                        self.message(inner)?;
                        continue;
                    }
                    Kind::Number(kind) => OwnedCell::Number(self.number(*kind)?),
                    Kind::Time => {
                        let seconds = self.number(match self.is_aligned {
                            true => NumberType::I32,
                            false => NumberType::U32,
                        })?;
                        OwnedCell::Seconds(seconds + self.number(NumberType::U32)? * 1e-9)
                    }
                    Kind::Text => OwnedCell::Text(self.text()?),
                };
                if let Some(column) = field.columns.get(element).copied().flatten() {
                    self.found[column] = Some(value);
                }
            }
        }
        Some(())
    }

    fn number(&mut self, kind: NumberType) -> Option<f64> {
        let length = kind.bytes();
        if self.is_aligned {
            self.at = self.at.next_multiple_of(length);
        }
        let bytes = self.bytes.get(self.at..)?.get(..length)?;
        self.at += length;
        Some(kind.number(bytes, self.order))
    }

    fn text(&mut self) -> Option<String> {
        let length = self.number(NumberType::U32)? as usize;
        let bytes = self.bytes.get(self.at..)?.get(..length)?;
        self.at += length;
        let text = String::from_utf8_lossy(bytes);
        Some(text.trim_end_matches('\0').to_owned())
    }
}
