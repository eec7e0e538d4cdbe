//! The set of an oracle for records of one platform: it knows the noise, the hidden cause and its size.

use gyrocal_calibration::{FittedPlatform, NoiseModel, Options};
use gyrocal_evaluation::{
    EvaluationError, InjectedEffect, ProjectedScores, SignatureColumns, run_of, same_or_equivalent,
    testable_effects,
};
use gyrocal_hypothesis::CONFIDENCE_SET_DEVIANCE;
use gyrocal_statistics::normal_probability;
use gyrocal_truth::{Scenario, Simulation};
use nalgebra::DVector;

/// Expected number of effects in the set: the cause, and those whose likelihood comes within the deviance of
/// a set. To an effect with the cosine c to a cause of d standard deviations d²(1 − c²) is lacking on
/// average, with twice the root of that for its standard deviation. Effects with an onset or a time constant
/// are left out, and so is all but the first of effects that are one but for their names. `None` if the
/// records do not show the cause.
///
/// The information is that of the simulation's true noise, with signatures that share no code with the search.
pub(super) fn set_size(
    scenario: &Scenario,
    simulations: &[Simulation],
    injected: &InjectedEffect,
) -> Result<Option<f64>, EvaluationError> {
    let noise = NoiseModel::default();
    let fit = |one| FittedPlatform::nominal(&run_of(one), &Options::default(), &noise);
    let fits: Vec<FittedPlatform<'_>> = simulations.iter().map(fit).collect::<Result<_, _>>()?;
    let benches: Vec<_> = simulations.iter().map(|one| &one.bench).collect();
    let scores = ProjectedScores::new(&FittedPlatform::joined(&fits, &benches)?, &[])?;
    let Some(first) = simulations.first() else {
        return Ok(None);
    };
    // Those of terms are parameters of the catalogue: no further columns.
    let mut columns = SignatureColumns::default();
    let Some(own) = columns.signature(injected.effect, &first.record, None) else {
        return Ok(None);
    };
    let sizes = DVector::from_column_slice(&injected.sizes);
    let strength = (scores.product(&own, &own) * &sizes).dot(&sizes).sqrt();
    if !scores.observes(&own) || strength <= 0.0 {
        return Ok(None);
    }
    let mut size = 1.0;
    let mut counted = vec![injected.effect.id];
    for other in testable_effects(scenario) {
        let mut known = counted.iter();
        let is_counted = known.any(|known| same_or_equivalent(known, other.id));
        if is_counted || !other.has_term() || other.shape().is_some() {
            continue;
        }
        let Some(signature) = columns.signature(other, &first.record, None) else {
            continue;
        };
        counted.push(other.id);
        let cosine = scores.cosine(&own, &injected.sizes, &signature);
        let lacks = strength * (1.0 - cosine * cosine).max(0.0).sqrt();
        size += match lacks > 0.0 {
            true => normal_probability((CONFIDENCE_SET_DEVIANCE - lacks * lacks) / (2.0 * lacks)),
            false => 1.0,
        };
    }
    Ok(Some(size))
}
