//! Reduction of an angle to the nearest multiple of a right angle, in integers (Payne and Hanek,
//! *Radian reduction for trigonometric functions*, 1983).
//!
//! An angle is m 2^s with an integer m of 24 bits. Of 2/pi only 96 bits matter: those before them
//! give multiples of four right angles, those after them less than 2^-69 of one. No `f32` comes
//! closer than 2^-30 of a right angle to a multiple, so 34 bits of the difference are right.

/// 32 zeros, then the bits of 2/pi behind the point.
const TWO_OVER_PI: [u32; 8] = [
    0,
    0xA2F9_836E,
    0x4E44_1529,
    0xFC27_57D1,
    0xF534_DDC0,
    0xDB62_9599,
    0x3C43_9041,
    0xFE51_63AB,
];
/// pi/2 · 2^31.
const HALF_PI: u64 = 0xC90F_DAA2;

/// `high + low` beyond `quadrant` right angles; between -pi/4 and pi/4.
pub(super) struct Reduced {
    pub(super) quadrant: u32,
    pub(super) high: f32,
    /// Less than the last place of `high`.
    pub(super) low: f32,
}

/// Reduces a finite angle of at least 1/2.
#[inline]
pub(super) fn reduce(angle: f32) -> Reduced {
    let bits = angle.to_bits();
    let exponent = (bits >> 23) & 0xff;
    let mantissa = u64::from((bits & 0x007f_ffff) | 0x0080_0000);
    // angle = mantissa · 2^(exponent - 150); bits of 2/pi of weight below 2^(152 - exponent) count.
    let offset = exponent.wrapping_sub(120);
    let window = window(offset >> 5, offset & 31);
    // Modulo four right angles, in units of 2^-94 of one.
    let low = mantissa * u64::from(window[2]);
    let middle = mantissa * u64::from(window[1]) + (low >> 32);
    let high = (mantissa * u64::from(window[0])).wrapping_add(middle >> 32);
    let turns = (high << 32) | (middle & 0xffff_ffff);
    let fraction = (turns << 2) | ((low & 0xffff_ffff) >> 30);
    // Above a half, the next multiple is the nearest.
    let down = fraction >> 63 == 1;
    let quadrant = (turns >> 62) as u32 + u32::from(down);
    let size = if down {
        fraction.wrapping_neg()
    } else {
        fraction
    };
    let zeros = size.leading_zeros() & 63;
    let product = ((size << zeros) >> 32) * HALF_PI;
    // product · 2^(-63 - zeros): 24 bits, and the 32 that follow.
    let high = (product >> 40) as u32 as f32 * power_of_two(-23, zeros);
    let low = (product >> 8) as u32 as f32 * power_of_two(-55, zeros);
    let negative = down != angle.is_sign_negative();
    let (high, low) = if negative { (-high, -low) } else { (high, low) };
    Reduced {
        quadrant: if angle.is_sign_negative() {
            quadrant.wrapping_neg()
        } else {
            quadrant
        },
        high,
        low,
    }
}

/// 96 bits of the table from bit `shift` of word `word`.
#[inline(always)]
fn window(word: u32, shift: u32) -> [u32; 3] {
    let at = |k: u32| u64::from(TWO_OVER_PI[((word + k) & 7) as usize]);
    let joined = |k: u32| ((((at(k) << 32) | at(k + 1)) << shift) >> 32) as u32;
    [joined(0), joined(1), joined(2)]
}

/// 2^(exponent - zeros), a normal number.
#[inline(always)]
fn power_of_two(exponent: i32, zeros: u32) -> f32 {
    f32::from_bits(((127 + exponent) as u32).wrapping_sub(zeros) << 23)
}
