//! The search forward: one cause after the other, with a full fit after each that is found.

use core::mem;

use gyrocal_calibration::CalibrationError;

use super::family::{Family, equivalent_to};
use super::finding::Accepted;
use super::knock;
use super::null::{Normals, Null};
use super::refine::refined;
use super::score::{Best, RICHER, Ranked, Scores};
use super::search::{MOST_EFFECTS, State, Task};
use super::unnamed::{self, Unnamed};

/// What the first test said.
#[derive(Default)]
pub(super) struct Tested {
    /// All families, largest first.
    pub(super) ranking: Vec<Ranked>,
    /// What their largest statistic must exceed.
    pub(super) threshold: f64,
}

/// When a random walk may be named: it goes where several other causes lead, too.
enum Walks<'a> {
    /// Not before those were looked for.
    Wait,
    /// They are being looked for.
    Left(Box<Walking<'a>>),
    /// Now.
    Take,
}

/// Where a search stood when a random walk would have been named.
struct Walking<'a> {
    /// What the walk explains, as it compares with other causes.
    score: f64,
    threshold: f64,
    state: State<'a>,
}

impl Walking<'_> {
    /// What was found instead explains: twice the logarithm of the likelihood, less what searching
    /// reaches and, for each cause but the first, what one must reach. `None` if there are not
    /// several, as one alone has been compared with the walk before, or not without what has no
    /// name.
    fn instead(&self, state: &State<'_>) -> Option<f64> {
        let found = &state.accepted[self.state.accepted.len()..];
        if found.len() < 2 || state.unnamed.len() > self.state.unnamed.len() {
            return None;
        }
        let penalties: f64 = found.iter().map(|accepted| accepted.penalty).sum();
        let more = (found.len() - 1) as f64 * self.threshold;
        let gained = self.state.stage.fitted.cost() - state.stage.fitted.cost();
        Some(gained - penalties - more)
    }
}

/// Until nothing more is found.
pub(super) fn forward<'a>(
    task: &Task<'_>,
    mut state: State<'a>,
    normals: &mut Normals,
) -> Result<(State<'a>, Tested), CalibrationError> {
    let mut first: Option<Tested> = None;
    let mut walks = Walks::Wait;
    loop {
        let families = families(task, &state, &walks);
        let null = Null::draw(&state.stage.bank, &families, normals);
        let jumps = state.stage.fitted.jumps()?;
        let knock = knock::best(&jumps, task.record);
        let scores = Scores::of(&state.stage.bank, &families, &null, knock);
        let threshold = null.threshold(task.options.false_alarm_probability);
        first.get_or_insert_with(|| Tested {
            ranking: scores.ranking(&families),
            threshold,
        });
        let best = scores
            .named(&families)
            .filter(|_| scores.largest() > threshold && state.accepted.len() < MOST_EFFECTS);
        let is_walk = best.is_some_and(|best| families[best.family].walk.is_some());
        // What the catalogue has no name for goes into the model without one: if nothing else is
        // there, or if it explains so much more that a name would be a false one. A random walk
        // would swallow any curve.
        let stands = |other: &Unnamed| {
            let explains_more = |best: Best| {
                // Several causes together look like a line of the day.
                !other.is_of_the_day(task.record)
                    && other.equivalent() > scores.penalised(best.family) + RICHER
            };
            other.ln_probability < task.options.unnamed_probability.ln()
                && best.is_none_or(explains_more)
        };
        // Of what bends or switches with a force, a polynomial or one knock takes up most.
        let curves = is_walk
            || !state.accepted.is_empty()
            || best.is_none_or(|best| families[best.family].knock);
        if state.seeking
            && state.unnamed.len() < MOST_EFFECTS
            && let Some(other) =
                unnamed::strongest(&state.stage.fitted, task.record, &jumps, curves, stands)?
            && take_unnamed(task, &mut state, other)
        {
            continue;
        }
        match (best, mem::replace(&mut walks, Walks::Take)) {
            (None, Walks::Left(walking)) => {
                let instead = walking.instead(&state);
                if instead.is_none_or(|instead| instead < walking.score) {
                    state = walking.state;
                }
            }
            (None, _) => return Ok((state, first.unwrap_or_default())),
            (Some(best), Walks::Wait) if is_walk => {
                walks = Walks::Left(Box::new(Walking {
                    score: scores.penalised(best.family) - RICHER,
                    threshold,
                    state: state.clone(),
                }));
            }
            (Some(best), as_before) => {
                walks = as_before;
                let accepted = Accepted {
                    family: best.family,
                    shape: refined(&state.stage.fitted, task.record, &task.plan, &best)?,
                    p_value: null.probability(scores.largest()),
                    searched: best.searched,
                    penalty: best.searched + null.penalties[best.family],
                };
                take(task, &mut state, accepted);
            }
        }
    }
}

/// What is not in the model, and can be told from what is.
fn families(task: &Task<'_>, state: &State<'_>, walks: &Walks<'_>) -> Vec<Family> {
    let accepted = state.accepted.iter().map(|accepted| accepted.family);
    let taken: Vec<usize> = accepted.chain(state.inseparable.iter().copied()).collect();
    let without_walks = matches!(walks, Walks::Left(_));
    let all = task.plan.families.iter().enumerate();
    all.map(|(index, family)| {
        let taken = taken.contains(&index) || equivalent_to(&task.plan, index, &taken);
        family.unless(taken || without_walks && family.walk.is_some())
    })
    .collect()
}

/// Puts an effect into the model. What cannot be fitted beside the others cannot be told from them.
fn take(task: &Task<'_>, state: &mut State<'_>, accepted: Accepted) {
    let family = accepted.family;
    state.accepted.push(accepted);
    match task.stage(&state.stage.fitted, &state.accepted, &state.unnamed) {
        Ok(next) => state.stage = next,
        Err(_) => {
            state.accepted.pop();
            state.inseparable.push(family);
        }
    }
}

/// Puts what has no name into the model; whether it could be fitted. If not, it is left to the tests
/// of what remains.
fn take_unnamed(task: &Task<'_>, state: &mut State<'_>, other: Unnamed) -> bool {
    state.unnamed.push(other);
    match task.stage(&state.stage.fitted, &state.accepted, &state.unnamed) {
        Ok(next) => {
            state.stage = next;
            true
        }
        Err(_) => {
            state.unnamed.pop();
            state.seeking = false;
            false
        }
    }
}
