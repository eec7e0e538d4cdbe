//! Candidates: the members of the confidence sets with the onsets and time constants that fit best.

use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::{FittedPlatform, PLATFORM};
use gyrocal_diagnosis::{missing_input, selection};
use gyrocal_hypothesis::{HypothesisSet, Variant};
use nalgebra::DVector;

use crate::effect_columns::Times;
use crate::error::DesignError;
use crate::joint_unknowns::{Candidate, ConfidenceSet, JointUnknowns};
use crate::named_cause::{NamedCause, is_walk, row};
use crate::past::Past;
use crate::run_information::RunInformation;
use crate::set_comparison::{Comparison, stays};

/// Size of a near twin over its typical size beyond which it is not plausible.
const PLAUSIBLE: f64 = 10.0;

/// Onsets of the search for each step of a random walk: eight in a record and as many in the next run. A
/// plan asks whether a walk or an effect is likelier, not how large a walk is.
const WALK_ONSETS: usize = 5;

/// Durations of the records and of a next run.
pub(crate) fn times(past: &Past<'_>, next_s: f64) -> Times {
    let rows = past.rows();
    let set = HypothesisSet::new(&PLATFORM, &rows, &[]);
    Times {
        first_s: past.run().record.duration_s(),
        next_s,
        onsets_s: set
            .onset_rows()
            .iter()
            .skip(WALK_ONSETS / 2)
            .step_by(WALK_ONSETS)
            .map(|row| rows.since_first_s(*row))
            .collect(),
    }
}

/// The members of all confidence sets, each with its best shape in the record. Near twins outside the
/// default search are among them if they explain as much with a plausible size.
pub(crate) fn candidates(
    fitted: &FittedPlatform<'_>,
    past: &Past<'_>,
    named: &[NamedCause],
) -> Result<Vec<Vec<Candidate>>, DesignError> {
    let named: Vec<&NamedCause> = named.iter().filter(|named| !named.is_noise()).collect();
    let run = past.run();
    let times = times(past, run.record.duration_s());
    let mut drafts = Vec::with_capacity(named.len());
    for named in &named {
        drafts.push(draft(named, past, &times)?);
    }
    let unknowns = JointUnknowns::new(fitted, &run, &drafts, &times);
    let information = unknowns.of_first(&RunInformation::of_record(
        fitted,
        run.record,
        &unknowns.first,
    )?);
    let mut sets = Vec::with_capacity(named.len());
    for (case, named) in unknowns.cases.iter().zip(named) {
        sets.push(settled(case, named, &unknowns, &information));
    }
    Ok(sets)
}

/// All candidates: of an effect with an onset or a time constant one for each variant of the search.
fn draft(
    named: &NamedCause,
    past: &Past<'_>,
    times: &Times,
) -> Result<Vec<Candidate>, DesignError> {
    let run = past.run();
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
        .filter(|twin| missing_input(twin, run.record, run.bench).is_none());
    for twin in twins {
        if !rows.iter().any(|row| row.id == twin.id) {
            rows.push(twin);
        }
    }
    let also: Vec<&str> = rows.iter().map(|row| row.id).collect();
    let selection = selection(run.record, run.bench, &also);
    let set = HypothesisSet::new(&PLATFORM, &past.rows(), &selection.effects);
    let walk_size = named.shape.filter(|_| is_walk(own));
    let mut candidates = vec![Candidate {
        turn_on_sigmas: named.turn_on_sigmas.clone(),
        variance: walk_size.map_or(0.0, |size| times.variance_of_steps(size)),
        ..candidate(own, named.shape.filter(|_| !is_walk(own)))
    }];
    for row in rows {
        // What no run tells from one that is there already is one with it.
        if let Some(same) = candidates
            .iter_mut()
            .find(|other| other.row.equivalents.contains(&row.id))
        {
            if !same.equivalents.contains(&row.id) {
                same.equivalents.push(row.id);
            }
            continue;
        }
        let shapes = set.index_of(row.id).map_or_else(Vec::new, |index| {
            let variants = set.hypotheses()[index].variants().iter();
            variants.map(Variant::shape).collect()
        });
        if shapes.is_empty() {
            candidates.push(candidate(row, None));
        }
        candidates.extend(shapes.into_iter().map(|shape| candidate(row, shape)));
    }
    Ok(candidates)
}

fn candidate(row: &'static Effect, shape: Option<f64>) -> Candidate {
    Candidate {
        row,
        shape,
        deficit: 0.0,
        equivalents: row.equivalents.to_vec(),
        variance: 0.0,
        handicap: 0.0,
        turn_on_sigmas: Vec::new(),
    }
}

/// The best candidate of each effect, with the deficit of the diagnosis.
fn settled(
    case: &ConfidenceSet,
    named: &NamedCause,
    unknowns: &JointUnknowns,
    information: &RunInformation,
) -> Vec<Candidate> {
    let alone = |candidate: &Candidate| vec![candidate.clone()];
    let Some(own) = case.members.first() else {
        return Vec::new();
    };
    let Some(comparison) = Comparison::new(case, &unknowns.list, &information.information) else {
        return alone(&own.candidate);
    };
    let projected: DVector<f64> = &comparison.projection * &information.score;
    let statistics = comparison.statistics(projected.as_slice());
    let Some(Some((best, variance))) = statistics.first().copied() else {
        return alone(&own.candidate);
    };
    // The steps of a named walk have the variance that it was found with, if this test finds none.
    let variance = Some(variance).filter(|variance| *variance > 0.0);
    let mut set = vec![Candidate {
        variance: variance.unwrap_or(own.candidate.variance),
        ..own.candidate.clone()
    }];
    let mut seen: Vec<&str> = vec![own.candidate.row.id];
    for member in &case.members[1..] {
        let id = member.candidate.row.id;
        if seen.contains(&id) {
            continue;
        }
        seen.push(id);
        let of_it = case.members.iter().enumerate().zip(&statistics);
        let strongest = of_it
            .filter(|((_, other), _)| other.candidate.row.id == id)
            .filter_map(|((index, _), statistic)| Some((index, (*statistic)?)))
            .max_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let Some((index, (statistic, variance))) = strongest else {
            continue;
        };
        let told = named.rivals.iter().find(|(rival, _)| rival == id);
        let deficit = match told {
            Some((_, deficit)) => *deficit,
            None => {
                let row = member.candidate.row;
                let size = comparison.estimates(index, projected.as_slice());
                let [size, _] = size.first().copied().unwrap_or([0.0; 2]);
                let deficit = 0.5 * (best - statistic);
                if !stays(deficit) || size.abs() > PLAUSIBLE * row.typical_size {
                    continue;
                }
                deficit
            }
        };
        set.push(Candidate {
            deficit,
            variance,
            handicap: statistic - best + 2.0 * deficit,
            ..case.members[index].candidate.clone()
        });
    }
    set
}
