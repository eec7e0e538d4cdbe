//! Selection of the noise model that explains the spectrum: likelihood-ratio tests of variance and
//! correlation.

use gyrocal::effect::{EffectKind, Enters, NoiseProperty};
use gyrocal::{EFFECTS, Effect};
use gyrocal_statistics::{chi_square_tail, two_sided_p, z_of_two_sided_p};

use super::finding::{Estimate, NoiseFinding, Shares};
use super::likelihood::{Bins, CORRELATION, NoiseFit, NoiseModel, fit};
use super::spectrum::Spectrum;
use crate::error_budget::INSTRUMENTS;

/// Smallest correlation that is reported: less is immaterial, however significant.
const LEAST_CORRELATION: f64 = 0.01;
/// Smallest deviation of a ratio from 1 that is reported.
const LEAST_EXCESS: f64 = 0.005;
/// Quantisation step in standard deviations of the noise beyond which rounding errors are not white:
/// they depend on the position of the platform between two values.
const COARSE_STEP: f64 = 1.0;
/// p-value above which a simpler model is not rejected against a richer one.
const NOT_REJECTED_P: f64 = 0.01;

/// The selected noise model.
pub(crate) struct Decision {
    pub(crate) findings: Vec<NoiseFinding>,
    pub(crate) fit: NoiseFit,
    /// Variance ratios without quantisation; 1 where none was found.
    pub(crate) variance: [f64; 3],
    pub(crate) correlation: f64,
}

/// Free parameters of the white model, and of the coloured one: variances, correlation, random walk.
const WHITE: [bool; 5] = [true, true, true, false, true];
const COLOURED: [bool; 5] = [true; 5];

/// Compares noise models of the spectrum. The random walk is a free parameter of all of them, so
/// that gyro noise and slow effects are not attributed to the accelerometers. `left_correlated` is that of
/// [`AuditOptions`](super::audit::AuditOptions).
pub(crate) fn decide(
    spectrum: &Spectrum,
    quantisation: [f64; 3],
    shares: &Shares,
    left_correlated: Option<f64>,
) -> Decision {
    let start = NoiseModel::declared(quantisation);
    let all = Bins::all(spectrum);
    let first = fit(spectrum, &all, start, COLOURED);
    let bins = Bins::without_lines(spectrum, &first.model);
    let fits = Fits {
        spectrum,
        white: fit(spectrum, &bins, start, WHITE),
        full: fit(spectrum, &bins, first.model, COLOURED),
        start,
        bins,
    };
    let mut findings = Vec::new();
    let (coloured, z) = match left_correlated {
        Some(p_value) => (fits.full.clone(), z_of_two_sided_p(p_value)),
        None => fits.correlation(shares),
    };
    let size = coloured.model.values[CORRELATION];
    let is_significant = left_correlated.is_some() || two_sided_p(z) < 0.5 * shares.coloured_noise;
    let is_coloured = is_significant && size.abs() > LEAST_CORRELATION;
    if is_coloured {
        findings.extend(correlation_effect().map(|effect| NoiseFinding {
            effect: effect.id,
            parameters: vec![Estimate {
                name: "correlation",
                estimate: size,
                sigma: coloured.sigma[CORRELATION],
                unit: "1",
            }],
            z,
            p_value: two_sided_p(z),
        }));
    }
    // A variance is reported only if no correlation explains as much.
    let best = if is_coloured {
        (&coloured, COLOURED)
    } else {
        (&fits.white, WHITE)
    };
    let mut variance = [1.0; 3];
    for axis in (0..3).filter(|axis| spectrum.axes[*axis].blocks > 0) {
        let (finding, value) = fits.variance(axis, best, is_coloured, quantisation[axis], shares);
        variance[axis] = value;
        findings.extend(finding);
    }
    Decision {
        findings,
        variance,
        correlation: if is_coloured { size } else { 0.0 },
        fit: if is_coloured {
            coloured
        } else {
            white_with(&fits.white, &coloured)
        },
    }
}

/// The effects of the table that describe correlation, and the level of an accelerometer's noise.
fn correlation_effect() -> Option<&'static Effect> {
    let kind = EffectKind::Noise(NoiseProperty::Correlation);
    EFFECTS.iter().find(|effect| effect.kind == kind)
}

fn level_effect(axis: usize) -> Option<&'static Effect> {
    let kind = EffectKind::Noise(NoiseProperty::Level);
    let mut levels = EFFECTS.iter().filter(|effect| effect.kind == kind);
    levels.find(|effect| matches!(effect.enters, Enters::Outputs(&[output]) if output == axis))
}

