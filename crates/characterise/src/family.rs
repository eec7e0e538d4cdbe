//! The same figures by family: effects that differ by their axes only.

use gyrocal_statistics::{Proportion, mean};
use serde::{Deserialize, Serialize};

use crate::case::Case;
use crate::summary::NEAR_PARALLEL;

/// One family in one cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FamilyRow {
    /// The effect with `i`, `j`, `k` for its axes.
    pub family: String,
    /// Records in which one of its effects was hidden.
    pub runs: u64,
    /// Those in which a cause was named.
    pub detected: u64,
    /// Of these, those whose set holds the truth.
    pub in_set: u64,
    /// Of these, those whose first name is of the right class.
    pub class_first: u64,
    /// Mean size of the first set, of these.
    pub mean_set_size: Option<f64>,
}

impl FamilyRow {
    /// The share of its records in which a cause was named.
    #[must_use]
    pub fn detected(&self) -> Proportion {
        Proportion {
            hits: self.detected,
            trials: self.runs,
        }
    }
}

/// The families of the first hidden effects, in alphabetical order.
#[must_use]
pub fn families(cases: &[&Case]) -> Vec<FamilyRow> {
    let mut by_family: std::collections::BTreeMap<String, Vec<&Case>> = Default::default();
    for case in cases {
        if let Some(hidden) = case.hidden.first() {
            by_family
                .entry(family(&hidden.effect))
                .or_default()
                .push(case);
        }
    }
    by_family
        .into_iter()
        .map(|(family, cases)| {
            let detected: Vec<&&Case> = cases.iter().filter(|case| case.detected()).collect();
            let count =
                |of: &dyn Fn(&Case) -> bool| detected.iter().filter(|case| of(case)).count() as u64;
            let sizes: Vec<f64> = detected.iter().map(|case| case.set_size() as f64).collect();
            FamilyRow {
                family,
                runs: cases.len() as u64,
                detected: detected.len() as u64,
                in_set: count(&|case| case.hidden.iter().all(|hidden| hidden.in_set)),
                class_first: count(&|case| {
                    let mut hidden = case.hidden.iter();
                    hidden.any(|hidden| hidden.first_cosine >= NEAR_PARALLEL)
                }),
                mean_set_size: (!sizes.is_empty()).then(|| mean(&sizes)),
            }
        })
        .collect()
}

/// An id with `i` for its own axis and `j`, `k` for others.
#[must_use]
pub fn family(id: &str) -> String {
    let Some((owner, rest)) = id.split_once('.') else {
        return id.to_owned();
    };
    let Some((kind, axes)) = owner.split_once('_') else {
        return match id {
            // One and the same to every record.
            "clock.rate" => "site.latitude".to_owned(),
            id => id.to_owned(),
        };
    };
    let axes = match axes.len() {
        1 => "i",
        _ => "ij",
    };
    let rest = match rest.strip_prefix("g_") {
        None => rest,
        Some(letters) => match letters.len() {
            1 => "g_j",
            2 => "g_jk",
            _ => "g_iii",
        },
    };
    format!("{kind}_{axes}.{rest}")
}

#[cfg(test)]
mod tests {
    use super::family;

    #[test]
    fn a_family_forgets_the_axes() {
        for (id, expected) in [
            ("gyro_x.g_y", "gyro_i.g_j"),
            ("gyro_z.g_xy", "gyro_i.g_jk"),
            ("gyro_z.g_yy", "gyro_i.g_jk"),
            ("gyro_y.g_yyy", "gyro_i.g_iii"),
            ("gyro_y.step", "gyro_i.step"),
            ("accel_xz.nonorthogonality", "accel_ij.nonorthogonality"),
            ("accel_x.bias", "accel_i.bias"),
            ("clock.rate", "site.latitude"),
            ("platform.knock", "platform.knock"),
        ] {
            assert_eq!(family(id), expected);
        }
    }
}
