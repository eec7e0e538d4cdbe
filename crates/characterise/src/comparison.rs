//! The diagnosis beside other methods, on the same records.

use gyrocal_statistics::{Proportion, mean};
use serde::{Deserialize, Serialize};

use crate::case::{Case, same};
use crate::methods::Method;
use crate::summary::NEAR_PARALLEL;

/// What this project's own method is called in tables.
pub const OWN: &str = "gyrocal";

/// One method in one cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ComparisonRow {
    /// The method.
    pub method: String,
    /// Records.
    pub runs: u64,
    /// Those in which it says that something is wrong.
    pub detected: u64,
    /// Of these, those whose first name is of the right class; `None` for methods without names and
    /// records without anything hidden.
    pub class_first: Option<u64>,
    /// Of these, those in which everything that is hidden is named; our own may name it in a set.
    pub all_named: Option<u64>,
    /// Of these, those with a cause more than are hidden.
    pub too_many: Option<u64>,
    /// Mean number of causes, of these.
    pub mean_names: Option<f64>,
}

impl ComparisonRow {
    /// The share of records in which the method says that something is wrong.
    #[must_use]
    pub fn detected(&self) -> Proportion {
        Proportion {
            hits: self.detected,
            trials: self.runs,
        }
    }

    /// A count of detected records as a share of these.
    #[must_use]
    pub fn of_detected(&self, hits: u64) -> Proportion {
        Proportion {
            hits,
            trials: self.detected,
        }
    }
}

/// One record by one method.
struct Said {
    detected: bool,
    first_cosine: f64,
    all_named: bool,
    causes: usize,
    hidden: usize,
}

/// All methods that were asked on the records of a cell, the diagnosis first.
#[must_use]
pub fn comparison(cases: &[&Case]) -> Vec<ComparisonRow> {
    let own: Vec<Said> = cases
        .iter()
        .map(|case| Said {
            detected: case.verdict != "clean",
            first_cosine: case
                .hidden
                .first()
                .map_or(0.0, |hidden| hidden.first_cosine),
            all_named: case.each_in_its_set(),
            causes: case.findings.len(),
            hidden: case.hidden.len(),
        })
        .collect();
    let mut rows = vec![row(OWN, true, &own)];
    for method in Method::ALL {
        let said: Vec<Said> = cases
            .iter()
            .filter_map(|case| {
                let asked = case
                    .methods
                    .iter()
                    .find(|asked| asked.method == method.name())?;
                let names = &asked.called.names;
                let named = |effect: &str| names.iter().any(|name| same(name, effect));
                Some(Said {
                    detected: asked.called.detected,
                    first_cosine: asked.first_cosine,
                    all_named: case.hidden.iter().all(|hidden| named(&hidden.effect)),
                    causes: names.len(),
                    hidden: case.hidden.len(),
                })
            })
            .collect();
        if !said.is_empty() {
            rows.push(row(method.name(), method.names(), &said));
        }
    }
    rows
}

fn row(method: &str, names: bool, said: &[Said]) -> ComparisonRow {
    let detected: Vec<&Said> = said.iter().filter(|said| said.detected).collect();
    let hides = said.iter().any(|said| said.hidden > 0);
    let count = |of: &dyn Fn(&Said) -> bool| {
        (names && hides).then(|| detected.iter().filter(|said| of(said)).count() as u64)
    };
    let causes: Vec<f64> = detected.iter().map(|said| said.causes as f64).collect();
    ComparisonRow {
        method: method.to_owned(),
        runs: said.len() as u64,
        detected: detected.len() as u64,
        class_first: count(&|said| said.first_cosine >= NEAR_PARALLEL),
        all_named: count(&|said| said.all_named),
        too_many: count(&|said| said.causes > said.hidden),
        mean_names: (names && !causes.is_empty()).then(|| mean(&causes)),
    }
}
