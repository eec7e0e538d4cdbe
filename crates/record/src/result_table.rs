//! Tables of results as CSV and Parquet.

use std::borrow::Cow;
use std::io;
use std::path::Path;

use crate::error::{Error, unwritable};
use crate::record::Record;

/// A table of named columns of equal length.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ResultTable {
    columns: Vec<(Cow<'static, str>, Column)>,
}

/// A column of a table; `None` is an empty cell.
#[derive(Debug, Clone, PartialEq)]
enum Column {
    Texts(Vec<Option<String>>),
    Numbers(Vec<Option<f64>>),
}

impl ResultTable {
    /// The table with a column of texts.
    #[must_use]
    pub fn texts<T: Into<String>>(
        mut self,
        name: impl Into<Cow<'static, str>>,
        cells: impl IntoIterator<Item = Option<T>>,
    ) -> Self {
        let cells = cells.into_iter().map(|cell| cell.map(Into::into));
        self.columns
            .push((name.into(), Column::Texts(cells.collect())));
        self
    }

    /// The table with a column of numbers; those that are not finite are empty cells.
    #[must_use]
    pub fn numbers(
        mut self,
        name: impl Into<Cow<'static, str>>,
        cells: impl IntoIterator<Item = Option<f64>>,
    ) -> Self {
        let cells = cells
            .into_iter()
            .map(|cell| cell.filter(|it| it.is_finite()));
        self.columns
            .push((name.into(), Column::Numbers(cells.collect())));
        self
    }

    /// The table of a record, in the columns of its file.
    #[must_use]
    pub fn of_record(record: &Record) -> Self {
        let axis = |axis: usize| record.accel_g.iter().map(move |row| Some(row[axis]));
        let table = Self::default()
            .numbers("time_s", record.time_s.iter().copied().map(Some))
            .numbers("accel_x_g", axis(0))
            .numbers("accel_y_g", axis(1))
            .numbers("accel_z_g", axis(2));
        match &record.temperature_c {
            Some(column) => table.numbers("temperature_c", column.iter().copied().map(Some)),
            None => table,
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |(_, column)| match column {
            Column::Texts(cells) => cells.len(),
            Column::Numbers(cells) => cells.len(),
        })
    }

    /// The content of the table's file: Parquet if its name ends in `.parquet`, else CSV.
    ///
    /// # Errors
    ///
    /// [`Error::Unwritable`], of Parquet also where its writer is not built in.
    pub fn content(&self, path: &Path) -> Result<Vec<u8>, Error> {
        let is_parquet = path
            .extension()
            .is_some_and(|it| it.eq_ignore_ascii_case("parquet"));
        let written = match is_parquet {
            true => self.to_parquet(),
            false => self.to_csv(),
        };
        written.map_err(unwritable(path))
    }

    fn to_csv(&self) -> io::Result<Vec<u8>> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        writer.write_record(self.columns.iter().map(|(name, _)| name.as_bytes()))?;
        for row in 0..self.rows() {
            writer.write_record(self.columns.iter().map(|(_, column)| match column {
                Column::Texts(cells) => cells[row].clone().unwrap_or_default(),
                Column::Numbers(cells) => {
                    cells[row].map_or_else(String::new, |number| format!("{number:?}"))
                }
            }))?;
        }
        writer.into_inner().map_err(io::Error::other)
    }

    #[cfg(not(feature = "parquet"))]
    fn to_parquet(&self) -> io::Result<Vec<u8>> {
        Err(io::Error::other(
            "this program was built without Parquet: `cargo install --locked --path crates/cli --features parquet` in a \
             clone of its repository builds it with it; or give the file a name that ends in .csv",
        ))
    }

    #[cfg(feature = "parquet")]
    fn to_parquet(&self) -> io::Result<Vec<u8>> {
        self.parquet().map_err(io::Error::other)
    }

    #[cfg(feature = "parquet")]
    fn parquet(&self) -> Result<Vec<u8>, parquet::errors::ParquetError> {
        use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
        use parquet::data_type::{ByteArray, ByteArrayType, DoubleType};
        use parquet::file::properties::WriterProperties;
        use parquet::file::writer::SerializedFileWriter;
        use parquet::schema::types::Type;
        use std::sync::Arc;

        let field = |(name, column): &(Cow<'static, str>, Column)| {
            let (physical, logical) = match column {
                Column::Texts(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
                Column::Numbers(_) => (Physical::DOUBLE, None),
            };
            Type::primitive_type_builder(name, physical)
                .with_repetition(Repetition::OPTIONAL)
                .with_logical_type(logical)
                .build()
                .map(Arc::new)
        };
        let fields = self.columns.iter().map(field).collect::<Result<_, _>>()?;
        let schema = Type::group_type_builder("table")
            .with_fields(fields)
            .build()?;
        let properties = WriterProperties::builder()
            .set_compression(Compression::SNAPPY)
            .build();
        let mut bytes = Vec::new();
        let mut writer =
            SerializedFileWriter::new(&mut bytes, Arc::new(schema), Arc::new(properties))?;
        let mut group = writer.next_row_group()?;
        for (_, column) in &self.columns {
            let Some(mut into) = group.next_column()? else {
                break;
            };
            match column {
                Column::Texts(cells) => {
                    let there: Vec<i16> = cells.iter().map(|it| i16::from(it.is_some())).collect();
                    let values: Vec<ByteArray> = cells
                        .iter()
                        .flatten()
                        .map(|text| ByteArray::from(text.as_str()))
                        .collect();
                    into.typed::<ByteArrayType>()
                        .write_batch(&values, Some(&there), None)?;
                }
                Column::Numbers(cells) => {
                    let there: Vec<i16> = cells.iter().map(|it| i16::from(it.is_some())).collect();
                    let values: Vec<f64> = cells.iter().flatten().copied().collect();
                    into.typed::<DoubleType>()
                        .write_batch(&values, Some(&there), None)?;
                }
            }
            into.close()?;
        }
        group.close()?;
        writer.close()?;
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_is_written_with_empty_cells_and_quoted_texts() {
        let table = ResultTable::default()
            .texts("name", [Some("a, \"b\""), None])
            .numbers("estimate", [Some(0.1), Some(f64::NAN)]);
        let text = String::from_utf8(table.content("t.csv".as_ref()).unwrap()).unwrap();
        assert_eq!(text, "name,estimate\n\"a, \"\"b\"\"\",0.1\n,\n");
    }

    #[cfg(not(feature = "parquet"))]
    #[test]
    fn without_the_writer_of_parquet_the_error_says_what_to_do() {
        let refused = ResultTable::default().content("t.parquet".as_ref());
        let message = refused.unwrap_err().to_string();
        assert!(message.contains("--features parquet"), "{message}");
    }
}
