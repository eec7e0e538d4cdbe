//! An oracle of the diagnosis: a search that knows that no rate walks, and not the levels of the noise.

use gyrocal::effect::EffectKind;
use gyrocal_calibration::{FittedPlatform, Options, Run, rows};
use gyrocal_diagnosis::{Diagnosis, selection};
use gyrocal_hypothesis::{Finding, FittedModel, SearchOptions, search};
use gyrocal_truth::Simulation;

use crate::error::EvaluationError;

/// The confidence sets of the same search without random walks, each with its effects, the named one first.
///
/// # Errors
/// Those of the fits of the search.
pub fn sets_without_walks(
    found: &Diagnosis<'_>,
    simulation: &Simulation,
) -> Result<Vec<Vec<&'static str>>, EvaluationError> {
    let options = SearchOptions {
        false_alarm_probability: found.result.false_alarm_shares.search,
        ..SearchOptions::default()
    };
    let (record, bench) = (&simulation.record, &simulation.bench);
    let mut selection = selection(record, bench, &[]);
    selection
        .effects
        .retain(|effect| effect.kind != EffectKind::RandomWalk);
    let run = Run { record, bench };
    let mut noise = found.noise_model.clone();
    noise.gyro_walk_deg_per_h_per_sqrt_h = [0.0; 3];
    let nominal = FittedPlatform::nominal(&run, &Options::default(), &noise)?;
    let rows = rows(record, nominal.covariates());
    let searched = search(nominal, rows, &selection, &options)?;
    let set = |finding: &Finding| {
        let others = finding.alternatives.iter().map(|other| other.effect);
        core::iter::once(finding.effect).chain(others).collect()
    };
    Ok(searched.findings.iter().map(set).collect())
}
