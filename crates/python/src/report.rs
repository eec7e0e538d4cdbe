//! Pages of results.

use std::fmt::Display;

use gyrocal_design::PlanResult;
use gyrocal_diagnosis::result::read_text;
use gyrocal_fleet::FleetResult;
use gyrocal_pages::{Part, of_calibration, of_fleet, of_plan, of_result, page};
use gyrocal_record::{CalibrationReport, SourceText};
use pyo3::prelude::*;
use serde::de::DeserializeOwned;

use crate::error::{Failure, Outcome};

/// The page of results (JSON) as one HTML file; of each the class of the result and its text.
#[pyfunction]
pub(crate) fn report(py: Python<'_>, results: Vec<(String, String)>) -> PyResult<String> {
    Ok(py.detach(|| html(&results))?)
}

fn html(results: &[(String, String)]) -> Outcome<String> {
    let parts: Vec<Part> = results
        .iter()
        .map(|(kind, result)| part(kind, result))
        .collect::<Outcome<_>>()?;
    page(parts).to_html().map_err(|error| refused(&error))
}

fn part(kind: &str, result: &str) -> Outcome<Part> {
    Ok(match kind {
        "Diagnosis" => of_result(&read_text(&SourceText::new(result, kind)?)?),
        // Charts over time need the records.
        "Calibration" => of_calibration(&read::<CalibrationReport>(result)?, &[])
            .map_err(|error| refused(&error))?,
        "Plan" => of_plan(&read::<PlanResult>(result)?),
        "Fleet" => of_fleet(&read::<FleetResult>(result)?),
        other => {
            return Err(Failure::of_value(
                "report",
                other,
                "a Calibration, a Diagnosis, a Plan or a Fleet",
                "its numbers are in to_dict() and to_dataframe()",
            ));
        }
    })
}

fn refused(error: &impl Display) -> Failure {
    Failure {
        message: error.to_string(),
        ..Failure::default()
    }
}

fn read<T: DeserializeOwned>(text: &str) -> Outcome<T> {
    serde_json::from_str(text)
        .map_err(|error| refused(&format!("the result cannot be read: {error}")))
}
