//! Exact equivalents: D_I, latitude and Earth rate.

use gyrocal::EARTH_RATE_RAD_PER_S;
use gyrocal_calibration::{Calibration, Options, SiteQuantity, calibrate};
use gyrocal_truth::{Coefficients, Hidden, Scenario, Simulation, simulate};

use super::ways::{PAPER_DAYS, SHOWN_SEED, scenario};
use crate::harness::{Error, Figure};
use crate::values::{Values, fixed, table, two_digits};

/// Decrease of the three D_I, deg/h/g.
const LOWERED: f64 = 0.1;
/// Largest difference of equivalent records, g: a thousandth of the noise of a sample.
const SAME_G: f64 = 1e-8;
/// An arc second.
const ERROR_DEG: f64 = 1.0 / 3600.0;
/// Largest difference between predicted and found bias, % of the bias in the norm of sigmas.
const BIAS_PERCENT: f64 = 2.0;

pub(super) fn measure(values: &mut Values) -> Result<[Figure; 2], Error> {
    let figures = [exact(values)?, arc_second(values)?];
    Ok(figures.map(|figure| figure.over(1, SHOWN_SEED.to_string())))
}

/// An upper limit by order of magnitude.
fn power_of_ten_above(value: f64) -> String {
    match 10_f64.powf(value.log10().ceil()) {
        small if small < 1e-3 => format!("{small:.0e}"),
        bound => bound.to_string(),
    }
}

/// Two simulations that must agree: D_I lowered, and Earth rate in local north and up moved by as much.
fn exact(values: &mut Values) -> Result<Figure, Error> {
    let one = scenario(SHOWN_SEED, PAPER_DAYS);
    let (sine, cosine) = one.latitude_deg.to_radians().sin_cos();
    let up = sine - (LOWERED / 3600.0).to_radians() / EARTH_RATE_RAD_PER_S;
    let shift_deg = up.atan2(cosine).to_degrees() - one.latitude_deg;
    let rate_change = up.hypot(cosine) - 1.0;
    let other = Scenario {
        coefficients: Coefficients {
            g_deg_per_h_per_g: one.coefficients.g_deg_per_h_per_g.map(|d| d - LOWERED),
            ..one.coefficients
        },
        hidden: vec![
            Hidden::new("site.latitude", &[("size", shift_deg)])?,
            Hidden::new("site.earth_rate", &[("size", rate_change)])?,
        ],
        ..one.clone()
    };
    let (a, b) = (simulate(&one)?.record, simulate(&other)?.record);
    let (a, b) = (a.accel_g.as_flattened(), b.accel_g.as_flattened());
    let apart = a.iter().zip(b).map(|(a, b)| (a - b).abs());
    let largest_g = apart.fold(0.0, f64::max);
    values.put("lowered", fixed(LOWERED, 1));
    values.put("shift", fixed(shift_deg, 3));
    values.put("rate_change", fixed(100.0 * rate_change, 3));
    values.put("same_g", power_of_ten_above(largest_g));
    let name = "D_I lowered, latitude and Earth rate moved: largest difference of samples (g)";
    Ok(Figure::at_most_small(name, SAME_G, largest_g))
}

/// Change of each coefficient by an error of latitude of one arc second: as predicted by the estimator,
/// and as simulated with the bench at another latitude.
fn arc_second(values: &mut Values) -> Result<Figure, Error> {
    let right = scenario(SHOWN_SEED, PAPER_DAYS);
    let wrong = Scenario {
        hidden: vec![Hidden::new("site.latitude", &[("size", ERROR_DEG)])?],
        ..right.clone()
    };
    let (before, after) = (batch(&right)?, batch(&wrong)?);
    let mut influences = before.site_sensitivities.iter();
    let latitude = influences.find(|one| one.quantity == SiteQuantity::Latitude);
    let latitude = latitude.ok_or("the batch estimator says nothing of latitude")?;
    let sigma: [f64; 9] = core::array::from_fn(|i| before.covariance[i][i].sqrt());
    let predicted = latitude.bias_per_unit.map(|bias| bias * ERROR_DEG);
    let (from, to) = (before.drift.to_array(), after.drift.to_array());
    let shifts: [f64; 9] = core::array::from_fn(|i| to[i] - from[i]);
    let norm = |of: &dyn Fn(usize) -> f64| (0..9).map(|i| (of(i) / sigma[i]).powi(2)).sum::<f64>();
    let missed = norm(&|i| shifts[i] - predicted[i]) / norm(&|i| shifts[i]);
    let missed_percent = 100.0 * missed.sqrt();
    let names = Coefficients::NONE.named().into_iter().enumerate();
    let rows = names.map(|(i, (name, _, _))| {
        vec![
            format!("`{name}`"),
            format!("{:.2e}", sigma[i]),
            format!("{:.2e}", predicted[i]),
            format!("{:.2e}", shifts[i]),
            fixed(shifts[i] / sigma[i], 2),
        ]
    });
    let header = "coefficient|sigma|shift, predicted|shift, simulated|in sigmas";
    let header: Vec<&str> = header.split('|').collect();
    let mean_shift = (shifts[1] + shifts[4] + shifts[7]) / 3.0;
    // The symmetry with Earth rate free: δφ = -k cos φ / Ω.
    let alone = EARTH_RATE_RAD_PER_S.to_degrees() * 3600.0 * ERROR_DEG.to_radians()
        / right.latitude_deg.to_radians().cos();
    let latitude_sigma = two_digits(latitude.from_record_sigma * 3600.0);
    values.put("table_arc_second", table(&header, rows));
    values.put("mean_shift", format!("{:.1e}", mean_shift.abs()));
    values.put("largest_shift", format!("{alone:.1e}"));
    values.put("latitude_sigma", latitude_sigma);
    values.put("missed_percent", power_of_ten_above(missed_percent));
    let name = "latitude wrong by an arc second: predicted bias against simulated (%)";
    Ok(Figure::within(name, [0.0, BIAS_PERCENT], missed_percent))
}

fn batch(scenario: &Scenario) -> Result<Calibration, Error> {
    let Simulation { record, bench, .. } = simulate(scenario)?;
    Ok(calibrate(&record, &bench, &Options::default(), |_| ())?)
}
