//! The analytic platform of the ring-laser unit.

use std::time::Instant;

use gyrocal_calibration::{Calibration, GyroAxes, Options, Run, calibrate, calibrate_strapdown};
use gyrocal_diagnosis::{DiagnoseOptions, Diagnosis, Verdict, diagnose};
use gyrocal_instruments::strapdown::{ImportReport, ImportSettings, Imported, import};
use gyrocal_instruments::{Description, Log};

use super::{Measured, data, run_time};
use crate::error::Error;
use crate::figure::Figure;
use crate::values::{Table, fixed};

/// Compared averaging intervals and thresholds of quiet rows.
const AVERAGING_S: [f64; 3] = [15.0, 30.0, 60.0];
const QUIET_FACTORS: [f64; 3] = [1.5, 2.0, 3.0];

pub(super) fn measure(measured: &mut Measured) -> Result<(), Error> {
    let begin = Instant::now();
    let description = Description::read(&data("ring_laser_static/log.toml"))?;
    let log = Log::read(&data("ring_laser_static/imu.csv"), &description)?;
    let imported = import(&log, &description, &ImportSettings::default())?;
    let calibration = calibrated(&imported)?;
    let diagnosis = diagnosed(&imported)?;
    let seconds = begin.elapsed().as_secs_f64();
    windows(measured, &imported.report);
    rates(measured, &imported.report);
    combinations(measured, &imported.report, &calibration);
    let options = Options::default();
    let in_platform_axes = calibrate(&imported.record, &imported.bench, &options, |_| ())?;
    platform_axes(measured, &imported.report, &in_platform_axes);
    judged(measured, &diagnosis);
    let run = run_time("import, calibrate and diagnose", seconds);
    measured.figures.push(run);
    choices(measured, &log, &description)
}

fn calibrated(imported: &Imported) -> Result<Calibration, Error> {
    let run = Run {
        record: &imported.record,
        bench: &imported.bench,
    };
    let axes = [GyroAxes::new(&imported.platform_q_body)];
    let calibration = calibrate_strapdown(&[run], &axes, &Options::default(), |_| ())?;
    Ok(calibration)
}

fn diagnosed(imported: &Imported) -> Result<Diagnosis<'_>, Error> {
    let options = DiagnoseOptions::default();
    Ok(diagnose(&imported.record, &imported.bench, &options)?)
}

fn windows(measured: &mut Measured, report: &ImportReport) {
    let disturbed: f64 = report.disturbed_s.iter().map(|[from, to]| to - from).sum();
    let values = &mut measured.values;
    values.put("duration", fixed(report.duration_s, 0));
    values.put("rows", report.rows.to_string());
    values.put("windows", report.disturbed_s.len().to_string());
    values.put("disturbed", fixed(disturbed, 0));
    values.put("norm", fixed(report.norm_g, 6));
    values.put("gyro_noise", fixed(report.gyro_noise_deg_per_h, 3));
    measured.figures.extend([
        // It rocks at times, by its source; a record that is rocked most of the time is none.
        Figure::within(
            "ring laser: disturbed share of the time",
            [0.05, 0.5],
            disturbed / report.duration_s,
        ),
        // Gravity and the unit of its accelerometers differ by a part in a thousand at this
        // latitude and height.
        Figure::within(
            "ring laser: mean norm of specific force, of the log's unit",
            [0.995, 1.005],
            report.norm_g,
        ),
    ]);
}

fn rates(measured: &mut Measured, report: &ImportReport) {
    let mut table = Table::new([
        "rate of gravity in the platform, deg/h",
        "measured",
        "sigma",
        "Earth",
        "difference",
    ]);
    let lines = [
        (
            "horizontal",
            report.horizontal_rate_deg_per_h,
            report.expected_horizontal_rate_deg_per_h,
        ),
        (
            "vertical",
            report.vertical_rate_deg_per_h,
            report.expected_vertical_rate_deg_per_h,
        ),
    ];
    for (name, [rate, sigma], expected) in lines {
        table.row([
            name.to_owned(),
            fixed(rate, 4),
            fixed(sigma, 4),
            fixed(expected, 4),
            fixed(rate - expected, 4),
        ]);
    }
    measured.values.put("table_rates", table.text());
    let [
        (_, [horizontal, _], horizontal_earth),
        (_, [vertical, vertical_sigma], vertical_earth),
    ] = lines;
    measured.figures.extend([
        // Gyros of this grade err by hundredths of a degree an hour.
        Figure {
            measured: format!("{:.4}", horizontal - horizontal_earth),
            ..Figure::within(
                "ring laser: horizontal rate less Earth's, deg/h",
                [-0.03, 0.03],
                horizontal - horizontal_earth,
            )
        },
        Figure::within(
            "ring laser: vertical rate less Earth's, over its sigma",
            [-3.0, 3.0],
            (vertical - vertical_earth) / vertical_sigma,
        ),
    ]);
}

