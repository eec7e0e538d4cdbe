use gyrocal_scalar::{NamedInputs, Real};

use crate::rotation::cross;

/// What lies fixed to the Earth, along the axes of a chart.
#[derive(Clone, Copy, Debug)]
pub struct Surroundings<'a, T> {
    pub(crate) north: &'a [T; 3],
    pub(crate) up: &'a [T; 3],
    /// Horizontal (north) and vertical component of Earth rate, rad/s.
    pub(crate) earth_rate: &'a [T; 2],
    pub(crate) gravity_g: T,
    /// East, North and Up component of the magnetic field, gauss.
    pub(crate) field_gauss: &'a [T; 3],
}

impl<T: Real> Surroundings<'_, T> {
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

    /// Sets what lies fixed to the Earth. A chart calls it whenever it has moved.
    fn surround(&mut self, surroundings: &Surroundings<'_, T>);
}

/// Every generated model is given what its groups of these names ask for. The others start at one
/// of their unit, where no term divides by zero.
impl<T: Real, I: NamedInputs<T>> ChartInputs<T> for I {
    #[inline(always)]
    fn unset() -> Self {
        Self::filled(T::from_f64(1.0))
    }

    #[inline(always)]
    fn surround(&mut self, surroundings: &Surroundings<'_, T>) {
        // The names are constants: nothing of this is left to be done at run time.
        if let Some(group) = self.group_mut("omega_0") {
            group.copy_from_slice(&surroundings.omega_0());
        }
        if let Some(group) = self.group_mut("f_0") {
            group.copy_from_slice(&surroundings.f_0());
        }
        if let Some(group) = self.group_mut("east_0") {
            group.copy_from_slice(&surroundings.east_0());
        }
        if let Some(group) = self.group_mut("field_0") {
            group.copy_from_slice(&surroundings.field_0());
        }
    }
}