/// Root of twice the log-likelihood that one fit gains over another: a normal deviate.
fn gain(better: &NoiseFit, worse: &NoiseFit) -> f64 {
    (2.0 * (better.log_likelihood - worse.log_likelihood))
        .max(0.0)
        .sqrt()
}

/// The fits of a spectrum that are compared.
struct Fits<'s> {
    spectrum: &'s Spectrum,
    bins: Bins,
    start: NoiseModel,
    white: NoiseFit,
    full: NoiseFit,
}

impl Fits<'_> {
    /// The coloured fit and its z. Correlation is reported in two cases, each with half of the share:
    /// the fit is significantly better with than without it; or the declared variances are rejected
    /// and the correlation alone explains the spectrum, even if a larger random walk would do so too.
    fn correlation(&self, shares: &Shares) -> (NoiseFit, f64) {
        let half = 0.5 * shares.coloured_noise;
        let held = |free: [bool; 5]| fit(self.spectrum, &self.bins, self.start, free);
        let coloured = &self.full;
        let of_correlation = gain(coloured, &self.white);
        let alone = held([false, false, false, true, false]);
        let walking = held([false, false, false, false, true]);
        let p =
            |worse: &NoiseFit| chi_square_tail(gain(coloured, worse).powi(2), 4.0).unwrap_or(1.0);
        let (declared_p, alone_p) = (p(&walking), p(&alone));
        let is_simplest = declared_p < half && alone_p > NOT_REJECTED_P;
        if is_simplest && two_sided_p(of_correlation) >= half {
            (alone, z_of_two_sided_p(declared_p))
        } else {
            (coloured.clone(), of_correlation)
        }
    }

    /// The finding on the noise of one accelerometer, and its variance over the declared one.
    fn variance(
        &self,
        axis: usize,
        (best, free): (&NoiseFit, [bool; 5]),
        is_coloured: bool,
        quantisation: f64,
        shares: &Shares,
    ) -> (Option<NoiseFinding>, f64) {
        let against = |value: f64| {
            let held = |fitted: &NoiseFit, mut free: [bool; 5]| {
                let mut held = fitted.model;
                held.values[axis] = value;
                free[axis] = false;
                gain(fitted, &fit(self.spectrum, &self.bins, held, free))
            };
            held(best, free).min(held(&self.full, COLOURED))
        };
        // The declared variance of correlated noise may be that of the noise or that of its driving
        // noise: either is a simpler explanation, with one finding less.
        let mut z = against(1.0);
        let mut nearest: f64 = 1.0;
        if is_coloured {
            let size = best.model.values[CORRELATION];
            let driven = 1.0 / (1.0 - size * size);
            let of_driving = against(driven);
            if of_driving < z {
                (z, nearest) = (of_driving, driven);
            }
        }
        let found = best.model.values[axis];
        let coarse = if quantisation * 12.0 > COARSE_STEP * COARSE_STEP {
            quantisation
        } else {
            0.0
        };
        let matters = 2.0 * LEAST_EXCESS + 0.3 * coarse;
        let p_value = (INSTRUMENTS * two_sided_p(z)).min(1.0);
        if p_value >= shares.accel_noise || (found / nearest - 1.0).abs() <= matters {
            return (None, nearest);
        }
        let finding = level_effect(axis).map(|effect| NoiseFinding {
            effect: effect.id,
            parameters: vec![ratio(best, axis)],
            z: z.copysign(found - nearest),
            p_value,
        });
        (finding, found)
    }
}

/// The white fit with the correlation of the coloured fit, for information.
fn white_with(white: &NoiseFit, coloured: &NoiseFit) -> NoiseFit {
    let mut fit = white.clone();
    fit.model.values[CORRELATION] = coloured.model.values[CORRELATION];
    fit.sigma[CORRELATION] = coloured.sigma[CORRELATION];
    fit
}

/// Ratio of standard deviations from a ratio of variances.
pub(crate) fn ratio(fit: &NoiseFit, parameter: usize) -> Estimate {
    let estimate = fit.model.values[parameter].max(0.0).sqrt();
    Estimate {
        name: "ratio",
        estimate,
        // Near zero the sigma of the root is bounded by the root of the sigma of the variance.
        sigma: fit.sigma[parameter] / (2.0 * estimate).max(fit.sigma[parameter].sqrt()),
        unit: "1",
    }
}
