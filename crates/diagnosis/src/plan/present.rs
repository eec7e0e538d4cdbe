//! What the record so far says: who is suspected, and with which onset or time constant.

use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::{Extended, Run};
use gyrocal_record::Record;
use nalgebra::DVector;

use super::named::{Named, is_walk, row};
use super::said::Said;
use super::set::{Comparison, stays};
use super::signature::Times;
use super::universe::{Case, Suspect, Universe};
use crate::cause;
use crate::error::DiagnosisError;

/// A near twin that would have to be so many times its typical size is not worth a run.
const PLAUSIBLE: f64 = 10.0;

/// When the record is, and a next run of some duration.
pub(crate) fn times(run: &Run<'_>, next_s: f64) -> Times {
    let plan = cause::Plan::new(run.record, run.bench, &[]);
    let first_s = run.record.time_s.first().copied().unwrap_or(0.0);
    Times {
        first_s: duration_s(run.record),
        next_s,
        onsets_s: plan
            .onset_rows
            .iter()
            .map(|row| run.record.time_s[*row] - first_s)
            .collect(),
    }
}

pub(crate) fn duration_s(record: &Record) -> f64 {
    match record.time_s.as_slice() {
        [first, .., last] => last - first,
        _ => 0.0,
    }
}

/// The members of all named sets, each with what is best of it in the record. Near twins that the
/// usual search leaves out are among them, if they explain as much by a size that may be.
pub(crate) fn suspects(
    fitted: &Extended<'_>,
    run: &Run<'_>,
    named: &[Named],
) -> Result<Vec<Vec<Suspect>>, DiagnosisError> {
    let mut drafts = Vec::with_capacity(named.len());
    for named in named {
        drafts.push(draft(named, run)?);
    }
    let times = times(run, duration_s(run.record));
    let universe = Universe::new(fitted, run, &drafts, &times);
    let said = universe.of_first(&Said::of(fitted, run.record, &universe.first)?);
    let mut sets = Vec::with_capacity(named.len());
    for (case, named) in universe.cases.iter().zip(named) {
        sets.push(settled(case, named, &universe, &said));
    }
    Ok(sets)
}

/// All candidates: of effects with an onset or a time constant one for each that the search tries.
fn draft(named: &Named, run: &Run<'_>) -> Result<Vec<Suspect>, DiagnosisError> {
    let mut rows = Vec::with_capacity(named.rivals.len());
    for (id, _) in &named.rivals {
        rows.push(row(id)?);
    }
    let own = named.row()?;
    let twins = own
        .near_twins
        .iter()
        .filter_map(|id| EFFECTS.iter().find(|effect| effect.id == *id))
        .filter(|twin| !twin.default_search && twin.has_term() && twin.shape().is_none())
        .filter(|twin| cause::missing(twin, run.record, run.bench).is_none());
    for twin in twins {
        if !rows.iter().any(|row| row.id == twin.id) {
            rows.push(twin);
        }
    }
    let also: Vec<&str> = rows.iter().map(|row| row.id).collect();
    let plan = cause::Plan::new(run.record, run.bench, &also);
    let mut suspects = vec![suspect(own, named.shape.filter(|_| !is_walk(own)))];
    for row in rows {
        // What no run tells from one that is there already is one with it.
        if let Some(same) = suspects
            .iter_mut()
            .find(|other| other.row.equivalents.contains(&row.id))
        {
            if !same.equivalents.contains(&row.id) {
                same.equivalents.push(row.id);
            }
            continue;
        }
        let family = plan.families.iter().find(|family| family.id() == row.id);
        let shapes = family.map_or_else(Vec::new, |family| {
            let shapes = family.candidates.iter().map(|candidate| candidate.shape);
            shapes.collect()
        });
        if shapes.is_empty() {
            suspects.push(suspect(row, None));
        }
        suspects.extend(shapes.into_iter().map(|shape| suspect(row, shape)));
    }
    Ok(suspects)
}

fn suspect(row: &'static Effect, shape: Option<f64>) -> Suspect {
    Suspect {
        row,
        shape,
        deficit: 0.0,
        equivalents: row.equivalents.to_vec(),
        variance: 0.0,
        handicap: 0.0,
    }
}

/// The best candidate of each, with what the diagnosis said of it.
fn settled(case: &Case, named: &Named, universe: &Universe, said: &Said) -> Vec<Suspect> {
    let alone = |suspect: &Suspect| vec![suspect.clone()];
    let Some(own) = case.members.first() else {
        return Vec::new();
    };
    let Some(comparison) = Comparison::new(case, &universe.unknowns, &said.information) else {
        return alone(&own.suspect);
    };
    let projected: DVector<f64> = &comparison.projection * &said.score;
    let statistics = comparison.statistics(projected.as_slice());
    let Some(Some((best, variance))) = statistics.first().copied() else {
        return alone(&own.suspect);
    };
    let mut set = vec![Suspect {
        variance,
        ..own.suspect.clone()
    }];
    let mut seen: Vec<&str> = vec![own.suspect.row.id];
    for member in &case.members[1..] {
        let id = member.suspect.row.id;
        if seen.contains(&id) {
            continue;
        }
        seen.push(id);
        let of_it = case.members.iter().enumerate().zip(&statistics);
        let strongest = of_it
            .filter(|((_, other), _)| other.suspect.row.id == id)
            .filter_map(|((index, _), statistic)| Some((index, (*statistic)?)))
            .max_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let Some((index, (statistic, variance))) = strongest else {
            continue;
        };
        let told = named.rivals.iter().find(|(rival, _)| rival == id);
        let deficit = match told {
            Some((_, deficit)) => *deficit,
            None => {
                let row = member.suspect.row;
                let size = comparison.estimates(index, projected.as_slice());
                let [size, _] = size.first().copied().unwrap_or([0.0; 2]);
                let deficit = 0.5 * (best - statistic);
                if !stays(deficit) || size.abs() > PLAUSIBLE * row.typical_size {
                    continue;
                }
                deficit
            }
        };
        set.push(Suspect {
            deficit,
            variance,
            handicap: statistic - best + 2.0 * deficit,
            ..case.members[index].suspect.clone()
        });
    }
    set
}
