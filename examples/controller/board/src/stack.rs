//! Use of the stack, found by paint.

use core::arch::asm;

const PAINT: u32 = 0x5057_4943;
/// Below the paint's beginning: frames of the functions here.
const MARGIN_WORDS: usize = 16;

unsafe extern "C" {
    static mut _stack_bottom: u32;
}

/// Bytes of the stack that `work` uses below its caller.
#[inline(never)]
pub fn used_by(work: impl FnOnce()) -> u32 {
    let top = paint();
    work();
    let mut word = &raw const _stack_bottom;
    // SAFETY: from the bottom of the stack to the pointer that was painted up to; volatile, as the
    // compiler knows nothing of it.
    unsafe {
        while word < top && word.read_volatile() == PAINT {
            word = word.add(1);
        }
    }
    (top as u32 + 4 * MARGIN_WORDS as u32).saturating_sub(word as u32)
}

/// Paints the free stack; returns the end of the paint.
#[inline(never)]
fn paint() -> *const u32 {
    let pointer: *mut u32;
    // SAFETY: reads the stack pointer.
    unsafe { asm!("mov {}, sp", out(reg) pointer, options(nomem, nostack)) };
    let end = pointer.wrapping_sub(MARGIN_WORDS);
    let mut word = &raw mut _stack_bottom;
    // SAFETY: the memory below the stack pointer is free.
    unsafe {
        while word < end {
            word.write_volatile(PAINT);
            word = word.add(1);
        }
    }
    end
}
