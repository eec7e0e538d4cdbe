//! Random walks of a model as findings.

use gyrocal_scalar::effect::Effect;

use crate::finding::{EffectEstimate, Finding};
use crate::model::FittedModel;
use crate::state::SearchState;
use crate::walk_candidates::{Candidates, Needed};

/// The walks of a model that are named. The one that gains most has the p-value of the test of all walks together;
/// another one, what it gains beside the others in the model, by the distribution of that test; beside effects it
/// was not computed.
pub(crate) fn named<F: FittedModel>(
    candidates: &Candidates,
    state: &SearchState<F>,
    walks: Vec<Needed>,
    p_value: f64,
) -> Result<Vec<(Needed, Finding)>, F::Error> {
    let sizes = &state.stage.noise.noise.walk;
    let intervals = state.stage.fitted.walk_intervals()?;
    let most = walks.iter().map(|walk| walk.gain).fold(0.0, f64::max);
    let finding = |walk: Needed| {
        let p_value = match walk.gain < most {
            true => p_value.max(candidates.p_value(walk.gain)),
            false => p_value,
        };
        // It is that of walks without effects.
        let p_value = state.accepted.is_empty().then_some(p_value);
        let interval = intervals.get(walk.rate).copied().flatten();
        let finding = walk_finding(
            walk.effect,
            sizes[walk.rate],
            interval,
            (walk.gain, p_value),
        );
        (walk, finding)
    };
    Ok(walks.into_iter().map(finding).collect())
}

fn walk_finding(
    effect: &'static Effect,
    size: f64,
    interval: Option<[f64; 2]>,
    (gain, p_value): (f64, Option<f64>),
) -> Finding {
    let parameters = effect.parameters.first().map(|parameter| EffectEstimate {
        name: parameter.name,
        estimate: size,
        sigma: None,
        interval: interval.map(|ends| vec![ends]),
        unit: parameter.unit,
    });
    Finding {
        effect: effect.id,
        parameters: parameters.into_iter().collect(),
        z: gain.max(0.0).sqrt(),
        p_value,
        alternatives: Vec::new(),
        exact_equivalents: Vec::new(),
        none_of_these: None,
    }
}
