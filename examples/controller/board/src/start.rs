//! Vectors and start-up.

use core::arch::global_asm;

use crate::semihosting;

// The first two words of the memory are the stack pointer and the address that a reset jumps to.
// All exceptions stop the program: this firmware enables no interrupt.
global_asm!(
    ".section .vectors, \"a\"",
    ".word _stack_top",
    ".word _reset",
    ".rept 14",
    ".word _exception",
    ".endr",
    ".section .text._reset, \"ax\"",
    ".thumb_func",
    ".global _reset",
    "_reset:",
    // Full access to coprocessors 10 and 11, the floating-point unit (CPACR, ARMv7-M B3.2.20).
    "ldr r0, =0xE000ED88",
    "ldr r1, [r0]",
    "orr r1, r1, #(0xf << 20)",
    "str r1, [r0]",
    "dsb",
    "isb",
    "bl _start_rust",
    ".thumb_func",
    ".global _exception",
    "_exception:",
    "bl _exception_rust",
);

unsafe extern "C" {
    static mut _data_start: u32;
    static mut _data_end: u32;
    static _data_load: u32;
    static mut _bss_start: u32;
    static mut _bss_end: u32;
    fn firmware_main();
}

#[unsafe(no_mangle)]
extern "C" fn _start_rust() -> ! {
    start()
}

/// Prepares the memory and calls the main function.
pub fn start() -> ! {
    // SAFETY: the linker script gives the bounds of the sections, aligned to words; nothing has
    // been read from or written to them.
    unsafe {
        let (mut to, end) = (&raw mut _data_start, &raw mut _data_end);
        let mut from = &raw const _data_load;
        while to < end {
            to.write_volatile(from.read());
            to = to.add(1);
            from = from.add(1);
        }
        let (mut to, end) = (&raw mut _bss_start, &raw mut _bss_end);
        while to < end {
            to.write_volatile(0);
            to = to.add(1);
        }
        firmware_main();
    }
    semihosting::exit(0)
}

#[unsafe(no_mangle)]
extern "C" fn _exception_rust() -> ! {
    semihosting::print("an exception stopped the firmware\n");
    semihosting::exit(70)
}
