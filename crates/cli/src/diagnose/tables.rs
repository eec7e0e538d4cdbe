//! The tables below the words.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use comfy_table::Cell;
use gyrocal_record::{DiagnosisReport, FindingReport, GainReport, NoiseRatioReport};
use gyrocal_statistics::format;

use super::words::{likelihood, value};
use super::{Found, residuals};
use crate::noise::told;
use crate::tables::{right, table};
use crate::text::bullet;

/// Rows of the ranking that are shown.
const TOP: usize = 12;

/// All tables with their heads.
pub(super) fn all(found: &Found<'_>) -> String {
    let report = &found.report;
    let mut text = String::new();
    if !report.findings.is_empty() {
        let _ = writeln!(text, "\nFindings:\n\n{}", findings(report));
    }
    if let Some(shown) = &report.residuals {
        let _ = writeln!(
            text,
            "\n{}\n\n{}",
            residuals::heading(shown),
            residuals::rows(shown, found.record.duration_s() / 3600.0)
        );
    }
    if !report.ranking.is_empty() {
        let threshold = report.threshold.map_or_else(String::new, |threshold| {
            format!("; the largest must exceed {threshold:.1}")
        });
        let _ = writeln!(
            text,
            "\nEffects of the first search, {} of {}, by chi-square less what searching alone \
             reaches{threshold}:\n\n{}",
            report.ranking.len().min(TOP),
            report.ranking.len(),
            ranking(report)
        );
    }
    if let Some(gain) = &report.gain {
        let _ = writeln!(
            text,
            "\nWhat {} changes of the coefficients, with 95 % intervals:\n\n{}",
            gain.effects.join(", "),
            shifts(gain)
        );
    }
    let _ = writeln!(
        text,
        "\nNoise over the declared, with the findings in the model:\n\n{}",
        noise(report)
    );
    let _ = writeln!(text, "\n{}", audit(found));
    if !report.not_searched.is_empty() {
        let _ = write!(
            text,
            "\nNot looked for, or not to be seen:\n{}",
            not_searched(report)
        );
    }
    text
}

fn findings(report: &DiagnosisReport) -> String {
    let mut table = table([
        "effect",
        "parameter",
        "estimate",
        "unit",
        "z",
        "p",
        "gain, nats",
    ]);
    for finding in &report.findings {
        let mut head = [
            Cell::new(&finding.effect),
            right(format!("{:.1}", finding.z)),
            right(format::p_cell(finding.p_value)),
            right(gain(finding)),
        ];
        if finding.parameters.is_empty() {
            let [effect, z, p, gain] = head;
            let none = || Cell::new("");
            table.add_row([effect, none(), none(), none(), z, p, gain]);
            continue;
        }
        for parameter in &finding.parameters {
            let [effect, z, p, gain] = head;
            table.add_row([
                effect,
                Cell::new(&parameter.name),
                right(value(parameter)),
                Cell::new(&parameter.unit),
                z,
                p,
                gain,
            ]);
            head = [(); 4].map(|()| Cell::new(""));
        }
    }
    table.trim_fmt()
}

/// Noise is no term of the model and has none.
fn gain(finding: &FindingReport) -> String {
    match (finding.gain_nats, finding.accepted) {
        (Some(nats), Some(false)) => format!("{nats:+.1}, not in the model"),
        (Some(nats), _) => format!("{nats:+.1}"),
        (None, _) => String::new(),
    }
}

fn shifts(gain: &GainReport) -> String {
    let mut table = table([
        "coefficient",
        "shift",
        "interval",
        "in sigmas",
        "interval",
        "unit",
    ]);
    for shift in &gain.coefficient_shift {
        let [low, high] = shift.interval;
        let [low_sigmas, high_sigmas] = shift.in_sigmas_interval;
        table.add_row([
            Cell::new(&shift.coefficient),
            right(format!("{:+.2e}", shift.shift)),
            right(format!("{low:+.2e} to {high:+.2e}")),
            right(format!("{:+.1}", shift.in_sigmas)),
            right(format!("{low_sigmas:+.1} to {high_sigmas:+.1}")),
            Cell::new(&shift.unit),
        ]);
    }
    table.trim_fmt()
}

fn ranking(report: &DiagnosisReport) -> String {
    let mut table = table(["effect", "statistic", ""]);
    for ranked in report.ranking.iter().take(TOP) {
        table.add_row([
            Cell::new(&ranked.effect),
            right(format!("{:.1}", ranked.statistic)),
            Cell::new(role(report, &ranked.effect)),
        ]);
    }
    table.trim_fmt()
}

/// What an effect of the ranking is in the answer.
fn role(report: &DiagnosisReport, effect: &str) -> String {
    for finding in &report.findings {
        if finding.effect == effect {
            return "named".to_owned();
        }
        if finding.equivalents.iter().any(|e| e.effect == effect) {
            return format!("the same as {}", finding.effect);
        }
        if let Some(rival) = finding.rivals.iter().find(|r| r.effect == effect) {
            return format!("rival of {}, {}", finding.effect, likelihood(rival));
        }
    }
    String::new()
}

fn noise(report: &DiagnosisReport) -> String {
    let mut table = table(["", "x", "y", "z"]);
    let row = |name: &str, ratios: &[NoiseRatioReport; 3]| {
        let cells = ratios.iter().map(|ratio| right(interval(ratio)));
        std::iter::once(Cell::new(name))
            .chain(cells)
            .collect::<Vec<_>>()
    };
    table.add_row(row("accelerometers", &report.noise.accel));
    table.add_row(row("gyros", &report.noise.gyro));
    table.trim_fmt()
}

fn interval(ratio: &NoiseRatioReport) -> String {
    told(ratio.ratio, ratio.interval).unwrap_or_else(|| "not told".to_owned())
}

/// What the audit of the noise saw, in lines.
fn audit(found: &Found<'_>) -> String {
    let audit = &found.diagnosis.audit;
    let mut parts = Vec::new();
    match &audit.correlation {
        Some(correlation) => parts.push(format!(
            "correlation from row to row {:.3} ± {:.3}",
            correlation.estimate, correlation.sigma
        )),
        None => parts.push("the record is too short for a spectrum of the noise".to_owned()),
    }
    parts.push(match audit.outliers.len() {
        0 => "no outliers".to_owned(),
        1 => "1 outlier, left out".to_owned(),
        count => format!("{count} outliers, left out"),
    });
    let gaps = &audit.gaps;
    if gaps.count > 0 {
        parts.push(format!(
            "{} {} with {} s missing, the longest interval {} s",
            gaps.count,
            if gaps.count == 1 { "gap" } else { "gaps" },
            format::short(gaps.missing_s, 4),
            format::short(gaps.longest_s, 4)
        ));
    }
    if gaps.missing_values > 0.0 {
        parts.push(format!(
            "{} % of the values missing",
            format::short(100.0 * gaps.missing_values, 4)
        ));
    }
    format!("Noise of the accelerometers: {}.", parts.join("; "))
}

/// Effects by what stands in the way.
fn not_searched(report: &DiagnosisReport) -> String {
    let mut by_reason: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for effect in &report.not_searched {
        by_reason
            .entry(&effect.why)
            .or_default()
            .push(&effect.effect);
    }
    by_reason
        .into_iter()
        .map(|(why, effects)| bullet(&format!("{}: {why}", effects.join(", "))))
        .collect()
}
