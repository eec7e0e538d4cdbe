//! Figures by family of effects: effects that differ only in their axes.

use gyrocal_statistics::{Proportion, mean};
use serde::{Deserialize, Serialize};

use crate::catalogue::effect_family;
use crate::record_score::{RecordScore, SAME_CLASS_COSINE};

/// One family of effects in one cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FamilyRow {
    /// Id of the effect with `i`, `j`, `k` for its axes.
    pub family: String,
    /// Number of records with an injected effect of the family.
    pub runs: u64,
    /// Number of detections: records with a finding.
    pub detected: u64,
    /// Detections whose confidence sets contain the injected effects.
    pub in_set: u64,
    /// Detections whose first finding is of the right class.
    pub class_first: u64,
    /// Mean size of the first confidence set over the detections.
    pub mean_set_size: Option<f64>,
}

impl FamilyRow {
    /// Fraction of the records with a finding.
    #[must_use]
    pub fn detected(&self) -> Proportion {
        Proportion {
            hits: self.detected,
            trials: self.runs,
        }
    }
}

/// The families of the first injected effects, in alphabetical order.
#[must_use]
pub fn families(records: &[&RecordScore]) -> Vec<FamilyRow> {
    let mut by_family: std::collections::BTreeMap<String, Vec<&RecordScore>> = Default::default();
    for record in records {
        if let Some(hidden) = record.hidden.first() {
            by_family
                .entry(effect_family(&hidden.effect).to_owned())
                .or_default()
                .push(record);
        }
    }
    by_family
        .into_iter()
        .map(|(family, records)| {
            let detected: Vec<&&RecordScore> =
                records.iter().filter(|record| record.detected()).collect();
            let count = |of: &dyn Fn(&RecordScore) -> bool| {
                detected.iter().filter(|record| of(record)).count() as u64
            };
            let sizes: Vec<f64> = detected
                .iter()
                .map(|record| record.set_size() as f64)
                .collect();
            FamilyRow {
                family,
                runs: records.len() as u64,
                detected: detected.len() as u64,
                in_set: count(&|record| record.hidden.iter().all(|hidden| hidden.in_set)),
                class_first: count(&|record| {
                    let mut hidden = record.hidden.iter();
                    hidden.any(|hidden| hidden.first_cosine >= SAME_CLASS_COSINE)
                }),
                mean_set_size: (!sizes.is_empty()).then(|| mean(&sizes)),
            }
        })
        .collect()
}
