//! Attitudes that are tried.

use gyrocal::generated::platform::reanchor;
use gyrocal::trajectory::{Orientation, orientation, rotation_between};
use gyrocal_record::GimbalLimits;

/// Attitudes spread over all that the limits allow.
const SPREAD: usize = 144;

/// Powers of the inverse of the real root of g⁴ = g + 1: three coordinates that no small number
/// of steps brings back (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018).
const STEPS: [f64; 3] = [
    0.819_172_513_396_164_4,
    0.671_043_606_703_789_2,
    0.549_700_477_901_970_2,
];

/// Angles about x, y and z to begin with: those that are easy to set, then a spread of equal
/// density over all attitudes. Whole degrees.
pub(crate) fn first(limits: &GimbalLimits) -> Vec<[f64; 3]> {
    let ranges = ranges(limits);
    let mut all = Vec::with_capacity(SPREAD + 16);
    let right = [-90.0, 0.0, 90.0, 180.0];
    for x in right {
        all.extend(right.map(|z| [x, 0.0, z]));
    }
    for index in 1..=SPREAD {
        let share = STEPS.map(|step| (step * index as f64).fract());
        let along = |axis: usize| {
            let [from, to] = ranges[axis];
            from + share[axis] * (to - from)
        };
        // Attitudes are dense as the sine of the middle angle is.
        let [low, high] = ranges[1].map(|angle| angle.to_radians().sin());
        let y = (low + share[1] * (high - low)).clamp(-1.0, 1.0);
        all.push([along(0), y.asin().to_degrees(), along(2)].map(f64::round));
    }
    all.retain(|angles| limits.hold(*angles));
    if all.is_empty() {
        // Limits less than a degree apart.
        let middle = ranges.map(|[from, to]| 0.5 * (from + to));
        all.extend(Some(middle).filter(|angles| limits.hold(*angles)));
    }
    all
}

/// The ranges that angles are spread over; the middle one covers every attitude in half a turn.
fn ranges(limits: &GimbalLimits) -> [[f64; 2]; 3] {
    let [x, y, z] = limits.deg;
    let all = [-180.0, 180.0];
    let middle = [-90.0, 90.0];
    let y = y.map_or(middle, |[from, to]| {
        let clipped = [from.max(-90.0), to.min(90.0)];
        if clipped[0] <= clipped[1] {
            clipped
        } else {
            middle
        }
    });
    [x.unwrap_or(all), y, z.unwrap_or(all)]
}

/// Attitudes beside one, a step about each axis away.
pub(crate) fn beside(angles_deg: [f64; 3], step_deg: f64) -> Vec<[f64; 3]> {
    let mut all = Vec::with_capacity(6);
    for axis in 0..3 {
        for step in [step_deg, -step_deg] {
            let mut angles = angles_deg;
            angles[axis] = within_turn(angles[axis] + step);
            all.push(angles);
        }
    }
    all
}

fn within_turn(angle_deg: f64) -> f64 {
    (angle_deg + 180.0).rem_euclid(360.0) - 180.0
}

/// The attitude of platform angles.
pub(crate) fn of_angles(angles_deg: [f64; 3]) -> Orientation {
    orientation(&reanchor(&angles_deg.map(f64::to_radians)).platform_c_chart)
}

/// The angle between two attitudes, deg.
pub(crate) fn apart_deg(a: [f64; 3], b: [f64; 3]) -> f64 {
    let turn = rotation_between(&of_angles(a), &of_angles(b));
    turn.iter().map(|x| x * x).sum::<f64>().sqrt().to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn attitudes_lie_within_the_limits_and_everywhere_in_them() {
        let limits = GimbalLimits {
            deg: [Some([-30.0, 30.0]), Some([-60.0, 10.0]), None],
        };
        let all = first(&limits);
        assert!(all.len() > SPREAD / 2);
        assert!(all.iter().all(|angles| limits.hold(*angles)));
        for target in [[-25.0, -50.0, 100.0], [25.0, 5.0, -100.0]] {
            // 144 balls of this radius cover the part of all attitudes that the limits leave, a
            // twentieth of them, many times.
            let near = all.iter().map(|angles| apart_deg(*angles, target));
            assert!(near.fold(f64::INFINITY, f64::min) < 25.0);
        }
    }

    #[test]
    fn limits_without_whole_degrees_between_them_leave_an_attitude() {
        let limits = GimbalLimits {
            deg: [Some([0.2, 0.4]), Some([-10.6, -10.4]), Some([30.1, 30.3])],
        };
        let all = first(&limits);
        assert!(all.iter().all(|angles| limits.hold(*angles)), "{all:?}");
        assert_eq!(all.len(), 1);
    }

    #[test]
    fn angles_stay_within_a_turn() {
        let all = beside([175.0, 0.0, -175.0], 10.0);
        assert_eq!(all[0], [-175.0, 0.0, -175.0]);
        assert_eq!(all[5], [175.0, 0.0, 175.0]);
    }
}
