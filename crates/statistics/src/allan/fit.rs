//! Fit of the parts of a noise to the overlapping Allan variances of a record.

use nalgebra::{DMatrix, DVector};
use serde::Serialize;

use super::covariance::ScaleCovariance;
use super::draws::Draws;
use super::intervals::interval;
use super::least_squares::{Conditions, Weighted};
use super::parts::{NoisePart, PARTS};
use super::{AllanPoint, NoiseType};
use crate::error::StatisticsError;

/// Probability that a fit without correlation at short times is given up although it is right.
const CORRELATED: f64 = 0.05;

/// Least p-value of a fit from which the shortest averaging times were left out.
const FITS: f64 = 0.1;

/// Largest share of the part 1/τ² in the variance at the shortest averaging time of such a fit: it stands
/// for the first order of the effect of a filter on white noise. With 0.3 a filter of first order has five
/// time constants, and a moving mean its length, in less than that averaging time.
const SETTLED: f64 = 0.3;

/// Fewest averaging times of a fit: one more than there are parts.
const FEWEST_SCALES: usize = PARTS + 1;

/// Probability that an interval of a coefficient contains it.
pub const COEFFICIENT_CONFIDENCE: f64 = 0.95;

/// Coefficient of a part.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Coefficient {
    /// The part.
    pub part: NoisePart,
    /// Its coefficient, in the unit of the rate and seconds; `None` if the record cannot tell it from
    /// something else.
    pub estimate: Option<f64>,
    /// Ends of its 95 % interval. The lower one is zero if the part is not visible.
    pub interval: Option<[f64; 2]>,
}

/// Fitted Allan deviation at one averaging time, for a plot.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FittedPoint {
    /// Averaging time \[s\].
    pub tau_s: f64,
    /// Deviation of the sum of the parts.
    pub deviation: f64,
    /// Deviation of each part, in the order of [`NoisePart::ALL`]; negative where it stands for noise
    /// that is less than white at short times.
    pub parts: [f64; PARTS],
    /// `true` if the fit uses this averaging time.
    pub used: bool,
}

/// Parts of a noise with a test of fit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct NoiseFit {
    /// Coefficients in the order of [`NoisePart::ALL`].
    pub coefficients: Vec<Coefficient>,
    /// `true` if the samples are correlated at short times, as those of a filtered or dithered sensor:
    /// the shortest averaging times are left out, and quantisation cannot be told.
    pub correlated_samples: bool,
    /// First and last averaging time of the fit \[s\].
    pub range_s: [f64; 2],
    /// Sum of squares of the whitened residuals.
    pub chi_square: f64,
    /// Probability of a larger one if the noise consists of the parts, by simulation. Below 5 % without
    /// correlated samples it does not, and no coefficient is given.
    pub p_value: f64,
    /// The fitted curve.
    pub curve: Vec<FittedPoint>,
}

impl NoiseFit {
    /// `true` if a sum of the parts describes the deviations; otherwise no coefficient is determined.
    #[must_use]
    pub fn is_described(&self) -> bool {
        self.correlated_samples || self.p_value >= CORRELATED
    }

    /// Coefficient of a part.
    #[must_use]
    pub fn coefficient(&self, part: NoisePart) -> Option<&Coefficient> {
        self.coefficients.iter().find(|other| other.part == part)
    }
}

/// One fit, in units of the first variance and of samples.
pub(super) struct Fit {
    pub(super) parts: [f64; PARTS],
    pub(super) covariance: DMatrix<f64>,
    pub(super) weighted: Weighted,
}

/// Data of a fit: Allan variances over averaging times in samples.
pub(super) struct Scales {
    pub(super) averaging: Vec<usize>,
    pub(super) variances: DVector<f64>,
    pub(super) covariance: ScaleCovariance,
}

