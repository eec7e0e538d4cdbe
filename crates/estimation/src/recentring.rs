use gyrocal_scalar::Real;

/// Times at which the chart of the moving states is moved to the estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Recentring<T> {
    /// At every step, and corrections are applied on the manifold: the consistent choice.
    EveryStep,
    /// When a moving state leaves ±limit; in between, corrections are added to coordinates.
    Beyond(T),
    /// Never: coordinates of the first chart all along.
    Never,
}

impl<T: Real> Recentring<T> {
    #[inline(always)]
    pub(crate) fn wanted<const M: usize>(self, moving: &[T; M]) -> bool {
        match self {
            Self::EveryStep => true,
            Self::Beyond(limit) => moving.iter().any(|state| state.abs() > limit),
            Self::Never => false,
        }
    }
}
