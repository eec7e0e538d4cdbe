//! Charts of a multi-position test.

use gyrocal::generated::catalogue::OUTPUTS;
use gyrocal_document::{Chart, Line, LineKind, Panel, TimeAxis, Tint};
use gyrocal_instruments::multi_position::{Finding, GyroReport, MultiPositionReport, PreparedTest};
use gyrocal_statistics::format;

use crate::panels::{band, line, two_sigmas};

/// The drift laws, each with its colour.
pub(super) const LAWS: [(&str, Tint); 2] = [
    ("nominal law", Tint::Nominal),
    ("extended law", Tint::Extended),
];

/// What bands hold.
const ERRORS: &str = "±2 standard errors of a stop";

/// A point for each stop.
fn points((label, tint): (&str, Tint), values: &[f64]) -> Line {
    Line::new(label, tint, LineKind::Points, values.to_vec())
}

pub(super) fn residuals(prepared: &PreparedTest, report: &MultiPositionReport) -> Chart {
    let found = !report.findings.is_empty();
    let [nominal, extended] = LAWS;
    let panels = report.gyros.iter().enumerate().map(|(axis, gyro)| {
        let sigmas = prepared.positions.sigma_deg_per_h.iter();
        let half: Vec<f64> = sigmas.map(|sigma| 2.0 * sigma[axis]).collect();
        let mut lines = vec![points(nominal, &gyro.nominal.residuals_deg_per_h)];
        if found {
            lines.push(points(extended, &gyro.extended.residuals_deg_per_h));
        }
        Panel {
            name: gyro.gyro.clone(),
            note: format!(
                "chi-square {:.0} → {:.1}",
                gyro.nominal.chi_square, gyro.extended.chi_square
            ),
            abscissa: (1..=half.len()).map(|stop| stop as f64).collect(),
            bands: vec![band(ERRORS, &half)],
            lines,
            no_gaps: true,
            ..Panel::default()
        }
    });
    let [before, after] = report.residual_rms_deg_per_h();
    let time = TimeAxis::of(&prepared.positions.time_s);
    Chart {
        title: match found {
            true => format!(
                "{before:.0} deg/h rms with the nominal law, {after:.0} with the extended one"
            ),
            false => format!("{before:.0} deg/h rms with the nominal law"),
        },
        caption: format!(
            "One point is one static stop; from the first to the last {} {}.",
            format::short(time.values.last().copied().unwrap_or(0.0), 3),
            time.unit
        ),
        abscissa: "stop".to_owned(),
        quantity: "residual".to_owned(),
        unit: "deg/h".to_owned(),
        panels: panels.collect(),
        columns: 3,
        height_px: 230,
        ..Chart::default()
    }
}

pub(super) fn contributions(prepared: &PreparedTest, report: &MultiPositionReport) -> Chart {
    let panels = report.findings.iter().filter_map(|finding| {
        let gyro = report.gyros.get(finding.gyro)?;
        Some(contribution(prepared, gyro, finding))
    });
    Chart {
        title: match &*report.findings {
            [one] => format!("{} is missing from the nominal drift law", one.effect),
            several => format!(
                "{} terms are missing from the nominal drift law",
                several.len()
            ),
        },
        caption: "Partial residuals, gyro output less all other terms of the extended law, with ±2 standard errors \
                  of a stop about the fitted term."
            .to_owned(),
        quantity: "rate".to_owned(),
        unit: "deg/h".to_owned(),
        panels: panels.collect(),
        columns: 3,
        height_px: 190,
        unlinked: true,
        ..Chart::default()
    }
}

fn contribution(prepared: &PreparedTest, gyro: &GyroReport, finding: &Finding) -> Panel {
    let residuals = &gyro.extended.residuals_deg_per_h;
    let rows = finding.regressor.iter().zip(residuals);
    let rows = rows.zip(&prepared.positions.sigma_deg_per_h);
    let rows = rows.map(|((at, residual), sigma)| {
        let rate = residual + finding.estimate * at;
        [*at, rate, sigma[finding.gyro]]
    });
    let mut rows: Vec<[f64; 3]> = rows.collect();
    rows.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let fitted = rows.iter();
    let fitted = fitted.map(|row| (finding.estimate * row[0], row[2]));
    let rates: Vec<f64> = rows.iter().map(|row| row[1]).collect();
    let [estimate, sigma] = format::estimate(finding.estimate, finding.sigma);
    Panel {
        name: finding.effect.clone(),
        note: format!("{estimate} ± {sigma} {}", finding.unit).replace('-', "−"),
        own_abscissa: Some(regressor(finding)),
        abscissa: rows.iter().map(|row| row[0]).collect(),
        bands: vec![two_sigmas(ERRORS, Tint::Extended, fitted.clone())],
        lines: vec![
            line(
                "fitted term",
                Tint::Extended,
                fitted.map(|(rate, sigma)| rate + 0.0 * sigma).collect(),
            ),
            points(("one static stop", Tint::Measured), &rates),
        ],
        no_gaps: true,
        ..Panel::default()
    }
}

/// Regressor of a term and its unit.
fn regressor(finding: &Finding) -> (String, String) {
    let factors = finding.term.factors(finding.gyro);
    let names: Vec<&str> = factors.iter().map(|axis| OUTPUTS[*axis].label).collect();
    match &*names {
        [] => ("time since the first stop".to_owned(), "days".to_owned()),
        [axis] => (format!("specific force {axis}"), "g".to_owned()),
        axes => {
            let factors: Vec<String> = axes.iter().map(|axis| format!("a_{axis}")).collect();
            (factors.join(" "), format!("g^{}", axes.len()))
        }
    }
}
