//! Results of 40 records before and after a change: every key of what the commands write.
//!
//! `tests/data/before` has the records (`cases.toml`, `inputs`), what an earlier build wrote of each
//! (`results`), and what may change at which step (`moves.toml`).

mod compare;
pub(crate) mod moves;
mod records;
mod results;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::PathBuf;

use gyrocal_testkit::workspace;
use rayon::prelude::*;
use serde::Deserialize;

use crate::harness::{Context, Error, Figure};
use compare::compared;
use moves::Moves;

pub(crate) use records::make;
pub(crate) use results::{as_command, gyrocal, placeless, told};

/// Number of records.
const RECORDS: usize = 40;

/// A record, and the commands whose results are compared.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Case {
    pub(crate) name: String,
    /// Platform, strapdown unit, several records of one, plant, or log of instruments.
    kind: String,
    /// Clean, faulty, set-up wrong, or cut: too short, or with a search that ends at its budget.
    state: String,
    /// Takes seconds; left out of the small version.
    #[serde(default)]
    slow: bool,
    /// What makes its files: lines of [`records::make`].
    #[serde(default)]
    pub(crate) make: Vec<String>,
    /// Commands, with the words of [`gyrocal_testkit::contracts::words`].
    pub(crate) run: Vec<String>,
}

/// The figures of the comparison; differences are printed before them. The small version leaves out slow records.
/// With names, only these records are compared; `write` renews what the next builds are compared with.
///
/// # Errors
/// If a record cannot be made, or a file of the comparison cannot be read or written.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let (small, write, names) = (context.is_small(), context.write, &context.named);
    let folder = folder();
    let mut cases = cases()?;
    let is_unknown = |name: &&String| cases.iter().all(|case| case.name != **name);
    if let Some(name) = names.iter().find(is_unknown) {
        return Err(format!("found no record `{name}`, expected one of cases.toml").into());
    }
    cases.retain(|case| (names.is_empty() || names.contains(&case.name)) && !(small && case.slow));
    let mut moves = Moves::read(&folder)?;
    let compared = cases.par_iter().map(|case| {
        let of_case = |error| format!("{}: {error}", case.name);
        let now = results::of(case).map_err(of_case)?;
        let before = results::renewed(&folder, case, &now, write).map_err(of_case)?;
        Ok(compared(&before, &now))
    });
    let compared: Vec<_> = compared.collect::<Result<_, Error>>()?;
    let (mut values, mut differ, mut may_differ) = (0, 0, 0);
    for (case, (count, differences)) in cases.iter().zip(compared) {
        values += count;
        for one in differences {
            let may = moves.allow(&case.name, &one.path);
            *(if may { &mut may_differ } else { &mut differ }) += 1;
            let said = if may { " (as it may)" } else { "" };
            println!("{}: {one}{said}", case.name);
        }
    }
    let whole = !small && names.is_empty();
    let least = if whole { RECORDS } else { 1 };
    let kinds = counted(cases.iter().map(|case| &case.kind));
    let states = counted(cases.iter().map(|case| &case.state));
    let all = format!("{}: {kinds}; {states}", cases.len());
    let compared = "records whose results are compared with those of an earlier build";
    let changed =
        "keys of them that differ and may not, by more than 1e-6 of their sigma or of themselves";
    let differ = Figure::at_most(changed, 0.0, f64::from(differ), "");
    let mut figures = vec![
        Figure::told(compared, &format!(">= {least}"), all, cases.len() >= least),
        // Not judged where results are renewed.
        differ.judged(!write),
        Figure::note("values compared", values.to_string()),
        Figure::note("keys that differ as they may", may_differ.to_string()),
    ];
    if whole {
        let name = "entries of moves.toml that nothing needs";
        figures.push(Figure::note(name, moves.unneeded().join("; ")));
        if write {
            moves::empty(&folder)?;
        }
    }
    Ok(figures)
}

/// How often each name occurs.
fn counted<'a>(names: impl Iterator<Item = &'a String>) -> String {
    let mut counts = BTreeMap::new();
    for name in names {
        *counts.entry(name).or_insert(0) += 1;
    }
    let counts = counts.iter().map(|(name, count)| format!("{count} {name}"));
    counts.collect::<Vec<_>>().join(", ")
}

/// The folder of the comparison.
fn folder() -> PathBuf {
    workspace().join("tests/data/before")
}

/// All cases.
pub(crate) fn cases() -> Result<Vec<Case>, Error> {
    let path = folder().join("cases.toml");
    let table = toml::from_str(&std::fs::read_to_string(&path)?);
    let mut table: BTreeMap<String, Vec<Case>> =
        table.map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(table.remove("case").unwrap_or_default())
}
