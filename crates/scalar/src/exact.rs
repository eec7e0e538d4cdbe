//! Functions whose result is exact or correctly rounded in every library: of the standard library,
//! where they are instructions of the target, or of `libm`.

#[cfg(not(feature = "std"))]
pub(crate) use libm::{sqrt, sqrtf};
// emit: off
#[cfg(not(feature = "std"))]
pub(crate) use libm::{ceil, ceilf, floor, floorf};
// emit: on

#[cfg(feature = "std")]
macro_rules! of_std {
    ($($name:ident: $float:ident, $method:ident);*) => {$(
        #[inline(always)]
        pub(crate) fn $name(x: $float) -> $float {
            x.$method()
        }
    )*};
}
#[cfg(feature = "std")]
of_std!(sqrt: f64, sqrt; floor: f64, floor; ceil: f64, ceil;
        sqrtf: f32, sqrt; floorf: f32, floor; ceilf: f32, ceil);
