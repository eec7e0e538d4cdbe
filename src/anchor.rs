use gyrocal_scalar::{Model, RatesJacobian, Real, Recentre};

use crate::chart_vectors::{ChartInputs, ChartVectors};
use crate::generated::platform::{PlatformInputs, reanchor};
use crate::orientation::{Numbers, Orientation};
use crate::rotation::{cross, turned_by};
use crate::site::Site;

/// A chart fixed to the Earth: its orientation, and the inputs `I` of a generated model along its
/// axes, such as Earth rate and specific force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chart<T, I = PlatformInputs<T>> {
    inputs: I,
    orientation: Orientation<T>,
    site: Site<T>,
    /// Horizontal (north) and vertical component of Earth rate, rad/s.
    earth_rate: [T; 2],
    /// East, North and Up component of the magnetic field, gauss.
    field_gauss: [T; 3],
}

impl<T: Real> Chart<T> {
    /// A chart of no site, for a filter that has not started.
    pub(crate) const fn unset() -> Self {
        let zero = [T::ZERO; 3];
        Self {
            inputs: PlatformInputs {
                omega_0: zero,
                f_0: zero,
            },
            orientation: Orientation::new(zero, zero),
            site: Site {
                latitude_rad: T::ZERO,
                earth_rate_rad_per_s: T::ZERO,
                gravity_g: T::ZERO,
            },
            earth_rate: [T::ZERO; 2],
            field_gauss: zero,
        }
    }

    /// The chart East-North-Up at a site, for the nominal model.
    #[must_use]
    pub fn east_north_up(site: Site<T>) -> Self {
        Self::for_model(site)
    }
}

impl<T: Real, I: ChartInputs<T>> Chart<T, I> {
    /// The chart East-North-Up at a site, for a model that takes the inputs `I`.
    ///
    /// ```
    /// use gyrocal::generated::surveyed::SurveyedInputs;
    /// use gyrocal::{Chart, Site};
    ///
    /// let chart: Chart<f64, SurveyedInputs<f64>> = Chart::for_model(Site::at_latitude_deg(39.1));
    /// assert_eq!(chart.inputs().east_0, [1.0, 0.0, 0.0]);
    /// ```
    #[must_use]
    pub fn for_model(site: Site<T>) -> Self {
        let (zero, one) = (T::from_f64(0.0), T::from_f64(1.0));
        let (sine, cosine) = site.latitude_rad.sin_cos();
        let rate = site.earth_rate_rad_per_s;
        let mut chart = Self {
            inputs: I::unset(),
            orientation: Orientation::new([zero, one, zero], [zero, zero, one]),
            site,
            earth_rate: [rate * cosine, rate * sine],
            field_gauss: [zero; 3],
        };
        chart.update_inputs();
        chart
    }

    /// Inputs of the generated model: Earth rate in rad/s, specific force in g, ….
    #[must_use]
    pub fn inputs(&self) -> &I {
        &self.inputs
    }

    /// Inputs that a caller sets: conditions and shapes of an extended model. Vectors fixed to the
    /// Earth are overwritten whenever the chart moves.
    #[must_use]
    pub fn inputs_mut(&mut self) -> &mut I {
        &mut self.inputs
    }

    /// Sets the magnetic field of the Earth: its East, North and Up components, gauss.
    pub fn set_field_gauss(&mut self, east_north_up: [T; 3]) {
        self.field_gauss = east_north_up;
        self.update_inputs();
    }

    /// Matrix that takes components along East, North, Up to components along the chart.
    #[must_use]
    pub fn chart_c_enu(&self) -> [[T; 3]; 3] {
        let Orientation { north, up, .. } = &self.orientation;
        let east = cross(north, up);
        core::array::from_fn(|i| [east[i], north[i], up[i]])
    }

    /// Unit vectors North and Up along the chart axes.
    #[must_use]
    pub fn orientation(&self) -> [[T; 3]; 2] {
        [self.orientation.north, self.orientation.up]
    }

    /// Numbers of the orientation, and the turns so far, on which the time of the next
    /// renormalisation depends.
    pub(crate) fn saved(&self) -> (Numbers<T>, u32) {
        self.orientation.saved()
    }

    /// Restores the orientation of a saved chart.
    pub(crate) fn restore(&mut self, numbers: Numbers<T>, turns: u32) {
        self.orientation.restore(numbers, turns);
        self.update_inputs();
    }

    /// Sets the orientation of the chart: the components of North and Up, orthogonal unit vectors.
    pub fn set_orientation(&mut self, north_and_up: &[[T; 3]; 2]) {
        self.orientation.set(north_and_up);
        self.update_inputs();
    }

    /// Rotates the chart: `matrix` takes old components to new ones.
    #[inline(always)]
    fn rotate(&mut self, matrix: &[[T; 3]; 3]) {
        self.orientation.turn(matrix);
        self.update_inputs();
    }

