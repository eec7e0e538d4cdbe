//! Shares of independent trials, with exact intervals.

use statrs::distribution::{Beta, ContinuousCDF};

use crate::bands::check;

/// Confidence at which a limit is shown to be met, one-sided.
const MET: f64 = 0.95;

/// Confidence at which a limit is shown to be missed, one-sided: with tens of shares judged at once,
/// none is to be missed by chance.
const MISSED: f64 = 0.999;

/// Comparison of a true share with a limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Judgement {
    /// The trials show, with 95 % confidence, that the limit is met.
    Met,
    /// The trials show, with 99.9 % confidence, that the limit is missed.
    Missed,
    /// The trials are too few to show either.
    TooFew,
}

impl Judgement {
    /// From what the trials show.
    #[must_use]
    pub fn of(met: bool, missed: bool) -> Self {
        match (met, missed) {
            (_, true) => Self::Missed,
            (true, false) => Self::Met,
            (false, false) => Self::TooFew,
        }
    }

    /// `true` if the limit is met, `false` if it is missed, `None` if the trials are too few to tell.
    #[must_use]
    pub fn holds(self) -> Option<bool> {
        match self {
            Self::Met => Some(true),
            Self::Missed => Some(false),
            Self::TooFew => None,
        }
    }
}

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

    /// Comparison of the true share with a lower limit.
    #[must_use]
    pub fn at_least(&self, least: f64) -> Judgement {
        Judgement::of(
            self.lower_bound(MET) >= least,
            self.upper_bound(MISSED) < least,
        )
    }

    /// Comparison of the true share with an upper limit.
    #[must_use]
    pub fn at_most(&self, most: f64) -> Judgement {
        Judgement::of(
            self.upper_bound(MET) <= most,
            self.lower_bound(MISSED) > most,
        )
    }

    fn counts(&self) -> [f64; 2] {
        [self.hits as f64, (self.trials - self.hits) as f64]
    }
}

/// The quantile of a beta distribution. Bisection on the distribution function, to the last bit:
/// library quantiles are approximate, and one wrong in the fifth digit decides tests.
fn beta_quantile(a: f64, b: f64, share: f64) -> f64 {
    #[expect(
        clippy::expect_used,
        reason = "counts of hits and misses, at least one of each"
    )]
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
