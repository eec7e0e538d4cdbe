//! Text to the debugger or emulator (Arm, *Semihosting for AArch32 and AArch64*).

use core::arch::asm;

const WRITE_CHARACTER: u32 = 0x03;
const COMMAND_LINE: u32 = 0x15;
const EXIT_EXTENDED: u32 = 0x20;
const APPLICATION_EXIT: u32 = 0x2_0026;

fn call(operation: u32, parameter: *const u32) -> u32 {
    let result;
    // SAFETY: the call of semihosting on ARMv7-M; it changes r0 and the memory of its parameter.
    unsafe {
        asm!(
            "bkpt #0xab",
            inlateout("r0") operation => result,
            in("r1") parameter,
            options(nostack)
        );
    }
    result
}

/// Writes text.
pub fn print(text: &str) {
    for byte in text.bytes() {
        let word = u32::from(byte);
        call(WRITE_CHARACTER, &raw const word);
    }
}

/// Writes a number in decimal digits.
pub fn print_decimal(number: u32) {
    let mut divisor = 1_000_000_000;
    let mut begun = false;
    while divisor > 0 {
        let digit = (number / divisor) % 10;
        begun |= digit > 0 || divisor == 1;
        if begun {
            print_digit(digit);
        }
        divisor /= 10;
    }
}

/// Writes the last `digits` hexadecimal digits of a number.
pub fn print_hexadecimal(number: u64, digits: u32) {
    for place in (0..digits.min(16)).rev() {
        print_digit((number >> (4 * place)) as u32 & 15);
    }
}

fn print_digit(digit: u32) {
    let word = digit + if digit < 10 { 48 } else { 87 };
    call(WRITE_CHARACTER, &raw const word);
}

/// Ends the program with a status.
pub fn exit(status: u32) -> ! {
    let block = [APPLICATION_EXIT, status];
    call(EXIT_EXTENDED, block.as_ptr());
    // A debugger may decline.
    loop {
        core::hint::spin_loop();
    }
}

/// The text that the program was started with, as far as it fits.
pub struct Argument {
    text: [u8; 64],
}

impl Argument {
    /// Asks for it.
    #[must_use]
    pub fn read() -> Self {
        let mut argument = Self { text: [0; 64] };
        let block = [argument.text.as_mut_ptr() as u32, 63];
        call(COMMAND_LINE, block.as_ptr());
        argument
    }

    /// True if one of its words is `word`.
    #[must_use]
    pub fn has(&self, word: &str) -> bool {
        self.text
            .split(|byte| *byte == b' ' || *byte == 0)
            .any(|part| part == word.as_bytes())
    }
}
