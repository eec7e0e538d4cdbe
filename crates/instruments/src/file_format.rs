//! Format of the file of a log: a part of its description.

use std::path::Path;

use gyrocal_record::{Error, SourceText};
use serde::{Deserialize, Serialize};

/// Format of the file of a log: text in columns, or binary records.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub struct FileFormat {
    /// Separator of the fields of a line.
    pub delimiter: Delimiter,
    /// Encoding of the text by its label in the Encoding Standard: `"utf-16le"`, `"latin1"`. Without it UTF-8, or what
    /// a byte-order mark says.
    pub encoding: Option<String>,
    /// Beginning of lines that are comments.
    pub comment: Option<String>,
    /// Number of lines before the header, or before the first row. A preamble in front of a header that
    /// has the columns of the description needs none: it is passed over.
    pub skip_lines: usize,
    /// Number of lines between the header and the first row, as one of units.
    pub skip_rows: usize,
    /// Decimal sign of the numbers.
    pub decimal: Decimal,
    /// Texts that stand for a missing value of an accelerometer or a temperature of a record, beside an empty
    /// field and `nan`.
    pub missing: Vec<String>,
    /// `false` for a file without a header: its columns are then called `"1"`, `"2"` and so on.
    pub header: bool,
    /// The rows of one sensor of a file with several.
    pub only: Option<Only>,
    /// Binary records in place of text.
    pub binary: Option<Binary>,
}

impl FileFormat {
    /// The text of a file of this format.
    pub(crate) fn read(&self, path: &Path) -> Result<SourceText, Error> {
        SourceText::read_as(path, self.encoding.as_deref())
    }

    /// Whether a text stands for a missing value.
    pub(crate) fn is_missing(&self, text: &str) -> bool {
        text.is_empty() || self.missing.iter().any(|missing| missing == text)
    }
}

impl Default for FileFormat {
    fn default() -> Self {
        Self {
            delimiter: Delimiter::Comma,
            encoding: None,
            comment: None,
            skip_lines: 0,
            skip_rows: 0,
            decimal: Decimal::Point,
            missing: Vec::new(),
            header: true,
            only: None,
            binary: None,
        }
    }
}

/// Separator of fields.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Delimiter {
    /// A comma.
    Comma,
    /// A semicolon.
    Semicolon,
    /// A tab.
    Tab,
    /// One or more blanks or tabs.
    Space,
    /// A vertical bar.
    Bar,
}

/// Decimal sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Decimal {
    /// A point.
    #[default]
    Point,
    /// A comma. Fields that commas separate have to be in quotation marks then.
    Comma,
}

impl Decimal {
    /// The number of a text, infinities and `nan` included.
    pub(crate) fn number(self, text: &str) -> Option<f64> {
        match self {
            Self::Comma if text.contains(',') => text.replacen(',', ".", 1).parse().ok(),
            _ => text.parse().ok(),
        }
    }
}

impl Delimiter {
    /// The delimiter in words.
    #[must_use]
    pub fn description(self) -> &'static str {
        match self {
            Self::Comma => "commas",
            Self::Semicolon => "semicolons",
            Self::Tab => "tabs",
            Self::Space => "blanks",
            Self::Bar => "vertical bars",
        }
    }
}

/// Rows with one value in one column.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Only {
    /// The column.
    pub column: String,
    /// Its value, as the file has it.
    pub equals: String,
}

/// Binary records of a fixed layout.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Binary {
    /// The fields of a record in their order, without gaps.
    pub fields: Vec<BinaryField>,
    /// Order of the bytes of a number.
    #[serde(default)]
    pub byte_order: ByteOrder,
    /// Bytes in front of the first record.
    #[serde(default)]
    pub skip_bytes: usize,
}

/// A field of a binary record.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct BinaryField {
    /// Name of its column.
    pub name: String,
    /// Type of its number.
    #[serde(rename = "type")]
    pub kind: NumberType,
}

/// Type of a binary number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum NumberType {
    /// Unsigned, 8 bits.
    U8,
    /// Signed, 8 bits.
    I8,
    /// Unsigned, 16 bits.
    U16,
    /// Signed, 16 bits.
    I16,
    /// Unsigned, 32 bits.
    U32,
    /// Signed, 32 bits.
    I32,
    /// Unsigned, 64 bits.
    U64,
    /// Signed, 64 bits.
    I64,
    /// Floating point, 32 bits.
    F32,
    /// Floating point, 64 bits.
    F64,
}

/// Order of the bytes of a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum ByteOrder {
    /// The least significant byte first.
    #[default]
    Little,
    /// The most significant byte first.
    Big,
}

impl NumberType {
    /// Number of bytes.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::U8 | Self::I8 => 1,
            Self::U16 | Self::I16 => 2,
            Self::U32 | Self::I32 | Self::F32 => 4,
            Self::U64 | Self::I64 | Self::F64 => 8,
        }
    }

    /// The number of some bytes; missing bytes are zero.
    pub(crate) fn number(self, bytes: &[u8], order: ByteOrder) -> f64 {
        let mut little = [0_u8; 8];
        for (place, byte) in little.iter_mut().zip(bytes.iter().take(self.bytes())) {
            *place = *byte;
        }
        if order == ByteOrder::Big {
            little[..self.bytes()].reverse();
        }
        let [a, b, c, d, ..] = little;
        match self {
            Self::U8 => f64::from(a),
            Self::I8 => f64::from(i8::from_le_bytes([a])),
            Self::U16 => f64::from(u16::from_le_bytes([a, b])),
            Self::I16 => f64::from(i16::from_le_bytes([a, b])),
            Self::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Self::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::U64 => u64::from_le_bytes(little) as f64,
            Self::I64 => i64::from_le_bytes(little) as f64,
            Self::F64 => f64::from_le_bytes(little),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_every_type_and_order_are_read() {
        use ByteOrder::{Big, Little};
        assert_eq!(
            NumberType::I16.number(&(-2_i16).to_le_bytes(), Little),
            -2.0
        );
        assert_eq!(NumberType::I16.number(&(-2_i16).to_be_bytes(), Big), -2.0);
        assert_eq!(NumberType::I8.number(&[0xff], Little), -1.0);
        assert_eq!(NumberType::U8.number(&[0xff], Big), 255.0);
        assert_eq!(NumberType::U32.number(&7_u32.to_be_bytes(), Big), 7.0);
        assert_eq!(NumberType::F32.number(&1.5_f32.to_be_bytes(), Big), 1.5);
        assert_eq!(
            NumberType::F64.number(&(-0.1_f64).to_le_bytes(), Little),
            -0.1
        );
        assert_eq!(NumberType::I64.number(&(-9_i64).to_be_bytes(), Big), -9.0);
    }
}
