//! The least that firmware needs on an Arm MPS2 board with a Cortex-M4F (QEMU `mps2-an386`):
//! vectors, start-up with the floating-point unit, text over semihosting, a cycle counter, and the
//! paint that shows how much of the stack was used.
//!
//! A firmware calls [`firmware!`] with its main function, links with `memory.x` of this package,
//! and has a panic handler from here that refers to a symbol which does not exist: it links only
//! if no panic can be reached.

#![no_std]
#![cfg(target_os = "none")]

mod counter;
mod semihosting;
mod stack;
mod start;

pub use counter::Counter;
pub use semihosting::{Argument, exit, print, print_decimal, print_hexadecimal};
pub use stack::used_by;
pub use start::start;

unsafe extern "C" {
    /// Defined nowhere: a panic that can be reached is an error of the linker.
    fn a_panic_can_be_reached() -> !;
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    // SAFETY: no firmware that links has this call.
    unsafe { a_panic_can_be_reached() }
}

/// Makes a function the main function of a firmware. When it returns, the processor exits with
/// status 0.
#[macro_export]
macro_rules! firmware {
    ($main:path) => {
        #[unsafe(no_mangle)]
        extern "C" fn firmware_main() {
            $main()
        }
    };
}
