use gyrocal_scalar::Recentre;

/// A model whose moving states can be put down as points of a trajectory and compared.
///
/// `M` moving states, `Y` outputs.
pub trait Manifold<const M: usize, const Y: usize>: Recentre<f64, M, Y> {
    /// A value of the moving states, wherever the chart is.
    type Point: Copy;

    /// The point where moving states and chart stand.
    fn point(&self, moving: &[f64; M], inputs: &Self::Inputs) -> Self::Point;

    /// Puts moving states and chart onto a point.
    fn place(&self, point: &Self::Point, moving: &mut [f64; M], inputs: &mut Self::Inputs);

    /// The correction that [`Recentre::correct`] needs to get from one point to the other.
    fn difference(&self, from: &Self::Point, to: &Self::Point) -> [f64; M];

    /// Transformation of errors by a correction; `None` if they do not change, as in a flat state
    /// space.
    fn corrected(&self, correction: &[f64; M]) -> Option<Corrected<M>> {
        let _ = correction;
        None
    }
}

/// Derivatives of a corrected point, as corrections of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Corrected<const M: usize> {
    /// With respect to a correction of the point that was corrected.
    pub point: [[f64; M]; M],
    /// With respect to the correction; the correction itself is mapped to itself.
    pub correction: [[f64; M]; M],
}
