//! Comparison of the diagnosis with the baseline methods on the same records.

use gyrocal_statistics::{Proportion, mean};
use serde::{Deserialize, Serialize};

use crate::baseline::BaselineMethod;
use crate::catalogue::same_or_equivalent;
use crate::record_score::{RecordScore, SAME_CLASS_COSINE};

/// Name of the diagnosis of this project in tables.
pub const OWN_METHOD: &str = "gyrocal";

/// One method on the records of one cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct ComparisonRow {
    /// Name of the method.
    pub method: String,
    /// Number of records.
    pub runs: u64,
    /// Number of detections: records for which the method rejects the nominal model.
    pub detected: u64,
    /// Detections whose first selected effect is of the right class; `None` for tests, and for records
    /// without an injected effect.
    pub class_first: Option<u64>,
    /// Detections with all injected effects among the selected ones; for the diagnosis, in its confidence
    /// sets.
    pub all_named: Option<u64>,
    /// Detections with more selected effects than injected ones.
    pub too_many: Option<u64>,
    /// Mean number of selected effects over the detections.
    pub mean_names: Option<f64>,
}

impl ComparisonRow {
    /// Fraction of the records with a detection.
    #[must_use]
    pub fn detected(&self) -> Proportion {
        Proportion {
            hits: self.detected,
            trials: self.runs,
        }
    }

    /// A number of detections as a fraction of all detections.
    #[must_use]
    pub fn of_detected(&self, hits: u64) -> Proportion {
        Proportion {
            hits,
            trials: self.detected,
        }
    }
}

/// Result of one method on one record.
struct MethodResult {
    detected: bool,
    first_cosine: f64,
    all_named: bool,
    causes: usize,
    hidden: usize,
}

/// All applied methods on the records of a cell, the diagnosis first.
#[must_use]
pub fn comparison(records: &[&RecordScore]) -> Vec<ComparisonRow> {
    let own: Vec<MethodResult> = records
        .iter()
        .map(|record| MethodResult {
            detected: record.verdict != "clean",
            first_cosine: record
                .hidden
                .first()
                .map_or(0.0, |hidden| hidden.first_cosine),
            all_named: record.each_in_its_set(),
            causes: record.findings.len(),
            hidden: record.hidden.len(),
        })
        .collect();
    let mut rows = vec![row(OWN_METHOD, true, &own)];
    for method in BaselineMethod::ALL {
        let results: Vec<MethodResult> = records
            .iter()
            .filter_map(|record| {
                let asked = record
                    .methods
                    .iter()
                    .find(|asked| asked.method == method.name())?;
                let names = &asked.result.names;
                let named =
                    |effect: &str| names.iter().any(|name| same_or_equivalent(name, effect));
                Some(MethodResult {
                    detected: asked.result.detected,
                    first_cosine: asked.first_cosine,
                    all_named: record.hidden.iter().all(|hidden| named(&hidden.effect)),
                    causes: names.len(),
                    hidden: record.hidden.len(),
                })
            })
            .collect();
        if !results.is_empty() {
            rows.push(row(method.name(), method.identifies_effects(), &results));
        }
    }
    rows
}

fn row(method: &str, names: bool, results: &[MethodResult]) -> ComparisonRow {
    let detected: Vec<&MethodResult> = results.iter().filter(|results| results.detected).collect();
    let hides = results.iter().any(|results| results.hidden > 0);
    let count = |of: &dyn Fn(&MethodResult) -> bool| {
        (names && hides).then(|| detected.iter().filter(|results| of(results)).count() as u64)
    };
    let causes: Vec<f64> = detected
        .iter()
        .map(|results| results.causes as f64)
        .collect();
    ComparisonRow {
        method: method.to_owned(),
        runs: results.len() as u64,
        detected: detected.len() as u64,
        class_first: count(&|results| results.first_cosine >= SAME_CLASS_COSINE),
        all_named: count(&|results| results.all_named),
        too_many: count(&|results| results.causes > results.hidden),
        mean_names: (names && !causes.is_empty()).then(|| mean(&causes)),
    }
}
