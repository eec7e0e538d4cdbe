use gyrocal_scalar::Real;

/// E-processes below e to this power count as nothing, which only lowers the statistic and spares
/// the exponential.
const LEAST: f64 = 6.0;
/// Exponents are cut here: the sum stays finite in single precision.
const MOST: f64 = 60.0;

/// The normal-mixture e-process of one effect from one onset.
///
/// For a score S with information I it is (1 + τ² I)^(-1/2) exp(S² / (2 (τ⁻² + I))): the mean of
/// the likelihood ratio over sizes with the standard deviation τ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Evidence<T> {
    /// τ⁻²: precision of the sizes that are looked for.
    pub precision: T,
}

impl<T: Real> Evidence<T> {
    /// The logarithm of the e-process; `None` where it counts as nothing.
    #[inline]
    #[must_use]
    pub fn logarithm(&self, score: T, information: T) -> Option<T> {
        let total = self.precision + information;
        let twice = score * score;
        // The exponent alone is above the logarithm.
        let counts = twice > T::from_f64(2.0 * LEAST) * total;
        if !counts {
            return None;
        }
        let half = T::from_f64(0.5);
        Some(half * (twice / total - (total / self.precision).ln()))
    }

    /// The e-process; zero where it counts as nothing.
    #[inline]
    #[must_use]
    pub fn value(&self, score: T, information: T) -> T {
        self.logarithm(score, information)
            .map_or(T::ZERO, |logarithm| logarithm.min(T::from_f64(MOST)).exp())
    }
}

/// The least deviance of an effect that cannot be told apart from the one with the largest: `width` below
/// it, or a third of it.
///
/// An effect whose onset lies between two of the grid loses a share of its deviance, however large that is.
#[inline]
#[must_use]
pub fn least_of_set<T: Real>(largest: T, width: T) -> T {
    largest - width.max(largest * T::from_f64(1.0 / 3.0))
}

/// Probability of a false alarm, and the onsets that share it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Budget<T> {
    /// Largest probability of a false alarm in a year, or for ever.
    pub alpha: T,
    /// Onsets of weight one in a year.
    pub onsets_per_year: T,
    /// For ever: the onsets of year y, from zero, have the weight 1 / ((y + 1) (y + 2)).
    pub for_ever: bool,
}

impl<T: Real> Budget<T> {
    /// The statistic at which there is an alarm; `first` is the weight of the first onset, which
    /// no onsets before it have paid for.
    #[inline]
    #[must_use]
    pub fn threshold(&self, first: T) -> T {
        (self.onsets_per_year + first) / self.alpha
    }

    /// Weight of an onset by its year.
    #[inline]
    #[must_use]
    pub fn weight(&self, onset: u32) -> T {
        let one = T::from_f64(1.0);
        if !self.for_ever {
            return one;
        }
        let year = T::from_u32((T::from_u32(onset) / self.onsets_per_year).to_u32());
        one / ((year + one) * (year + one + one))
    }
}
