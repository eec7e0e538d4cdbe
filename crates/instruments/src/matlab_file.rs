//! Numeric variables of MAT files of version 5, which `save` of MATLAB writes with `-v6` and `-v7`, and GNU
//! Octave and SciPy as well.
//!
//! A file is a header of 128 bytes and *elements*: a tag with type and length, then content, which ends at a
//! multiple of eight bytes. An array is an element that has elements: flags with its class, dimensions, name,
//! values; one in zlib's compression is an element by itself. Source: The MathWorks, *MAT-File Format*,
//! chapter 1.

use std::borrow::Cow;
use std::fs::Metadata;
use std::io::Read;
use std::path::Path;

use flate2::read::ZlibDecoder;
use gyrocal_record::{LARGE_MIB, LARGE_RATIO, read_content};

use crate::cell::{Cell, TakeCells, no_column, unfit};
use crate::error::InstrumentError;
use crate::file_format::{ByteOrder, NumberType};

/// Bytes before the first element.
pub(crate) const HEADER: usize = 128;

/// Types of elements that hold elements.
const ARRAY: u32 = 14;
const COMPRESSED: u32 = 15;

/// Classes of arrays: structures, and from doubles to integers of 64 bits.
const STRUCTURE: u32 = 2;
const NUMERIC: core::ops::RangeInclusive<u32> = 6..=15;

/// Flag of complex numbers.
const COMPLEX: u32 = 0x0800;

/// Structures within structures that are read.
const DEEPEST: usize = 8;

/// Whether a file that begins so is one: of version 5 by the number of its version, of version 7.3 by its words.
pub(crate) fn is_one(first: &[u8]) -> bool {
    byte_order(first).is_some() || is_hdf5(first)
}

/// Order of the bytes of a file of version 5.
fn byte_order(first: &[u8]) -> Option<ByteOrder> {
    match first.get(HEADER - 4..HEADER)? {
        [0, 1, b'I', b'M'] => Some(ByteOrder::Little),
        [1, 0, b'M', b'I'] => Some(ByteOrder::Big),
        _ => None,
    }
}

fn is_hdf5(first: &[u8]) -> bool {
    first.starts_with(b"MATLAB 7.3 MAT-file")
}

/// A matrix of real numbers.
#[derive(Debug)]
struct Matrix {
    /// Name of the variable; of a field of a structure with that of the structure and a point before it.
    name: String,
    rows: usize,
    columns: usize,
    /// Values, column by column.
    values: Vec<f64>,
}

impl Matrix {
    /// The column of an index: `(:,2)` or `(2,:)`; without one that of a vector.
    fn column(&self, index: Option<&str>) -> Option<Vec<f64>> {
        let Some(index) = index else {
            let is_vector = self.rows == 1 || self.columns == 1;
            return is_vector.then(|| self.values.clone());
        };
        let place = |number: &str, count: usize| {
            let number: usize = number.trim().parse().ok()?;
            (1..=count).contains(&number).then(|| number - 1)
        };
        if let Some(number) = index.strip_prefix(":,") {
            let column = place(number, self.columns)?;
            let first = column * self.rows;
            return Some(self.values[first..first + self.rows].to_vec());
        }
        let row = place(index.strip_suffix(",:")?, self.rows)?;
        let values = self.values.iter().skip(row).step_by(self.rows);
        Some(values.copied().collect())
    }
}

/// Hands the cells of the columns `names` of each row to `take`. A column is a vector, or a part of a matrix,
/// as `accel(:,2)`; `log.accel(:,2)` is one of a structure.
pub(crate) fn read(
    path: &Path,
    names: &[&str],
    take: &mut TakeCells<'_>,
) -> Result<(), InstrumentError> {
    let bytes = read_content(path)?;
    let Some(order) = byte_order(&bytes) else {
        return Err(unfit(
            "a MAT file of version 7.3, which is HDF5",
            "one of version 5",
            "write it with `save(name, variables, '-v7')`",
        ));
    };
    let matrices = matrices(&bytes[HEADER..], order, stored_bytes(path, &bytes))?;
    let columns = names
        .iter()
        .map(|name| column(&matrices, name).ok_or_else(|| no_column(name, &list(&matrices))))
        .collect::<Result<Vec<Vec<f64>>, InstrumentError>>()?;
    let rows = columns.first().map_or(0, Vec::len);
    if let Some(at) = columns.iter().position(|column| column.len() != rows) {
        return Err(unfit(
            &format!("{} values in `{}`", columns[at].len(), names[at]),
            &format!("{rows} values, as `{}` has", names[0]),
            "name columns of one log in the map",
        ));
    }
    for row in 0..rows {
        let cells: Vec<Cell<'_>> = columns
            .iter()
            .map(|column| Cell::Number(column[row]))
            .collect();
        take(&cells)?;
    }
    Ok(())
}

