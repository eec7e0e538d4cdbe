//! Several records of one platform: diagnosed together, planned, and predicted from an earlier one.

pub(crate) mod later;
mod oracle;
pub(crate) mod planning;
pub(crate) mod several;

use gyrocal::effect::EffectKind;
use gyrocal_evaluation::{constant_of_channel, effect_of};
use gyrocal_truth::{Hidden, Scenario};

use crate::harness::Error;

/// The hidden effects of a scenario as they continue in a record that starts so long after: what has grown is a
/// constant then, and what happened at a time has left a constant or nothing.
fn continued(first: &Scenario, after_s: f64) -> Result<Vec<Hidden>, Error> {
    let days = after_s / 86_400.0;
    let mut all = Vec::new();
    for hidden in &first.hidden {
        let parameters = hidden.parameters();
        let size = parameters.first().map_or(0.0, |(_, size, _)| *size);
        let effect = effect_of(hidden.id()).ok_or("an effect that the catalogue lacks")?;
        let grown = match effect.kind {
            EffectKind::InitialState | EffectKind::StateJump => continue,
            EffectKind::Step => size,
            EffectKind::Ramp => size * days,
            _ => 0.0,
        };
        if effect.kind != EffectKind::Step {
            all.push(hidden.clone());
        }
        if grown != 0.0 {
            let constant = constant_of_channel(effect).ok_or("a change of no channel")?;
            all.push(Hidden::new(constant, &[("size", grown)])?);
        }
    }
    Ok(all)
}
