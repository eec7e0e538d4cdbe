//! Regression of residuals on a covariate, such as time or temperature: means in bins.

use crate::error::StatisticsError;
use crate::probability::chi_square_tail;

/// Mean of the residuals of one bin.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BinMean {
    /// Mean of the abscissa.
    pub at: f64,
    /// Mean of the residuals.
    pub mean: f64,
    /// Its standard deviation if residuals are independent and of the variance stated.
    pub sigma: f64,
    /// Number of residuals.
    pub values: usize,
}

/// Binned means over an abscissa, and the test that all are zero.
#[derive(Debug, Clone, PartialEq)]
pub struct BinnedMeans {
    /// Bins of equal numbers of values, in rising order.
    pub bins: Vec<BinMean>,
    /// Sum of squared means over their variances.
    pub chi_square: f64,
    /// Probability of as large a sum if all means are zero.
    pub p_value: f64,
}

/// Test that all means of bins are equal, whatever they are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EqualMeans {
    /// Sum of squared deviations from the weighted mean of all bins, over their variances.
    pub chi_square: f64,
    /// Number of bins less one.
    pub degrees_of_freedom: f64,
    /// Probability of as large a sum if all means are equal.
    pub p_value: f64,
}

impl BinnedMeans {
    /// Tests whether the residuals depend on the abscissa, their mean left free; `None` of one bin.
    #[must_use]
    pub fn equal_means(&self) -> Option<EqualMeans> {
        let weight = |bin: &BinMean| bin.sigma.powi(-2);
        let all: f64 = self.bins.iter().map(weight).sum();
        let mean = self
            .bins
            .iter()
            .map(|bin| weight(bin) * bin.mean)
            .sum::<f64>()
            / all;
        let deviations = self.bins.iter().map(|bin| (bin.mean - mean) / bin.sigma);
        let chi_square = deviations.map(|deviation| deviation * deviation).sum();
        let degrees_of_freedom = self.bins.len().saturating_sub(1) as f64;
        (self.bins.len() > 1).then(|| EqualMeans {
            chi_square,
            degrees_of_freedom,
            p_value: chi_square_tail(chi_square, degrees_of_freedom).unwrap_or(1.0),
        })
    }
}

/// Means of residuals in `bins` bins of equal numbers over an abscissa, such as a component of
/// specific force, time, or temperature. Each residual has standard deviation `sigma`; `NaN` in
/// either series is missing.
///
/// # Errors
///
/// [`StatisticsError::UnequalLengths`], [`StatisticsError::TooShort`] with fewer than two values a
/// bin, and [`StatisticsError::InvalidArgument`] without a bin or for a sigma that is not positive.
pub fn binned_means(
    abscissa: &[f64],
    residuals: &[f64],
    sigma: f64,
    bins: usize,
) -> Result<BinnedMeans, StatisticsError> {
    if abscissa.len() != residuals.len() {
        return Err(StatisticsError::UnequalLengths {
            what: "residuals",
            found: residuals.len(),
            expected: abscissa.len(),
        });
    }
    if !(sigma > 0.0 && sigma.is_finite()) {
        return Err(StatisticsError::InvalidArgument {
            what: "the standard deviation of a residual",
            found: sigma,
            expected: "a positive number",
        });
    }
    if bins == 0 {
        return Err(StatisticsError::InvalidArgument {
            what: "the number of bins",
            found: 0.0,
            expected: "one or more",
        });
    }
    let mut points: Vec<(f64, f64)> = abscissa
        .iter()
        .copied()
        .zip(residuals.iter().copied())
        .filter(|(at, value)| !at.is_nan() && !value.is_nan())
        .collect();
    if points.len() < 2 * bins {
        return Err(StatisticsError::TooShort {
            test: "the dependence of residuals",
            found: points.len(),
            expected: 2 * bins,
        });
    }
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    let edge = |bin: usize| bin * points.len() / bins;
    let bins: Vec<BinMean> = (0..bins)
        .map(|bin| {
            let within = &points[edge(bin)..edge(bin + 1)];
            let count = within.len() as f64;
            BinMean {
                at: within.iter().map(|(at, _)| at).sum::<f64>() / count,
                mean: within.iter().map(|(_, value)| value).sum::<f64>() / count,
                sigma: sigma / count.sqrt(),
                values: within.len(),
            }
        })
        .collect();
    let chi_square = bins.iter().map(|bin| (bin.mean / bin.sigma).powi(2)).sum();
    Ok(BinnedMeans {
        p_value: chi_square_tail(chi_square, bins.len() as f64).unwrap_or(1.0),
        chi_square,
        bins,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_means_leave_the_mean_free() -> Result<(), StatisticsError> {
        let abscissa: Vec<f64> = (0..40).map(f64::from).collect();
        let of = |step: f64| {
            let residuals: Vec<f64> = abscissa
                .iter()
                .map(|at| 5.0 + if *at < 20.0 { 0.0 } else { step })
                .collect();
            Ok::<_, StatisticsError>(binned_means(&abscissa, &residuals, 1.0, 4)?.equal_means())
        };
        assert!(of(0.0)?.is_some_and(|test| test.chi_square < 1e-20 && test.p_value > 0.999));
        // Four bins of ten values: each mean is half a step from that of all, over a sigma of 1/√10.
        let expected = 4.0 * 10.0 * 0.25;
        assert!(of(1.0)?.is_some_and(|test| (test.chi_square - expected).abs() < 1e-9));
        assert!(
            binned_means(&abscissa, &abscissa, 1.0, 1)?
                .equal_means()
                .is_none()
        );
        Ok(())
    }

    #[test]
    fn bins_hold_equal_numbers_and_sum_to_chi_square() -> Result<(), StatisticsError> {
        // Residuals alternate about 0.5 above and -0.5 below the middle of the abscissa, given
        // in falling order and with one missing value.
        let abscissa: Vec<f64> = (0..401).rev().map(f64::from).collect();
        let mut residuals: Vec<f64> = abscissa
            .iter()
            .map(|at| {
                let mean = if *at > 200.0 { 0.5 } else { -0.5 };
                mean + if *at as i64 % 2 == 0 { 1.0 } else { -1.0 }
            })
            .collect();
        residuals[200] = f64::NAN;
        let found = binned_means(&abscissa, &residuals, 1.0, 4)?;
        assert!(
            found
                .bins
                .iter()
                .all(|bin| bin.values == 100 && bin.sigma == 0.1)
        );
        assert_eq!(
            found.bins.iter().map(|bin| bin.mean).collect::<Vec<_>>(),
            [-0.5, -0.5, 0.5, 0.5]
        );
        assert_eq!(found.bins[0].at, 49.5);
        // Four means, each five of their sigmas off.
        assert!((found.chi_square - 100.0).abs() < 1e-9);
        assert!(found.p_value < 1e-18);
        assert!(binned_means(&abscissa, &residuals, 1.0, 300).is_err());
        Ok(())
    }
}
