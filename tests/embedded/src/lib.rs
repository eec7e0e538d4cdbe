//! A controller's view of `gyrocal`: a static library without the standard library, with its
//! own panic handler, that a C program can link.
//!
//! It proves that nothing in the library needs `std` or an allocator. The filter lives where
//! the caller puts it.

#![no_std]

use core::mem::{align_of, size_of};
use core::panic::PanicInfo;

use gyrocal::{FactorisedPlatformFilter, FilterSettings, InitialAttitude, Site};

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    loop {}
}

/// Bytes that a filter needs.
#[unsafe(no_mangle)]
pub extern "C" fn gyrocal_filter_size() -> usize {
    size_of::<FactorisedPlatformFilter<f32>>()
}

/// Alignment that a filter needs.
#[unsafe(no_mangle)]
pub extern "C" fn gyrocal_filter_alignment() -> usize {
    align_of::<FactorisedPlatformFilter<f32>>()
}

/// Makes a filter in `place`; false if the settings are refused.
///
/// # Safety
/// `place` must be valid for writes of [`gyrocal_filter_size`] bytes and aligned.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_filter_start(
    place: *mut FactorisedPlatformFilter<f32>,
    latitude_deg: f64,
) -> bool {
    let settings = FilterSettings::at_site(Site::at_latitude_deg(latitude_deg));
    match FactorisedPlatformFilter::factorised(&settings, &InitialAttitude::aligned()) {
        Ok(filter) => {
            // SAFETY: the caller vouches for size, alignment and validity.
            unsafe { place.write(filter) };
            true
        }
        Err(_) => false,
    }
}

/// Takes a sample and writes its normalised innovation squared; false if the filter failed.
///
/// # Safety
/// `filter` must come from [`gyrocal_filter_start`], `specific_force_g` and `nis` be valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_filter_step(
    filter: *mut FactorisedPlatformFilter<f32>,
    interval_s: f32,
    specific_force_g: *const [f32; 3],
    nis: *mut f32,
) -> bool {
    // SAFETY: the caller vouches for the pointers.
    let (filter, sample, nis) = unsafe { (&mut *filter, &*specific_force_g, &mut *nis) };
    match filter.step(interval_s, sample) {
        Ok(innovation) => {
            *nis = innovation.nis;
            true
        }
        Err(_) => false,
    }
}
