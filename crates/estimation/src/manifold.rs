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
}
