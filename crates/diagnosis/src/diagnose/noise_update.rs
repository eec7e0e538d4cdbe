//! Search with the noise of the gyros as estimated, and the test of that noise.

use gyrocal::EFFECTS;
use gyrocal::effect::{EffectKind, NoiseProperty};
use gyrocal_calibration::{FittedPlatform, NoiseEstimate, NoiseModel, NoiseRatio, Run, rows};
use gyrocal_hypothesis::{Finding, FittedModel, SearchOptions, Searched, Selection, search};
use gyrocal_statistics::{NORMAL_97_5, two_sided_p};

use crate::error::DiagnosisError;
use crate::error_budget::{INSTRUMENTS, NOISE_UPDATE_Z};
use crate::noise::{Estimate, NoiseAudit, NoiseFinding};

/// Logarithms of noise that differ by less count as equal: a tenth of what three days determine.
const SAME_NOISE: f64 = 0.02;

/// Most rounds of noise and search: noise that a cause had raised falls when the cause is in the
/// model.
const MOST_ROUNDS: usize = 3;

/// A search with the noise that it assumed.
pub(super) struct NoiseUpdate<'a> {
    /// The nominal model, fitted with that noise.
    pub(super) nominal: FittedPlatform<'a>,
    /// The noise.
    pub(super) noise_model: NoiseModel,
    /// The search.
    pub(super) searched: Searched<FittedPlatform<'a>>,
    /// Maximum-likelihood noise over the assumed one, with all causes in the model.
    pub(super) estimate: NoiseEstimate,
}

/// Searches, and searches again with the noise of the gyros that the first search leaves, until it
/// changes no more.
pub(super) fn search_with_noise<'a>(
    mut nominal: FittedPlatform<'a>,
    mut noise_model: NoiseModel,
    run: &Run<'a>,
    selection: &Selection,
    options: &SearchOptions,
) -> Result<NoiseUpdate<'a>, DiagnosisError> {
    let search = |nominal: &FittedPlatform<'a>| {
        let rows = rows(run.record, nominal.covariates());
        search(nominal.clone(), rows, selection, options)
    };
    let mut searched = search(&nominal)?;
    let mut estimate = searched.fitted.noise()?;
    for _ in 1..MOST_ROUNDS {
        let gyro_ratio = gyro_ratio(&estimate, &noise_model);
        let changed = gyro_ratio
            .iter()
            .zip(noise_model.gyro_ratio)
            .any(|(new, old)| (new / old).ln().abs() > SAME_NOISE);
        if !changed {
            break;
        }
        let updated = NoiseModel {
            gyro_ratio,
            ..noise_model.clone()
        };
        // A mismatch that is no noise cannot always be fitted as noise: the search stands as it is.
        let Ok(refitted) = nominal.with_noise(run.bench, &updated) else {
            break;
        };
        (nominal, noise_model) = (refitted, updated);
        searched = search(&nominal)?;
        estimate = searched.fitted.noise()?;
    }
    Ok(NoiseUpdate {
        nominal,
        noise_model,
        searched,
        estimate,
    })
}

/// Logarithm of a ratio and its standard deviation.
fn logarithm(ratio: &NoiseRatio) -> (f64, f64) {
    let [low, high] = ratio.interval;
    (ratio.ratio.ln(), (high / low).ln() / (2.0 * NORMAL_97_5))
}

/// Gyro noise over the declared one that a search should assume; the estimate is over the noise
/// assumed before.
fn gyro_ratio(estimate: &NoiseEstimate, assumed: &NoiseModel) -> [f64; 3] {
    core::array::from_fn(|axis| {
        let (value, sigma) = logarithm(&estimate.gyro[axis]);
        let total = value + assumed.gyro_ratio[axis].ln();
        if total.abs() > NOISE_UPDATE_Z * sigma {
            total.exp()
        } else {
            1.0
        }
    })
}

/// Gyro noise that differs from the declared one, `alpha` being the false-alarm probability of all
/// three gyros. Nothing is reported of a gyro with a random walk, which looks like white noise
/// between the steps that it is modelled by, nor if the noise of the accelerometers is correlated:
/// the likelihood attributes the slow part of that to the gyros.
pub(super) fn gyro_noise_findings(
    estimate: &NoiseEstimate,
    assumed: &NoiseModel,
    audit: &NoiseAudit,
    causes: &[Finding],
    alpha: f64,
) -> Vec<NoiseFinding> {
    if audit.cleaned.correlation != 0.0 {
        return Vec::new();
    }
    let levels = EFFECTS
        .iter()
        .filter(|effect| effect.kind == EffectKind::Noise(NoiseProperty::Level))
        .filter_map(|effect| Some((effect, effect.rate()?)));
    levels
        .filter_map(|(effect, axis)| {
            let (value, sigma) = logarithm(&estimate.gyro[axis]);
            let total = value + assumed.gyro_ratio[axis].ln();
            let z = total / sigma;
            let p_value = (INSTRUMENTS * two_sided_p(z)).min(1.0);
            let walks = EFFECTS.iter().any(|walk| {
                walk.kind == EffectKind::RandomWalk
                    && walk.enters == effect.enters
                    && causes.iter().any(|cause| cause.effect == walk.id)
            });
            (p_value < alpha && !walks).then(|| NoiseFinding {
                effect: effect.id,
                parameters: vec![Estimate {
                    name: "ratio",
                    estimate: total.exp(),
                    sigma: total.exp() * sigma,
                    unit: "1",
                }],
                z,
                p_value,
            })
        })
        .collect()
}
