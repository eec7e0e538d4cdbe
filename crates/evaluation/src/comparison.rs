//! Comparison of the diagnosis with the baseline methods on the same records.

use gyrocal_statistics::{Proportion, mean};
use serde::{Deserialize, Serialize};

use crate::baseline::BaselineMethod;
use crate::catalogue::{effect_family, same_or_equivalent};
use crate::coefficient_score::CoefficientScore;
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
        let (hits, trials) = (self.detected, self.runs);
        Proportion { hits, trials }
    }

    /// A number of detections as a fraction of all detections.
    #[must_use]
    pub fn of_detected(&self, hits: u64) -> Proportion {
        let trials = self.detected;
        Proportion { hits, trials }
    }
}

/// What one method says of one record.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// Whether it rejects the nominal model.
    pub detected: bool,
    /// Closeness of its first name to the first injected effect: 1 for that or an exact equivalent.
    pub first_cosine: f64,
    /// Whether all injected effects are among its names; two for the diagnosis in a set each.
    pub all_named: bool,
    /// Number of selected effects; for the diagnosis that of its sets.
    pub causes: usize,
    /// Number of names; for the diagnosis those of all members of its sets.
    pub names: usize,
    /// The coefficients of the model that it ends with.
    pub coefficients: Option<CoefficientScore>,
}

impl Answer {
    /// Of a baseline method, of the diagnosis for `None`; `None` if the method was not applied.
    #[must_use]
    pub fn of(method: Option<BaselineMethod>, record: &RecordScore) -> Option<Self> {
        let Some(method) = method else {
            let sets = record.findings.iter();
            let first = record.hidden.first();
            return Some(Self {
                detected: record.verdict != "clean",
                first_cosine: first.map_or(0.0, |hidden| hidden.first_cosine),
                all_named: record.each_in_its_set(),
                causes: record.findings.len(),
                names: sets.map(|finding| 1 + finding.alternatives.len()).sum(),
                coefficients: record.coefficients,
            });
        };
        let mut asked = record.methods.iter();
        let asked = asked.find(|asked| asked.method == method.name())?;
        let names = &asked.result.names;
        let named = |effect: &str| names.iter().any(|name| same_or_equivalent(name, effect));
        Some(Self {
            detected: asked.result.detected,
            first_cosine: asked.first_cosine,
            all_named: record.hidden.iter().all(|hidden| named(&hidden.effect)),
            causes: names.len(),
            names: names.len(),
            coefficients: asked.coefficients,
        })
    }
}

/// All applied methods on the records of a cell, the diagnosis first.
#[must_use]
pub fn comparison(records: &[&RecordScore]) -> Vec<ComparisonRow> {
    let rows = core::iter::once(None).chain(BaselineMethod::ALL.map(Some));
    let row = |method: Option<BaselineMethod>| {
        let of = |record: &&RecordScore| Some((record.hidden.len(), Answer::of(method, record)?));
        let answers: Vec<(usize, Answer)> = records.iter().filter_map(of).collect();
        (method.is_none() || !answers.is_empty()).then(|| row(method, &answers))
    };
    rows.filter_map(row).collect()
}

/// The row of a method, from the number of injected effects and the answer of each record.
fn row(method: Option<BaselineMethod>, answers: &[(usize, Answer)]) -> ComparisonRow {
    let detected = answers.iter().filter(|(_, answer)| answer.detected);
    let detected: Vec<&(usize, Answer)> = detected.collect();
    let names = method.is_none_or(BaselineMethod::identifies_effects);
    let hides = answers.iter().any(|(hidden, _)| *hidden > 0);
    let count = |of: &dyn Fn(&(usize, Answer)) -> bool| {
        (names && hides).then(|| detected.iter().filter(|answer| of(answer)).count() as u64)
    };
    let causes = || detected.iter().map(|(_, answer)| answer.causes as f64);
    ComparisonRow {
        method: method.map_or(OWN_METHOD, BaselineMethod::name).to_owned(),
        runs: answers.len() as u64,
        detected: detected.len() as u64,
        class_first: count(&|(_, answer)| answer.first_cosine >= SAME_CLASS_COSINE),
        all_named: count(&|(_, answer)| answer.all_named),
        too_many: count(&|(hidden, answer)| answer.causes > *hidden),
        mean_names: (names && !detected.is_empty()).then(|| mean(causes())),
    }
}

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
        let (hits, trials) = (self.detected, self.runs);
        Proportion { hits, trials }
    }
}

/// The families of the first injected effects, in alphabetical order.
#[must_use]
pub fn families(records: &[&RecordScore]) -> Vec<FamilyRow> {
    let mut by_family: std::collections::BTreeMap<String, Vec<&RecordScore>> = Default::default();
    for record in records {
        if let Some(hidden) = record.hidden.first() {
            let family = effect_family(&hidden.effect).to_owned();
            by_family.entry(family).or_default().push(record);
        }
    }
    let row = |(family, records): (String, Vec<&RecordScore>)| {
        let detected = records.iter().filter(|record| record.detected());
        let detected: Vec<&RecordScore> = detected.copied().collect();
        let count = |of: fn(&RecordScore) -> bool| {
            detected.iter().filter(|record| of(record)).count() as u64
        };
        let sizes = || detected.iter().map(|record| record.set_size() as f64);
        FamilyRow {
            family,
            runs: records.len() as u64,
            detected: detected.len() as u64,
            in_set: count(|record| record.hidden.iter().all(|hidden| hidden.in_set)),
            class_first: count(|record| {
                let mut hidden = record.hidden.iter();
                hidden.any(|hidden| hidden.first_cosine >= SAME_CLASS_COSINE)
            }),
            mean_set_size: (!detected.is_empty()).then(|| mean(sizes())),
        }
    };
    by_family.into_iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::baseline::BaselineResult;
    use crate::record_score::BaselineScore;
    use crate::record_score::tests::{found, pair};

    #[test]
    fn a_set_counts_by_its_members() {
        let mut record = pair(vec![
            found("gyro_y.ramp", &["accel_x.bias"]),
            found("gyro_x.g_y", &[]),
        ]);
        record.methods = vec![BaselineScore {
            method: "bic".to_owned(),
            result: BaselineResult {
                detected: true,
                names: vec!["gyro_x.g_y".to_owned()],
            },
            first_cosine: 1.0,
            coefficients: None,
        }];
        let of = |method| Answer::of(method, &record).map(|of| (of.causes, of.names, of.all_named));
        assert_eq!(of(None), Some((2, 3, true)));
        assert_eq!(of(Some(BaselineMethod::Bic)), Some((1, 1, false)));
        // What was not applied has neither an answer nor a row.
        assert_eq!(of(Some(BaselineMethod::Stls)), None);
        let rows = comparison(&[&record]);
        let told: Vec<_> = rows
            .iter()
            .map(|row| (row.method.as_str(), row.all_named, row.mean_names))
            .collect();
        assert_eq!(
            told,
            [
                (OWN_METHOD, Some(1), Some(2.0)),
                ("bic", Some(0), Some(1.0))
            ]
        );
    }
}
