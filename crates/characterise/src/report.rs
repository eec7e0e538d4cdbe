//! Cells run to their end, and the JSON result of `gyrocal characterise`.

use core::ops::Range;

use gyrocal::generated::MODEL_HASH;
use gyrocal_campaign::{Campaign, Failure, Fingerprint, Outcome, program};
use gyrocal_diagnosis::DiagnoseOptions;
use gyrocal_record::Manifest;
use serde::{Deserialize, Serialize};

use crate::case::Case;
use crate::cell::Cell;
use crate::characteristic::Characteristic;
use crate::comparison::{ComparisonRow, comparison};
use crate::family::{FamilyRow, families};
use crate::methods::Method;
use crate::summary::characteristics;

/// What `gyrocal characterise` found.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CharacteriseReport {
    /// [`SCHEMA_VERSION`](gyrocal_record::SCHEMA_VERSION) at the time of writing.
    pub schema_version: u32,
    /// Where the result comes from.
    pub manifest: Manifest,
    /// Cell by cell.
    pub cells: Vec<CellReport>,
}

/// What the records of one cell say.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CellReport {
    /// Its name.
    pub cell: String,
    /// What its records have in common.
    pub title: String,
    /// The first seed and the one after the last.
    pub seeds: [u64; 2],
    /// The figures.
    pub characteristics: Vec<Characteristic>,
    /// By family; empty where not one effect of the catalogue is hidden.
    pub families: Vec<FamilyRow>,
    /// The diagnosis and the other methods that were asked.
    pub comparison: Vec<ComparisonRow>,
    /// Records that gave no case.
    pub failures: Vec<Failure>,
}

/// The campaign of a cell. Its results depend on the model, the options of the diagnosis and the
/// methods, all of which are in its fingerprint, and on the program itself.
#[must_use]
pub fn campaign(cell: Cell, seeds: Range<u64>, methods: &[Method]) -> Campaign {
    let names: Vec<&str> = methods.iter().map(|method| method.name()).collect();
    let fingerprint = Fingerprint::new("gyrocal characterise")
        .with("program", program())
        .with("cell", cell.name())
        .with("model", MODEL_HASH)
        .with("options", format!("{:#?}", DiagnoseOptions::default()))
        .with("methods", names.join(", "));
    Campaign::new(seeds, fingerprint)
}

/// What the outcome of a cell's campaign says.
#[must_use]
pub fn cell_report(cell: Cell, outcome: &Outcome<Case>, seeds: &Range<u64>) -> CellReport {
    let cases: Vec<&Case> = outcome.successes().map(|(_, case)| case).collect();
    CellReport {
        cell: cell.name(),
        title: cell.title(),
        seeds: [seeds.start, seeds.end],
        characteristics: characteristics(cell, outcome, seeds),
        families: match cell {
            Cell::Single(_) | Cell::LogUniform => families(&cases),
            _ => Vec::new(),
        },
        comparison: match cell {
            // What is hidden there has no signature that the others could know.
            Cell::Beyond => Vec::new(),
            _ => comparison(&cases),
        },
        failures: outcome
            .failures()
            .map(|(seed, message)| Failure {
                seed,
                message: message.to_owned(),
            })
            .collect(),
    }
}

impl CellReport {
    /// Whether no figure misses its target.
    #[must_use]
    pub fn holds(&self) -> bool {
        let mut figures = self.characteristics.iter();
        figures.all(|figure| figure.holds != Some(false))
    }
}
