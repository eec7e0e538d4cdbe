//! Detected effects and their alternatives.

use gyrocal_statistics::format::short as rounded;

use crate::files::joined;
use crate::format::{behind, short, with_sigma};
use gyrocal_answer::{Alternative, AlternativeKind, Parameter};

/// All parameters with their sigmas and units.
#[must_use]
pub fn parameter_values(parameters: &[Parameter]) -> String {
    let each = parameters.iter().map(|parameter| {
        let (name, unit) = (&parameter.name, behind(&parameter.unit));
        format!("{name} {}{unit}", value(parameter))
    });
    joined(each, ", ")
}

/// Estimate and sigma of a parameter, or its interval where the likelihood is not symmetric.
pub(super) fn value(parameter: &Parameter) -> String {
    match (parameter.sigma, &parameter.interval) {
        (Some(sigma), _) => with_sigma(parameter.estimate, sigma),
        (None, Some(pieces)) if !pieces.is_empty() => {
            let piece = |ends: &[f64; 2]| ends.map(|end| rounded(end, 3)).join(" to ");
            let interval = joined(pieces.iter().map(piece), " or ");
            format!("{} (95 %: {interval})", short(parameter.estimate))
        }
        (None, _) => short(parameter.estimate),
    }
}

/// An estimated probability: `cargo figures diagnosis --part outside` holds it within five points.
pub(super) fn likely(probability: f64) -> String {
    match probability {
        high if high > 0.95 => "above 95 %".to_owned(),
        low if low < 0.05 => "below 5 %".to_owned(),
        between => format!("{:.0} %", 100.0 * between),
    }
}

/// How an alternative stands to the reported effect: the likelihood of one that is not excluded.
#[must_use]
pub fn likelihood(alternative: &Alternative) -> String {
    // Beyond this the factor carries no information.
    let deficit = match (alternative.kind, alternative.log_likelihood_deficit) {
        (AlternativeKind::ExactEquivalent, _) => return "exact equivalent".to_owned(),
        (AlternativeKind::NotExcluded, Some(deficit)) => deficit,
        _ => return "not searched".to_owned(),
    };
    let factor = deficit.clamp(-50.0, 50.0).exp();
    if factor >= 1.05 {
        format!("{factor:.1} times less likely")
    } else if factor > 0.95 {
        "equally likely".to_owned()
    } else {
        format!(
            "likelihood ratio {:.1} in its favour, but it has more parameters",
            factor.recip()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_size_without_a_sigma_has_its_interval() {
        let of = |interval: Option<Vec<[f64; 2]>>| {
            value(&Parameter {
                name: "size".to_owned(),
                estimate: 0.001_05,
                sigma: None,
                interval,
                unit: "1".to_owned(),
            })
        };
        assert_eq!(of(None), "0.00105");
        assert_eq!(
            of(Some(vec![[0.000_72, 0.001_38]])),
            "0.00105 (95 %: 7.2e-4 to 0.00138)"
        );
    }

    #[test]
    fn a_probability_has_no_more_digits_than_it_is_known_with() {
        assert_eq!(likely(0.3838), "38 %");
        assert_eq!(likely(1.0), "above 95 %");
        assert_eq!(likely(1e-7), "below 5 %");
    }

    #[test]
    fn an_alternative_is_described_by_its_likelihood() {
        let of = |deficit: f64| {
            likelihood(&Alternative {
                effect: "gyro_x.ramp".to_owned(),
                kind: AlternativeKind::NotExcluded,
                log_likelihood_deficit: Some(deficit),
                parameters: Vec::new(),
            })
        };
        assert_eq!(of(2.0), "7.4 times less likely");
        assert_eq!(of(0.0), "equally likely");
        assert_eq!(
            of(-1.0),
            "likelihood ratio 2.7 in its favour, but it has more parameters"
        );
    }
}
