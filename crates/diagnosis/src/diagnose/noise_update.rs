//! Search with the noise of the gyros as estimated, and the test of that noise.

use gyrocal::EFFECTS;
use gyrocal::effect::{EffectKind, NoiseProperty};
use gyrocal_calibration::{FittedPlatform, NoiseEstimate, NoiseModel, NoiseRatio, Run, rows};
use gyrocal_hypothesis::{Finding, FittedModel, SearchOptions, Searched, Selection, search};
use gyrocal_statistics::{NORMAL_97_5, two_sided_p};

use crate::error::DiagnosisError;
use crate::error_budget::{GYRO_NOISE_PRIOR_SIGMA, INSTRUMENTS};
use crate::noise::{Estimate, NoiseAudit, NoiseFinding};

/// Change of the logarithm of a noise, in its standard deviations, beyond which a search is made again.
const CHANGED: f64 = 0.5;

/// Most searches: noise that a cause had raised falls when the cause is in the model.
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

/// Searches with the noise of the gyros that the nominal fit gives, and again with that of the fit with
/// all causes if it differs.
pub(super) fn search_with_noise<'a>(
    mut nominal: FittedPlatform<'a>,
    mut noise_model: NoiseModel,
    run: &Run<'a>,
    selection: &Selection,
    options: &SearchOptions,
) -> Result<NoiseUpdate<'a>, DiagnosisError> {
    let mut believed = GyroNoise::new(&nominal.noise()?, &noise_model);
    let mut round = 0;
    loop {
        let updated = NoiseModel {
            gyro_ratio: believed.ratio(),
            ..noise_model.clone()
        };
        // A mismatch that is no noise cannot always be fitted as noise: the last noise then stands.
        if let Ok(refitted) = nominal.with_noise(run.bench, &updated) {
            (nominal, noise_model) = (refitted, updated);
        }
        let rows = rows(run.record, nominal.covariates());
        let options = SearchOptions {
            // Later noise is that of a model with the causes.
            rate_degrees: if round == 0 {
                believed.degrees.to_vec()
            } else {
                Vec::new()
            },
            ..options.clone()
        };
        let searched = search(nominal.clone(), rows, selection, &options)?;
        let estimate = searched.fitted.noise()?;
        let next = GyroNoise::new(&estimate, &noise_model);
        round += 1;
        if round == MOST_ROUNDS || !next.differs(&noise_model) {
            return Ok(NoiseUpdate {
                nominal,
                noise_model,
                searched,
                estimate,
            });
        }
        believed = next;
    }
}

/// Logarithm of a ratio and its standard deviation.
fn logarithm(ratio: &NoiseRatio) -> (f64, f64) {
    let [low, high] = ratio.interval;
    (ratio.ratio.ln(), (high / low).ln() / (2.0 * NORMAL_97_5))
}

/// Logarithm of the noise of each gyro over the declared one, given the record and the prior.
struct GyroNoise {
    mean: [f64; 3],
    sigma: [f64; 3],
    /// Effective degrees of freedom of the estimated variance.
    degrees: [f64; 3],
}

impl GyroNoise {
    /// From the maximum-likelihood estimate over the `assumed` noise.
    fn new(estimate: &NoiseEstimate, assumed: &NoiseModel) -> Self {
        let mut noise = Self {
            mean: [0.0; 3],
            sigma: [0.0; 3],
            degrees: [f64::INFINITY; 3],
        };
        for axis in 0..3 {
            let (value, sigma) = logarithm(&estimate.gyro[axis]);
            let total = value + assumed.gyro_ratio[axis].ln();
            let weight =
                GYRO_NOISE_PRIOR_SIGMA.powi(2) / (GYRO_NOISE_PRIOR_SIGMA.powi(2) + sigma.powi(2));
            // An unobservable noise has an infinite interval: the prior stands.
            if weight > 0.0 {
                noise.mean[axis] = weight * total;
                // The variance of ln χ²(ν)/2 is 1/(2ν).
                noise.degrees[axis] = 0.5 / (sigma * sigma) / weight;
            }
            noise.sigma[axis] = GYRO_NOISE_PRIOR_SIGMA * (1.0 - weight).sqrt();
        }
        noise
    }

    fn ratio(&self) -> [f64; 3] {
        self.mean.map(f64::exp)
    }

    /// Whether it differs from the assumed noise.
    fn differs(&self, assumed: &NoiseModel) -> bool {
        (0..3).any(|axis| {
            let change = self.mean[axis] - assumed.gyro_ratio[axis].ln();
            change.abs() > CHANGED * self.sigma[axis]
        })
    }
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
