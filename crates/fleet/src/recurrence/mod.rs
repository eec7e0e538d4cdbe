//! Causes that recur in many units below each one's threshold.
//!
//! Every effect has the evidence E that it is in some share of the units (`mixture`) and the p-value of that
//! evidence. Signatures overlap, so that one cause raises the evidence of its twins. The effect with the largest
//! evidence is named; what has no evidence of its own with it in the model of each unit is an alternative
//! to it, and what has is named in turn.
//!
//! The k-th name of m effects needs p ≤ k q/m, the critical values of Benjamini and Hochberg (J. R. Statist.
//! Soc. B 57, 289, 1995) taken step by step: twins, which are no names, do not raise them. That keeps the
//! false discovery rate below q where statistics are independent or depend positively on one another, which the
//! scores of overlapping signatures do to a good approximation; `cargo figures fleet` measures it with
//! signatures of real records. That E itself passes, E ≥ m/(k q), which holds whatever the dependence (Wang,
//! Ramdas, J. R. Statist. Soc. B 84, 822, 2022), is told with each discovery: it costs power, as
//! P(E ≥ 1/α) is below α.

mod given;
mod mixture;
mod naming;
mod null;
mod scores;
mod simulated;

use std::collections::BTreeSet;

use gyrocal_hypothesis::ScoreTable;

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
    tested.sort_by(|a, b| b.evidence.ln_e.total_cmp(&a.evidence.ln_e));
    let mut naming = Naming {
        first_limit: options.false_discovery_rate / tested.len() as f64,
        options,
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
