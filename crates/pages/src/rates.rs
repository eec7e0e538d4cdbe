//! The page of gyro outputs in the rate domain.

mod screen;

use gyrocal_document::{EstimateRow, Estimates, Item, Part, Section, Table, Tint};
use gyrocal_instruments::rates::{GyroRates, RateReport};
use gyrocal_record::{Input, Manifest};
use gyrocal_statistics::{NORMAL_97_5, format};

use crate::bad_samples;
use crate::origin::{file_name, named, part};
use crate::words::section;

/// The page of gyro outputs in the rate domain. The last file of the manifest describes the logs before it;
/// `clocks` is what there is to tell of their clocks.
#[must_use]
pub fn of_rates(manifest: &Manifest, report: &RateReport, clocks: &[String]) -> Part {
    let inputs = &manifest.inputs;
    let logs = inputs.split_last().map_or(&[][..], |(_, logs)| logs);
    let mut sections = vec![means(logs, report, clocks)];
    sections.extend(report.gyros.iter().map(|gyro| of_gyro(gyro, logs.len())));
    let (name, first) = (file_name(manifest, 0, "log"), screen::first(logs, report));
    part(manifest, name, named(logs), first, sections)
}

fn means(logs: &[Input], report: &RateReport, clocks: &[String]) -> Section {
    let rows = logs.iter().zip(&report.logs).flat_map(|(file, log)| {
        let row = |of: String, rate: f64, half_width: f64| {
            [
                file.path.clone(),
                of,
                format!("{rate:.4}"),
                format!("± {half_width:.4}"),
            ]
        };
        let gyros = report.gyros.iter().enumerate().map(move |(gyro, law)| {
            let of = match report.earth_vertical_deg_per_h {
                Some(_) => format!("{}, less Earth rate", law.gyro),
                None => law.gyro.clone(),
            };
            let half_width = log.bias_half_width_deg_per_h[gyro];
            row(of, log.bias_deg_per_h[gyro], half_width)
        });
        let vertical = log.vertical_deg_per_h.map(|[rate, sigma]| {
            let of = "vertical, Earth rate and bias".to_owned();
            row(of, rate, NORMAL_97_5 * sigma)
        });
        gyros.chain(vertical)
    });
    let heads = "log | of | > mean of the log, deg/h | > 95 %";
    let mut items: Vec<Item> = clocks.iter().map(Item::text).collect();
    items.push(Table::of("", heads, rows).into());
    items.extend(bad_samples::table(&report.bad_samples, logs.len()));
    let earth = [
        report.earth_vertical_deg_per_h,
        report.earth_horizontal_deg_per_h,
    ];
    let lead = match earth {
        [Some(up), Some(north)] => format!(
            "The heading is unknown, and Earth rate is {up:.4} deg/h up and {north:.4} deg/h north."
        ),
        _ => format!(
            "Earth rate of up to 15.04 deg/h is in all rates: {}.",
            screen::not_known(report)
        ),
    };
    section("means", "Means", &lead, items)
}

fn of_gyro(gyro: &GyroRates, logs: usize) -> Section {
    let rows = gyro.coefficients.iter();
    let rows = rows.map(|one| EstimateRow::new(&one.name, &one.unit, [[one.estimate, one.sigma]]));
    let models = [("estimate", Tint::Extended)];
    let mut items = vec![Item::Estimates(Estimates::new("", &models, rows))];
    if !gyro.undetermined.is_empty() {
        let names = gyro.undetermined.join(", ");
        items.push(Item::text(format!("Not determined in addition: {names}.")));
    }
    for effect in &gyro.effects {
        let at = effect.place(logs);
        let alternatives = match &effect.alternatives[..] {
            [] => "no alternative".to_owned(),
            names => format!("alternatives: {}", names.join(", ")),
        };
        let p = format::p_value(effect.p_value);
        let found = format!("Found: {}{at} ({p}); {alternatives}.", effect.name);
        items.push(Item::text(found));
    }
    let noise = &gyro.noise;
    let between = match logs > 1 {
        true if gyro.assumes_equal_bias => ", bias taken as equal in all logs".to_owned(),
        true => format!(", bias from log to log {:.3e} deg/h", noise.between_logs),
        false => String::new(),
    };
    items.push(Item::text(format!(
        "Noise: random walk {:.3e} deg/h sqrt(s), bias instability {:.3e} deg/h, rate random walk {:.3e} \
         deg/h/sqrt(s){between}.",
        noise.random_walk, noise.bias_instability, noise.rate_random_walk
    )));
    let lead = "Coefficients, effects and noise.";
    section(&gyro.gyro, &gyro.gyro, lead, items)
}
