//! First-order integration: its error without noise, and the number of sub-steps that it needs.

use gyrocal::{Discretisation, Integration};
use gyrocal_calibration::Options;
use gyrocal_statistics::{median, root_mean_square};

use super::bench::{Data, Judged, PAPER_DAYS, SHOWN_SEED, judge_all, scenario};
use super::{Error, Measured};
use crate::values::{Table, fixed, two_digits};

pub(super) fn measure(measured: &mut Measured) -> Result<(), Error> {
    without_noise(measured)?;
    sub_steps(measured)
}

/// Difference of both rules from one attitude, without noise.
fn without_noise(measured: &mut Measured) -> Result<(), Error> {
    let mut quiet = scenario(SHOWN_SEED, PAPER_DAYS);
    quiet.accel_noise_g = 0.0;
    quiet.gyro_noise_deg_per_h = 0.0;
    quiet.initial_angles_sigma_deg = [0.0; 3];
    let exact = Data::Exact.simulate(&quiet)?.record;
    let rule = Data::PaperRule.simulate(&quiet)?.record;
    let apart_g: Vec<f64> = exact
        .accel_g
        .iter()
        .zip(&rule.accel_g)
        .map(|(a, b)| (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt())
        .collect();
    let noise_g = scenario(SHOWN_SEED, PAPER_DAYS).accel_noise_g;
    let mut table = Table::new([
        "after",
        "largest difference so far (g)",
        "in sigmas of a sample",
    ]);
    for (name, rows) in [
        ("one step", 1),
        ("one hour", 60),
        ("one day", 1440),
        ("three days", 4320),
    ] {
        let largest = apart_g[..=rows]
            .iter()
            .fold(0.0_f64, |most, d| most.max(*d));
        table.row([
            name.to_owned(),
            format!("{largest:.1e}"),
            two_digits(largest / noise_g),
        ]);
    }
    measured.values.put("table_rule", table.text());
    // The Earth turns by this in one step, and half its square is left out.
    let turn_rad = gyrocal::EARTH_RATE_RAD_PER_S * quiet.interval_s;
    measured
        .values
        .put("turn_deg", fixed(turn_rad.to_degrees(), 2));
    measured
        .values
        .put("left_out", format!("{:.1e}", 0.5 * turn_rad * turn_rad));
    Ok(())
}

/// The default filter with first-order steps instead of RK4.
fn sub_steps(measured: &mut Measured) -> Result<(), Error> {
    let mut table = Table::new([
        "integration of a sample's interval",
        "mean NIS, median",
        "errors in sigmas, RMS of all nine",
    ]);
    let rules = [1, 4, 16, 64].map(|substeps| {
        let name = format!("first order, {substeps} sub-steps");
        (
            name.replace(" 1 sub-steps", " one step"),
            Integration::Euler { substeps },
        )
    });
    for (name, integration) in rules
        .into_iter()
        .chain([("RK4, one step".to_owned(), Integration::RK4)])
    {
        let options = Options {
            discretisation: Discretisation {
                integration,
                ..Discretisation::default()
            },
            ..Options::streaming()
        };
        let runs = judge_all(Data::Exact, PAPER_DAYS, &options)?;
        let nis: Vec<f64> = runs.iter().map(|run| run.nis_mean).collect();
        let sigmas: Vec<f64> = runs.iter().flat_map(Judged::in_sigmas).collect();
        table.row([
            name,
            fixed(median(&nis), 2),
            fixed(root_mean_square(&sigmas), 2),
        ]);
    }
    measured.values.put("table_sub_steps", table.text());
    Ok(())
}
