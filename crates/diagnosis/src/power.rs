//! Power of the search: whether effects of typical size exceed the detection threshold.

use gyrocal::effect::Role;
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::{CalibrationError, FittedPlatform};
use gyrocal_hypothesis::{Ranked, sigmas};
use gyrocal_record::Record;
use gyrocal_statistics::normal_probability;

use gyrocal_answer::Power;

/// Records as long as a sidereal day \[s\] show effects of typical size: their verdict needs no
/// caveat.
const SIDEREAL_DAY_S: f64 = 86_164.1;

/// Records of more rows need no caveat either, however short they are.
const MOST_ROWS: usize = 6000;

/// Standard deviations above the detection threshold at which an effect counts as detectable; its
/// power is then 84 %.
const MARGIN: f64 = 1.0;

/// Power of the search for each ranked effect at its typical size.
///
/// # Errors
/// As [`FittedPlatform::signatures`].
pub(crate) fn powers(
    nominal: &FittedPlatform<'_>,
    record: &Record,
    ranking: &[Ranked],
    threshold: f64,
) -> Result<Vec<Power>, CalibrationError> {
    let effects: Vec<&'static Effect> = ranking
        .iter()
        .filter_map(|ranked| EFFECTS.iter().find(|effect| effect.id == ranked.effect))
        .collect();
    let asked: Vec<(&Effect, Option<f64>)> = effects
        .iter()
        .map(|effect| (*effect, typical_shape(effect, record)))
        .collect();
    let sigmas = sigmas(nominal, &nominal.rows(record), &asked)?;
    Ok(effects
        .into_iter()
        .zip(sigmas)
        .map(|(effect, sigma)| Power {
            effect: effect.id.to_owned(),
            typical_size: effect.typical_size,
            sigma,
            power: sigma.map(|sigma| power(effect.typical_size / sigma, threshold)),
            unit: effect
                .parameters
                .first()
                .map_or("1", |size| size.unit)
                .to_owned(),
        })
        .collect())
}

/// Probability that an effect of `strength` standard deviations exceeds the threshold of chi-square.
fn power(strength: f64, threshold: f64) -> f64 {
    let needed = threshold.max(0.0).sqrt();
    normal_probability(strength - needed)
}

/// Whether a record is so short that its verdict needs a caveat on power.
pub(crate) fn needs_caveat(record: &Record) -> bool {
    record.duration_s() < SIDEREAL_DAY_S && record.len() <= MOST_ROWS
}

/// Whether an effect would go undetected at its typical size.
pub(crate) fn undetectable(power: &Power, threshold: f64) -> bool {
    let needed = threshold.max(0.0).sqrt() + MARGIN;
    power
        .sigma
        .is_none_or(|sigma| needed * sigma >= power.typical_size)
}

/// An onset in the middle of the record, a time constant of a quarter of it.
fn typical_shape(effect: &Effect, record: &Record) -> Option<f64> {
    let duration_s = record.duration_s();
    match effect.shape()?.role {
        Role::TimeConstant(_) => Some(0.25 * duration_s / 3600.0),
        _ => Some(0.5 * duration_s),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_effect_at_the_threshold_is_detected_half_of_the_time() {
        assert!((power(3.0, 9.0) - 0.5).abs() < 1e-12);
        // One sigma above: 84 %.
        assert!((power(4.0, 9.0) - 0.841_344_746).abs() < 1e-8);
        let one = |sigma| Power {
            effect: String::new(),
            typical_size: 4.0,
            sigma,
            power: None,
            unit: String::new(),
        };
        assert!(undetectable(&one(Some(1.0)), 9.0));
        assert!(!undetectable(&one(Some(0.9)), 9.0));
        assert!(undetectable(&one(None), 9.0));
    }
}
