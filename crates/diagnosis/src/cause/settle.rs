//! After the search: what was found first may have another name beside what was found later, or be
//! explained by it.

use gyrocal_calibration::CalibrationError;

use super::finding::{Accepted, Finding, tell};
use super::null::Normals;
use super::refine::refined;
use super::score::Best;
use super::search::{MOST_EFFECTS, State, Task};

/// Exchanges names and takes out what explains too little, until nothing changes; what is then to
/// be said of each effect.
pub(super) fn settle(
    task: &Task<'_>,
    state: &mut State<'_>,
    threshold: f64,
    normals: &mut Normals,
) -> Result<Vec<Finding>, CalibrationError> {
    let mut exchanges = 0;
    loop {
        let mut findings = Vec::with_capacity(state.accepted.len());
        let mut weakest: Option<(usize, f64)> = None;
        let mut better: Option<(usize, Best, f64)> = None;
        for index in 0..state.accepted.len() {
            let State {
                stage, accepted, ..
            } = &*state;
            let told = tell(stage, &task.plan, task.record, accepted, index, normals)?;
            findings.push(told.finding);
            if weakest.is_none_or(|(_, least)| told.tested < least) {
                weakest = Some((index, told.tested));
            }
            if let Some((other, advantage)) = told.better
                && better.is_none_or(|(.., most)| advantage > most)
            {
                better = Some((index, other, advantage));
            }
        }
        // One alone was named beside nothing already.
        if let Some((index, other, _)) = better
            && state.accepted.len() > 1
            && exchanges < MOST_EFFECTS
        {
            exchanges += 1;
            // What cannot be fitted in its place leaves it there.
            if exchange(task, state, index, &other).is_ok() {
                continue;
            }
        }
        match weakest {
            Some((index, strength))
                if strength <= threshold && state.accepted.len() + state.unnamed.len() > 1 =>
            {
                state.accepted.remove(index);
                state.stage = task.stage(&state.stage.fitted, &state.accepted, &state.unnamed)?;
            }
            _ => return Ok(findings),
        }
    }
}

/// Puts another effect in the place of an accepted one. An error leaves all as it was.
fn exchange(
    task: &Task<'_>,
    state: &mut State<'_>,
    index: usize,
    other: &Best,
) -> Result<(), CalibrationError> {
    let mut accepted = state.accepted.clone();
    let own = accepted.remove(index);
    let without = task.fitted(&state.stage.fitted, &accepted, &state.unnamed)?;
    let exchanged = Accepted {
        family: other.family,
        shape: refined(&without, task.record, &task.plan, other)?,
        searched: other.searched,
        ..own
    };
    accepted.insert(index, exchanged);
    state.stage = task.stage(&without, &accepted, &state.unnamed)?;
    state.accepted = accepted;
    Ok(())
}
