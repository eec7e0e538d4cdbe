//! C interface of the streaming filter in single precision: `include/gyrocal.h`.
//!
//! Memory belongs to the caller; a mark in its first word tells whether a filter was initialised in
//! it, so that memory of zeros is answered by a status. Every other rule of C remains: pointers must
//! point to what their type says.

#![no_std]

mod filter;
mod settings;
mod status;

pub use filter::*;
pub use settings::*;
pub use status::*;

unsafe extern "C" {
    /// Defined nowhere: a program that links holds no panic that can be reached.
    fn gyrocal_a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: no program that links has this call.
    unsafe { gyrocal_a_panic_can_be_reached() }
}
