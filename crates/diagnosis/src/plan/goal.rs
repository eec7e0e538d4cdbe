//! What a run is to reach, and the shortest that does.

use gyrocal::generated::platform::DRIFT;

use super::error::PlanError;
use super::evaluate::Looked;
use super::outlook::Outlook;
use super::proposal::{FINE, Planner, Proposal};

/// A set counts as resolved if one member is left with this probability.
const RESOLVED: f64 = 0.95;

/// The longest run that is looked at, s: two months.
const LONGEST_S: f64 = 60.0 * 86_400.0;

/// Durations that are looked at are so many times the one before.
const RATIO: f64 = core::f64::consts::SQRT_2;

/// What a run is to reach; nothing by default.
#[derive(Clone, Debug, PartialEq, Default)]
pub struct Goal {
    /// Coefficients by id, with the standard deviation that each is to have at most.
    pub sigmas: Vec<(String, f64)>,
    /// Whether one name is to be left of every set, with a probability of 95 %.
    pub one_name: bool,
}

/// What was found for a goal.
#[derive(Clone, Debug, PartialEq)]
pub struct Reached {
    /// The run; `None` if none that was looked at reaches the goal.
    pub run: Option<Proposal>,
    /// The longest that was looked at, s.
    pub longest_s: f64,
}

impl Goal {
    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sigmas.is_empty() && !self.one_name
    }

    pub(crate) fn check(&self) -> Result<(), PlanError> {
        for (name, _) in &self.sigmas {
            if !DRIFT.iter().any(|coefficient| coefficient.id == name) {
                let known: Vec<&str> = DRIFT.iter().map(|coefficient| coefficient.id).collect();
                return Err(PlanError::UnknownCoefficient {
                    name: name.clone(),
                    known: known.join(", "),
                });
            }
        }
        Ok(())
    }

    fn is_met(&self, outlook: &Outlook) -> bool {
        let small = self.sigmas.iter().all(|(name, wanted)| {
            let mut found = outlook.coefficients.iter();
            found.any(|coefficient| coefficient.name == *name && coefficient.sigma <= *wanted)
        });
        let resolved = outlook.sets.iter().all(|set| set.one_left >= RESOLVED);
        small && (resolved || !self.one_name)
    }
}

/// The shortest run that reaches the goal, by halves: first from an attitude that is good for the
/// duration asked for, then from one that is good for the duration found.
pub(crate) fn reach(planner: &Planner<'_, '_>, first: [f64; 3]) -> Result<Reached, PlanError> {
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
        run: found,
        longest_s: LONGEST_S,
    })
}

/// The shortest duration of a ladder that reaches the goal from an attitude.
fn shortest(
    planner: &Planner<'_, '_>,
    ladder: &[f64],
    angles_deg: [f64; 3],
) -> Result<Option<Proposal>, PlanError> {
    let at = |duration_s: f64| {
        planner.with(duration_s, FINE, |setting| {
            Ok(match setting.look(angles_deg)? {
                Looked::At(outlook) if planner.options.goal.is_met(&outlook) => Some(Proposal {
                    angles_deg: Some(angles_deg),
                    duration_s,
                    outlook,
                }),
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
