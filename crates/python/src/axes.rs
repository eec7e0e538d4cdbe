//! Axes of the instruments of a strapdown unit: a file beside a record, or an array.

use std::path::PathBuf;

use gyrocal_calibration::GyroAxes;
use gyrocal_instruments::strapdown::{read_axes, wrong_norm};
use gyrocal_record::{Input, Record, SourceText};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use sha2::{Digest, Sha256};

use crate::error::{Failure, Outcome};

/// What is given: quaternions (w, x, y, z) in rows, or a file of them.
#[derive(FromPyObject)]
pub(crate) enum GivenAxes<'py> {
    Array(PyReadonlyArray2<'py, f64>),
    File(PathBuf),
}

/// The same without the interpreter; an array has the name of its argument, for errors and results.
#[derive(Clone)]
pub(crate) enum Axes {
    Array {
        name: String,
        quaternions: Vec<[f64; 4]>,
    },
    File(PathBuf),
}

impl GivenAxes<'_> {
    /// Takes the values out of the interpreter's memory; `name` is that of the argument.
    pub(crate) fn take(&self, name: &str) -> Outcome<Axes> {
        let array = match self {
            Self::File(path) => return Ok(Axes::File(path.clone())),
            Self::Array(array) => array.as_array(),
        };
        if array.ncols() != 4 {
            return Err(Failure::of_value(
                name,
                format!("the shape ({}, {})", array.nrows(), array.ncols()),
                "(rows, 4)",
                "give one quaternion a row, q_w, q_x, q_y, q_z",
            ));
        }
        let rows = array.rows().into_iter();
        Ok(Axes::Array {
            name: name.to_owned(),
            quaternions: rows.map(|row| [row[0], row[1], row[2], row[3]]).collect(),
        })
    }
}

impl Axes {
    /// The axes at the rows of a record.
    pub(crate) fn of(&self, record: &Record) -> Outcome<GyroAxes> {
        let (name, quaternions) = match self {
            Self::File(path) => {
                return Ok(GyroAxes::new(&read_axes(&SourceText::read(path)?, record)?));
            }
            Self::Array { name, quaternions } => (name, quaternions),
        };
        if quaternions.len() != record.len() {
            return Err(Failure::of_value(
                name,
                format!("{} rows", quaternions.len()),
                format!("{}, as many as the record has", record.len()),
                "record and axes are written together: gyrocal import strapdown",
            ));
        }
        let mut rows = quaternions.iter().enumerate();
        let wrong = rows.find_map(|(row, quaternion)| Some((row, wrong_norm(quaternion)?)));
        if let Some((row, norm)) = wrong {
            return Err(Failure::of_value(
                &format!("{name}, row {row}"),
                format!("a quaternion of norm {norm:.4}"),
                "a rotation, norm 1",
                "q_w is its real part",
            ));
        }
        Ok(GyroAxes::new(quaternions))
    }

    /// Its name and its hash: of the file, or of the values row by row, as 64-bit numbers of little end first.
    pub(crate) fn input(&self) -> Outcome<Input> {
        let (name, quaternions) = match self {
            Self::File(path) => return Ok(Input::of(path)?),
            Self::Array { name, quaternions } => (name, quaternions),
        };
        let mut digest = Sha256::new();
        let values = quaternions.iter().flatten();
        values.for_each(|value| digest.update(value.to_le_bytes()));
        let digest = digest.finalize();
        Ok(Input {
            path: format!("<{name}>"),
            sha256: digest.iter().map(|byte| format!("{byte:02x}")).collect(),
            ..Input::default()
        })
    }
}
