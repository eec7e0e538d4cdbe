//! Limits of the platform angles, set by the gimbals of a bench.

use std::fmt::Write as _;

use crate::AXES;
use crate::bound::Bound;
use crate::error::{Error, InputErrorKind};
use crate::table::Table;

/// Limits of the platform angles about x, then y, then z, in the convention of
/// `initial_angles_deg`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct GimbalLimits {
    /// Lower and upper limit of each angle, deg; `None` for a gimbal without stops.
    pub deg: [Option<[f64; 2]>; 3],
}

impl GimbalLimits {
    /// Name of the table in a bench file.
    pub const TABLE: &'static str = "gimbal_limits_deg";

    /// Condition on the two limits of an angle, for messages.
    pub const EXPECTED: &'static str =
        "two angles from -360 to 360 deg, the lower end first, less than 360 deg apart";

    /// Whether two limits of an angle are valid.
    #[must_use]
    pub fn is_sound([from, to]: [f64; 2]) -> bool {
        let angle = Bound::ANGLE_DEG;
        angle.holds(from) && angle.holds(to) && from <= to && to - from < 360.0
    }

    /// Whether angles lie within the limits, whole turns added as needed.
    #[must_use]
    pub fn hold(&self, angles_deg: [f64; 3]) -> bool {
        // Angles at an end must not be lost to rounding.
        const ROUNDING_DEG: f64 = 1e-9;
        self.deg.iter().zip(angles_deg).all(|(limit, angle_deg)| {
            limit.is_none_or(|[from, to]| {
                let beyond = (angle_deg - from + ROUNDING_DEG).rem_euclid(360.0);
                beyond <= to - from + 2.0 * ROUNDING_DEG
            })
        })
    }

    /// Takes the table of a bench file, which may be absent.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] for a fault in it.
    pub fn from_root(root: &Table<'_>) -> Result<Self, Error> {
        let mut limits = Self::default();
        if let Some(table) = root.optional_table(Self::TABLE, &AXES)? {
            for (limit, key) in limits.deg.iter_mut().zip(AXES) {
                *limit = table.optional_two_numbers(key, Bound::ANGLE_DEG)?;
                if limit.is_some_and(|limit| !Self::is_sound(limit)) {
                    let kind = InputErrorKind::OutOfRange;
                    return Err(table.error_at(key, kind, Self::EXPECTED, ""));
                }
            }
        }
        Ok(limits)
    }

    /// The table as text; empty if no angle is limited.
    #[must_use]
    pub fn to_toml(&self) -> String {
        let mut text = String::new();
        for (limit, key) in self.deg.iter().zip(AXES) {
            if let Some(limit) = limit {
                if text.is_empty() {
                    let _ = writeln!(text, "\n[{}]", Self::TABLE);
                }
                let _ = writeln!(text, "{key} = {limit:?}");
            }
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::GimbalLimits;

    #[test]
    fn whole_turns_do_not_matter_and_ends_belong_to_it() {
        let limits = GimbalLimits {
            deg: [Some([-30.0, 30.0]), None, Some([170.0, 190.0])],
        };
        assert!(limits.hold([30.0, 77.0, -175.0]) && limits.hold([330.0, 0.0, 180.0]));
        assert!(!limits.hold([31.0, 0.0, 180.0]) && !limits.hold([0.0, 0.0, 165.0]));
    }
}
