//! A diagnosed record, as far as the fleet needs it.

use gyrocal_answer::{Answer, CoefficientEstimate, FindingKind, read_platform_text};
use gyrocal_hypothesis::ScoreTable;
use gyrocal_record::SourceText;

use crate::error::FleetError;
use crate::score_bytes::from_bytes;

/// Seconds of a Julian year.
pub(crate) const YEAR_S: f64 = 31_557_600.0;

/// Name of a record, and what its operator knows of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordName {
    /// The unit: a platform with its gyros.
    pub unit: String,
    /// The record.
    pub record: String,
    /// Date of the record: seconds since any fixed moment.
    pub date_s: Option<f64>,
    /// Batch that the unit was made in.
    pub batch: Option<String>,
    /// Site of the record.
    pub site: Option<String>,
}

/// A diagnosed record.
#[derive(Clone, Debug, PartialEq)]
pub struct FleetRecord {
    /// Its name.
    pub name: RecordName,
    /// The coefficients with all accepted causes in the model.
    pub coefficients: Vec<CoefficientEstimate>,
    /// Causes that the record shows by itself.
    pub causes: Vec<String>,
    /// Whether these are settled: the search came to its end, and left a white rest.
    pub is_settled: bool,
    /// Scores on all other effects.
    pub scores: Option<ScoreTable>,
}

impl FleetRecord {
    /// Of the result of a diagnosis, and its scores.
    #[must_use]
    pub fn new(name: RecordName, result: &Answer, scores: Option<ScoreTable>) -> Self {
        // Over all members of the confidence sets, where there are causes.
        let coefficients = result
            .coefficients
            .iter()
            .flat_map(|all| match &all.over_set {
                None => all.best().to_vec(),
                Some(over_set) => over_set
                    .iter()
                    .map(|one| CoefficientEstimate {
                        name: one.name.clone(),
                        estimate: one.estimate,
                        sigma: one.sigma,
                        unit: one.unit.clone(),
                    })
                    .collect(),
            });
        Self {
            name,
            coefficients: coefficients.collect(),
            causes: result
                .of_kind(FindingKind::Cause)
                .map(|finding| finding.effect.clone())
                .collect(),
            is_settled: result.is_settled(),
            scores,
        }
    }

    /// Of a written result (JSON) and the bytes of its scores ([`crate::to_bytes`]).
    ///
    /// # Errors
    /// Those of reading either.
    pub fn read(name: RecordName, result: &str, scores: Option<&[u8]>) -> Result<Self, FleetError> {
        let origin = format!("{}/{}", name.unit, name.record);
        let result = read_platform_text(&SourceText::new(result, &origin)?)?;
        Ok(Self::new(
            name,
            &result,
            scores.map(from_bytes).transpose()?,
        ))
    }
}
