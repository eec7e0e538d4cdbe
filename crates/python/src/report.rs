//! Pages of results.

use gyrocal_answer::{PlantFit, read_text};
use gyrocal_design::PlanResult;
use gyrocal_document::Words;
use gyrocal_evaluation::CharacteriseReport;
use gyrocal_fleet::FleetResult;
use gyrocal_pages::{
    Part, of_calibration, of_characterise, of_fit, of_fleet, of_plan, of_result, page,
    read as read_part, read_sections,
};
use gyrocal_record::{CalibrationReport, Manifest, SourceText};
use gyrocal_report::{to_html, words_to_html};
use pyo3::prelude::*;
use serde::Deserialize;
use serde::de::DeserializeOwned;

use crate::error::{Failure, Outcome};
use crate::origin::json;
use crate::plant::HeldPage;

/// A result: its class, its text (JSON) and, of a plant, its page.
type Given<'a> = (&'a str, &'a str, Option<&'a HeldPage>);

/// The fit of a plant with its manifest, as it is written.
#[derive(Deserialize)]
struct WrittenFit {
    manifest: Manifest,
    #[serde(flatten)]
    fit: PlantFit,
}

/// What is read of a result (JSON): its first screen, and the sections of its page, each as words (JSON).
#[pyfunction]
pub(crate) fn words_of(kind: &str, result: &str) -> PyResult<(String, String)> {
    let mut part = part((kind, result, None))?;
    let sections = read_sections(&std::mem::take(&mut part.sections));
    Ok((json(&read_part(&part))?, json(&sections)?))
}

/// An answer in words (JSON) as text for a terminal.
#[pyfunction]
pub(crate) fn text_of(words: &str) -> PyResult<String> {
    Ok(gyrocal_cli::text_of(&read::<Vec<Words>>(words)?))
}

/// The same as HTML for a notebook.
#[pyfunction]
pub(crate) fn html_of(words: &str) -> PyResult<String> {
    Ok(words_to_html(&read::<Vec<Words>>(words)?).map_err(|error| Failure::of_text(&error))?)
}

/// The page of results as one HTML file.
#[pyfunction]
pub(crate) fn report(
    py: Python<'_>,
    results: Vec<(String, String, Option<Bound<'_, HeldPage>>)>,
) -> PyResult<String> {
    let given: Vec<Given<'_>> = results
        .iter()
        .map(|(kind, result, page)| (&**kind, &**result, page.as_ref().map(Bound::get)))
        .collect();
    Ok(py.detach(|| html(&given))?)
}

fn html(results: &[Given<'_>]) -> Outcome<String> {
    let parts = results.iter().copied().map(part);
    let parts: Vec<Part> = parts.collect::<Outcome<_>>()?;
    to_html(&page(parts)).map_err(|error| Failure::of_text(&error))
}

fn part((kind, result, page): Given<'_>) -> Outcome<Part> {
    Ok(match kind {
        "Diagnosis" => of_result(&read_text(&SourceText::new(result, kind)?)?),
        // Charts over time need the records.
        "Calibration" => {
            let report = read::<CalibrationReport>(result)?;
            of_calibration(&report, &[]).map_err(|error| Failure::of_text(&error))?
        }
        "Plan" => of_plan(&read::<PlanResult>(result)?),
        "Characteristics" => of_characterise(&read::<CharacteriseReport>(result)?),
        "Fleet" => of_fleet(&read::<FleetResult>(result)?),
        "PlantFit" => {
            let WrittenFit { manifest, fit } = read(result)?;
            of_fit(&fit, &manifest)
        }
        "PlantDiagnosis" => match page {
            Some(page) => page.part.clone()?,
            // One that was pickled has no charts.
            None => of_result(&read_text(&SourceText::new(result, kind)?)?),
        },
        other => {
            return Err(Failure::of_value(
                "report",
                other,
                "a Calibration, a Diagnosis, a Plan, a Characteristics, a Fleet, a PlantDiagnosis or a PlantFit",
                "its numbers are in to_dict() and to_pandas()",
            ));
        }
    })
}

fn read<T: DeserializeOwned>(text: &str) -> Outcome<T> {
    serde_json::from_str(text)
        .map_err(|error| Failure::of_text(&format!("the result cannot be read: {error}")))
}