    /// Vectors fixed to the Earth, where the chart stands otherwise: at the given orientation.
    #[cfg(feature = "watch")]
    pub(crate) fn vectors_along<'a>(
        &'a self,
        north: &'a [T; 3],
        up: &'a [T; 3],
    ) -> ChartVectors<'a, T> {
        ChartVectors {
            north,
            up,
            earth_rate: &self.earth_rate,
            gravity_g: self.site.gravity_g,
            field_gauss: &self.field_gauss,
        }
    }

    /// Computes the inputs of the model along the axes of the chart.
    #[inline(always)]
    fn update_inputs(&mut self) {
        self.inputs.set_from_chart(&ChartVectors {
            north: &self.orientation.north,
            up: &self.orientation.up,
            earth_rate: &self.earth_rate,
            gravity_g: self.site.gravity_g,
            field_gauss: &self.field_gauss,
        });
    }
}

/// A generated platform model whose chart moves with the platform.
///
/// The moving states are the platform angles in the current [`Chart`]. Moving the chart
/// replaces the error of the angles by the small rotation W δθ between the platform and its
/// estimate, in platform axes, which is what a correction is applied as:
/// C ← exp(-\[δφ\]×) C. At the new origin W is the identity, so rates, output and covariance
/// need no further change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Anchored<D>(pub D);

impl<T, D> Model<T, 3, 3> for Anchored<D>
where
    T: Real,
    D: Model<T, 3, 3, Inputs: ChartInputs<T>>,
{
    type Inputs = Chart<T, D::Inputs>;

    #[inline(always)]
    fn parameters(&self) -> usize {
        self.0.parameters()
    }

    #[inline(always)]
    fn output_parameters(&self) -> usize {
        self.0.output_parameters()
    }

    #[inline(always)]
    fn noise_parameters(&self) -> Option<[usize; 3]> {
        self.0.noise_parameters()
    }

    #[inline(always)]
    fn rates(&self, moving: &[T; 3], parameters: &[T], chart: &Self::Inputs) -> [T; 3] {
        self.0.rates(moving, parameters, &chart.inputs)
    }

    #[inline(always)]
    fn rates_jacobian(
        &self,
        moving: &[T; 3],
        parameters: &[T],
        chart: &Self::Inputs,
        jacobian: &mut RatesJacobian<'_, T, 3>,
    ) -> [T; 3] {
        self.0
            .rates_jacobian(moving, parameters, &chart.inputs, jacobian)
    }

    #[inline(always)]
    fn rates_jacobian_at_origin(
        &self,
        parameters: &[T],
        chart: &Self::Inputs,
        jacobian: &mut RatesJacobian<'_, T, 3>,
    ) -> [T; 3] {
        self.0
            .rates_jacobian_at_origin(parameters, &chart.inputs, jacobian)
    }

    #[inline(always)]
    fn enters_at_origin(&self, i: usize, j: usize) -> bool {
        self.0.enters_at_origin(i, j)
    }

    #[inline(always)]
    fn moves_at_origin(&self, i: usize, j: usize) -> bool {
        self.0.moves_at_origin(i, j)
    }

    #[inline(always)]
    fn shows_at_origin(&self, k: usize, j: usize) -> bool {
        self.0.shows_at_origin(k, j)
    }

    #[inline(always)]
    fn output(&self, moving: &[T; 3], parameters: &[T], chart: &Self::Inputs) -> [T; 3] {
        self.0.output(moving, parameters, &chart.inputs)
    }

    #[inline(always)]
    fn output_jacobian(
        &self,
        moving: &[T; 3],
        parameters: &[T],
        chart: &Self::Inputs,
        d_moving: &mut [[T; 3]; 3],
        d_parameters: &mut [T],
    ) -> [T; 3] {
        self.0
            .output_jacobian(moving, parameters, &chart.inputs, d_moving, d_parameters)
    }

    #[inline(always)]
    fn output_jacobian_at_origin(
        &self,
        parameters: &[T],
        chart: &Self::Inputs,
        d_moving: &mut [[T; 3]; 3],
        d_parameters: &mut [T],
    ) -> [T; 3] {
        self.0
            .output_jacobian_at_origin(parameters, &chart.inputs, d_moving, d_parameters)
    }
}

impl<T, D> Recentre<T, 3, 3> for Anchored<D>
where
    T: Real,
    D: Model<T, 3, 3, Inputs: ChartInputs<T>>,
{
    #[inline(always)]
    fn has_chart(&self) -> bool {
        true
    }

    #[inline(always)]
    fn recentre(&self, moving: &mut [T; 3], chart: &mut Self::Inputs) -> Option<[[T; 3]; 3]> {
        let at = reanchor(moving);
        chart.rotate(&at.platform_c_chart);
        *moving = [T::from_f64(0.0); 3];
        Some(at.rotation_d_theta_dense())
    }

    /// W is the rate matrix of rotations about x, then y, then z: the last turns about the axis
    /// itself, and the second stays in the plane across it.
    #[inline(always)]
    fn maps(&self, i: usize, j: usize) -> bool {
        j == 0 || (j == 1 && i < 2)
    }

    #[inline(always)]
    fn correct(&self, _moving: &mut [T; 3], chart: &mut Self::Inputs, correction: &[T; 3]) {
        chart.rotate(&turned_by(correction));
    }
}
