//! Units of a fleet about their mean: estimates with known variances, and a spread that is not known.
//!
//! ```text
//! y = X β + u + e,     u ~ N(0, τ²),     e_i ~ N(0, v_i)
//! Q(τ²) = Σ (y − X β̂(τ²))² / (v + τ²)  ~  χ²(n − p)                             (1)
//! ```
//!
//! Q at the true τ² has that distribution exactly, for any number of units and any variances, and falls as
//! τ² grows. The interval of the spread is where Q lies within its quantiles (Viechtbauer, Statist. Med.
//! 26, 37, 2007), and the estimate where it is n − p (Paule and Mandel, J. Res. NBS 87, 377, 1982): with
//! equal variances that of the restricted likelihood. Coefficients β have Student's intervals with n − p
//! degrees of freedom (Hartung and Knapp, Statist. Med. 20, 3875, 2001): exact with equal variances, and
//! right for few units, where normal intervals are too short.

use gyrocal_statistics::{chi_square_quantile, student_quantile};
use nalgebra::{Cholesky, DMatrix, DVector};

/// Confidence of all intervals.
pub(crate) const CONFIDENCE: f64 = 0.95;

/// Halvings of the interval of a root: to the last bits of a spread.
const HALVINGS: usize = 60;

/// Estimates of units, each with its variance, and columns of a design.
#[derive(Clone, Debug)]
pub(crate) struct Units<'a> {
    pub(crate) values: &'a [f64],
    pub(crate) variances: &'a [f64],
    /// Columns beside the mean.
    pub(crate) columns: Vec<Vec<f64>>,
}

/// A fit of (1).
#[derive(Clone, Debug)]
pub(crate) struct RandomEffects {
    /// Spread τ.
    pub(crate) spread: f64,
    /// Coefficients: the mean, then those of the columns.
    pub(crate) beta: DVector<f64>,
    pub(crate) covariance: DMatrix<f64>,
    pub(crate) degrees_of_freedom: f64,
    /// Q at the estimated spread over its mean: above one only where the spread is zero and the
    /// variances are too small.
    pub(crate) scale: f64,
}

/// A weighted least-squares fit at one τ².
struct Weighted {
    q: f64,
    beta: DVector<f64>,
    covariance: DMatrix<f64>,
}

