//! Campaigns of population cells, and the JSON result of `gyrocal characterise`.

use core::ops::Range;

use gyrocal::generated::MODEL_HASH;
use gyrocal_diagnosis::DiagnoseOptions;
use gyrocal_record::Manifest;
use serde::{Deserialize, Serialize};

use crate::baseline::BaselineMethod;
use crate::campaign::{Campaign, Failure, Fingerprint, Outcome, program};
use crate::cell_characteristics::characteristics;
use crate::characteristic::Characteristic;
use crate::comparison::{ComparisonRow, FamilyRow, comparison, families};
use crate::population::PopulationCell;
use crate::record_score::RecordScore;

/// Result of `gyrocal characterise`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CharacteriseReport {
    /// `SCHEMA_VERSION` of `gyrocal-record` at the time of writing.
    pub schema_version: u32,
    /// Program, inputs and command that made the result.
    pub manifest: Manifest,
    /// One report for each cell.
    pub cells: Vec<CellReport>,
}

/// Operating characteristics of one cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CellReport {
    /// Name of the cell.
    pub cell: String,
    /// Description of its records, as a heading.
    pub title: String,
    /// The first seed and the one after the last.
    pub seeds: [u64; 2],
    /// Figures with their targets.
    pub characteristics: Vec<Characteristic>,
    /// Figures by family; empty unless one effect of the catalogue is injected.
    pub families: Vec<FamilyRow>,
    /// The diagnosis and the applied baseline methods.
    pub comparison: Vec<ComparisonRow>,
    /// Records that gave no record.
    pub failures: Vec<Failure>,
}

/// The campaign of a cell. Its fingerprint has everything that the results depend on: the program, the
/// model, the options of the diagnosis and the baseline methods.
#[must_use]
pub fn cell_campaign(
    cell: PopulationCell,
    seeds: Range<u64>,
    methods: &[BaselineMethod],
) -> Campaign {
    let names: Vec<&str> = methods.iter().map(|method| method.name()).collect();
    let fingerprint = Fingerprint::new("gyrocal characterise")
        .with("program", program())
        .with("cell", cell.name())
        .with("model", MODEL_HASH)
        .with("options", format!("{:#?}", DiagnoseOptions::default()))
        .with("methods", names.join(", "));
    Campaign::new(seeds, fingerprint)
}

/// Operating characteristics of a cell from the outcome of its campaign.
#[must_use]
pub fn cell_report(
    cell: PopulationCell,
    outcome: &Outcome<RecordScore>,
    seeds: &Range<u64>,
) -> CellReport {
    let records: Vec<&RecordScore> = outcome.successes().map(|(_, record)| record).collect();
    CellReport {
        cell: cell.name(),
        title: cell.title(),
        seeds: [seeds.start, seeds.end],
        characteristics: characteristics(cell, outcome, seeds),
        families: match cell {
            PopulationCell::Single(_) | PopulationCell::LogUniform => families(&records),
            _ => Vec::new(),
        },
        comparison: match cell {
            // Its effects have no signature that a baseline method could select.
            PopulationCell::OutOfCatalogue => Vec::new(),
            _ => comparison(&records),
        },
        failures: outcome.failures().collect(),
    }
}

impl CellReport {
    /// `true` if no figure misses its target.
    #[must_use]
    pub fn holds(&self) -> bool {
        let mut figures = self.characteristics.iter();
        figures.all(|figure| figure.holds != Some(false))
    }
}
