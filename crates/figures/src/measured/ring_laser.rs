//! The analytic platform of the ring-laser unit.

use std::time::Instant;

use gyrocal_answer::Verdict;
use gyrocal_calibration::{Calibration, GyroAxes, Options, Run, calibrate, calibrate_strapdown};
use gyrocal_diagnosis::{DiagnoseOptions, Diagnosis, diagnose};
use gyrocal_instruments::strapdown::{ImportReport, ImportSettings, Imported, import};
use gyrocal_instruments::{Description, Log};

use super::{Measured, data};
use crate::harness::Error;

/// Compared averaging intervals and thresholds of quiet rows.
const AVERAGING_S: [f64; 3] = [15.0, 30.0, 60.0];
const QUIET_FACTORS: [f64; 3] = [1.5, 2.0, 3.0];

pub(super) fn measure(measured: &mut Measured) -> Result<(), Error> {
    let begin = Instant::now();
    let description = Description::read(&data("ring_laser_static/log.toml"))?;
    let log = Log::read(&data("ring_laser_static/imu.csv"), &description)?;
    let imported = import(&log, &description, &ImportSettings::default())?;
    let (record, bench, report) = (&imported.record, &imported.bench, &imported.report);
    let axes = [GyroAxes::new(&imported.platform_q_body)];
    let options = Options::default();
    let in_body = calibrate_strapdown(&[Run { record, bench }], &axes, &options, |_| ())?;
    let diagnosis = diagnosed(&imported)?;
    let seconds = begin.elapsed().as_secs_f64();
    windows(measured, report);
    rates(measured, report);
    combinations(measured, report, &in_body);
    // Apparent coefficients by the drift law of a platform with gyros of its own.
    let in_platform = calibrate(record, bench, &options, |_| ())?;
    let [_, sigma, before] = along(report, &in_platform, 0);
    measured.put([("platform_east", format!("{:.0}", 100.0 * sigma / before))]);
    let causes = diagnosis.result.causes().count() as f64;
    let name = "ring laser: physical causes that its diagnosis names";
    measured.judge(name, causes);
    measured.judge("import, calibrate and diagnose: run time, s", seconds);
    choices(measured, &log, &description)
}

fn diagnosed(imported: &Imported) -> Result<Diagnosis<'_>, Error> {
    let options = DiagnoseOptions::default();
    Ok(diagnose(&imported.record, &imported.bench, &options)?)
}

fn windows(measured: &mut Measured, report: &ImportReport) {
    let disturbed: f64 = report.disturbed_s.iter().map(|[from, to]| to - from).sum();
    measured.put([
        ("duration", format!("{:.0}", report.duration_s)),
        ("rows", report.rows.to_string()),
        ("windows", report.disturbed_s.len().to_string()),
        ("disturbed", format!("{disturbed:.0}")),
        ("norm", format!("{:.6}", report.norm_g)),
        ("gyro_noise", format!("{:.3}", report.gyro_noise_deg_per_h)),
    ]);
    let share = disturbed / report.duration_s;
    measured.judge("ring laser: disturbed share of the time", share);
    let name = "ring laser: mean norm of specific force, of the log's unit";
    measured.judge(name, report.norm_g);
}

fn rates(measured: &mut Measured, report: &ImportReport) {
    let line = |name: &str, [rate, sigma]: [f64; 2], earth: f64| {
        let more = rate - earth;
        format!("| {name} | {rate:.4} | {sigma:.4} | {earth:.4} | {more:.4} |")
    };
    let [horizontal, vertical] = [
        report.horizontal_rate_deg_per_h,
        report.vertical_rate_deg_per_h,
    ];
    let across = report.expected_horizontal_rate_deg_per_h;
    let along = report.expected_vertical_rate_deg_per_h;
    let lines = [
        line("horizontal", horizontal, across),
        line("vertical", vertical, along),
    ];
    measured.put([("lines_rates", lines.join("\n"))]);
    let more = horizontal[0] - across;
    measured.judge("ring laser: horizontal rate less Earth's, deg/h", more);
    let sigmas = (vertical[0] - along) / vertical[1];
    measured.judge(
        "ring laser: vertical rate less Earth's, over its sigma",
        sigmas,
    );
}

