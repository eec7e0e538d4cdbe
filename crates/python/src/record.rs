//! A record: rows of a file or of columns in memory.

use std::path::PathBuf;

use gyrocal_record::{Input, Record, RecordFile};
use numpy::ndarray::{ArrayView1, ArrayView2};
use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use pyo3::prelude::*;
use sha2::{Digest, Sha256};

use crate::arrow_abi::Stream;
use crate::arrow_stream;
use crate::error::{Failure, Outcome};
use crate::names::COLUMNS;

/// A record that calls of the library take.
#[pyclass(frozen, name = "Record", module = "gyrocal._gyrocal")]
pub(crate) struct HeldRecord {
    pub(crate) file: RecordFile,
    /// Its name and its hash: of the file, or of the values of the columns.
    pub(crate) input: Input,
}

impl HeldRecord {
    /// Takes a record in memory.
    pub(crate) fn of_memory(record: Record, name: &str) -> Outcome<Self> {
        check_values(&record, name)?;
        Ok(Self {
            input: Input {
                path: name.to_owned(),
                sha256: hash(&record),
                ..Input::default()
            },
            file: RecordFile::of_record(record, name),
        })
    }

    fn record(&self) -> &Record {
        self.file.record()
    }
}

#[pymethods]
impl HeldRecord {
    /// Reads a record from a file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let read = || -> Outcome<Self> {
            Ok(Self {
                file: RecordFile::read(&path)?,
                input: Input::of(&path)?,
            })
        };
        Ok(py.detach(read)?)
    }

    /// Takes columns of equal lengths, whose values are copied into rows.
    #[staticmethod]
    fn of_columns(
        name: &str,
        time_s: PyReadonlyArray1<'_, f64>,
        accel_g: [PyReadonlyArray1<'_, f64>; 3],
        temperature_c: Option<PyReadonlyArray1<'_, f64>>,
    ) -> PyResult<Self> {
        let time_s = time_s.as_array();
        let axes = accel_g.each_ref().map(|axis| axis.as_array());
        let temperature_c = temperature_c.as_ref().map(|column| column.as_array());
        let others = axes.iter().chain(&temperature_c);
        for (column, values) in COLUMNS[1..].iter().zip(others) {
            check_length(name, column, values.len(), time_s.len())?;
        }
        let [x, y, z] = axes;
        let rows = x.iter().zip(y).zip(z);
        let record = Record {
            time_s: time_s.to_vec(),
            accel_g: rows.map(|((x, y), z)| [*x, *y, *z]).collect(),
            temperature_c: temperature_c.map(|column| column.to_vec()),
        };
        Ok(Self::of_memory(record, name)?)
    }

    /// Takes the columns of an Arrow stream, the capsule `arrow_array_stream`.
    #[staticmethod]
    fn of_arrow(py: Python<'_>, name: &str, stream: &Bound<'_, PyAny>) -> PyResult<Self> {
        let stream = Stream::of_capsule(stream)?;
        let read = || Self::of_memory(arrow_stream::read(stream, name)?, name);
        Ok(py.detach(read)?)
    }

    /// Number of rows.
    fn __len__(&self) -> usize {
        self.record().len()
    }

    /// The name that errors and results give the record.
    #[getter]
    fn name(&self) -> &str {
        &self.input.path
    }

    /// SHA-256 of the file or of the values, in hexadecimal.
    #[getter]
    fn sha256(&self) -> &str {
        &self.input.sha256
    }

    /// Time of each row, s: a view that cannot be written to.
    #[getter]
    fn time_s<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        view(this, &this.get().record().time_s)
    }

    /// Specific force, one row a sample, in g: a view that cannot be written to.
    #[getter]
    fn accel_g<'py>(this: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = ArrayView2::from(this.get().record().accel_g.as_slice());
        // SAFETY: the rows belong to a frozen object, which is never changed and which the array
        // keeps alive; no reference to them leaves this function but the array, made read-only here.
        let array = unsafe { PyArray2::borrow_from_array(&rows, this.clone().into_any()) };
        read_only(&array)?;
        Ok(array)
    }

    /// Temperature of each row, if it was logged.
    #[getter]
    fn temperature_c<'py>(this: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyArray1<f64>>>> {
        let column = this.get().record().temperature_c.as_ref();
        column.map(|column| view(this, column)).transpose()
    }

    /// The text of the record's file.
    fn to_csv(&self, py: Python<'_>) -> PyResult<String> {
        let path = PathBuf::from(&self.input.path);
        let text = py.detach(|| self.record().to_csv(&path));
        Ok(text.map_err(Failure::from)?)
    }
}

fn view<'py>(
    owner: &Bound<'py, HeldRecord>,
    column: &[f64],
) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let column = ArrayView1::from(column);
    // SAFETY: as in `accel_g`.
    let array = unsafe { PyArray1::borrow_from_array(&column, owner.clone().into_any()) };
    read_only(&array)?;
    Ok(array)
}

fn read_only(array: &Bound<'_, PyAny>) -> PyResult<()> {
    let options = pyo3::types::PyDict::new(array.py());
    options.set_item("write", false)?;
    array
        .call_method("setflags", (), Some(&options))
        .map(|_| ())
}

fn check_length(name: &str, column: &str, found: usize, expected: usize) -> Outcome<()> {
    if found == expected {
        return Ok(());
    }
    Err(Failure::of_value(
        &format!("{name}, column `{column}`"),
        format!("{found} values"),
        format!("{expected}, as many as `time_s` has"),
        "give all columns of the same rows; a missing value is nan",
    ))
}

/// Refuses values that no file of a record can hold.
fn check_values(record: &Record, name: &str) -> Outcome<()> {
    let refuse = |column: &str, row: usize, value: f64, expected: &str, advice: &str| {
        let place = format!("{name}, column `{column}`, row {row}");
        Err(Failure {
            code: Some("gyrocal::input::not_a_number".to_owned()),
            file: Some(name.to_owned()),
            ..Failure::of_value(&place, format!("{value}"), expected, advice)
        })
    };
    if let Some(row) = record.time_s.iter().position(|time| !time.is_finite()) {
        let advice = "leave the row out: a sample without a time cannot be used";
        return refuse(
            COLUMNS[0],
            row,
            record.time_s[row],
            "a finite number",
            advice,
        );
    }
    for (row, sample) in record.accel_g.iter().enumerate() {
        if let Some(axis) = sample.iter().position(|value| value.is_infinite()) {
            let expected = "a finite number or nan";
            let advice = "write nan for what was not measured";
            return refuse(COLUMNS[1 + axis], row, sample[axis], expected, advice);
        }
    }
    let temperatures = record.temperature_c.as_deref().unwrap_or_default();
    if let Some(row) = temperatures.iter().position(|value| !value.is_finite()) {
        let advice = "interpolate the temperature, or leave the column out";
        return refuse(
            COLUMNS[4],
            row,
            temperatures[row],
            "a finite number",
            advice,
        );
    }
    Ok(())
}

/// SHA-256 of the values, column after column, as 64-bit numbers of little end first.
fn hash(record: &Record) -> String {
    let mut digest = Sha256::new();
    let mut add = |value: &f64| digest.update(value.to_le_bytes());
    record.time_s.iter().for_each(&mut add);
    record.accel_g.iter().flatten().for_each(&mut add);
    record.temperature_c.iter().flatten().for_each(&mut add);
    let digest = digest.finalize();
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}
