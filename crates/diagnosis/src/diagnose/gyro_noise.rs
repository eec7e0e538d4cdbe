//! Noise of the instruments over the declared noise, and the test of the gyros' noise.

use gyrocal::EFFECTS;
use gyrocal::effect::{EffectKind, NoiseProperty};
use gyrocal_calibration::{CalibrationError, FittedPlatform, NoiseEstimate, NoiseRatio};
use gyrocal_hypothesis::RateNoiseFit;
use gyrocal_statistics::two_sided_p;

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

/// Logarithm of a noise over the declared one, in standard deviations, from which on it is tested.
const WORTH_TESTING: f64 = 2.0;

/// Gyro noise that differs from the declared one by a likelihood-ratio test, `alpha` being the
/// false-alarm probability of all three gyros; `noise` is that of the fit. Nothing is reported if the
/// noise of the accelerometers is correlated: the likelihood attributes the slow part of that to the
/// gyros.
pub(super) fn gyro_noise_findings(
    fit: &FittedPlatform<'_>,
    noise: &RateNoiseFit,
    audit: &NoiseAudit,
    alpha: f64,
) -> Result<Vec<NoiseFinding>, CalibrationError> {
    let mut findings = Vec::new();
    if audit.cleaned.correlation != 0.0 {
        return Ok(findings);
    }
    let levels = EFFECTS
        .iter()
        .filter(|effect| effect.kind == EffectKind::Noise(NoiseProperty::Level))
        .filter_map(|effect| Some((effect, effect.rate()?)));
    for (effect, axis) in levels {
        let (ratio, sigma) = (noise.noise.white[axis], noise.white_sigma[axis]);
        if ratio.ln().abs() < WORTH_TESTING * sigma {
            continue;
        }
        let declared = fit.fit_rate_noise_held(&[axis])?;
        let gained = 2.0 * (noise.log_likelihood - declared.log_likelihood);
        let z = gained.max(0.0).sqrt().copysign(ratio - 1.0);
        let p_value = (INSTRUMENTS * two_sided_p(z)).min(1.0);
        if p_value < alpha {
            findings.push(NoiseFinding {
                effect: effect.id,
                parameters: vec![Estimate {
                    name: "ratio",
                    estimate: ratio,
                    sigma: ratio * sigma,
                    unit: "1",
                }],
                z,
                p_value,
            });
        }
    }
    Ok(findings)
}
