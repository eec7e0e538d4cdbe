use core::mem::{align_of, size_of};
use core::ptr;
use core::slice;

use gyrocal::{ControllerError, ControllerFilter};

use crate::settings::GyrocalSettings;
use crate::status::{self, GYROCAL_NOT_RUNNING, GYROCAL_NULL, GYROCAL_OK};

/// Words of 32 bits that a filter takes.
pub const GYROCAL_FILTER_WORDS: usize = 656;
/// Bytes that a filter takes.
pub const GYROCAL_FILTER_SIZE: usize = 2624;
/// Alignment of a filter in bytes.
pub const GYROCAL_FILTER_ALIGNMENT: usize = 4;
/// Bytes of a saved state.
pub const GYROCAL_SAVED_SIZE: usize = 476;

/// A filter. Its contents are private; memory of zeros is no filter, and is answered as such.
#[repr(C)]
pub struct GyrocalFilter {
    words: [u32; 656],
}

/// The contents of the memory.
#[repr(C)]
struct Inner {
    /// [`MARK`] if a filter follows.
    mark: u32,
    /// NIS of the last sample that was taken.
    nis: f32,
    filter: ControllerFilter<f32>,
}

const MARK: u32 = 0x4759_5243;

// The header has literals.
const _: () = {
    assert!(size_of::<Inner>() <= size_of::<GyrocalFilter>());
    assert!(align_of::<Inner>() <= align_of::<GyrocalFilter>());
    assert!(GYROCAL_FILTER_SIZE == size_of::<GyrocalFilter>());
    assert!(GYROCAL_FILTER_WORDS * 4 == GYROCAL_FILTER_SIZE);
    assert!(GYROCAL_FILTER_ALIGNMENT == align_of::<GyrocalFilter>());
    assert!(GYROCAL_SAVED_SIZE == ControllerFilter::<f32>::SAVED_BYTES);
};

/// The filter in some memory, or the status why there is none.
///
/// # Safety
/// `memory` must be null or point to a `GyrocalFilter` that nothing else uses meanwhile.
#[inline(always)]
unsafe fn inner<'a>(memory: *mut GyrocalFilter) -> Result<&'a mut Inner, i32> {
    if memory.is_null() {
        return Err(GYROCAL_NULL);
    }
    let inner = memory.cast::<Inner>();
    // SAFETY: the memory is valid for reads, and any word is a valid mark.
    if unsafe { ptr::read(&raw const (*inner).mark) } != MARK {
        return Err(GYROCAL_NOT_RUNNING);
    }
    // SAFETY: a filter was written there; the caller vouches that nothing else uses it.
    Ok(unsafe { &mut *inner })
}

/// Initialises a filter at its first sample, which gyrocal_update takes. What the memory held
/// before is forgotten, so this is also the reset.
///
/// # Safety
/// Each pointer must be null or point to what its type says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_init(
    filter: *mut GyrocalFilter,
    settings: *const GyrocalSettings,
) -> i32 {
    if filter.is_null() || settings.is_null() {
        return GYROCAL_NULL;
    }
    let unset = Inner {
        mark: MARK,
        nis: 0.0,
        filter: ControllerFilter::unset(),
    };
    // SAFETY: the memory is as large and as aligned as its contents. The compiler writes there at
    // once; `cargo figures embedded --part controller` prints the stack that this function takes.
    unsafe { ptr::write(filter.cast::<Inner>(), unset) };
    // SAFETY: both are valid, as the caller vouches.
    let (inner, settings) = match (unsafe { inner(filter) }, unsafe { &*settings }) {
        (Ok(inner), settings) => (inner, settings),
        (Err(status), _) => return status,
    };
    let result = inner
        .filter
        .start(&settings.filter(), &settings.attitude(), settings.limits());
    status::of(result)
}

/// Takes a sample of three accelerometers in g at the time the filter is at: the first one.
///
/// # Safety
/// Each pointer must be null or point to what its type says, `sample` to three numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_update(filter: *mut GyrocalFilter, sample: *const f32) -> i32 {
    // SAFETY: as the caller vouches.
    unsafe { with_sample(filter, sample, |filter, sample| filter.update(sample)) }
}

/// Time passes, and at its end a sample of three accelerometers in g is taken.
///
/// # Safety
/// As gyrocal_update.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_step(
    filter: *mut GyrocalFilter,
    interval_s: f32,
    sample: *const f32,
) -> i32 {
    // SAFETY: as the caller vouches.
    unsafe {
        with_sample(filter, sample, |filter, sample| {
            filter.step(interval_s, sample)
        })
    }
}

/// # Safety
/// As gyrocal_update.
#[inline(always)]
unsafe fn with_sample(
    filter: *mut GyrocalFilter,
    sample: *const f32,
    call: impl FnOnce(
        &mut ControllerFilter<f32>,
        &[f32; 3],
    ) -> Result<gyrocal::Innovation<f32, 3>, ControllerError>,
) -> i32 {
    if sample.is_null() {
        return GYROCAL_NULL;
    }
    // SAFETY: as the caller vouches; an array of three numbers has their alignment.
    let (inner, sample) = match (unsafe { inner(filter) }, unsafe { &*sample.cast() }) {
        (Ok(inner), sample) => (inner, sample),
        (Err(status), _) => return status,
    };
    let result = call(&mut inner.filter, sample);
    if let Ok(innovation) = &result {
        inner.nis = innovation.nis;
    }
    status::of(result)
}

