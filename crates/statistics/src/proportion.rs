//! Shares of independent trials, with exact intervals.

use statrs::distribution::{Beta, ContinuousCDF};

use crate::bands::check;

/// Number of independent trials that came out in one way, of all of them.
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
