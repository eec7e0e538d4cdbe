//! What a run is to reach, and the shortest that does.

use gyrocal::generated::platform::DRIFT;

use crate::error::DesignError;
use crate::evaluator::Evaluation;
use crate::result::{Outlook, Proposal, Reached};
use crate::search::{FINE, Planner};

/// A set counts as resolved if one member is left with this probability.
const RESOLVED: f64 = 0.95;

/// The longest run that is looked at, s: two months.
pub(crate) const LONGEST_S: f64 = 60.0 * 86_400.0;

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

impl Goal {
    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.sigmas.is_empty() && !self.one_name
    }

    pub(crate) fn check(&self) -> Result<(), DesignError> {
        for (name, _) in &self.sigmas {
            if !DRIFT.iter().any(|coefficient| coefficient.id == name) {
                let known: Vec<&str> = DRIFT.iter().map(|coefficient| coefficient.id).collect();
                return Err(DesignError::UnknownCoefficient {
                    name: name.clone(),
                    known: known.join(", "),
                });
            }
        }
        Ok(())
    }

    /// The goal in words; `None` if there is none.
    #[must_use]
    pub fn in_words(&self) -> Option<String> {
        let sigmas = self.sigmas.iter();
        let sigmas = sigmas.map(|(id, sigma)| format!("a sigma of {id} of at most {sigma:e}"));
        let one_name = self
            .one_name
            .then(|| "one member in each confidence set with a probability of 95 %".to_owned());
        let wishes: Vec<String> = sigmas.chain(one_name).collect();
        (!wishes.is_empty()).then(|| wishes.join(" and "))
    }

    pub(crate) fn is_met(&self, outlook: &Outlook) -> bool {
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
            Ok(match evaluator.look(angles_deg)? {
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
