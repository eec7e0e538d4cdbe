//! Latitude: its exact equivalents, and the bias by an error of latitude.

use gyrocal_calibration::{Options, SiteQuantity, calibrate};
use gyrocal_truth::{
    Attitude, Coefficients, EARTH_RATE_RAD_PER_S, Hidden, Platform, Population, simulate,
};

use super::Error;
use crate::figure::Figure;

/// Largest difference of two equivalent simulations, g.
const SAME_G: f64 = 1e-8;

/// Largest relative difference between predicted and found bias, %.
const BIAS_PERCENT: f64 = 2.0;

/// Simulated error of latitude: a common deflection of the vertical.
const LATITUDE_ERROR_DEG: f64 = 10.0 / 3600.0;

/// Records in which latitude is wrong, and the seed of their population.
const RECORDS: u64 = 12;
const SEED: u64 = 20_150_905;

pub(crate) fn figures() -> Result<Vec<Figure>, Error> {
    Ok(vec![symmetry(), bias()?])
}

/// Lowers the three D_I by k and takes k of the vertical Earth rate.
fn symmetry() -> Figure {
    const DAYS: f64 = 5.0;
    let times_s: Vec<f64> = (0..=(DAYS * 1440.0) as u32)
        .map(|minute| 60.0 * f64::from(minute))
        .collect();
    let mut largest = 0.0_f64;
    let mut count = 0;
    for k_deg_per_h in [0.01_f64, -0.05, 0.2] {
        for latitude_deg in [-62.0_f64, 0.0, 39.1, 75.0] {
            for rotation_rad in [[0.0; 3], [0.7, -1.1, 2.0]] {
                let platform = Platform {
                    latitude_deg,
                    specific_force_at_rest_g: 1.0,
                    coefficients: Coefficients::PAPER_LIKE,
                    initial_platform_c_enu: Attitude::turned_by(rotation_rad),
                };
                let (sine, cosine) = latitude_deg.to_radians().sin_cos();
                let k = k_deg_per_h.to_radians() / 3600.0 / EARTH_RATE_RAD_PER_S;
                let rate = cosine.hypot(sine - k);
                // The simulator has one Earth rate. A faster one is the same in less time: all
                // rates over it, all times multiplied by it.
                let slower = |values: [f64; 3]| values.map(|value| value / rate);
                let of = platform.coefficients;
                let moved = Platform {
                    latitude_deg: (sine - k).atan2(cosine).to_degrees(),
                    coefficients: Coefficients {
                        bias_deg_per_h: slower(of.bias_deg_per_h),
                        g_deg_per_h_per_g: slower(of.g_deg_per_h_per_g.map(|d| d - k_deg_per_h)),
                        gg_deg_per_h_per_g2: slower(of.gg_deg_per_h_per_g2),
                    },
                    ..platform
                };
                let moved_times_s: Vec<f64> = times_s.iter().map(|time_s| time_s * rate).collect();
                let one = platform.specific_force_g(&times_s);
                let other = moved.specific_force_g(&moved_times_s);
                for (a, b) in one.as_flattened().iter().zip(other.as_flattened()) {
                    largest = largest.max((a - b).abs());
                }
                count += 1;
            }
        }
    }
    let mut figure = Figure::within(
        "D_I lowered, latitude and Earth rate moved: largest difference over five days, g",
        [0.0, SAME_G],
        largest,
    );
    figure.target = format!("<= {SAME_G:e} g");
    figure.measured = format!("{largest:.1e} g");
    figure.over(count, "3 shifts, 4 latitudes, 2 attitudes")
}

/// The bias that the batch estimator predicts for an error of latitude, against simulating one.
fn bias() -> Result<Figure, Error> {
    let population = Population {
        duration_days: [2.0, 5.0],
        ..Population::new(SEED)
    };
    let mut worst = 0.0_f64;
    for number in 0..RECORDS {
        let scenario = population.scenario(number);
        let mut shifted = scenario.clone();
        shifted.hidden = vec![Hidden::new(
            "site.latitude",
            &[("size", LATITUDE_ERROR_DEG)],
        )?];
        let [clean, wrong] = [&scenario, &shifted].map(|scenario| {
            let simulation = simulate(scenario)?;
            let options = Options::default();
            let found = calibrate(&simulation.record, &simulation.bench, &options, |_| ())?;
            Ok::<_, Error>(found)
        });
        let (clean, wrong) = (clean?, wrong?);
        let influence = clean
            .site_sensitivities
            .iter()
            .find(|influence| influence.quantity == SiteQuantity::Latitude)
            .ok_or("the influence of latitude is missing")?;
        let (before, after) = (clean.drift.to_array(), wrong.drift.to_array());
        // In sigmas, over all nine together: a coefficient that hardly moves has no ratio.
        let (mut found, mut missed) = (0.0, 0.0);
        for i in 0..9 {
            let variance = clean.covariance[i][i];
            let predicted = influence.bias_per_unit[i] * LATITUDE_ERROR_DEG;
            found += (after[i] - before[i]).powi(2) / variance;
            missed += (after[i] - before[i] - predicted).powi(2) / variance;
        }
        worst = worst.max(100.0 * (missed / found).sqrt());
    }
    Ok(Figure::within(
        "latitude wrong by 10″: predicted bias against a simulated one, worst record, %",
        [0.0, BIAS_PERCENT],
        worst,
    )
    .over(
        RECORDS as usize,
        format!("population {SEED}, 0 to {}", RECORDS - 1),
    ))
}
