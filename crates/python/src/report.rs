//! Pages of results.

use gyrocal_design::PlanResult;
use gyrocal_diagnosis::result::read_text;
use gyrocal_fleet::FleetResult;
use gyrocal_pages::{of_fleet, of_plan, of_result, page};
use gyrocal_record::SourceText;
use pyo3::prelude::*;
use serde::de::DeserializeOwned;

use crate::error::{Failure, Outcome};

/// The page of a result (JSON) as one HTML file; `kind` is the class of the result.
#[pyfunction]
pub(crate) fn report(py: Python<'_>, kind: &str, result: &str) -> PyResult<String> {
    Ok(py.detach(|| html(kind, result))?)
}

fn html(kind: &str, result: &str) -> Outcome<String> {
    let part = match kind {
        "Diagnosis" => of_result(&read_text(&SourceText::new(result, kind)?)?),
        "Plan" => of_plan(&read::<PlanResult>(result)?),
        "Fleet" => of_fleet(&read::<FleetResult>(result)?),
        other => {
            return Err(Failure::of_value(
                "report",
                other,
                "a Diagnosis, a Plan or a Fleet",
                "the command `gyrocal report` makes pages of calibrations",
            ));
        }
    };
    page(vec![part]).to_html().map_err(|error| Failure {
        message: error.to_string(),
        ..Failure::default()
    })
}

fn read<T: DeserializeOwned>(text: &str) -> Outcome<T> {
    serde_json::from_str(text).map_err(|error| Failure {
        message: format!("the result cannot be read: {error}"),
        ..Failure::default()
    })
}
