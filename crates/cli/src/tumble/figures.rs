//! Pictures of a multi-position test.

use std::path::Path;

use gyrocal_measured::tumble::{Finding, GyroReport, Prepared, TumbleReport};
use gyrocal_report::{After, Contribution, Contributions, Residuals};

use crate::pictures::Named;
use crate::rounding::rounded;

/// Contribution of each finding, and residuals of the laws; only the latter without findings.
pub(super) fn pictures(log: &Path, prepared: &Prepared, report: &TumbleReport) -> Vec<Named> {
    let mut pictures: Vec<Named> = Vec::new();
    if let Some(causes) = causes(log, prepared, report) {
        pictures.push(("causes", Box::new(causes)));
    }
    if let Some(residuals) = residuals(log, prepared, report) {
        pictures.push(("residuals", Box::new(residuals)));
    }
    pictures
}

fn subtitle(log: &Path, report: &TumbleReport) -> String {
    let name = log.file_name().unwrap_or(log.as_os_str());
    format!("{}; {} static stops", name.display(), report.stops)
}

fn gyro_of<'a>(report: &'a TumbleReport, finding: &Finding) -> Option<(usize, &'a GyroReport)> {
    let (gyro, _) = finding.effect.split_once('.')?;
    let mut gyros = report.gyros.iter().enumerate();
    gyros.find(|(_, other)| other.gyro == gyro)
}

/// By gyro and then by name: findings come in the order of their significance.
fn causes(log: &Path, prepared: &Prepared, report: &TumbleReport) -> Option<Contributions> {
    let mut findings: Vec<&Finding> = report.findings.iter().collect();
    findings.sort_by(|a, b| a.effect.cmp(&b.effect));
    let panels = findings
        .iter()
        .filter_map(|finding| contribution(prepared, report, finding));
    let panels: Vec<Contribution> = panels.collect();
    let title = match &*report.findings {
        [] => return None,
        [one] => format!("{}: the nominal drift law leaves it out", one.effect),
        several => format!(
            "{} terms that the nominal drift law leaves out",
            several.len()
        ),
    };
    Some(Contributions {
        title,
        subtitle: format!(
            "gyro output less all other terms of the extended law; {}",
            subtitle(log, report)
        ),
        quantity: "rate".to_owned(),
        unit: "deg/h".to_owned(),
        dot: "one static stop".to_owned(),
        columns: 2.min(panels.len()),
        panels,
    })
}

fn contribution(
    prepared: &Prepared,
    report: &TumbleReport,
    finding: &Finding,
) -> Option<Contribution> {
    let (axis, gyro) = gyro_of(report, finding)?;
    let sigmas = prepared.positions.sigma_deg_per_h.iter();
    let residuals = &gyro.extended.residuals_deg_per_h;
    let rest = residuals.iter().zip(&finding.regressor);
    let (abscissa, abscissa_unit) = abscissa(&finding.effect);
    let [estimate, sigma] = rounded(finding.estimate, finding.sigma);
    Some(Contribution {
        name: finding.effect.clone(),
        size: format!("{estimate} ± {sigma} {}", finding.unit),
        abscissa,
        abscissa_unit,
        abscissae: finding.regressor.clone(),
        rest: rest.map(|(left, x)| left + finding.estimate * x).collect(),
        standard_error: sigmas.map(|sigma| sigma[axis]).collect(),
        slope: finding.estimate,
    })
}

/// Regressor of a term, by its name: `gyro_x.g_yz` multiplies forces along y and z.
fn abscissa(effect: &str) -> (String, String) {
    match effect.split_once(".g_").map(|(_, axes)| axes) {
        Some(axis) if axis.len() == 1 => (format!("specific force {axis}"), "g".to_owned()),
        Some(axes) => {
            let factors: Vec<String> = axes.chars().map(|axis| format!("a_{axis}")).collect();
            (factors.join(" "), format!("g^{}", axes.len()))
        }
        None => ("time since the first stop".to_owned(), "days".to_owned()),
    }
}

fn residuals(log: &Path, prepared: &Prepared, report: &TumbleReport) -> Option<Residuals> {
    let [x, y, z] = &*report.gyros else {
        return None;
    };
    let gyros = [x, y, z];
    let rms =
        |values: &[f64]| (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt();
    let all = |residuals: [&Vec<f64>; 3]| rms(&residuals.map(|column| rms(column)));
    let before = gyros.map(|gyro| &gyro.nominal.residuals_deg_per_h);
    let after = gyros.map(|gyro| &gyro.extended.residuals_deg_per_h);
    let miss = all(before);
    let found = !report.findings.is_empty();
    let title = if found {
        format!(
            "The nominal drift law misses the stops by {miss:.0} deg/h, the extended one by {:.0}",
            all(after)
        )
    } else {
        format!("The nominal drift law misses the stops by {miss:.0} deg/h")
    };
    Some(Residuals {
        title,
        subtitle: format!(
            "gyro output less the law at each stop; {}",
            subtitle(log, report)
        ),
        time_s: prepared.positions.time_s.clone(),
        before: before.map(Clone::clone),
        before_label: "nominal law".to_owned(),
        after: found.then(|| After {
            values: after.map(Clone::clone),
            label: "extended law".to_owned(),
        }),
        sigma: core::array::from_fn(|axis| {
            let sigmas = prepared.positions.sigma_deg_per_h.iter();
            rms(&sigmas.map(|sigma| sigma[axis]).collect::<Vec<_>>())
        }),
        quantity: "residual".to_owned(),
        unit: "deg/h".to_owned(),
    })
}
