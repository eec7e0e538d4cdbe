//! Cycles, counted by SysTick (ARMv7-M B3.3).

use core::ptr;

const CONTROL: *mut u32 = 0xE000_E010 as *mut u32;
const RELOAD: *mut u32 = 0xE000_E014 as *mut u32;
const VALUE: *mut u32 = 0xE000_E018 as *mut u32;
const LARGEST: u32 = 0x00ff_ffff;

/// A counter of ticks of the processor's clock; differences hold for 2^24 of them.
pub struct Counter {
    start: u32,
}

impl Counter {
    /// Starts to count.
    #[must_use]
    #[inline(always)]
    pub fn start() -> Self {
        // SAFETY: registers of the core, which only this type uses.
        unsafe {
            ptr::write_volatile(RELOAD, LARGEST);
            ptr::write_volatile(VALUE, 0);
            // Enabled, clock of the processor, no interrupt.
            ptr::write_volatile(CONTROL, 5);
            // The count begins one tick after it was cleared.
            while ptr::read_volatile(VALUE) == 0 {}
            Self {
                start: ptr::read_volatile(VALUE),
            }
        }
    }

    /// Ticks since the start.
    #[must_use]
    #[inline(always)]
    pub fn ticks(&self) -> u32 {
        // SAFETY: as above.
        let now = unsafe { ptr::read_volatile(VALUE) };
        self.start.wrapping_sub(now) & LARGEST
    }
}