/// Takes a sample at the time the filter is at, whatever its NIS: after GYROCAL_DIVERGED, with the sample
/// that was answered so. All sigmas are widened in the same proportion until it is no surprise.
///
/// # Safety
/// As gyrocal_update.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_reopen(filter: *mut GyrocalFilter, sample: *const f32) -> i32 {
    // SAFETY: as the caller vouches.
    unsafe { with_sample(filter, sample, |filter, sample| filter.reopen(sample)) }
}

/// Writes the number of samples since gyrocal_init that were not taken because of their NIS.
///
/// # Safety
/// `filter` must be null or point to a filter, `count` to a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_surprising_samples(
    filter: *const GyrocalFilter,
    count: *mut u32,
) -> i32 {
    // SAFETY: as the caller vouches.
    unsafe { read(filter, count, |inner| [inner.filter.surprising_samples()]) }
}

/// Time passes without a sample.
///
/// # Safety
/// `filter` must be null or point to a filter.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_coast(filter: *mut GyrocalFilter, interval_s: f32) -> i32 {
    // SAFETY: as the caller vouches.
    match unsafe { inner(filter) } {
        Ok(inner) => status::of(inner.filter.coast(interval_s)),
        Err(status) => status,
    }
}

/// Writes the nine drift coefficients: deg/h, deg/h/g, deg/h/g² of gyro x, then of y and z.
///
/// # Safety
/// `filter` must be null or point to a filter, `drift` to nine numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_drift(filter: *const GyrocalFilter, drift: *mut f32) -> i32 {
    // SAFETY: as the caller vouches.
    unsafe {
        read(filter, drift, |inner| {
            inner.filter.filter().drift().to_array()
        })
    }
}

/// Writes the standard deviations of the errors of the nine drift coefficients.
///
/// # Safety
/// As gyrocal_drift.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_sigma(filter: *const GyrocalFilter, sigma: *mut f32) -> i32 {
    // SAFETY: as the caller vouches.
    unsafe {
        read(filter, sigma, |inner| {
            inner.filter.filter().drift_sigma().to_array()
        })
    }
}

/// Writes the normalised innovation squared of the last sample; three is expected.
///
/// # Safety
/// As gyrocal_drift, `nis` to one number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_nis(filter: *const GyrocalFilter, nis: *mut f32) -> i32 {
    // SAFETY: as the caller vouches.
    unsafe { read(filter, nis, |inner| [inner.nis]) }
}

/// # Safety
/// `filter` must be null or point to a filter, `place` to as many numbers as are read.
#[inline(always)]
unsafe fn read<T, const N: usize>(
    filter: *const GyrocalFilter,
    place: *mut T,
    numbers: impl FnOnce(&Inner) -> [T; N],
) -> i32 {
    if place.is_null() {
        return GYROCAL_NULL;
    }
    // SAFETY: as the caller vouches; nothing is written through the reference.
    match unsafe { inner(filter.cast_mut()) } {
        Ok(inner) if inner.filter.is_running() => {
            let numbers = numbers(inner);
            // SAFETY: as the caller vouches.
            unsafe { place.cast::<[T; N]>().write(numbers) };
            GYROCAL_OK
        }
        Ok(_) => GYROCAL_NOT_RUNNING,
        Err(status) => status,
    }
}

/// Writes the state with version and checksum to GYROCAL_SAVED_SIZE bytes.
///
/// # Safety
/// `filter` must be null or point to a filter, `place` to as many bytes as `length` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_save(
    filter: *const GyrocalFilter,
    place: *mut u8,
    length: usize,
) -> i32 {
    if place.is_null() {
        return GYROCAL_NULL;
    }
    // SAFETY: as the caller vouches.
    let (inner, place) = match (unsafe { inner(filter.cast_mut()) }, unsafe {
        slice::from_raw_parts_mut(place, length)
    }) {
        (Ok(inner), place) => (inner, place),
        (Err(status), _) => return status,
    };
    status::of(inner.filter.save(place))
}

/// Takes over a saved state. The filter must have been initialised with the settings of the one
/// that was saved; a filter that has stopped runs again.
///
/// # Safety
/// `filter` must be null or point to a filter, `saved` to as many bytes as `length` says.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn gyrocal_restore(
    filter: *mut GyrocalFilter,
    saved: *const u8,
    length: usize,
) -> i32 {
    if saved.is_null() {
        return GYROCAL_NULL;
    }
    // SAFETY: as the caller vouches.
    let (inner, saved) = match (unsafe { inner(filter) }, unsafe {
        slice::from_raw_parts(saved, length)
    }) {
        (Ok(inner), saved) => (inner, saved),
        (Err(status), _) => return status,
    };
    status::of(inner.filter.restore(saved))
}
