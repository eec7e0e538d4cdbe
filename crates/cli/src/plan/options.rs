//! Limits and goals of the command line.

use gyrocal_record::{AXES, Bench, GimbalLimits};

use crate::Failure;
use crate::numbers::positive;

/// Parses `x=-30..30`.
pub(super) fn limit(text: &str) -> Result<(usize, [f64; 2]), String> {
    let wrong = || {
        format!(
            "expected AXIS=FROM..TO, as x=-30..30: {}",
            GimbalLimits::EXPECTED
        )
    };
    let (axis, range) = text.split_once('=').ok_or_else(wrong)?;
    let axis = AXES
        .iter()
        .position(|key| *key == axis.trim())
        .ok_or_else(wrong)?;
    let (from, to) = range.split_once("..").ok_or_else(wrong)?;
    match (from.trim().parse(), to.trim().parse()) {
        (Ok(from), Ok(to)) if GimbalLimits::is_sound([from, to]) => Ok((axis, [from, to])),
        _ => Err(wrong()),
    }
}

/// Parses `gyro_x.g_x=1e-4`.
pub(super) fn wished_sigma(text: &str) -> Result<(String, f64), String> {
    let (id, sigma) = text
        .split_once('=')
        .ok_or("expected ID=SIGMA, as gyro_x.g_x=1e-4")?;
    Ok((id.trim().to_owned(), positive(sigma.trim())?))
}

/// Refuses repeated limits of one axis.
pub(super) fn refuse_repeated(given: &[(usize, [f64; 2])]) -> Result<(), Failure> {
    for (axis, key) in AXES.iter().enumerate() {
        if given.iter().filter(|(other, _)| *other == axis).count() > 1 {
            return Err(Failure::Usage(format!(
                "--limits of {key} are given more than once; give one FROM..TO for each axis"
            )));
        }
    }
    Ok(())
}

/// Each duration once, in the order given.
pub(super) fn durations_s(hours: &[f64]) -> Vec<f64> {
    let mut durations_s: Vec<f64> = Vec::with_capacity(hours.len());
    for duration_s in hours.iter().map(|hours| 3600.0 * hours) {
        if !durations_s.contains(&duration_s) {
            durations_s.push(duration_s);
        }
    }
    durations_s
}

/// Limits of the command line, then those of the bench.
pub(super) fn limits(given: &[(usize, [f64; 2])], bench: &Bench) -> GimbalLimits {
    let mut limits = bench.gimbal_limits;
    for (axis, ends) in given {
        limits.deg[*axis] = Some(*ends);
    }
    limits
}

#[cfg(test)]
mod tests {
    use super::{durations_s, limit, wished_sigma};

    #[test]
    fn durations_are_those_asked_for_once() {
        assert_eq!(durations_s(&[24.0, 48.0, 24.0]), [86_400.0, 172_800.0]);
    }

    #[test]
    fn limits_are_read_and_mistakes_refused() {
        assert_eq!(limit("x=-30..30"), Ok((0, [-30.0, 30.0])));
        assert_eq!(limit("z = 10.5 .. 20"), Ok((2, [10.5, 20.0])));
        for wrong in [
            "",
            "x",
            "w=0..1",
            "x=0",
            "x=1..0",
            "x=0..400",
            "x=nan..1",
            "y=-200..200",
        ] {
            assert!(limit(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn wishes_are_read_and_mistakes_refused() {
        let wish = wished_sigma("gyro_x.g_x=1e-4");
        assert_eq!(wish, Ok(("gyro_x.g_x".to_owned(), 1e-4)));
        for wrong in ["gyro_x.g_x", "gyro_x.g_x=", "gyro_x.g_x=0"] {
            assert!(wished_sigma(wrong).is_err(), "{wrong}");
        }
    }
}
