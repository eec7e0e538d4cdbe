//! The shortest run that reaches a goal.

use crate::error::DesignError;
use crate::evaluator::Evaluation;
use crate::planner::{FINE, Planner};
use crate::result::{Proposal, Reached};

/// The longest run that is considered, s: two months.
const LONGEST_S: f64 = 60.0 * 86_400.0;

/// Ratio of one considered duration to the one before.
const RATIO: f64 = core::f64::consts::SQRT_2;

/// The shortest run that reaches the goal, by halves: first from an attitude that is good for the
/// duration asked for, then from one that is good for the duration found.
pub(crate) fn reach(planner: &Planner<'_, '_>, first: [f64; 3]) -> Result<Reached, DesignError> {
    let mut ladder = vec![planner.least_s()];
    while let Some(last) = ladder.last()
        && last * RATIO < LONGEST_S
    {
        ladder.push(last * RATIO);
    }
    ladder.push(LONGEST_S);
    let mut found = None;
    let mut angles_deg = first;
    for _ in 0..2 {
        let Some(run) = shortest(planner, &ladder, angles_deg)? else {
            break;
        };
        let duration_s = run.duration_s;
        let shorter = found
            .as_ref()
            .is_none_or(|found: &Proposal| duration_s < found.duration_s);
        if shorter {
            found = Some(run);
        }
        match planner.search(duration_s)?.first() {
            Some(Proposal {
                angles_deg: Some(best),
                ..
            }) => angles_deg = *best,
            _ => break,
        }
    }
    Ok(Reached {
        wish: planner.options.goal.in_words().unwrap_or_default(),
        already: false,
        run: found,
        longest_s: LONGEST_S,
    })
}

/// The shortest duration of a ladder that reaches the goal from an attitude.
fn shortest(
    planner: &Planner<'_, '_>,
    ladder: &[f64],
    angles_deg: [f64; 3],
) -> Result<Option<Proposal>, DesignError> {
    let at = |duration_s: f64| {
        planner.with(duration_s, FINE, |evaluator| {
            Ok(match evaluator.evaluate(angles_deg)? {
                Evaluation::At(outlook) if planner.options.goal.is_met(&outlook) => {
                    Some(Proposal {
                        angles_deg: Some(angles_deg),
                        duration_s,
                        outlook,
                    })
                }
                _ => None,
            })
        })
    };
    let (mut low, mut high) = (0, ladder.len());
    let mut found = None;
    while low < high {
        let middle = usize::midpoint(low, high);
        match at(ladder[middle])? {
            Some(run) => {
                found = Some(run);
                high = middle;
            }
            None => low = middle + 1,
        }
    }
    Ok(found)
}
