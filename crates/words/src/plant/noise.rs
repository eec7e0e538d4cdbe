//! Noise that a plant does not declare, in words.

use gyrocal_answer::UndeclaredNoise;
use gyrocal_statistics::format::significant;

/// Noise that the plant does not declare, a sentence or two.
#[must_use]
pub fn undeclared_noise(one: &UndeclaredNoise) -> String {
    let size = format!("{} {}", significant(one.sigma, 2), one.unit);
    let what = match one.time_s {
        Some(time_s) => format!(
            "noise of {size} in readings of {}, correlated over {} s",
            one.channel,
            significant(time_s, 2)
        ),
        None => format!("noise of {size} of the {}", one.channel),
    };
    let instead = match one.instead.as_slice() {
        [] => String::new(),
        others => format!(" Noise of {} explains as much.", others.join(", or of ")),
    };
    format!(
        "Beside white noise, {what} explains what is left, which the plant does not declare; effects were judged beside it.{instead}"
    )
}
