//! Oracles of the diagnosis: searches that know more of the noise.

use gyrocal::Effect;
use gyrocal::effect::EffectKind;
use gyrocal_calibration::{NoiseModel, rows};
use gyrocal_diagnosis::{Diagnosis, selection};
use gyrocal_hypothesis::{Finding, FittedModel, SearchOptions, search};
use gyrocal_truth::Simulation;

use crate::error::EvaluationError;
use crate::injection::fit;

/// The confidence sets of the same search without random walks, each with its effects, the named one first: that of
/// an oracle that knows that no rate walks, and not the levels of the noise.
///
/// # Errors
/// Those of the fits of the search.
pub fn sets_without_walks(
    found: &Diagnosis<'_>,
    simulation: &Simulation,
) -> Result<Vec<Vec<&'static str>>, EvaluationError> {
    let mut noise = found.noise_model.clone();
    noise.gyro_walk_deg_per_h_per_sqrt_h = [0.0; 3];
    let walks = |effect: &Effect| effect.kind == EffectKind::RandomWalk;
    sets_in_noise(found, simulation, &noise, |effect| !walks(effect))
}

/// The confidence sets of the same search among some effects, in a noise that is known.
pub(crate) fn sets_in_noise(
    found: &Diagnosis<'_>,
    simulation: &Simulation,
    noise: &NoiseModel,
    among: impl Fn(&Effect) -> bool,
) -> Result<Vec<Vec<&'static str>>, EvaluationError> {
    let shares = found.result.false_alarm_shares.as_ref();
    let options = SearchOptions {
        false_alarm_probability: shares.map_or(0.0, |all| all.search),
        ..SearchOptions::default()
    };
    let mut selection = selection(&simulation.record, &simulation.bench, &[]);
    selection.effects.retain(|effect| among(effect));
    let nominal = fit(simulation, noise)?;
    let rows = rows(&simulation.record, nominal.covariates());
    let searched = search(nominal, rows, &selection, &options)?;
    let set = |finding: &Finding| {
        let others = finding.alternatives.iter().map(|other| other.effect);
        core::iter::once(finding.effect).chain(others).collect()
    };
    Ok(searched.findings.iter().map(set).collect())
}
