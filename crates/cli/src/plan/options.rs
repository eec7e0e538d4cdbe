//! Limits and goals, as they are typed and as they are told.

use gyrocal_diagnosis::plan::Goal;
use gyrocal_record::{Bench, GimbalLimits};

use super::PlanArguments;
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
    let axis = GimbalLimits::KEYS
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

/// Those of the command line before those of the bench.
pub(super) fn limits(given: &[(usize, [f64; 2])], bench: &Bench) -> GimbalLimits {
    let mut limits = bench.gimbal_limits;
    for (axis, ends) in given {
        limits.deg[*axis] = Some(*ends);
    }
    limits
}

pub(super) fn goal(arguments: &PlanArguments) -> Goal {
    Goal {
        sigmas: arguments.sigma.clone(),
        one_name: arguments.one_name,
    }
}

/// A goal in words.
pub(super) fn in_words(goal: &Goal) -> Option<String> {
    let mut wishes: Vec<String> = goal
        .sigmas
        .iter()
        .map(|(id, sigma)| format!("a sigma of {id} of at most {sigma:e}"))
        .collect();
    if goal.one_name {
        wishes.push("one name in each set, with a probability of 95 %".to_owned());
    }
    (!wishes.is_empty()).then(|| wishes.join(" and "))
}

#[cfg(test)]
mod tests {
    use super::{limit, wished_sigma};

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
