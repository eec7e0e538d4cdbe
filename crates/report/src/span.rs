//! Intervals of values.

/// An interval of values; the lower end is not above the upper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    pub lo: f64,
    pub hi: f64,
}

impl Span {
    pub(crate) fn new(lo: f64, hi: f64) -> Self {
        Self { lo, hi }
    }

    /// The span of all finite values; `None` if there are none.
    pub(crate) fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let finite = values.into_iter().filter(|value| value.is_finite());
        finite
            .map(|value| Self::new(value, value))
            .reduce(Self::with)
    }

    /// From minus to plus the size.
    pub(crate) fn symmetric(size: f64) -> Self {
        Self::new(-size, size).open()
    }

    /// Both together.
    pub(crate) fn with(self, other: Self) -> Self {
        Self::new(self.lo.min(other.lo), self.hi.max(other.hi))
    }

    /// A little more on either side, a fraction of the length.
    pub(crate) fn padded(self, fraction: f64) -> Self {
        let span = self.open();
        let more = fraction * span.length();
        Self::new(span.lo - more, span.hi + more)
    }

    /// A span that is not a single point, so that there is a scale.
    pub(crate) fn open(self) -> Self {
        let size = self.lo.abs().max(self.hi.abs());
        // Below that, differences of neighbouring numbers would be the steps of the axis.
        if self.length() > 1e-9 * size {
            return self;
        }
        let more = if size > 0.0 { 0.1 * size } else { 1.0 };
        Self::new(self.lo - more, self.hi + more)
    }

    pub(crate) fn length(self) -> f64 {
        self.hi - self.lo
    }

    /// The largest absolute value.
    pub(crate) fn largest(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }
}
