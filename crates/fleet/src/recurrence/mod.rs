//! Causes that recur in many units below each one's threshold.
//!
//! Every effect has the evidence E that it is in some share of the units (`mixture`) and the p-value of that
//! evidence (`null`). The effect with the largest evidence of those with p ≤ q/m, of m effects, is named first: a
//! fleet without a cause names one with at most the probability q, whatever depends on whatever.
//!
//! Signatures overlap, so that one cause raises the evidence of others too. Further names need evidence beside
//! those that are named (`beside`), E ≥ m/(k q) of the k-th: the critical values of Benjamini and Hochberg (J. R.
//! Statist. Soc. B 57, 289, 1995) for such ratios, which hold under any dependence (Wang, Ramdas, J. R. Statist.
//! Soc. B 84, 822, 2022). A name that the later ones leave without evidence is taken back. Alternatives of a name
//! are effects with evidence of their own, with which in its place it has none left.

mod beside;
mod given;
mod mixture;
mod naming;
mod null;
mod scores;
mod simulated;

use std::collections::BTreeSet;

use gyrocal_hypothesis::{ScoreTable, Stopped, stop};

use crate::answer::RecurringCause;
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

/// The effects that recur.
///
/// # Errors
/// [`Stopped`] if the job was asked to end.
pub fn recurring(
    units: &[UnitRecords<'_>],
    options: &RecurrenceOptions,
) -> Result<Vec<RecurringCause>, Stopped> {
    let tested = effects(units).into_iter().map(|id| {
        stop::check()?;
        Ok(Tested::of(units, id, options))
    });
    let mut tested: Vec<Tested> = tested.collect::<Result<_, Stopped>>()?;
    tested.sort_by(|a, b| b.evidence.ln_e.total_cmp(&a.evidence.ln_e));
    let naming = Naming {
        units,
        tested: &tested,
        options,
    };
    stop::finished(naming.discoveries())
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
