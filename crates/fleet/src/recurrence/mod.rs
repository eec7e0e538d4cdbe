//! Causes that recur in many units below each one's threshold.
//!
//! Every effect has the evidence E that it is in some share of the units ([`mixture`]) and the p-value of that
//! evidence. Effects are chosen by the procedure of Benjamini and Hochberg (J. R. Statist. Soc. B 57, 289,
//! 1995) on p-values: of m effects the r with the smallest, as many as have p ≤ r q/m. It keeps the false
//! discovery rate below q where statistics are independent or depend positively on one another, which the
//! scores of overlapping signatures do to a good approximation; `cargo figures fleet` measures it with
//! signatures of real records. That E itself passes the same procedure (Wang, Ramdas, J. R. Statist. Soc. B
//! 84, 822, 2022), which holds whatever the dependence, is told with each discovery: it costs power, as
//! P(E ≥ 1/α) is below α.
//!
//! Signatures overlap, so that one cause raises the evidence of its twins. The effect with the largest
//! evidence is named; what has no evidence of its own with it in the model of each unit is an alternative
//! to it, and what has is named in turn.

mod given;
mod mixture;
mod naming;
mod null;
mod scores;
mod simulated;

use std::collections::BTreeSet;

use gyrocal_hypothesis::ScoreTable;
use gyrocal_statistics::math::exp;

use naming::{Naming, Tested};

pub use simulated::{Injected, ScoreSimulator, oracle_finds};

/// The records of one unit.
#[derive(Clone, Debug)]
pub struct UnitRecords<'a> {
    /// Name of the unit.
    pub unit: &'a str,
    /// Scores of its records.
    pub tables: Vec<&'a ScoreTable>,
}

/// Settings of the search for recurring causes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RecurrenceOptions {
    /// False discovery rate.
    pub false_discovery_rate: f64,
    /// Draws of each p-value.
    pub draws: usize,
    /// Their seed.
    pub seed: u64,
}

impl Default for RecurrenceOptions {
    fn default() -> Self {
        Self {
            false_discovery_rate: 0.05,
            draws: 400,
            seed: 0,
        }
    }
}

/// A cause that recurs.
#[derive(Clone, Debug, PartialEq)]
pub struct Discovery {
    /// Public id of the effect.
    pub effect: String,
    /// Logarithm of its evidence E.
    pub ln_e: f64,
    /// P-value of the evidence.
    pub p_value: f64,
    /// Whether it is a discovery by E alone, whatever depends on whatever.
    pub by_e_value: bool,
    /// Share of the units that have it: mean over what the scores allow.
    pub share: f64,
    /// Its strength in them, standard deviations of a unit.
    pub strength: f64,
    /// Whether one size in all units explains it better than sizes of their own.
    pub is_common: bool,
    /// Size in all units with its standard deviation, of an effect with one size that persists.
    pub size: Option<(f64, f64)>,
    /// Its unit.
    pub unit: String,
    /// Units with the probability that they have it, the likeliest first.
    pub units: Vec<(String, f64)>,
    /// Effects that the units' scores do not tell from it, the likeliest first.
    pub alternatives: Vec<String>,
}

/// The effects that recur.
#[must_use]
pub fn recurring(units: &[UnitRecords<'_>], options: &RecurrenceOptions) -> Vec<Discovery> {
    let mut tested: Vec<Tested> = effects(units)
        .into_iter()
        .map(|id| Tested::of(units, id, options))
        .collect();
    let rate = options.false_discovery_rate;
    let p_values = tested.iter().map(|one| one.p_value).collect();
    let chosen = step_up(p_values, rate);
    let limit = rate * chosen as f64 / tested.len() as f64;
    // An e-value passes where its reciprocal does as a p-value.
    let reciprocals = tested.iter().map(|one| exp(-one.evidence.ln_e)).collect();
    let by_e_values = step_up(reciprocals, rate);
    tested.sort_by(|a, b| b.evidence.ln_e.total_cmp(&a.evidence.ln_e));
    let by_e_values: Vec<String> = tested[..by_e_values]
        .iter()
        .map(|one| one.id.clone())
        .collect();
    let mut naming = Naming {
        limit,
        options,
        by_e_values,
        found: Vec::new(),
    };
    naming.name(units, tested);
    naming.found
}

/// Ids of all effects that some record shows, in the order of the first record that shows each.
fn effects<'a>(units: &[UnitRecords<'a>]) -> Vec<&'a str> {
    let tables = units.iter().flat_map(|unit| &unit.tables);
    let mut seen = BTreeSet::new();
    let all = tables.flat_map(|table| &table.effects);
    all.map(|effect| effect.id.as_str())
        .filter(|id| seen.insert(*id))
        .collect()
}

/// The number of discoveries of Benjamini and Hochberg.
fn step_up(mut p_values: Vec<f64>, rate: f64) -> usize {
    p_values.sort_by(f64::total_cmp);
    let count = p_values.len() as f64;
    let passes = |rank: &usize| p_values[rank - 1] <= rate * *rank as f64 / count;
    (1..=p_values.len()).rev().find(passes).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_up_procedure_is_that_of_its_authors() {
        // Benjamini and Hochberg (1995), section 3.2: 15 p-values, four of them at 5 %.
        let published = [
            0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344, 0.0459, 0.3240, 0.4262,
            0.5719, 0.6528, 0.7590, 1.0,
        ];
        assert_eq!(step_up(published.to_vec(), 0.05), 4);
        assert_eq!(step_up(Vec::new(), 0.05), 0);
    }
}
