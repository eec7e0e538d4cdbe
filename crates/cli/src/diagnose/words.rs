//! The first screen: what was found, in words.

mod gain;

use std::fmt::Write as _;

use gyrocal::generated::catalogue::EFFECTS;
use gyrocal_record::{
    DiagnosisVerdict, FilterReport, FindingReport, ParameterReport, RemainderVerdict, RivalReport,
};
use gyrocal_statistics::format;

use super::blind::is_blind;
use super::{Found, channels, filter, tables};
use crate::text::{bullet, indented, paragraph};

/// Rivals that are told in words; the table has all.
const RIVALS_TOLD: usize = 4;

pub(super) fn summary(found: &Found<'_>) -> String {
    let report = &found.report;
    let mut text = format!(
        "{}: {} rows over {:.2} days\n\n",
        found.path.display(),
        found.record.len(),
        found.record.duration_s() / 86_400.0
    );
    text.push_str(&paragraph(&verdict(found)));
    text.push('\n');
    text.push_str(&paragraph(&channels::norm_in_words(report)));
    for (index, finding) in report.findings.iter().enumerate() {
        let _ = writeln!(
            text,
            "\n{}. {}: {}",
            index + 1,
            finding.effect,
            name(&finding.effect)
        );
        text.push_str(&indented("   ", &size(finding)));
        if let Some(words) = gain::refused(finding) {
            text.push_str(&indented("   ", &words));
        }
        if !finding.rivals.is_empty() {
            text.push_str(&indented("   ", &rivals(finding)));
        }
        for equivalent in &finding.equivalents {
            let words = format!(
                "No record can tell it from {}: {}.",
                equivalent.effect,
                values(&equivalent.parameters)
            );
            text.push_str(&indented("   ", &words));
        }
    }
    if let Some(filter) = &report.filter {
        text.push('\n');
        text.push_str(&paragraph(&judged(filter, &report.findings)));
    }
    if !report.cannot_tell.is_empty() {
        text.push_str("\nNot told apart, and what would separate it:\n");
        for group in &report.cannot_tell {
            let words = format!(
                "{}: {}. To separate: {}.",
                group.members.join(", "),
                group.why,
                group.would_separate
            );
            text.push_str(&bullet(&words));
        }
    }
    if let Some(gain) = &report.gain {
        text.push('\n');
        text.push_str(&paragraph(&gain::gained(gain)));
    }
    if let Some(words) = gain::later(found) {
        text.push('\n');
        text.push_str(&paragraph(&words));
    }
    text.push('\n');
    text.push_str(&paragraph(&left(found)));
    text.push_str(&paragraph(&channels::allan_in_words(report)));
    text.push_str(&tables::all(found));
    text
}

/// What the catalogue calls an effect.
pub(super) fn name(effect: &str) -> &'static str {
    EFFECTS
        .iter()
        .find(|row| row.id == effect)
        .map_or("", |row| row.name)
}

fn verdict(found: &Found<'_>) -> String {
    let report = &found.report;
    let alarm = format!(
        "a sound record shows anything with a probability of {}",
        format::percent(report.false_alarm_probability)
    );
    match report.verdict {
        DiagnosisVerdict::EffectsFound => {
            let count = report.findings.len();
            let least = report
                .findings
                .iter()
                .map(|finding| finding.p_value)
                .fold(1.0, f64::min);
            format!(
                "Something is wrong: {} found ({} for the whole search; {alarm}).",
                if count == 1 {
                    "one effect".to_owned()
                } else {
                    format!("{count} effects")
                },
                format::p_value(least),
            )
        }
        DiagnosisVerdict::Unexplained => format!(
            "Something is wrong, and no effect of the catalogue explains it ({}; {alarm}).",
            format::p_value(report.remainder.p_value)
        ),
        _ => format!(
            "Nothing is wrong: {}, no effect of the catalogue{} ({alarm}).{}",
            if found.diagnosis.audit.accel_ratio.is_some() {
                "noise as declared"
            } else {
                "no outliers nor quantisation (the record is too short for a spectrum of its noise)"
            },
            match report.remainder.verdict {
                RemainderVerdict::White => ", white innovations",
                _ => "",
            },
            unseen(found)
        ),
    }
}

/// What a verdict on a short record does not mean.
fn unseen(found: &Found<'_>) -> String {
    let report = &found.report;
    let blind = report.not_searched.iter().filter(|e| is_blind(e)).count();
    if blind == 0 {
        return String::new();
    }
    format!(
        " That says little: the record is so short that {blind} of {} effects would pass unseen \
         at their typical size. Record for a day or longer.",
        report.ranking.len()
    )
}