fn column(matrices: &[Matrix], name: &str) -> Option<Vec<f64>> {
    let (variable, index) = match name.strip_suffix(')').and_then(|it| it.split_once('(')) {
        Some((variable, index)) => (variable, Some(index)),
        None => (name, None),
    };
    let mut named = matrices.iter().filter(|one| one.name == variable);
    named.next()?.column(index)
}

/// Names of the columns that there are.
fn list(matrices: &[Matrix]) -> String {
    let names = matrices.iter().map(|one| match (one.rows, one.columns) {
        (1, _) | (_, 1) => one.name.clone(),
        (rows, columns) if rows < columns => format!("{}(1,:) to ({rows},:)", one.name),
        (_, columns) => format!("{}(:,1) to (:,{columns})", one.name),
    });
    let names: Vec<String> = names.collect();
    match names.is_empty() {
        true => "of objects or texts alone (a table: write `table2struct(t, 'ToScalar', true)`)"
            .to_owned(),
        false => names.join(", "),
    }
}

/// Bytes of a file as it is stored: those of its content if it is a stream.
fn stored_bytes(path: &Path, content: &[u8]) -> u64 {
    let file = std::fs::metadata(path).ok().filter(Metadata::is_file);
    file.map_or(content.len() as u64, |file| file.len())
}

fn not_whole() -> InstrumentError {
    let advice = "copy the file again; it ends early, or is damaged";
    unfit("an element that is not whole", "a whole file", advice)
}

/// The matrices of a file, which is stored in so many bytes, after its header.
fn matrices(bytes: &[u8], order: ByteOrder, stored: u64) -> Result<Vec<Matrix>, InstrumentError> {
    let mut found = Vec::new();
    let mut file = Elements { bytes, order };
    let mut room = Room::of(stored);
    while !file.bytes.is_empty() {
        let (kind, content) = file.next().ok_or_else(not_whole)?;
        match kind {
            COMPRESSED => {
                let inflated = room.inflated(content)?;
                let mut inner = Elements {
                    bytes: &inflated,
                    order,
                };
                if let (ARRAY, content) = inner.next().ok_or_else(not_whole)? {
                    array(content, order, "", 0, &mut found).ok_or_else(not_whole)?;
                }
            }
            ARRAY => array(content, order, "", 0, &mut found).ok_or_else(not_whole)?,
            _ => {}
        }
    }
    Ok(found)
}

/// Room for the content of the compressed variables of a file.
struct Room {
    stored: u64,
    most: u64,
    left: u64,
}

impl Room {
    fn of(stored: u64) -> Self {
        let most = (LARGE_MIB << 20).max(stored.saturating_mul(LARGE_RATIO));
        Self {
            stored,
            most,
            left: most,
        }
    }

    /// The content of a compressed variable.
    fn inflated(&mut self, content: &[u8]) -> Result<Vec<u8>, InstrumentError> {
        let mut inflated = Vec::new();
        ZlibDecoder::new(content)
            .take(self.left)
            .read_to_end(&mut inflated)
            .map_err(|_| not_whole())?;
        self.left -= inflated.len() as u64;
        if self.left > 0 {
            return Ok(inflated);
        }
        Err(unfit(
            &format!(
                "compressed variables of {} MiB and more in a file of {} bytes",
                self.most >> 20,
                self.stored
            ),
            &format!("less than {LARGE_RATIO} times the size of the file"),
            "write it with `save(name, variables, '-v6')`, which does not compress, if it is a log",
        ))
    }
}

