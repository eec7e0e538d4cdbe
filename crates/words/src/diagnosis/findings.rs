//! Detected effects, one entry each.

use gyrocal_statistics::format::{percent, short as rounded};

use super::records;
use crate::format::{short, tested, with_sigma};
use gyrocal_answer::{Alternative, AlternativeKind, Answer, Finding, FindingKind, Parameter};
use gyrocal_document::{Entry, Words};

/// Alternatives that an entry names; the ranking shows all of them.
const ALTERNATIVES_SHOWN: usize = 4;

/// One entry for each detected effect.
pub(super) fn entries(result: &Answer) -> impl Iterator<Item = Words> {
    let findings = result.findings.iter().enumerate();
    findings.map(|(index, finding)| {
        Words::Entry(Entry {
            number: index + 1,
            title: format!("{}: {}", finding.effect, finding.name),
            paragraphs: paragraphs(finding),
        })
    })
}

fn paragraphs(finding: &Finding) -> Vec<String> {
    let mut paragraphs = vec![estimate(finding)];
    paragraphs.extend(records::sizes(finding));
    if let (Some(nats), Some(false)) = (finding.gain_nats, finding.accepted) {
        paragraphs.push(format!(
            "Significant, but not in the extended model: with it cross-validation does not improve \
             ({nats:+.1} nats)."
        ));
    }
    paragraphs.extend(alternatives(finding));
    paragraphs.extend(none_of_these(finding));
    let equivalents = finding.of_kind(AlternativeKind::ExactEquivalent);
    paragraphs.extend(equivalents.map(|equivalent| {
        format!(
            "Exact equivalent, in any record: {}, {}.",
            equivalent.effect,
            parameter_values(&equivalent.parameters)
        )
    }));
    paragraphs
}

fn estimate(finding: &Finding) -> String {
    let significance = format!("{:.1} sigma, {}", finding.z, tested(finding.p_value));
    if finding.parameters.is_empty() {
        significance
    } else {
        format!("{}; {significance}", parameter_values(&finding.parameters))
    }
}

fn alternatives(finding: &Finding) -> Option<String> {
    let set: Vec<String> = finding
        .of_kind(AlternativeKind::NotExcluded)
        .map(|other| format!("{} ({})", other.effect, likelihood(other)))
        .collect();
    let shown = &set[..set.len().min(ALTERNATIVES_SHOWN)];
    let more = match set.len().saturating_sub(ALTERNATIVES_SHOWN) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let of = match finding.coverage {
        Some(coverage) => format!("{} confidence set", percent(coverage)),
        None => "confidence set".to_owned(),
    };
    (!set.is_empty()).then(|| format!("Alternatives ({of}): {}{more}.", shown.join(", ")))
}

/// The probability that the cause is not in the catalogue, and how much likelier it is than what is named.
fn none_of_these(finding: &Finding) -> Option<String> {
    let Some(probability) = finding.none_of_these else {
        let words = "None of these: probability not estimated.";
        return (finding.kind == FindingKind::Cause).then(|| words.to_owned());
    };
    let followed = "the residuals follow the specific force, its past, its products with time or the \
                    temperature as no effect of the catalogue does";
    let likelier = if probability > 0.5 {
        format!("likelier than not: {followed}")
    } else {
        "less likely than not".to_owned()
    };
    let ratio = finding.none_of_these_log_likelihood_ratio.map(|nats| {
        let ratio = match nats.exp() {
            ratio if ratio.is_finite() => rounded(ratio, 2),
            _ => format!("exp({nats:.0})"),
        };
        format!(", {ratio} times the likelihood of these")
    });
    Some(format!(
        "None of these: probability {}{}, {likelier}.",
        likely(probability),
        ratio.unwrap_or_default()
    ))
}

/// All parameters with their sigmas and units.
#[must_use]
pub fn parameter_values(parameters: &[Parameter]) -> String {
    let each = parameters.iter().map(|parameter| {
        let unit = match parameter.unit.as_str() {
            "1" => String::new(),
            unit => format!(" {unit}"),
        };
        format!("{} {}{unit}", parameter.name, value(parameter))
    });
    each.collect::<Vec<_>>().join(", ")
}

/// Estimate and sigma of a parameter, or its interval where the likelihood is not symmetric.
pub(super) fn value(parameter: &Parameter) -> String {
    match (parameter.sigma, &parameter.interval) {
        (Some(sigma), _) => with_sigma(parameter.estimate, sigma),
        (None, Some(pieces)) if !pieces.is_empty() => {
            let piece =
                |[low, high]: &[f64; 2]| format!("{} to {}", rounded(*low, 3), rounded(*high, 3));
            let pieces: Vec<String> = pieces.iter().map(piece).collect();
            let interval = pieces.join(" or ");
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