/// Fits the four parts, none of them negative, by generalised least squares: the covariances of the
/// Allan variances over averaging times are those of the fitted parts themselves, iterated. Each
/// interval holds the values that a test of size 5 % does not reject; the distributions of its
/// statistic and of the test of fit are simulated.
///
/// If the parts do not fit at all averaging times, the shortest are left out until they do, and one
/// octave more. The part 1/τ², which is then of either sign, represents samples that are correlated for a
/// short time. Averaging times at which a ramp of the rate makes most of the deviation are left out.
///
/// `points` are overlapping Allan deviations of `samples` in octaves.
///
/// # Errors
///
/// [`StatisticsError::TooShort`] with fewer than five averaging times, and if the covariances of the
/// deviations are numerically singular.
pub fn fit_noise(points: &[AllanPoint], samples: usize) -> Result<NoiseFit, StatisticsError> {
    let usable: Vec<&AllanPoint> = points
        .iter()
        .filter(|point| point.deviation > 0.0 && point.noise != NoiseType::RateRamp)
        .collect();
    let too_short = StatisticsError::TooShort {
        test: "the fit of the parts of a noise to Allan deviations",
        found: usable.len(),
        expected: FEWEST_SCALES,
    };
    let [first, .., last] = usable[..] else {
        return Err(too_short);
    };
    if usable.len() < FEWEST_SCALES {
        return Err(too_short);
    }
    let averaging: Vec<usize> = usable.iter().map(|point| point.averaging).collect();
    let relative = usable
        .iter()
        .map(|point| (point.deviation / first.deviation).powi(2));
    let all = Scales {
        variances: DVector::from_iterator(usable.len(), relative),
        covariance: ScaleCovariance::new(samples, &averaging),
        averaging,
    };
    let chosen = choose(&all).ok_or(too_short)?;
    let interval_s = first.tau_s / first.averaging as f64;
    let scales = all.without_first(chosen.first);
    let coefficient = |(index, part): (usize, NoisePart)| {
        let unit = first.deviation * part.time_factor(interval_s);
        let told = match chosen.correlated {
            true => index > 0,
            false => chosen.p_value >= CORRELATED,
        };
        let variance = chosen.fit.parts[index];
        Coefficient {
            part,
            estimate: told.then(|| unit * variance.sqrt()),
            interval: told
                .then(|| interval(&scales, index, &chosen.fit, chosen.correlated))
                .flatten()
                .map(|ends| ends.map(|variance| unit * variance.sqrt())),
        }
    };
    Ok(NoiseFit {
        coefficients: NoisePart::ALL
            .into_iter()
            .enumerate()
            .map(coefficient)
            .collect(),
        correlated_samples: chosen.correlated,
        range_s: [usable[chosen.first].tau_s, last.tau_s],
        chi_square: chosen.chi_square,
        p_value: chosen.p_value,
        curve: curve(
            points,
            first.deviation,
            &usable[chosen.first..],
            &chosen.fit.parts,
        ),
    })
}

struct Chosen {
    first: usize,
    correlated: bool,
    fit: Fit,
    chi_square: f64,
    p_value: f64,
}

/// The fit at all averaging times, or the one without the shortest that fits.
fn choose(all: &Scales) -> Option<Chosen> {
    let plain = all.judged(0, false)?;
    if plain.p_value >= CORRELATED {
        return Some(plain);
    }
    let most = all.averaging.len().saturating_sub(FEWEST_SCALES);
    let fitting = (0..=most).find_map(|first| {
        let found = all.judged(first, true)?;
        let averaging = all.averaging[first] as f64;
        let of_one = NoisePart::Quantisation.variance(averaging);
        let largest = SETTLED * variance(&found.fit.parts, averaging) / of_one;
        let [short, ..] = found.fit.parts;
        let settled = short.abs() <= largest + found.fit.weighted.sigma(0)?;
        (found.p_value >= FITS && settled).then_some(first)
    });
    // Without a fit at any: the plain one, whose p-value says so.
    let Some(first) = fitting else {
        return Some(plain);
    };
    // What the test just fails to see is less by a factor of three an octave later.
    all.judged((first + 1).min(most), true).or(Some(plain))
}

