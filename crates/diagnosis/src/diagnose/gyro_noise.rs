//! Noise of the instruments over the declared noise, and the test of the gyros' noise.

use gyrocal::EFFECTS;
use gyrocal::effect::{EffectKind, NoiseProperty};
use gyrocal_calibration::{CalibrationError, FittedPlatform, NoiseEstimate, NoiseRatio};
use gyrocal_statistics::{NORMAL_97_5, two_sided_p};

use crate::error_budget::INSTRUMENTS;
use crate::noise::{Estimate, NoiseAudit, NoiseFinding};

/// Noise at the largest likelihood over the declared noise.
pub(super) fn over_declared(fit: &FittedPlatform<'_>) -> Result<NoiseEstimate, CalibrationError> {
    let believed = fit.noise_model();
    let estimate = fit.noise()?;
    let scaled = |found: [NoiseRatio; 3], believed: [f64; 3]| {
        core::array::from_fn(|axis| NoiseRatio {
            ratio: found[axis].ratio * believed[axis],
            interval: found[axis].interval.map(|end| end * believed[axis]),
        })
    };
    Ok(NoiseEstimate {
        accel: scaled(estimate.accel, believed.accel_ratio),
        gyro: scaled(estimate.gyro, believed.gyro_ratio),
    })
}

/// Logarithm of a ratio and its standard deviation.
fn logarithm(ratio: &NoiseRatio) -> (f64, f64) {
    let [low, high] = ratio.interval;
    (ratio.ratio.ln(), (high / low).ln() / (2.0 * NORMAL_97_5))
}

/// Gyro noise that differs from the declared one, `alpha` being the false-alarm probability of all
/// three gyros; the `estimate` is over the declared noise. Nothing is reported if the noise of the
/// accelerometers is correlated: the likelihood attributes the slow part of that to the gyros.
pub(super) fn gyro_noise_findings(
    estimate: &NoiseEstimate,
    audit: &NoiseAudit,
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
            let z = value / sigma;
            let p_value = (INSTRUMENTS * two_sided_p(z)).min(1.0);
            (p_value < alpha).then(|| NoiseFinding {
                effect: effect.id,
                parameters: vec![Estimate {
                    name: "ratio",
                    estimate: value.exp(),
                    sigma: value.exp() * sigma,
                    unit: "1",
                }],
                z,
                p_value,
            })
        })
        .collect()
}