/// Adds the matrices of an array; those of another class are passed over.
fn array(
    content: &[u8],
    order: ByteOrder,
    name: &str,
    depth: usize,
    found: &mut Vec<Matrix>,
) -> Option<()> {
    let mut parts = Elements {
        bytes: content,
        order,
    };
    // A field without a value is an array without content.
    if content.is_empty() || depth > DEEPEST {
        return Some(());
    }
    let (_, flags) = parts.next()?;
    let flags = parts.word(flags)?;
    let class = flags & 0xff;
    if class != STRUCTURE && !NUMERIC.contains(&class) {
        return Some(());
    }
    let sizes = numbers(parts.next()?, order)?;
    let own = text(parts.next()?.1);
    let name = if depth == 0 { &*own } else { name };
    if class == STRUCTURE {
        let is_single = sizes.iter().all(|size| *size == 1.0);
        return match is_single {
            true => structure(parts, name, depth, found),
            false => Some(()),
        };
    }
    let [rows, columns] = sizes[..] else {
        return Some(());
    };
    if flags & COMPLEX != 0 {
        return Some(());
    }
    let values = numbers(parts.next()?, order)?;
    if values.len() as f64 != rows * columns {
        return None;
    }
    found.push(Matrix {
        name: name.to_owned(),
        rows: rows as usize,
        columns: columns as usize,
        values,
    });
    Some(())
}

/// Adds the matrices of the fields of a structure.
fn structure(
    mut parts: Elements<'_>,
    name: &str,
    depth: usize,
    found: &mut Vec<Matrix>,
) -> Option<()> {
    let (_, length) = parts.next()?;
    let length = parts.word(length)? as usize;
    let titles = parts.next()?.1;
    for title in titles.chunks(length.max(1)) {
        let (_, content) = parts.next()?;
        let path = format!("{name}.{}", text(title));
        array(content, parts.order, &path, depth + 1, found)?;
    }
    Some(())
}

/// The text of some bytes up to the first zero.
fn text(bytes: &[u8]) -> Cow<'_, str> {
    let end = bytes.iter().position(|byte| *byte == 0);
    String::from_utf8_lossy(&bytes[..end.unwrap_or(bytes.len())])
}

/// The numbers of an element.
fn numbers((kind, content): (u32, &[u8]), order: ByteOrder) -> Option<Vec<f64>> {
    let kind = match kind {
        1 => NumberType::I8,
        2 => NumberType::U8,
        3 => NumberType::I16,
        4 => NumberType::U16,
        5 => NumberType::I32,
        6 => NumberType::U32,
        7 => NumberType::F32,
        9 => NumberType::F64,
        12 => NumberType::I64,
        13 => NumberType::U64,
        _ => return None,
    };
    let each = content.chunks_exact(kind.bytes());
    let is_whole = each.remainder().is_empty();
    is_whole.then(|| each.map(|bytes| kind.number(bytes, order)).collect())
}

/// Elements one after the other.
struct Elements<'a> {
    bytes: &'a [u8],
    order: ByteOrder,
}

impl<'a> Elements<'a> {
    /// Type and content of the next; `None` if it is not whole.
    fn next(&mut self) -> Option<(u32, &'a [u8])> {
        let bytes = self.bytes;
        let tag = self.word(bytes)?;
        // Up to four bytes stand within the tag.
        if tag >> 16 != 0 {
            let content = bytes.get(4..8)?.get(..(tag >> 16) as usize)?;
            self.bytes = bytes.get(8..)?;
            return Some((tag & 0xffff, content));
        }
        let length = self.word(bytes.get(4..)?)? as usize;
        let content = bytes.get(8..)?.get(..length)?;
        let padded = match tag {
            COMPRESSED => length,
            _ => length.next_multiple_of(8),
        };
        // The last may end without its padding.
        self.bytes = bytes.get(8 + padded..).unwrap_or_default();
        Some((tag, content))
    }

    /// The first four bytes as a number.
    fn word(&self, bytes: &[u8]) -> Option<u32> {
        let four = *bytes.first_chunk::<4>()?;
        Some(match self.order {
            ByteOrder::Little => u32::from_le_bytes(four),
            ByteOrder::Big => u32::from_be_bytes(four),
        })
    }
}