impl Scales {
    /// The same without the first averaging times.
    fn without_first(&self, first: usize) -> Self {
        let left = self.averaging.len() - first;
        Self {
            averaging: self.averaging[first..].to_vec(),
            variances: self.variances.rows(first, left).into_owned(),
            covariance: self.covariance.without_first(first),
        }
    }

    /// Fit from averaging time number `first` on, with its test.
    fn judged(&self, first: usize, signed: bool) -> Option<Chosen> {
        let scales = self.without_first(first);
        let conditions = Conditions {
            signed,
            fixed: None,
        };
        let fit = scales.fit(conditions)?;
        let white = fit.weighted.whiten(&scales.variances);
        let chi_square = fit.weighted.chi_square(&white, &fit.parts);
        let draws = Draws::of(&scales, &fit)?;
        let as_large = draws.share(|drawn| {
            let white = fit.weighted.whiten(drawn);
            let parts = fit.weighted.solve(&white, conditions);
            fit.weighted.chi_square(&white, &parts) >= chi_square
        });
        Some(Chosen {
            first,
            correlated: signed,
            fit,
            chi_square,
            p_value: as_large,
        })
    }

    /// Generalised least squares with the covariance of the fitted parts.
    pub(super) fn fit(&self, conditions: Conditions) -> Option<Fit> {
        const MOST_ITERATIONS: usize = 40;
        const CHANGE: f64 = 1e-7;
        // At first relative errors that grow with the averaging time.
        let start = DVector::from_iterator(
            self.averaging.len(),
            self.averaging
                .iter()
                .zip(self.variances.iter())
                .map(|(m, variance)| variance * variance * *m as f64),
        );
        let start = Weighted::new(&self.averaging, DMatrix::from_diagonal(&start))?;
        let unsigned = Conditions {
            signed: false,
            ..conditions
        };
        let mut parts = start.solve(&start.whiten(&self.variances), unsigned);
        for iteration in 0..MOST_ITERATIONS {
            let weighted = Weighted::new(&self.averaging, self.covariance.of(&parts))?;
            let found = weighted.solve(&weighted.whiten(&self.variances), conditions);
            // Half steps end a cycle between two solutions.
            let share = if iteration < MOST_ITERATIONS / 4 {
                1.0
            } else {
                0.5
            };
            let next: [f64; PARTS] =
                core::array::from_fn(|p| parts[p] + share * (found[p] - parts[p]));
            let change = (0..self.averaging.len())
                .map(|k| {
                    let averaging = self.averaging[k] as f64;
                    (variance(&next, averaging) / variance(&parts, averaging) - 1.0).abs()
                })
                .fold(0.0, f64::max);
            parts = next;
            if change < CHANGE {
                break;
            }
        }
        let covariance = self.covariance.of(&parts);
        let weighted = Weighted::new(&self.averaging, covariance.clone())?;
        Some(Fit {
            parts,
            covariance,
            weighted,
        })
    }
}

/// Allan variance of a sum of parts.
pub(super) fn variance(parts: &[f64; PARTS], averaging: f64) -> f64 {
    let all = NoisePart::ALL.iter().zip(parts);
    all.map(|(part, size)| size * part.variance(averaging))
        .sum()
}

fn curve(
    points: &[AllanPoint],
    unit: f64,
    used: &[&AllanPoint],
    parts: &[f64; PARTS],
) -> Vec<FittedPoint> {
    let root = |variance: f64| unit * variance.abs().sqrt().copysign(variance);
    let of = |point: &AllanPoint| {
        let averaging = point.averaging as f64;
        FittedPoint {
            tau_s: point.tau_s,
            deviation: root(variance(parts, averaging).max(0.0)),
            parts: core::array::from_fn(|p| root(parts[p] * NoisePart::ALL[p].variance(averaging))),
            used: used.iter().any(|other| other.averaging == point.averaging),
        }
    };
    points.iter().map(of).collect()
}
