use gyrocal_scalar::{NamedInputs, Real};

use crate::rotation::cross;

/// Vectors fixed to the Earth, resolved along the axes of a chart.
#[derive(Clone, Copy, Debug)]
pub struct ChartVectors<'a, T> {
    pub(crate) north: &'a [T; 3],
    pub(crate) up: &'a [T; 3],
    /// Horizontal (north) and vertical component of Earth rate, rad/s.
    pub(crate) earth_rate: &'a [T; 2],
    pub(crate) gravity_g: T,
    /// East, North and Up component of the magnetic field, gauss.
    pub(crate) field_gauss: &'a [T; 3],
}

impl<T: Real> ChartVectors<'_, T> {
    /// Earth rate, rad/s.
    #[inline(always)]
    #[must_use]
    pub fn omega_0(&self) -> [T; 3] {
        let [horizontal, vertical] = *self.earth_rate;
        core::array::from_fn(|i| horizontal.mul_add(self.north[i], vertical * self.up[i]))
    }

    /// Specific force, up positive, g.
    #[inline(always)]
    #[must_use]
    pub fn f_0(&self) -> [T; 3] {
        self.up.map(|component| self.gravity_g * component)
    }

    /// Unit vector East.
    #[inline(always)]
    #[must_use]
    pub fn east_0(&self) -> [T; 3] {
        cross(self.north, self.up)
    }

    /// Magnetic field of the Earth, gauss.
    #[inline(always)]
    #[must_use]
    pub fn field_0(&self) -> [T; 3] {
        let (e, [east, north, up]) = (self.east_0(), *self.field_gauss);
        core::array::from_fn(|i| east.mul_add(e[i], north.mul_add(self.north[i], up * self.up[i])))
    }
}

/// Inputs of a generated model of the platform, as far as a [`Chart`](crate::Chart) gives them.
///
/// The inputs of every generated model have it through
/// [`NamedInputs`](gyrocal_scalar::NamedInputs); inputs written by hand get it by that trait too:
///
/// ```
/// use gyrocal::scalar::NamedInputs;
/// use gyrocal::{ChartInputs, Real};
///
/// #[derive(Clone, Copy)]
/// struct MyInputs<T> {
///     omega_0: [T; 3],
///     f_0: [T; 3],
///     conditions: [T; 3],
/// }
///
/// impl<T: Real> NamedInputs<T> for MyInputs<T> {
///     fn filled(value: T) -> Self {
///         Self { omega_0: [value; 3], f_0: [value; 3], conditions: [value; 3] }
///     }
///     fn group_mut(&mut self, name: &str) -> Option<&mut [T]> {
///         match name {
///             "omega_0" => Some(&mut self.omega_0),
///             "f_0" => Some(&mut self.f_0),
///             "conditions" => Some(&mut self.conditions),
///             _ => None,
///         }
///     }
/// }
///
/// let unset = <MyInputs<f64> as ChartInputs<f64>>::unset();
/// assert_eq!(unset.conditions, [1.0; 3]);
/// ```
pub trait ChartInputs<T>: Copy {
    /// Inputs before a chart has set them; those that no chart sets have a harmless value.
    #[must_use]
    fn unset() -> Self;

    /// Sets the inputs that are vectors fixed to the Earth. A chart calls it whenever it has moved.
    fn set_from_chart(&mut self, vectors: &ChartVectors<'_, T>);
}

/// A generated model gets the vectors that its groups of inputs are named after. Its other inputs
/// start at one of their unit, where no term divides by zero.
impl<T: Real, I: NamedInputs<T>> ChartInputs<T> for I {
    #[inline(always)]
    fn unset() -> Self {
        Self::filled(T::from_f64(1.0))
    }

    #[inline(always)]
    fn set_from_chart(&mut self, vectors: &ChartVectors<'_, T>) {
        // The names are constants: the compiler resolves the comparisons.
        if let Some(group) = self.group_mut("omega_0") {
            group.copy_from_slice(&vectors.omega_0());
        }
        if let Some(group) = self.group_mut("f_0") {
            group.copy_from_slice(&vectors.f_0());
        }
        if let Some(group) = self.group_mut("east_0") {
            group.copy_from_slice(&vectors.east_0());
        }
        if let Some(group) = self.group_mut("field_0") {
            group.copy_from_slice(&vectors.field_0());
        }
    }
}