/// τ² at which a falling Q has a value, from a first guess that is positive; zero if Q is below the value
/// everywhere.
pub(crate) fn tau_squared_at(
    value: f64,
    guess: f64,
    q: impl Fn(f64) -> Option<f64>,
) -> Option<f64> {
    if q(0.0)? <= value {
        return Some(0.0);
    }
    let mut high = guess;
    while q(high)? > value {
        high *= 4.0;
        if !high.is_finite() {
            return None;
        }
    }
    let mut low = 0.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if q(middle)? > value {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

/// Estimate and 95 % interval of a spread, whose Q has these degrees of freedom.
pub(crate) fn spread_of(
    degrees_of_freedom: f64,
    guess: f64,
    q: impl Fn(f64) -> Option<f64>,
) -> Option<(f64, [f64; 2])> {
    let tail = 0.5 * (1.0 - CONFIDENCE);
    let upper = chi_square_quantile(tail, degrees_of_freedom)?;
    let lower = chi_square_quantile(1.0 - tail, degrees_of_freedom)?;
    let at = |value| Some(tau_squared_at(value, guess, &q)?.sqrt());
    Some((at(degrees_of_freedom)?, [at(lower)?, at(upper)?]))
}

impl Units<'_> {
    /// Value of column `index` of the design at a unit; the first is the mean.
    fn design(&self, unit: usize, index: usize) -> f64 {
        match index {
            0 => 1.0,
            _ => self.columns[index - 1][unit],
        }
    }

    fn degrees_of_freedom(&self) -> usize {
        self.values.len().saturating_sub(1 + self.columns.len())
    }

    fn weighted(&self, tau_squared: f64) -> Option<Weighted> {
        let count = 1 + self.columns.len();
        let mut normal = DMatrix::zeros(count, count);
        let mut right = DVector::zeros(count);
        let mut square = 0.0;
        for (unit, (value, variance)) in self.values.iter().zip(self.variances).enumerate() {
            let weight = (variance + tau_squared).recip();
            for i in 0..count {
                let weighted = weight * self.design(unit, i);
                right[i] += weighted * value;
                for j in 0..=i {
                    normal[(i, j)] += weighted * self.design(unit, j);
                }
            }
        }
        normal.fill_upper_triangle_with_lower_triangle();
        let cholesky = Cholesky::new(normal)?;
        let beta = cholesky.solve(&right);
        for (unit, (value, variance)) in self.values.iter().zip(self.variances).enumerate() {
            let fitted: f64 = (0..count).map(|i| beta[i] * self.design(unit, i)).sum();
            square += (value - fitted).powi(2) / (variance + tau_squared);
        }
        Some(Weighted {
            q: square,
            beta,
            covariance: cholesky.inverse(),
        })
    }

    /// Sum of squares Q of (1); `None` where columns are dependent.
    pub(crate) fn q(&self, tau_squared: f64) -> Option<f64> {
        Some(self.weighted(tau_squared)?.q)
    }

    /// The largest variance, which a search for τ² starts from.
    pub(crate) fn largest_variance(&self) -> f64 {
        self.variances.iter().copied().fold(0.0, f64::max)
    }

    fn tau_squared_at(&self, q: f64) -> Option<f64> {
        tau_squared_at(q, self.largest_variance(), |at| self.q(at))
    }

    /// Coefficients and their covariance at a spread.
    pub(crate) fn at(&self, tau_squared: f64) -> Option<(DVector<f64>, DMatrix<f64>)> {
        let at = self.weighted(tau_squared)?;
        Some((at.beta, at.covariance))
    }

    /// The fit; `None` with fewer units than unknowns and one more, and where columns are dependent.
    pub(crate) fn fit(&self) -> Option<RandomEffects> {
        let degrees_of_freedom = self.degrees_of_freedom();
        if degrees_of_freedom == 0 {
            return None;
        }
        let tau_squared = self.tau_squared_at(degrees_of_freedom as f64)?;
        let at = self.weighted(tau_squared)?;
        let scale = at.q / degrees_of_freedom as f64;
        Some(RandomEffects {
            spread: tau_squared.sqrt(),
            beta: at.beta,
            covariance: at.covariance,
            degrees_of_freedom: degrees_of_freedom as f64,
            scale,
        })
    }

    /// 95 % interval of the spread; `None` as for [`Self::fit`].
    pub(crate) fn spread_interval(&self) -> Option<[f64; 2]> {
        let degrees_of_freedom = self.degrees_of_freedom() as f64;
        let found = spread_of(degrees_of_freedom, self.largest_variance(), |at| self.q(at));
        Some(found?.1)
    }
}

impl RandomEffects {
    /// Standard error of a coefficient; where the spread is zero, Q may be below its mean, and the error
    /// is that of the variances.
    pub(crate) fn standard_error(&self, index: usize) -> f64 {
        (self.covariance[(index, index)] * self.scale.max(1.0)).sqrt()
    }

    /// 95 % interval of a coefficient.
    pub(crate) fn interval(&self, index: usize) -> Option<[f64; 2]> {
        let quantile = student_quantile(0.5 * (1.0 + CONFIDENCE), self.degrees_of_freedom)?;
        let half = quantile * self.standard_error(index);
        Some([self.beta[index] - half, self.beta[index] + half])
    }

    /// Student's statistic of a coefficient.
    pub(crate) fn t(&self, index: usize) -> f64 {
        self.beta[index] / self.standard_error(index)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn without_errors_it_is_the_normal_sample() {
        // Mean 3, standard deviation √2.5; interval of the mean 3 ± 2.776 √(2.5/5), as in tables, and
        // of the spread √(4·2.5/11.143), √(4·2.5/0.4844).
        let values = [1.0, 2.0, 3.0, 4.0, 5.0];
        let units = Units {
            values: &values,
            variances: &[1e-12; 5],
            columns: Vec::new(),
        };
        let fit = units.fit().unwrap();
        assert!((fit.beta[0] - 3.0).abs() < 1e-12);
        assert!((fit.spread - 2.5_f64.sqrt()).abs() < 1e-9);
        let [low, high] = fit.interval(0).unwrap();
        assert!((high - 3.0 - 2.7764 * 0.5_f64.sqrt()).abs() < 1e-4);
        assert!((low + high - 6.0).abs() < 1e-9);
        let [low, high] = units.spread_interval().unwrap();
        assert!((low - (10.0_f64 / 11.143).sqrt()).abs() < 1e-4, "{low}");
        assert!((high - (10.0_f64 / 0.4844).sqrt()).abs() < 1e-3, "{high}");
    }

    #[test]
    fn estimates_with_their_errors_alone_have_no_spread() {
        // Q of (−1, 0, 1) with unit variances is 2, its mean: at the edge.
        let units = Units {
            values: &[-0.9, 0.0, 0.9],
            variances: &[1.0; 3],
            columns: Vec::new(),
        };
        let fit = units.fit().unwrap();
        assert_eq!(fit.spread, 0.0);
        // No less than the errors allow.
        assert!((fit.standard_error(0) - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        let two = Units {
            values: &[1.0],
            variances: &[1.0],
            columns: Vec::new(),
        };
        assert!(two.fit().is_none());
    }

    #[test]
    fn a_group_has_the_statistic_of_two_samples() {
        // Pooled two-sample t of (1,2,3) and (4,6,8): difference 4, pooled variance 2.5,
        // t = 4/√(2.5·2/3).
        let values = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0];
        let units = Units {
            values: &values,
            variances: &[1e-12; 6],
            columns: vec![vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0]],
        };
        let fit = units.fit().unwrap();
        assert!((fit.t(1) - 4.0 / (5.0_f64 / 3.0).sqrt()).abs() < 1e-8);
    }
}
