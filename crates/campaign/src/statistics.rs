//! What a number of independent runs says, with exact intervals.

use gyrocal_calibration::chi_square_band;
use statrs::distribution::{Beta, ContinuousCDF};

/// Mean; `NaN` of nothing.
#[must_use]
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Standard error of the mean, from the scatter of the values; `NaN` of fewer than two.
#[must_use]
pub fn standard_error(values: &[f64]) -> f64 {
    let mean = mean(values);
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    let count = values.len() as f64;
    (squares / (count - 1.0) / count).sqrt()
}

/// Root mean square; `NaN` of nothing.
#[must_use]
pub fn root_mean_square(values: &[f64]) -> f64 {
    let squares: f64 = values.iter().map(|value| value * value).sum();
    (squares / values.len() as f64).sqrt()
}

/// Median: half of the values lie below. `NaN` of nothing.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// Quantile, linear between neighbouring values (type 7 of Hyndman and Fan 1996, the default of
/// R and NumPy). `NaN` of nothing.
///
/// # Panics
/// If `share` is not between 0 and 1.
#[must_use]
pub fn quantile(values: &[f64], share: f64) -> f64 {
    assert!((0.0..=1.0).contains(&share), "a share, found {share}");
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let place = share * last as f64;
    let below = place.floor() as usize;
    let above = (below + 1).min(last);
    let fraction = place - below as f64;
    if fraction == 0.0 {
        return sorted[below];
    }
    sorted[below] + fraction * (sorted[above] - sorted[below])
}

/// How many of a number of independent trials came out in one way.
///
/// Its bounds are those of Clopper and Pearson (1934): at least the stated confidence, whatever
/// the true share.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Proportion {
    /// Trials that did.
    pub hits: u64,
    /// All trials.
    pub trials: u64,
}

impl Proportion {
    /// Counts.
    #[must_use]
    pub fn of(outcomes: impl IntoIterator<Item = bool>) -> Self {
        let none = Self { hits: 0, trials: 0 };
        outcomes.into_iter().fold(none, |count, hit| Self {
            hits: count.hits + u64::from(hit),
            trials: count.trials + 1,
        })
    }

    /// The share of hits; `NaN` without trials.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.hits as f64 / self.trials as f64
    }

    /// Variance of the share, with half a hit and half a miss more: never zero.
    #[must_use]
    pub fn variance(&self) -> f64 {
        let trials = self.trials as f64 + 1.0;
        let share = (self.hits as f64 + 0.5) / trials;
        share * (1.0 - share) / trials
    }

    /// The true share is not lower than this, with at least this confidence.
    ///
    /// # Panics
    /// If `confidence` is not between 0 and 1, neither included.
    #[must_use]
    pub fn lower_bound(&self, confidence: f64) -> f64 {
        check(confidence);
        if self.hits == 0 {
            return 0.0;
        }
        let [hits, misses] = self.counts();
        beta_quantile(hits, misses + 1.0, 1.0 - confidence)
    }

    /// The true share is not higher than this, with at least this confidence.
    ///
    /// # Panics
    /// If `confidence` is not between 0 and 1, neither included.
    #[must_use]
    pub fn upper_bound(&self, confidence: f64) -> f64 {
        check(confidence);
        if self.hits >= self.trials {
            return 1.0;
        }
        let [hits, misses] = self.counts();
        beta_quantile(hits + 1.0, misses, confidence)
    }

    /// The true share lies between these, with at least this confidence; each side errs with
    /// half of the rest.
    ///
    /// # Panics
    /// If `confidence` is not between 0 and 1, neither included.
    #[must_use]
    pub fn interval(&self, confidence: f64) -> [f64; 2] {
        let one_sided = (1.0 + confidence) / 2.0;
        [self.lower_bound(one_sided), self.upper_bound(one_sided)]
    }

    fn counts(&self) -> [f64; 2] {
        [self.hits as f64, (self.trials - self.hits) as f64]
    }
}

/// The interval that holds, with this probability, the sum over `runs` of normalised squared
/// errors divided by `runs`, if the covariances are right; `degrees_of_freedom` is the sum over
/// all runs.
///
/// # Panics
/// If `degrees_of_freedom` is not positive, or `probability` not between 0 and 1.
#[must_use]
pub fn mean_square_band(degrees_of_freedom: f64, runs: f64, probability: f64) -> [f64; 2] {
    check(probability);
    chi_square_band(degrees_of_freedom, 1.0 - probability).map(|bound| bound / runs)
}

/// The interval that holds, with this confidence, the true ratio of root mean square error to
/// sigma, when normal errors gave `ratio` in a number of runs.
///
/// # Panics
/// If `runs` is 0, or `confidence` not between 0 and 1.
#[must_use]
pub fn rms_ratio_interval(ratio: f64, runs: usize, confidence: f64) -> [f64; 2] {
    check(confidence);
    let count = runs as f64;
    let [low, high] = chi_square_band(count, 1.0 - confidence);
    [ratio * (count / high).sqrt(), ratio * (count / low).sqrt()]
}

fn check(probability: f64) {
    assert!(
        probability > 0.0 && probability < 1.0,
        "a probability between 0 and 1, found {probability}"
    );
}

/// The quantile of a beta distribution. Bisection on the distribution function, to the last bit:
/// library quantiles are approximate, and one wrong in the fifth digit decides tests.
fn beta_quantile(a: f64, b: f64, share: f64) -> f64 {
    #[allow(clippy::expect_used)] // counts of hits and misses, at least one of each
    let distribution = Beta::new(a, b).expect("positive counts");
    let (mut low, mut high) = (0.0, 1.0);
    loop {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            return middle;
        }
        if distribution.cdf(middle) < share {
            low = middle;
        } else {
            high = middle;
        }
    }
}

#[cfg(test)]
mod tests;
