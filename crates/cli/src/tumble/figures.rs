//! Pictures of a multi-position test.

use std::path::Path;

use gyrocal::generated::catalogue::OUTPUTS;
use gyrocal_instruments::multi_position::{Finding, MultiPositionReport, PreparedTest};
use gyrocal_record::AXES;
use gyrocal_report::{ResidualChannel, Residuals, TermContribution, TermContributions};
use gyrocal_statistics::format;

use crate::pictures::Named;

/// Partial residuals of each effect found, and the residuals of both laws; only the latter if
/// nothing was found.
pub(super) fn pictures(
    log: &Path,
    prepared: &PreparedTest,
    report: &MultiPositionReport,
) -> Vec<Named> {
    let mut pictures: Vec<Named> = Vec::new();
    if let Some(causes) = causes(log, prepared, report) {
        pictures.push(("causes", Box::new(causes)));
    }
    if let Some(residuals) = residuals(log, prepared, report) {
        pictures.push(("residuals", Box::new(residuals)));
    }
    pictures
}

fn subtitle(log: &Path, report: &MultiPositionReport) -> String {
    let name = log.file_name().unwrap_or(log.as_os_str());
    format!("{}; {} static stops", name.display(), report.stops)
}

/// By gyro and then by name: findings come in the order of their significance.
fn causes(
    log: &Path,
    prepared: &PreparedTest,
    report: &MultiPositionReport,
) -> Option<TermContributions> {
    let mut findings: Vec<&Finding> = report.findings.iter().collect();
    findings.sort_by(|a, b| a.effect.cmp(&b.effect));
    let terms = findings
        .iter()
        .filter_map(|finding| contribution(prepared, report, finding));
    let terms: Vec<TermContribution> = terms.collect();
    let title = match &*report.findings {
        [] => return None,
        [one] => format!("{} is missing from the nominal drift law", one.effect),
        several => format!(
            "{} terms are missing from the nominal drift law",
            several.len()
        ),
    };
    Some(TermContributions {
        title,
        subtitle: format!(
            "partial residuals: gyro output minus all other terms of the extended law; {}",
            subtitle(log, report)
        ),
        quantity: "rate".to_owned(),
        unit: "deg/h".to_owned(),
        point_label: "one static stop".to_owned(),
        columns: 2.min(terms.len()),
        terms,
    })
}

fn contribution(
    prepared: &PreparedTest,
    report: &MultiPositionReport,
    finding: &Finding,
) -> Option<TermContribution> {
    let axis = finding.gyro;
    let gyro = report.gyros.get(axis)?;
    let sigmas = prepared.positions.sigma_deg_per_h.iter();
    let residuals = &gyro.extended.residuals_deg_per_h;
    let pairs = residuals.iter().zip(&finding.regressor);
    let (regressor, regressor_unit) = regressor(finding);
    let [estimate, sigma] = format::estimate(finding.estimate, finding.sigma);
    Some(TermContribution {
        name: finding.effect.clone(),
        estimate: format!("{estimate} ± {sigma} {}", finding.unit),
        regressor,
        regressor_unit,
        regressor_values: finding.regressor.clone(),
        partial_residuals: pairs
            .map(|(residual, x)| residual + finding.estimate * x)
            .collect(),
        standard_errors: sigmas.map(|sigma| sigma[axis]).collect(),
        slope: finding.estimate,
    })
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

fn residuals(
    log: &Path,
    prepared: &PreparedTest,
    report: &MultiPositionReport,
) -> Option<Residuals> {
    let [x, y, z] = &*report.gyros else {
        return None;
    };
    let gyros = [x, y, z];
    let before = gyros.map(|gyro| &gyro.nominal.residuals_deg_per_h);
    let after = gyros.map(|gyro| &gyro.extended.residuals_deg_per_h);
    let [miss, miss_extended] = report.residual_rms_deg_per_h();
    let found = !report.findings.is_empty();
    let title = if found {
        format!(
            "Residual at the static stops: {miss:.0} deg/h rms for the nominal drift law, {:.0} for \
             the extended one",
            miss_extended
        )
    } else {
        format!("Residual of the nominal drift law at the static stops: {miss:.0} deg/h rms")
    };
    Some(Residuals {
        title,
        subtitle: format!(
            "gyro output minus drift law at each stop; {}",
            subtitle(log, report)
        ),
        time_s: prepared.positions.time_s.clone(),
        channels: (0..3)
            .map(|axis| ResidualChannel {
                name: AXES[axis].to_owned(),
                before: before[axis].clone(),
                after: found.then(|| after[axis].clone()),
                sigma: prepared.positions.rms_sigma_deg_per_h(axis),
            })
            .collect(),
        before_label: "nominal law".to_owned(),
        after_label: "extended law".to_owned(),
        quantity: "residual".to_owned(),
        unit: "deg/h".to_owned(),
    })
}