/// The errors along north, up and east at the first row, from a calibration in the axes of the gyros.
fn combinations(measured: &mut Measured, report: &ImportReport, calibration: &Calibration) {
    let mut table = Table::new([
        "error of the gyros toward",
        "estimate, deg/h",
        "sigma",
        "prior sigma",
    ]);
    for (name, direction) in [("north", 1), ("up", 2), ("east", 0)] {
        let [estimate, sigma, before] = along(report, calibration, direction);
        table.row([
            name.to_owned(),
            fixed(estimate, 4),
            fixed(sigma, 4),
            fixed(before, 2),
        ]);
        let (what, bounds) = match direction {
            // Determined: below the tenth of the prior's that counts as determined.
            1 | 2 => ("determined", [0.0, 0.1]),
            // A heading is not known from elsewhere, and no record of one attitude tells it.
            _ => ("not determined", [0.1, 1.0]),
        };
        measured.figures.push(Figure::within(
            &format!("ring laser: {name} is {what}, sigma after over before"),
            bounds,
            sigma / before,
        ));
    }
    let undetermined = calibration.unobservable.len();
    measured.values.put("table_combinations", table.text());
    measured
        .values
        .put("undetermined", undetermined.to_string());
    measured.figures.push(Figure::within(
        "ring laser: combinations of nine coefficients that are not determined",
        // All but north and up, whatever the length.
        [7.0, 7.0],
        undetermined as f64,
    ));
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

/// Apparent coefficients by the drift law of a platform with gyros of its own.
fn platform_axes(measured: &mut Measured, report: &ImportReport, calibration: &Calibration) {
    let [_, sigma, before] = along(report, calibration, 0);
    let values = &mut measured.values;
    values.put("platform_east", fixed(100.0 * sigma / before, 0));
}

fn judged(measured: &mut Measured, diagnosis: &Diagnosis<'_>) {
    measured.figures.extend([
        // Half an hour in one attitude cannot tell one drift term from another: to name one
        // would be an invention.
        Figure::within(
            "ring laser: physical causes that its diagnosis names",
            [0.0, 0.0],
            diagnosis.result.causes().count() as f64,
        ),
        Figure::note("ring laser: verdict of its diagnosis", verdict(diagnosis)),
    ]);
}

fn verdict(diagnosis: &Diagnosis<'_>) -> String {
    let findings = diagnosis.result.findings.iter();
    let names: Vec<String> = findings
        .map(|found| format!("`{}`", found.effect))
        .collect();
    match diagnosis.result.verdict {
        Verdict::EffectsFound => names.join(", "),
        Verdict::Unexplained => "correlated rows, unexplained".to_owned(),
        _ => "nothing".to_owned(),
    }
}

/// Dependence on the settings of the import.
fn choices(measured: &mut Measured, log: &Log, description: &Description) -> Result<(), Error> {
    let mut table = Table::new([
        "rows of, s",
        "quiet factor",
        "quiet rows",
        "noise of a row, g",
        "correlation of rows",
        "horizontal less Earth's, deg/h",
        "findings",
    ]);
    let mut differences = Vec::new();
    let mut named = 0;
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
            let difference =
                report.horizontal_rate_deg_per_h[0] - report.expected_horizontal_rate_deg_per_h;
            differences.push(difference);
            named += diagnosis.result.causes().count();
            table.row([
                fixed(averaging_s, 0),
                fixed(quiet_factor, 1),
                quiet.to_string(),
                format!("{:.1e}", report.accel_noise_g),
                fixed(report.accel_noise_correlation, 2),
                fixed(difference, 4),
                verdict(&diagnosis),
            ]);
        }
    }
    measured.values.put("table_choices", table.text());
    let least = differences.iter().copied().fold(f64::INFINITY, f64::min);
    let largest = differences
        .iter()
        .copied()
        .fold(f64::NEG_INFINITY, f64::max);
    measured.figures.extend([
        Figure {
            measured: format!("{:.4}", largest - least),
            ..Figure::within(
                "ring laser: spread of the horizontal difference over choices, deg/h",
                // The sigma of the default choice is 0.0025.
                [0.0, 0.005],
                largest - least,
            )
        }
        .over(differences.len(), ""),
        Figure::within(
            "ring laser: physical causes named over choices",
            [0.0, 0.0],
            named as f64,
        )
        .over(differences.len(), ""),
    ]);
    Ok(())
}
