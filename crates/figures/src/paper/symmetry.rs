//! Exact equivalents: D_I, latitude and Earth rate.

use gyrocal::EARTH_RATE_RAD_PER_S;
use gyrocal_calibration::{Calibration, Options, SiteQuantity, calibrate};
use gyrocal_truth::{Coefficients, Hidden, Scenario, simulate};

use super::bench::{PAPER_DAYS, SHOWN_SEED, names, scenario};
use super::{Error, Measured};
use crate::figure::Figure;
use crate::values::{Table, fixed, two_digits};

/// Decrease of the three D_I, deg/h/g.
const LOWERED: f64 = 0.1;
/// Largest difference of equivalent records, g: a thousandth of the noise of a sample.
const SAME_G: f64 = 1e-8;
/// An arc second.
const ERROR_DEG: f64 = 1.0 / 3600.0;
/// Largest difference between predicted and found bias, % of the bias in the norm of sigmas.
const BIAS_PERCENT: f64 = 2.0;

pub(super) fn measure(measured: &mut Measured) -> Result<(), Error> {
    exact(measured)?;
    arc_second(measured)
}

/// Earth rate in local north and up after D_I has been lowered: latitude in degrees, and its
/// size against the true one.
fn moved_earth_rate(latitude_deg: f64, lowered: f64) -> (f64, f64) {
    let (sine, cosine) = latitude_deg.to_radians().sin_cos();
    let up = sine - (lowered / 3600.0).to_radians() / EARTH_RATE_RAD_PER_S;
    (up.atan2(cosine).to_degrees(), up.hypot(cosine))
}

/// An upper limit by order of magnitude.
fn power_of_ten_above(value: f64) -> String {
    let bound = 10_f64.powf(value.log10().ceil());
    if bound < 1e-3 {
        format!("{bound:.0e}")
    } else {
        bound.to_string()
    }
}

/// Two simulations that must agree.
fn exact(measured: &mut Measured) -> Result<(), Error> {
    let one = scenario(SHOWN_SEED, PAPER_DAYS);
    let (latitude_deg, rate) = moved_earth_rate(one.latitude_deg, LOWERED);
    let shift_deg = latitude_deg - one.latitude_deg;
    let other = Scenario {
        coefficients: Coefficients {
            g_deg_per_h_per_g: one.coefficients.g_deg_per_h_per_g.map(|d| d - LOWERED),
            ..one.coefficients
        },
        hidden: vec![
            Hidden::new("site.latitude", &[("size", shift_deg)])?,
            Hidden::new("site.earth_rate", &[("size", rate - 1.0)])?,
        ],
        ..one.clone()
    };
    let (a, b) = (simulate(&one)?.record, simulate(&other)?.record);
    let pairs = a
        .accel_g
        .as_flattened()
        .iter()
        .zip(b.accel_g.as_flattened());
    let largest_g = pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
    let values = &mut measured.values;
    values.put("lowered", fixed(LOWERED, 1));
    values.put("shift", fixed(shift_deg, 3));
    values.put("rate_change", fixed(100.0 * (rate - 1.0), 3));
    values.put("same_g", power_of_ten_above(largest_g));
    let name = "D_I lowered, latitude and Earth rate moved: largest difference of samples (g)";
    let mut figure = Figure::within(name, [0.0, SAME_G], largest_g);
    figure.target = format!("<= {SAME_G:e}");
    figure.measured = format!("{largest_g:.1e}");
    let seed = SHOWN_SEED.to_string();
    measured.figures.push(figure.over(1, seed));
    Ok(())
}

/// Change of each coefficient by an error of latitude of one arc second: as predicted by the estimator,
/// and as simulated with the bench at another latitude.
fn arc_second(measured: &mut Measured) -> Result<(), Error> {
    let right = scenario(SHOWN_SEED, PAPER_DAYS);
    let wrong = Scenario {
        hidden: vec![Hidden::new("site.latitude", &[("size", ERROR_DEG)])?],
        ..right.clone()
    };
    let (before, after) = (batch(&right)?, batch(&wrong)?);
    let latitude = before
        .site_sensitivities
        .iter()
        .find(|influence| influence.quantity == SiteQuantity::Latitude)
        .ok_or("the batch estimator says nothing of latitude")?;
    let mut table = Table::new([
        "coefficient",
        "sigma",
        "shift, predicted",
        "shift, simulated",
        "in sigmas",
    ]);
    let (mut shifts, mut missed, mut found) = ([0.0; 9], 0.0, 0.0);
    for (i, name) in names().into_iter().enumerate() {
        let sigma = before.covariance[i][i].sqrt();
        let predicted = latitude.bias_per_unit[i] * ERROR_DEG;
        shifts[i] = after.drift.to_array()[i] - before.drift.to_array()[i];
        found += (shifts[i] / sigma).powi(2);
        missed += ((shifts[i] - predicted) / sigma).powi(2);
        table.row([
            format!("`{name}`"),
            format!("{sigma:.2e}"),
            format!("{predicted:.2e}"),
            format!("{:.2e}", shifts[i]),
            fixed(shifts[i] / sigma, 2),
        ]);
    }
    let missed_percent = 100.0 * (missed / found).sqrt();
    let mean_shift = (shifts[1] + shifts[4] + shifts[7]) / 3.0;
    // The symmetry with Earth rate free: δφ = -k cos φ / Ω.
    let alone = EARTH_RATE_RAD_PER_S.to_degrees() * 3600.0 * ERROR_DEG.to_radians()
        / right.latitude_deg.to_radians().cos();
    let values = &mut measured.values;
    values.put("table_arc_second", table.text());
    values.put("mean_shift", format!("{:.1e}", mean_shift.abs()));
    values.put("largest_shift", format!("{alone:.1e}"));
    values.put(
        "latitude_sigma",
        two_digits(latitude.from_record_sigma * 3600.0),
    );
    values.put("missed_percent", power_of_ten_above(missed_percent));
    let name = "latitude wrong by an arc second: predicted bias against simulated (%)";
    let figure = Figure::within(name, [0.0, BIAS_PERCENT], missed_percent);
    measured
        .figures
        .push(figure.over(1, SHOWN_SEED.to_string()));
    Ok(())
}

fn batch(scenario: &Scenario) -> Result<Calibration, Error> {
    let simulation = simulate(scenario)?;
    let options = Options::default();
    Ok(calibrate(
        &simulation.record,
        &simulation.bench,
        &options,
        |_| (),
    )?)
}