/// The errors along north, up and east at the first row, from a calibration in the axes of the gyros.
fn combinations(measured: &mut Measured, report: &ImportReport, calibration: &Calibration) {
    let directions = [
        ("north", "is determined", 1),
        ("up", "is determined", 2),
        ("east", "is not determined", 0),
    ];
    let lines = directions.map(|(name, what, direction)| {
        let [estimate, sigma, before] = along(report, calibration, direction);
        let title = format!("ring laser: {name} {what}, sigma after over before");
        measured.judge(&title, sigma / before);
        format!("| {name} | {estimate:.4} | {sigma:.4} | {before:.2} |")
    });
    let undetermined = calibration.unobservable.len();
    measured.put([
        ("lines_combinations", lines.join("\n")),
        ("undetermined", undetermined.to_string()),
    ]);
    let name = "ring laser: combinations of nine coefficients that are not determined";
    measured.judge(name, undetermined as f64);
}

/// Estimate of the error along east, north or up at the first row, its sigma, and its prior sigma.
fn along(report: &ImportReport, calibration: &Calibration, direction: usize) -> [f64; 3] {
    // What a coefficient of a gyro adds along a direction, at body specific force.
    let weights: [f64; 9] = core::array::from_fn(|i| {
        let axis = &report.body_c_enu[i / 3];
        axis[direction] * axis[2].powi((i % 3) as i32)
    });
    let dot = |values: &[f64; 9]| (0..9).map(|i| weights[i] * values[i]).sum::<f64>();
    let prior = calibration.prior_sigma.to_array();
    let before = (0..9).map(|i| (weights[i] * prior[i]).powi(2)).sum::<f64>();
    [
        dot(&calibration.drift.to_array()),
        dot(&calibration.covariance.map(|row| dot(&row))).sqrt(),
        before.sqrt(),
    ]
}

fn verdict(diagnosis: &Diagnosis<'_>) -> String {
    let findings = diagnosis.result.findings.iter();
    let names = findings.map(|found| format!("`{}`", found.effect));
    match diagnosis.result.verdict {
        Verdict::EffectsFound => names.collect::<Vec<_>>().join(", "),
        Verdict::Unexplained => "correlated rows, unexplained".to_owned(),
        _ => "nothing".to_owned(),
    }
}

/// Dependence on the settings of the import.
fn choices(measured: &mut Measured, log: &Log, description: &Description) -> Result<(), Error> {
    let (mut lines, mut named) = (Vec::new(), 0);
    let (mut least, mut largest) = (f64::INFINITY, f64::NEG_INFINITY);
    for averaging_s in AVERAGING_S {
        for quiet_factor in QUIET_FACTORS {
            let settings = ImportSettings {
                averaging_s,
                quiet_factor,
                ..ImportSettings::default()
            };
            let imported = import(log, description, &settings)?;
            let diagnosis = diagnosed(&imported)?;
            let report = &imported.report;
            let missing = |row: &&[f64; 3]| !row[0].is_nan();
            let quiet = imported.record.accel_g.iter().filter(missing).count();
            let more =
                report.horizontal_rate_deg_per_h[0] - report.expected_horizontal_rate_deg_per_h;
            (least, largest) = (least.min(more), largest.max(more));
            named += diagnosis.result.causes().count();
            let (noise, correlation) = (report.accel_noise_g, report.accel_noise_correlation);
            let found = verdict(&diagnosis);
            lines.push(format!(
                "| {averaging_s:.0} | {quiet_factor:.1} | {quiet} | {noise:.1e} | {correlation:.2} | {more:.4} | {found} |"
            ));
        }
    }
    let runs = lines.len();
    measured.put([("lines_choices", lines.join("\n"))]);
    let name = "ring laser: spread of the horizontal difference over choices, deg/h";
    measured.judge(name, largest - least).runs = runs;
    let name = "ring laser: physical causes named over choices";
    measured.judge(name, named as f64).runs = runs;
    Ok(())
}
