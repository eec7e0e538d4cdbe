//! Result of a test with few positions as text.

use std::fmt::Write as _;

use comfy_table::Cell;
use gyrocal_instruments::multi_position::FewPositionReport;
use gyrocal_statistics::format;

use crate::tables::table;

/// Laws, what the positions do not determine, and significant terms.
pub(super) fn text(report: &FewPositionReport, false_alarm: f64) -> String {
    let mut table = table(["coefficient", "estimate"]);
    for coefficient in report.gyros.iter().flat_map(|gyro| &gyro.coefficients) {
        let estimate = format::estimate(coefficient.estimate, coefficient.sigma).join(" ± ");
        table.add_row([
            Cell::new(&coefficient.name),
            Cell::new(format!("{estimate} {}", coefficient.unit)),
        ]);
    }
    let mut text = format!(
        "The terms that {} positions determine, judged by the standard errors of the stops:\n\n{}\n\n",
        report.stops,
        table.trim_fmt()
    );
    for gyro in &report.gyros {
        let fit = match gyro.p_value {
            Some(p) => format!(
                "chi-square {:.1} with {} degrees of freedom, {}",
                gyro.chi_square,
                gyro.degrees_of_freedom,
                format::p_value(p)
            ),
            None => "no degrees of freedom are left to test the law".to_owned(),
        };
        let _ = write!(text, "{}: {fit}", gyro.gyro);
        if gyro.inflation > 1.0 {
            let _ = write!(
                text,
                "; scatter beyond the standard errors: sigmas are {:.1} times as large",
                gyro.inflation
            );
        }
        text.push_str(".\n");
        if !gyro.undetermined.is_empty() {
            let _ = writeln!(
                text,
                "  Not determined in addition: {}.",
                gyro.undetermined.join(", ")
            );
        }
    }
    if report.findings.is_empty() {
        let _ = writeln!(
            text,
            "\nNo significant term beyond the nominal law (false-alarm probability {false_alarm})."
        );
    } else {
        text.push_str("\nSignificant terms beyond the nominal law:\n");
    }
    for finding in &report.findings {
        let [estimate, sigma] = format::estimate(finding.estimate, finding.sigma);
        let alternatives = match &finding.alternatives[..] {
            [] => "no alternative in the catalogue".to_owned(),
            names => format!("alternatives: {}", names.join(", ")),
        };
        let _ = writeln!(
            text,
            "  {}  {estimate} ± {sigma} {}  (family-wise {}); {alternatives}",
            finding.effect,
            finding.unit,
            format::p_value(finding.p_value)
        );
    }
    text
}
