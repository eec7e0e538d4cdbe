//! Look-ups in the catalogue by the ids of stored results.

use gyrocal::effect::Enters;
use gyrocal::generated::catalogue::{OUTPUTS, PARAMETERS, RATES};
use gyrocal::{EFFECTS, Effect};
use gyrocal_answer::Finding;

/// The effect of an id; `None` for an id that the catalogue does not have.
#[must_use]
pub fn effect_of(id: &str) -> Option<&'static Effect> {
    EFFECTS.iter().find(|effect| effect.id == id)
}

/// `true` if two ids are of one effect or of exact equivalents.
#[must_use]
pub fn same_or_equivalent(one: &str, other: &str) -> bool {
    one == other || effect_of(one).is_some_and(|effect| effect.equivalents.contains(&other))
}

/// `true` if the confidence set of a finding holds an effect or an exact equivalent of it.
#[must_use]
pub fn set_holds(finding: &Finding, id: &str) -> bool {
    finding.set().any(|member| same_or_equivalent(member, id))
}

/// Family of an effect: that of the first of its exact equivalents, its id with `i` for its own axis and
/// `j`, `k` for others. The id itself if the catalogue does not have it.
#[must_use]
pub fn effect_family(id: &str) -> &str {
    let mut equivalents = EFFECTS.iter();
    equivalents
        .find(|effect| same_or_equivalent(id, effect.id))
        .map_or(id, |effect| effect.family)
}

/// Id of the constant error of the channel that an effect enters; `None` unless it enters exactly one.
#[must_use]
pub fn constant_of_channel(effect: &Effect) -> Option<&'static str> {
    let channel = match effect.enters {
        Enters::Rates(&[rate]) => &RATES[rate],
        Enters::Outputs(&[output]) => &OUTPUTS[output],
        _ => return None,
    };
    Some(PARAMETERS[channel.constant].id)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_equivalents_are_the_same() {
        assert!(
            same_or_equivalent("gyro_x.g_yy", "gyro_x.g_zz")
                && same_or_equivalent("clock.rate", "site.latitude")
        );
        assert!(
            !same_or_equivalent("gyro_x.g_yy", "gyro_y.g_zz")
                && !same_or_equivalent("no effect", "gyro_x.g_y")
        );
    }

    #[test]
    fn a_family_does_not_depend_on_the_axes() {
        for (id, expected) in [
            ("gyro_x.g_y", "gyro_i.g_j"),
            ("gyro_z.g_xy", "gyro_i.g_jk"),
            ("gyro_z.g_yy", "gyro_i.g_jk"),
            ("gyro_y.g_yyy", "gyro_i.g_iii"),
            ("gyro_y.step", "gyro_i.step"),
            ("accel_xz.nonorthogonality", "accel_ij.nonorthogonality"),
            ("accel_x.bias", "accel_i.bias"),
            ("clock.rate", "site.latitude"),
            ("platform.knock", "platform.knock"),
        ] {
            assert_eq!(effect_family(id), expected);
        }
    }

    #[test]
    fn a_channel_has_its_constant_error() {
        let constant = |id| effect_of(id).and_then(constant_of_channel);
        assert_eq!(constant("gyro_y.ramp"), Some("gyro_y.bias"));
        assert_eq!(constant("accel_z.ramp"), Some("accel_z.bias"));
        assert_eq!(constant("site.gravity"), None);
    }
}
