//! Measured coverage of the confidence sets of causes.

use gyrocal::EFFECTS;
use gyrocal::effect::EffectKind;

/// Least statistic, in standard deviations, of findings whose coverage is stated. It was measured of causes
/// of eight; that of larger ones is more, and that of weaker ones was not measured by kind.
pub const LEAST_STATISTIC: f64 = 7.0;

/// Most that is stated: no number of records shows that every set holds its cause.
const MOST: f64 = 0.99;

/// Share of the confidence sets that hold the cause, of causes of each kind that were detected: eight standard
/// deviations large, the noise unknown. Rounded down to a hundredth, and 0.99 where all sets
/// did.
///
/// `cargo figures diagnosis --part causes` measures it, and `docs/figures/diagnosis.md` has the number
/// of records and the interval of each.
pub const SET_COVERAGE: [(EffectKind, f64); 8] = [
    (EffectKind::Constant, 0.98),
    (EffectKind::Exponential, 0.97),
    (EffectKind::Step, 0.98),
    (EffectKind::Ramp, 0.97),
    (EffectKind::Periodic, 0.94),
    (EffectKind::Regressor, MOST),
    (EffectKind::StateJump, 0.99),
    (EffectKind::InitialState, MOST),
];

/// Coverage of a set: the least of the kinds that it holds, for the cause may be of any of them.
///
/// `None` where it was not measured: of weak findings, of sets whose named effect is a random walk or of no
/// kind of [`SET_COVERAGE`].
pub(crate) fn of_set<'a>(
    named: &'a str,
    others: impl Iterator<Item = &'a str>,
    statistic: f64,
) -> Option<f64> {
    let of_named = of_effect(named).filter(|_| statistic >= LEAST_STATISTIC)?;
    Some(others.filter_map(of_effect).fold(of_named, f64::min))
}

fn of_effect(id: &str) -> Option<f64> {
    EFFECTS
        .iter()
        .find(|effect| effect.id == id)
        .and_then(|effect| of_kind(effect.kind))
}

fn of_kind(kind: EffectKind) -> Option<f64> {
    let mut measured = SET_COVERAGE.iter();
    measured
        .find(|(one, _)| *one == kind)
        .map(|(_, share)| *share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_covers_as_the_least_of_its_kinds() {
        let [step, ramp] = [EffectKind::Step, EffectKind::Ramp].map(of_kind);
        assert!(ramp < step, "the measured coverages have another order");
        let alone = of_set("gyro_x.step", [].into_iter(), 9.0);
        assert_eq!(alone, step);
        let with_ramp = of_set("gyro_x.step", ["gyro_x.ramp"].into_iter(), 9.0);
        assert_eq!(with_ramp, ramp);
        // A random walk in a set does not tell how often the set holds the cause.
        let with_walk = of_set("gyro_x.step", ["gyro_x.random_walk"].into_iter(), 9.0);
        assert_eq!(with_walk, step);
    }

    #[test]
    fn no_coverage_is_stated_that_was_not_measured() {
        assert_eq!(of_set("gyro_x.step", [].into_iter(), 6.0), None);
        assert_eq!(of_set("gyro_x.random_walk", [].into_iter(), 50.0), None);
        assert_eq!(of_set("my_own.effect", [].into_iter(), 50.0), None);
    }
}
