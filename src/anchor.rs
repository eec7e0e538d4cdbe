use gyrocal_scalar::{Model, RatesJacobian, Real, Recentre};

use crate::chart_vectors::{ChartInputs, ChartVectors};
use crate::generated::platform::{PlatformInputs, reanchor};
use crate::rotation::{cross, dot, rotate, turned_by};
use crate::site::Site;

/// A chart fixed to the Earth: its orientation, and the inputs `I` of a generated model along its
/// axes, such as Earth rate and specific force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chart<T, I = PlatformInputs<T>> {
    inputs: I,
    /// Unit vectors along the chart axes.
    north: [T; 3],
    up: [T; 3],
    site: Site<T>,
    /// Horizontal (north) and vertical component of Earth rate, rad/s.
    earth_rate: [T; 2],
    /// East, North and Up component of the magnetic field, gauss.
    field_gauss: [T; 3],
    turns: u32,
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
            north: zero,
            up: zero,
            site: Site {
                latitude_rad: T::ZERO,
                earth_rate_rad_per_s: T::ZERO,
                gravity_g: T::ZERO,
            },
            earth_rate: [T::ZERO; 2],
            field_gauss: zero,
            turns: 0,
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
            north: [zero, one, zero],
            up: [zero, zero, one],
            site,
            earth_rate: [rate * cosine, rate * sine],
            field_gauss: [zero; 3],
            turns: 0,
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
        let east = cross(&self.north, &self.up);
        core::array::from_fn(|i| [east[i], self.north[i], self.up[i]])
    }

    /// Unit vectors North and Up along the chart axes.
    #[must_use]
    pub fn orientation(&self) -> [[T; 3]; 2] {
        [self.north, self.up]
    }

    /// Turns so far, on which the time of the next renormalisation depends.
    pub(crate) fn turns(&self) -> u32 {
        self.turns
    }

    /// Restores orientation and turns of a saved chart.
    pub(crate) fn restore(&mut self, orientation: &[[T; 3]; 2], turns: u32) {
        self.set_orientation(orientation);
        self.turns = turns;
    }

    /// Sets the orientation of the chart: the components of North and Up, orthogonal unit vectors.
    pub fn set_orientation(&mut self, [north, up]: &[[T; 3]; 2]) {
        (self.north, self.up) = (*north, *up);
        self.update_inputs();
    }

    /// Rotates the chart: `matrix` takes old components to new ones.
    #[inline(always)]
    fn rotate(&mut self, matrix: &[[T; 3]; 3]) {
        self.north = rotate(matrix, &self.north);
        self.up = rotate(matrix, &self.up);
        self.turns = self.turns.wrapping_add(1);
        // Rounding adds at most some units of the last place a turn; in f32 that would matter
        // after a few thousand.
        if self.turns & 63 == 0 {
            self.orthonormalise();
        }
        self.update_inputs();
    }

    /// Computes the inputs of the model along the axes of the chart.
    #[inline(always)]
    fn update_inputs(&mut self) {
        self.inputs.set_from_chart(&ChartVectors {
            north: &self.north,
            up: &self.up,
            earth_rate: &self.earth_rate,
            gravity_g: self.site.gravity_g,
            field_gauss: &self.field_gauss,
        });
    }

    #[cold]
    #[inline(never)]
    fn orthonormalise(&mut self) {
        let one = T::from_f64(1.0);
        let scale = one / dot(&self.up, &self.up).sqrt();
        self.up = self.up.map(|component| component * scale);
        let along = dot(&self.up, &self.north);
        for i in 0..3 {
            self.north[i] = self.north[i] - along * self.up[i];
        }
        let scale = one / dot(&self.north, &self.north).sqrt();
        self.north = self.north.map(|component| component * scale);
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
