//! The multi-position test.

use std::time::Instant;

use gyrocal_instruments::multi_position::{
    Alternative, MultiPositionReport, MultiPositionSettings, multi_position_test, prepare,
};
use gyrocal_instruments::{Description, Log, StopSettings, find_stops};
use gyrocal_record::AXES;

use super::{Measured, data};
use crate::harness::Error;

pub(super) fn measure(measured: &mut Measured) -> Result<(), Error> {
    let begin = Instant::now();
    let description = Description::read(&data("xsens_38_positions/log.toml"))?;
    let log = Log::read(&data("xsens_38_positions/imu_counts.csv"), &description)?;
    let stops = find_stops(&log, &StopSettings::default())?;
    let prepared = prepare(&log, &description, &stops)?;
    let report = multi_position_test(&prepared.positions, &MultiPositionSettings::default())?;
    measured.judge("tumble: run time, s", begin.elapsed().as_secs_f64());
    laws(measured, &report);
    findings(measured, &report);
    gain(measured, &report)?;
    Ok(())
}

/// Chi-square of each law by the standard errors of the stops, and the noise between stops beside it.
fn laws(measured: &mut Measured, report: &MultiPositionReport) {
    let mut lines = Vec::new();
    let level = |[median, most]: [f64; 2]| format!("{median:.0} ({most:.0})");
    for gyro in &report.gyros {
        let of = &gyro.gyro;
        for (name, law) in [("nominal", &gyro.nominal), ("extended", &gyro.extended)] {
            let (freedom, chi_square) = (law.degrees_of_freedom, law.chi_square);
            let noise = &law.noise;
            let [scatter, flicker] = [noise.scatter_deg_per_h, noise.flicker_deg_per_h].map(level);
            let walk = level(noise.walk_deg_per_h);
            lines.push(format!(
                "| {of}, {name} law | {freedom} | {chi_square:.1} | {scatter} | {flicker} | {walk} |"
            ));
        }
        let nominal = "chi-square of the nominal law over its expectation";
        let extended = "that of the extended law";
        for (what, law) in [(nominal, &gyro.nominal), (extended, &gyro.extended)] {
            let value = law.chi_square / law.degrees_of_freedom as f64;
            measured.judge(&format!("xsens {of}: {what}"), value);
        }
    }
    measured.put([
        ("stops", report.stops.to_string()),
        ("lines_laws", lines.join("\n")),
    ]);
    measured.judge("xsens: static stops found", report.stops as f64);
}

fn findings(measured: &mut Measured, report: &MultiPositionReport) {
    let written = |other: &Alternative| {
        let nats = other.log_likelihood_deficit;
        format!("`{}` ({nats:.1} nats)", other.effect)
    };
    let lines = report.findings.iter().map(|found| {
        let (effect, size, sigma) = (&found.effect, found.estimate, found.sigma);
        let p = found.p_value;
        let others: Vec<String> = found.alternatives.iter().map(written).collect();
        let others = match others.is_empty() {
            true => "none".to_owned(),
            false => others.join(", "),
        };
        let nearest = found.nearest_ruled_out.as_ref();
        let nearest = nearest.map_or(String::new(), written);
        format!("| `{effect}` | {size:.0} ± {sigma:.0} | {p:.0e} | {others} | {nearest} |")
    });
    let lines: Vec<String> = lines.collect();
    let all = || report.findings.iter();
    let angles = all().filter_map(|found| found.misalignment_needed_rad);
    let cross = angles.clone().count();
    let smallest = angles.fold(f64::INFINITY, f64::min);
    measured.put([
        ("lines_findings", lines.join("\n")),
        ("smallest_misalignment", format!("{smallest:.1}")),
    ]);
    let rivals: usize = all().map(|found| found.alternatives.len()).sum();
    let nearest = all().flat_map(|found| &found.nearest_ruled_out);
    let nearest = nearest.map(|other| other.log_likelihood_deficit);
    let largest = all().map(|found| found.p_value).fold(0.0, f64::max);
    let nearest = nearest.fold(f64::INFINITY, f64::min);
    let others = report.findings.len() - cross;
    measured.judge("xsens: linear cross-axis terms found", cross as f64);
    measured.judge("xsens: other terms found", others as f64);
    measured.judge(
        "xsens: largest p of a finding, corrected for the search",
        largest,
    );
    measured.judge(
        "xsens: rivals that cannot be ruled out, all findings",
        rivals as f64,
    );
    measured.judge(
        "xsens: nearest term that is ruled out, nats of log likelihood",
        nearest,
    );
}

fn gain(measured: &mut Measured, report: &MultiPositionReport) -> Result<(), Error> {
    let gain = report.cross_validation.as_ref();
    let gain = gain.ok_or("no gain of the extended law")?;
    let (nats, sigma) = (
        gain.cross_validated_log_score_nats,
        gain.standard_error_nats,
    );
    let lines = [
        ("nominal law", gain.rms_before_deg_per_h),
        ("extended law", gain.rms_after_deg_per_h),
        ("standard errors of the stops", gain.noise_deg_per_h),
    ];
    let lines = lines.map(|(name, [x, y, z])| format!("| {name} | {x:.0} | {y:.0} | {z:.0} |"));
    let again = gain.found_in_blocks.iter().map(|(_, blocks)| *blocks);
    let least = again.min().unwrap_or(0);
    measured.put([
        ("lines_gain", lines.join("\n")),
        ("gain_nats", format!("{nats:.1}")),
        ("gain_sigma", format!("{sigma:.1}")),
        ("gain_blocks", gain.blocks.to_string()),
        ("gain_left_out", gain.left_out.to_string()),
        ("least_found_again", least.to_string()),
    ]);
    let name = "xsens: gain at unused stops, nats, over its standard error";
    measured.judge(name, nats / sigma);
    let name = "xsens: blocks without which each cause is found again, at least";
    measured.judge(name, least as f64);
    let both = gain
        .rms_after_deg_per_h
        .iter()
        .zip(gain.rms_before_deg_per_h);
    for ((after, before), axis) in both.zip(AXES) {
        let what = "error at unused stops, extended over nominal law";
        measured.judge(&format!("xsens gyro_{axis}: {what}"), after / before);
    }
    Ok(())
}
