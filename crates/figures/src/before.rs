//! Results of 40 records before and after a change: every key of what the commands write.
//!
//! `tests/data/before` has the records (`cases.toml`, `inputs`), what an earlier build wrote of each
//! (`results`), and what may change at which step (`moves.toml`).

mod compare;
mod moves;
mod records;
mod results;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Instant;

use gyrocal_testkit::workspace;
use rayon::prelude::*;
use serde::Deserialize;

use crate::error::Error;
use crate::figure::Figure;
use crate::harness::Context;
use compare::compared;
use moves::Moves;

pub(crate) use results::as_command;

/// Number of records.
const RECORDS: usize = 40;

/// A record, and the commands whose results are compared.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Case {
    name: String,
    /// Platform, strapdown unit, several records of one, plant, or log of instruments.
    kind: String,
    /// Clean, faulty, set-up wrong, or cut: too short, or with a search that ends at its budget.
    state: String,
    /// Takes seconds; left out of the small version.
    #[serde(default)]
    slow: bool,
    /// What makes its files: lines of [`records::make`].
    #[serde(default)]
    make: Vec<String>,
    /// Commands, with the words of [`gyrocal_testkit::contracts::words`].
    run: Vec<String>,
}

/// The figures of the comparison; differences are printed before them. The small version leaves out slow records.
/// With names, only these records are compared; `write` renews what the next builds are compared with.
///
/// # Errors
/// If a record cannot be made, or a file of the comparison cannot be read or written.
pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let (small, write, names) = (context.is_small(), context.write, &context.named);
    let folder = folder();
    let mut cases = table(&folder)?;
    if let Some(name) = names
        .iter()
        .find(|name| cases.iter().all(|case| case.name != **name))
    {
        return Err(format!("found no record `{name}`, expected one of cases.toml").into());
    }
    cases.retain(|case| (names.is_empty() || names.contains(&case.name)) && !(small && case.slow));
    let mut moves = Moves::read(&folder)?;
    let compared = cases.par_iter().map(|case| {
        let began = Instant::now();
        let of_case = |error| format!("{}: {error}", case.name);
        let now = results::of(case).map_err(of_case)?;
        let before = results::renewed(&folder, case, &now, write).map_err(of_case)?;
        Ok((compared(&before, &now), began.elapsed().as_secs_f64()))
    });
    let compared: Vec<_> = compared.collect::<Result<_, Error>>()?;
    let (mut values, mut differ, mut may_differ) = (0, 0, 0);
    let mut seconds = Vec::new();
    for (case, ((count, differences), time_s)) in cases.iter().zip(compared) {
        values += count;
        seconds.push((time_s, &*case.name));
        for one in differences {
            let may = moves.allow(&case.name, &one.path);
            *(if may { &mut may_differ } else { &mut differ }) += 1;
            println!(
                "{}: {one}{}",
                case.name,
                if may { " (as it may)" } else { "" }
            );
        }
    }
    seconds.sort_by(|one, other| other.0.total_cmp(&one.0));
    let longest = seconds.iter().take(5);
    let longest: Vec<String> = longest
        .map(|(time_s, name)| format!("{name} {time_s:.1}"))
        .collect();
    let whole = !small && names.is_empty();
    let mut figures = vec![
        number_of(&cases, whole),
        number_that(differ, write),
        Figure::note("values compared", values.to_string()),
        Figure::note("keys that differ as they may", may_differ.to_string()),
        Figure::note("longest of the records, s", longest.join(", ")),
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

/// The records, of each kind and in each state.
fn number_of(cases: &[Case], whole: bool) -> Figure {
    let of = |key: fn(&Case) -> &str| {
        let mut counts = BTreeMap::new();
        for case in cases {
            *counts.entry(key(case)).or_insert(0) += 1;
        }
        let counts = counts.iter().map(|(name, count)| format!("{count} {name}"));
        counts.collect::<Vec<_>>().join(", ")
    };
    let name = "records whose results are compared with those of an earlier build";
    let least = if whole { RECORDS } else { 1 } as f64;
    let measured = format!(
        "{}: {}; {}",
        cases.len(),
        of(|case| &case.kind),
        of(|case| &case.state)
    );
    Figure {
        measured,
        ..Figure::within(name, [least, f64::INFINITY], cases.len() as f64)
    }
}

/// The keys that differ and may not; not judged where results are renewed.
fn number_that(differ: usize, write: bool) -> Figure {
    let name =
        "keys of them that differ and may not, by more than 1e-6 of their sigma or of themselves";
    let figure = Figure::within(name, [0.0, 0.0], differ as f64);
    Figure {
        target: "0".to_owned(),
        measured: differ.to_string(),
        holds: figure.holds.filter(|_| !write),
        ..figure
    }
}

/// The folder of the comparison.
fn folder() -> PathBuf {
    workspace().join("tests/data/before")
}

/// All cases.
fn table(folder: &Path) -> Result<Vec<Case>, Error> {
    let path = folder.join("cases.toml");
    let table = toml::from_str(&std::fs::read_to_string(&path)?);
    let mut table: BTreeMap<String, Vec<Case>> =
        table.map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(table.remove("case").unwrap_or_default())
}