fn size(finding: &FindingReport) -> String {
    let mut words = Vec::new();
    if !finding.parameters.is_empty() {
        words.push(values(&finding.parameters));
    }
    words.push(format!(
        "{:.1} sigma, {}",
        finding.z,
        format::p_value(finding.p_value)
    ));
    words.join("; ")
}

/// All parameters with their sigmas and units.
pub(super) fn values(parameters: &[ParameterReport]) -> String {
    let each = parameters.iter().map(|parameter| {
        let unit = match parameter.unit.as_str() {
            "1" => String::new(),
            unit => format!(" {unit}"),
        };
        format!("{} {}{unit}", parameter.name, value(parameter))
    });
    each.collect::<Vec<_>>().join(", ")
}

/// Estimate and sigma of a parameter.
pub(super) fn value(parameter: &ParameterReport) -> String {
    match parameter.sigma {
        Some(sigma) => {
            let [estimate, sigma] = format::estimate(parameter.estimate, sigma);
            format!("{estimate} ± {sigma}")
        }
        None => format::short(parameter.estimate, 4),
    }
}

fn rivals(finding: &FindingReport) -> String {
    let told: Vec<String> = finding
        .rivals
        .iter()
        .take(RIVALS_TOLD)
        .map(|rival| format!("{} ({})", rival.effect, likelihood(rival)))
        .collect();
    let more = finding.rivals.len().saturating_sub(RIVALS_TOLD);
    let more = match more {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!(
        "Or else {}{more}: the set holds the cause with a probability of {:.0} %.",
        told.join(", "),
        100.0 * finding.coverage
    )
}

/// How much less likely a rival is.
pub(super) fn likelihood(rival: &RivalReport) -> String {
    // Beyond this a factor says nothing but that there is no comparison.
    let factor = rival.log_likelihood_deficit.clamp(-50.0, 50.0).exp();
    if factor >= 1.05 {
        format!("{factor:.1} times less likely")
    } else if factor > 0.95 {
        "as likely".to_owned()
    } else {
        format!(
            "{:.1} times more likely, but the richer one",
            factor.recip()
        )
    }
}

fn judged(report: &FilterReport, findings: &[FindingReport]) -> String {
    let [low, high] = report.nis_band;
    let reference = report.reference_nis_mean;
    let band = format!("99.9 % band {low:.3} to {high:.3}");
    match (report.nis_mean, &report.stopped) {
        (Some(mean), _) if findings.iter().any(|found| found.effect == filter::EFFECT) => format!(
            "The paper's filter on this record: mean NIS {mean:.1} ({band}), where the filter of \
             this program has {reference:.3}. One Euler step a sample, with Euler angles as states, \
             is too coarse for this record; its coefficients and sigmas mean nothing."
        ),
        (Some(mean), _) => format!(
            "The paper's filter on this record: mean NIS {mean:.3} ({band}), the filter of this \
             program {reference:.3}: its integration rule is not what is wrong."
        ),
        (None, stopped) => format!(
            "The paper's filter stopped {}; the filter of this program has mean NIS {reference:.3} \
             ({band}).",
            stopped.as_deref().unwrap_or("before it had an answer")
        ),
    }
}

fn left(found: &Found<'_>) -> String {
    let remainder = &found.report.remainder;
    let p = format::p_value(remainder.p_value);
    match remainder.verdict {
        RemainderVerdict::Unexplained => format!(
            "Left unexplained: {} ({p}). No effect of the catalogue does \
             this; docs/adding-a-term.md adds one.",
            remainder.description
        ),
        RemainderVerdict::NotTested => format!(
            "What is left was not tested for {}: too few rows without a gap have all three axes.",
            remainder.description
        ),
        _ => format!(
            "Left: noise. The innovations of the model are white up to half the sampling rate \
             ({p})."
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rival_is_told_by_its_likelihood() {
        let of = |log_likelihood_deficit| {
            likelihood(&RivalReport {
                effect: "gyro_x.ramp".to_owned(),
                log_likelihood_deficit,
            })
        };
        assert_eq!(of(2.0), "7.4 times less likely");
        assert_eq!(of(0.0), "as likely");
        assert_eq!(of(-1.0), "2.7 times more likely, but the richer one");
    }
}
