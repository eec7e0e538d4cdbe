//! Intervals of noise by the profile of its likelihood.

use nalgebra::{DMatrix, DVector};

/// The 97.5 % point of the standard normal distribution: its square is the 95 % point of χ²(1).
const NORMAL_97_5: f64 = 1.959_963_984_540_054;

/// Most evaluations for one end of an interval, and the error of an end that is good enough, in
/// standard deviations.
const MAX_EVALUATIONS: usize = 6;
const END_PRECISION: f64 = 0.02;

/// Length of an interval of the logarithm of a variance beyond which it has no end: a factor of 400 in a size.
const LONGEST: f64 = 12.0;

/// Standard deviation of the logarithm of a variance up to which the likelihood is a normal one in it: its third
/// derivative moves the ends by less than a fortieth of the interval.
const NORMAL_UP_TO: f64 = 0.1;

/// A maximum of a likelihood of noise.
#[derive(Clone, Copy, Debug)]
pub struct Maximum<'a> {
    /// Logarithms of the variances.
    pub logarithms: &'a DVector<f64>,
    /// Their covariance by the curvature.
    pub covariance: &'a DMatrix<f64>,
    /// Logarithm of the likelihood.
    pub value: f64,
}

impl Maximum<'_> {
    /// 95 % interval of a logarithm by its profile likelihood. An end is `None` where the likelihood stays high to a
    /// factor of 400 of the size. `value` is the logarithm of the likelihood at some logarithms, which are moved along
    /// the ridge at the maximum, or the largest with the logarithm `own` of these; `None` where the filter leaves the
    /// numbers.
    pub fn interval(
        &self,
        own: usize,
        value: &mut dyn FnMut(&[f64]) -> Option<f64>,
    ) -> [Option<f64>; 2] {
        let sigma = self.covariance[(own, own)].sqrt();
        let along = self.covariance.column(own) / sigma;
        [-1.0, 1.0].map(|side| {
            let end = if sigma < NORMAL_UP_TO {
                Some(NORMAL_97_5)
            } else {
                profile_end(LONGEST / sigma, |distance| {
                    let moved = self.logarithms + &along * (side * distance);
                    let here = value(moved.as_slice());
                    here.map_or(f64::INFINITY, |here| 2.0 * (self.value - here))
                })
            };
            end.map(|distance| self.logarithms[own] + side * sigma * distance)
        })
    }

    /// The same as standard deviations over that where the logarithm is zero: from zero where nothing smaller is
    /// excluded, to 400 times the estimate where nothing larger is.
    pub fn sizes(&self, own: usize, value: &mut dyn FnMut(&[f64]) -> Option<f64>) -> [f64; 2] {
        let size = |logarithm: f64| (0.5 * logarithm).exp();
        let [low, high] = self.interval(own, value);
        [
            low.map_or(0.0, size),
            size(high.unwrap_or(self.logarithms[own] + LONGEST)),
        ]
    }
}

/// The distance from the maximum at which twice the log-likelihood has fallen to the 95 % point of χ²(1),
/// in standard deviations; `None` if that is farther than `longest`. The root of the fall is nearly
/// proportional to the distance.
fn profile_end(longest: f64, mut fall: impl FnMut(f64) -> f64) -> Option<f64> {
    let mut distance = NORMAL_97_5;
    for _ in 0..MAX_EVALUATIONS {
        let root = fall(distance).max(0.0).sqrt();
        if (root - NORMAL_97_5).abs() < END_PRECISION {
            break;
        }
        if distance >= longest && root < NORMAL_97_5 {
            return None;
        }
        distance = (distance * (NORMAL_97_5 / root).clamp(0.4, 2.5)).min(longest);
    }
    Some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// n squares of a normal variable of variance e^l: minus twice the log-likelihood is n (l + e^(m - l)) with the
    /// maximum at m.
    #[test]
    fn the_ends_of_a_variance_are_those_of_its_likelihood() {
        let (count, maximum) = (20.0, 0.7);
        let value = |l: f64| -0.5 * count * (l + f64::exp(maximum - l));
        let logarithms = DVector::from_row_slice(&[maximum]);
        let covariance = DMatrix::from_row_slice(1, 1, &[2.0 / count]);
        let at = Maximum {
            logarithms: &logarithms,
            covariance: &covariance,
            value: value(maximum),
        };
        let found = at.interval(0, &mut |logarithms| Some(value(logarithms[0])));
        for end in found {
            let end = end.unwrap();
            let fallen = (2.0 * (value(maximum) - value(end))).sqrt();
            assert!((fallen - NORMAL_97_5).abs() < END_PRECISION, "{end}");
        }
        let [low, high] = found.map(|end| (end.unwrap() - maximum).abs());
        assert!(high > low, "large variances are likelier than small ones");
    }

    #[test]
    fn a_likelihood_that_stays_high_has_no_end() {
        let logarithms = DVector::from_row_slice(&[0.0]);
        let covariance = DMatrix::from_row_slice(1, 1, &[1.0]);
        let at = Maximum {
            logarithms: &logarithms,
            covariance: &covariance,
            value: 0.0,
        };
        let found = at.interval(0, &mut |logarithms| Some(-f64::exp(logarithms[0]).ln_1p()));
        assert!(found[0].is_none());
        assert!(found[1].is_some());
    }
}
