//! Scatter of estimates over calibrations of one platform, against their uncertainties.

use gyrocal_statistics::chi_square_tail;
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::budget::{CoefficientBudget, Contribution, UncertaintyBudget};
use crate::coefficients::PARAMETERS;
use crate::variances::UncertaintySource;

/// Probability that any coefficient of a stable platform is said to scatter more than its uncertainty.
const FALSE_ALARM: f64 = 0.01;

/// Scatter of the coefficients over calibrations.
#[derive(Clone, Debug, PartialEq)]
pub struct Spread {
    /// Number of calibrations.
    pub runs: usize,
    /// One for each coefficient, in the order of the budgets.
    pub coefficients: Vec<CoefficientSpread>,
}

/// Scatter of one coefficient over calibrations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoefficientSpread {
    /// Id of the coefficient.
    pub id: &'static str,
    /// Unit of mean and deviations.
    pub unit: &'static str,
    /// Mean of the estimates.
    pub mean: f64,
    /// Standard deviation of the estimates between runs.
    pub standard_deviation: f64,
    /// Standard deviation between runs that the uncertainties make one expect.
    pub expected: f64,
    /// Probability of so large a scatter where those uncertainties are its only reason.
    pub p_value: f64,
    /// The scatter is larger than the uncertainties explain, with a probability of 1 % of any such
    /// statement about a platform that they do explain.
    pub is_larger: bool,
}

/// Scatter over calibrations of one platform; `None` of fewer than two.
///
/// The error of the site is the same in all of them, but a run in another attitude is another function of
/// it: estimates have a covariance. The squared distance from the generalised least-squares mean, in that
/// covariance, has the chi-square distribution with one degree of freedom less than runs.
#[must_use]
pub fn spread(budgets: &[UncertaintyBudget]) -> Option<Spread> {
    let (first, runs) = (budgets.first()?, budgets.len());
    if runs < 2 {
        return None;
    }
    let of = |index: usize| {
        let all: Vec<&CoefficientBudget> = budgets
            .iter()
            .filter_map(|one| one.coefficients.get(index))
            .collect();
        scatter(&all)
    };
    let coefficients = (0..first.coefficients.len()).map(of);
    Some(Spread {
        runs,
        coefficients: coefficients.collect::<Option<_>>()?,
    })
}

/// Scatter of one coefficient; `None` without runs, or of uncertainties that are zero.
fn scatter(runs: &[&CoefficientBudget]) -> Option<CoefficientSpread> {
    let (first, count) = (runs.first()?, runs.len());
    let covariance = DMatrix::from_fn(count, count, |i, j| {
        let own = match i == j {
            true => runs[i].part(|source| !is_shared(source)).powi(2),
            false => 0.0,
        };
        own + shared(runs[i], runs[j])
    });
    let estimates = DVector::from_fn(count, |i, _| runs[i].estimate);
    let free = (count - 1) as f64;
    let expected = (covariance.trace() - covariance.sum() / count as f64) / free;
    let cholesky = Cholesky::new(covariance)?;
    let ones = DVector::repeat(count, 1.0);
    let weights = cholesky.solve(&ones);
    let centre = weights.dot(&estimates) / weights.sum();
    let distances = estimates.add_scalar(-centre);
    let statistic = cholesky.solve(&distances).dot(&distances);
    let p_value = chi_square_tail(statistic, free)?;
    let mean = estimates.mean();
    Some(CoefficientSpread {
        id: first.id,
        unit: first.unit,
        mean,
        standard_deviation: (estimates.add_scalar(-mean).norm_squared() / free).sqrt(),
        expected: expected.max(0.0).sqrt(),
        p_value,
        is_larger: p_value < FALSE_ALARM / PARAMETERS as f64,
    })
}

/// Covariance of the estimates of two runs by what they share.
fn shared(one: &CoefficientBudget, other: &CoefficientBudget) -> f64 {
    let lines = one.contributions.iter();
    lines
        .filter(|line| is_shared(line.source))
        .filter_map(|line| {
            let mut others = other.contributions.iter();
            let same = others.find(|same| same.source == line.source)?;
            let of = |it: &Contribution| it.sensitivity * it.quantity_standard;
            Some(of(line) * of(same))
        })
        .sum()
}

/// Whether runs of one platform on one site share the error of a source: that of the site, and the
/// distance of the coefficients from the means of their priors.
fn is_shared(source: UncertaintySource) -> bool {
    matches!(
        source,
        UncertaintySource::Prior(_) | UncertaintySource::Effects | UncertaintySource::Site(_)
    )
}
