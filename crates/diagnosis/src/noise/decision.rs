//! Which explanation of the spectrum is the right one.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::finding::{Estimate, NoiseFinding, Shares};
use super::likelihood::{Bins, CORRELATION, NoiseFit, NoiseModel, fit};
use super::spectrum::Spectrum;
use crate::significance::{two_sided_p, z_of_two_sided_p};

/// A correlation of less changes nothing that matters, however significant.
const LEAST_CORRELATION: f64 = 0.01;
/// Nor does a ratio closer to one than this.
const LEAST_EXCESS: f64 = 0.005;
/// On a lattice coarser than this part of the noise, rounding errors depend on where between two
/// values the platform stands, and are not white while it stands there.
const COARSE: f64 = 1.0;
/// An explanation that the data contradict no more than this is as good as a richer one.
const SIMPLE: f64 = 0.01;

const NOISE: [&str; 3] = ["accel_x.noise", "accel_y.noise", "accel_z.noise"];

/// What was decided of the spectrum.
pub(crate) struct Decision {
    pub(crate) findings: Vec<NoiseFinding>,
    pub(crate) fit: NoiseFit,
    /// Variance ratios without quantisation that were found, else one.
    pub(crate) variance: [f64; 3],
    pub(crate) correlation: f64,
}

/// Compares explanations of the spectrum. The random walk is free in all of them: whatever the
/// gyros' noise is, and whatever slow cause there is, is not laid on the accelerometers.
pub(crate) fn decide(spectrum: &Spectrum, quantisation: [f64; 3], shares: &Shares) -> Decision {
    const WHITE: [bool; 5] = [true, true, true, false, true];
    const COLOURED: [bool; 5] = [true; 5];
    let start = NoiseModel::declared(quantisation);
    let all = Bins::all(spectrum);
    let first = fit(spectrum, &all, start, COLOURED);
    let bins = Bins::without_lines(spectrum, &first.model);
    let white = fit(spectrum, &bins, start, WHITE);
    let full = fit(spectrum, &bins, first.model, COLOURED);
    let coloured = full.clone();
    let gain = |better: &NoiseFit, worse: &NoiseFit| {
        (2.0 * (better.log_likelihood - worse.log_likelihood))
            .max(0.0)
            .sqrt()
    };

    let mut findings = Vec::new();
    // Two ways to be called coloured, with half of the share each: to fit significantly better
    // with a correlation than without, or to be explained by the correlation alone where the
    // declared variances are not enough, though others with a stronger walk would do as well.
    let half = 0.5 * shares.coloured_noise;
    let of_correlation = gain(&coloured, &white);
    let alone = fit(spectrum, &bins, start, [false, false, false, true, false]);
    let walking = fit(spectrum, &bins, start, [false, false, false, false, true]);
    let declared_p = chi_squared_p(gain(&coloured, &walking).powi(2), 4.0);
    let alone_p = chi_squared_p(gain(&coloured, &alone).powi(2), 4.0);
    let is_simplest = declared_p < half && alone_p > SIMPLE;
    let (coloured, z) = if is_simplest && two_sided_p(of_correlation) >= half {
        (alone, z_of_two_sided_p(declared_p))
    } else {
        (coloured, of_correlation)
    };
    let size = coloured.model.values[CORRELATION];
    let is_coloured = two_sided_p(z) < half && size.abs() > LEAST_CORRELATION;
    if is_coloured {
        findings.push(NoiseFinding {
            effect: "accel.coloured_noise",
            parameters: vec![Estimate {
                name: "correlation",
                estimate: size,
                sigma: coloured.sigma[CORRELATION],
                unit: "1",
            }],
            z,
            p_value: two_sided_p(z),
        });
    }
    // Variances are called wrong only if no correlation would explain as much.
    let (best, free) = if is_coloured {
        (&coloured, COLOURED)
    } else {
        (&white, WHITE)
    };
    let mut variance = [1.0; 3];
    for axis in (0..3).filter(|axis| spectrum.axes[*axis].blocks > 0) {
        let against = |value: f64| {
            let held = |fitted: &NoiseFit, mut free: [bool; 5]| {
                let mut held = fitted.model;
                held.values[axis] = value;
                free[axis] = false;
                gain(fitted, &fit(spectrum, &bins, held, free))
            };
            held(best, free).min(held(&full, COLOURED))
        };
        // Of correlated noise, either the variance or that of its driving noise may be what was
        // declared: with one finding less, both are simpler explanations.
        let mut z = against(1.0);
        let mut nearest: f64 = 1.0;
        if is_coloured {
            let driven = 1.0 / (1.0 - size * size);
            let of_driving = against(driven);
            if of_driving < z {
                (z, nearest) = (of_driving, driven);
            }
        }
        let found = best.model.values[axis];
        let coarse = if quantisation[axis] * 12.0 > COARSE * COARSE {
            quantisation[axis]
        } else {
            0.0
        };
        let matters = 2.0 * LEAST_EXCESS + 0.3 * coarse;
        let p_value = (3.0 * two_sided_p(z)).min(1.0);
        variance[axis] = nearest;
        if p_value < shares.accel_noise && (found / nearest - 1.0).abs() > matters {
            variance[axis] = found;
            findings.push(NoiseFinding {
                effect: NOISE[axis],
                parameters: vec![ratio(best, axis)],
                z: z.copysign(found - nearest),
                p_value,
            });
        }
    }
    Decision {
        findings,
        variance,
        correlation: if is_coloured { size } else { 0.0 },
        fit: if is_coloured {
            coloured
        } else {
            white_with(&white, &coloured)
        },
    }
}

fn chi_squared_p(value: f64, degrees: f64) -> f64 {
    ChiSquared::new(degrees).map_or(1.0, |distribution| distribution.sf(value))
}

/// The white fit with what the coloured one says of the correlation, for information.
fn white_with(white: &NoiseFit, coloured: &NoiseFit) -> NoiseFit {
    let mut fit = white.clone();
    fit.model.values[CORRELATION] = coloured.model.values[CORRELATION];
    fit.sigma[CORRELATION] = coloured.sigma[CORRELATION];
    fit
}

/// Standard deviation over the declared one, from a ratio of variances.
pub(crate) fn ratio(fit: &NoiseFit, parameter: usize) -> Estimate {
    let estimate = fit.model.values[parameter].max(0.0).sqrt();
    Estimate {
        name: "ratio",
        estimate,
        // Near zero the variance knows more than its root: the root of its sigma then.
        sigma: fit.sigma[parameter] / (2.0 * estimate).max(fit.sigma[parameter].sqrt()),
        unit: "1",
    }
}
