//! Result of a test with many positions as text.

use std::fmt::Write as _;

use comfy_table::{Cell, Table};
use gyrocal_instruments::multi_position::{CoefficientReport, Finding, MultiPositionReport};
use gyrocal_statistics::format;

use super::TumbleArguments;
use crate::tables::table;

/// Laws, significant terms, gain and controls.
pub(super) fn text(arguments: &TumbleArguments, report: &MultiPositionReport) -> String {
    let mut text = String::new();
    let _ = writeln!(text, "{}\n", laws(report).trim_fmt());
    for gyro in &report.gyros {
        let (nominal, extended) = (&gyro.nominal, &gyro.extended);
        let test = &gyro.nominal_against_catalogue;
        let _ = writeln!(
            text,
            "{}: chi-square {:.0} with the nominal law ({} degrees of freedom), {:.1} with the \
             extended law ({}; {}).\n  Scatter beyond the standard errors of the stops: {:.0} \
             deg/h, with the nominal law {:.0} deg/h.\n  All terms of the catalogue against the \
             nominal law: F({}, {}) = {:.1}, {}; against the extended law: F = {:.1}, {}.",
            gyro.gyro,
            nominal.chi_square,
            nominal.degrees_of_freedom,
            extended.chi_square,
            extended.degrees_of_freedom,
            format::p_value(extended.p_value),
            extended.excess_deg_per_h,
            nominal.excess_deg_per_h,
            test.degrees_of_freedom[0],
            test.degrees_of_freedom[1],
            test.f,
            format::p_value(test.p_value),
            gyro.extended_against_catalogue.f,
            format::p_value(gyro.extended_against_catalogue.p_value),
        );
        if !gyro.undetermined.is_empty() {
            let names = gyro.undetermined.join(", ");
            let _ = writeln!(
                text,
                "  Not identifiable from these attitudes, given the others: {names}."
            );
        }
    }
    if report.findings.is_empty() {
        let _ = writeln!(
            text,
            "\nNo significant term beyond the nominal law (false-alarm probability {}): the extended \
             law is the nominal one.",
            arguments.false_alarm
        );
    } else {
        text.push_str("\nSignificant terms beyond the nominal law, in the order of finding:\n");
    }
    if !report.not_confirmed.is_empty() {
        let _ = writeln!(
            text,
            "Significant, but no gain on held-out stops, so not in the law: {}.",
            report.not_confirmed.join(", ")
        );
    }
    for finding in &report.findings {
        describe(&mut text, finding);
    }
    held_out_gain(&mut text, arguments, report);
    text
}

fn laws(report: &MultiPositionReport) -> Table {
    let mut table = table(["coefficient", "nominal law", "extended law"]);
    let value = |of: &CoefficientReport| {
        let estimate = format::estimate(of.estimate, of.sigma).join(" ± ");
        format!("{estimate} {}", of.unit)
    };
    for gyro in &report.gyros {
        for coefficient in &gyro.extended.coefficients {
            let mut nominal = gyro.nominal.coefficients.iter();
            let nominal = nominal.find(|other| other.name == coefficient.name);
            table.add_row([
                Cell::new(&coefficient.name),
                Cell::new(nominal.map_or_else(String::new, value)),
                Cell::new(value(coefficient)),
            ]);
        }
    }
    table
}

fn describe(text: &mut String, finding: &Finding) {
    let [estimate, sigma] = format::estimate(finding.estimate, finding.sigma);
    let _ = writeln!(
        text,
        "  {}  {estimate} ± {sigma} {}  (F = {:.0}, family-wise {})",
        finding.effect,
        finding.unit,
        finding.f,
        format::p_value(finding.p_value)
    );
    let rivals: Vec<String> = finding
        .alternatives
        .iter()
        .map(|rival| {
            format!(
                "{} ({:.1} nats)",
                rival.effect, rival.log_likelihood_deficit
            )
        })
        .collect();
    if rivals.is_empty() {
        text.push_str("    no alternative in the catalogue");
    } else {
        let _ = write!(text, "    alternatives: {}", rivals.join(", "));
    }
    if let Some(nearest) = &finding.nearest_ruled_out {
        let _ = write!(
            text,
            "; nearest excluded term: {} ({:.1} nats)",
            nearest.effect, nearest.log_likelihood_deficit
        );
    }
    text.push('\n');
    if !finding.equivalents.is_empty() {
        let _ = writeln!(
            text,
            "    exact equivalent, with the opposite sign: {}",
            finding.equivalents.join(", ")
        );
    }
    if let Some(angle) = finding.misalignment_needed_rad {
        let _ = writeln!(
            text,
            "    as a misalignment of the accelerometers: {angle:.1} rad"
        );
    }
}

fn held_out_gain(text: &mut String, arguments: &TumbleArguments, report: &MultiPositionReport) {
    if report.cross_validation.is_none() && !report.findings.is_empty() {
        let _ = writeln!(
            text,
            "\nThe gain of the extended law on held-out stops cannot be measured: without {} successive \
             stops the others\ndo not determine it. Give a smaller --left-out.",
            arguments.left_out
        );
    }
    if let Some(gain) = &report.cross_validation {
        let list = |values: [f64; 3]| values.map(|value| format!("{value:.0}")).join(", ");
        let _ = writeln!(
            text,
            "\nOn held-out stops ({} blocks of up to {}, searched and fitted without them) the \
             extended law improves the\npredictive log score by {:.1} ± {:.1} nats. Rms errors of \
             gyros x, y, z: {} deg/h, nominal law {},\nstandard errors of the stops {}.",
            gain.blocks,
            gain.left_out,
            gain.cross_validated_log_score_nats,
            gain.standard_error_nats,
            list(gain.rms_after_deg_per_h),
            list(gain.rms_before_deg_per_h),
            list(gain.noise_deg_per_h),
        );
        let found: Vec<String> = gain
            .found_in_blocks
            .iter()
            .map(|(name, blocks)| format!("{name} {blocks}"))
            .collect();
        let _ = writeln!(
            text,
            "Blocks without which each term is found again: {}.",
            found.join(", ")
        );
    }
    let controls = &report.controls;
    let names = |names: &[String]| match names {
        [] => "none".to_owned(),
        names => names.join(", "),
    };
    let _ = writeln!(
        text,
        "\nControls: findings in {} of {} data sets with permuted stops; with all axes renamed, the \
         findings\nare {} under their new names; with only the axes of the accelerometers renamed, \
         spurious\nfindings: {}.",
        controls.shuffles_with_findings,
        controls.shuffles,
        if controls.renamed_as_expected {
            "the same"
        } else {
            "NOT the same"
        },
        names(&controls.forces_renamed_unexpected),
    );
}
