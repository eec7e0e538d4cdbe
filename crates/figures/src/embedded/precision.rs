//! The filter in single precision beside the one in double: differences on one record, and
//! consistency over many.

use gyrocal::{
    Drift, FilterSettings, InitialAttitude, PlatformFilter, Precision, SavedForm, SavedNumber, Site,
};
use gyrocal_estimation::form::Form;
use gyrocal_statistics::mean_square_band;
use gyrocal_truth::{Population, Simulation, simulate};
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;

use crate::error::Error;
use crate::figure::Figure;

const DAY_S: f64 = 86_400.0;
const DIFFERENCE_SEED: u64 = 20_261_122;
const CONSISTENCY_SEED: u64 = 20_261_123;
/// Days after which both precisions are compared.
const DAYS: [f64; 3] = [1.0, 3.0, 5.0];

pub(super) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = differences(if small { 4 } else { 40 })?;
    figures.extend(consistency(if small { 60 } else { 500 })?);
    Ok(figures)
}

/// Coefficients and their covariance.
struct Estimate {
    drift: [f64; 9],
    covariance: SMatrix<f64, 9, 9>,
}

/// The estimates of the filter at some times of a record.
fn estimates<T>(simulation: &Simulation, times_s: &[f64]) -> Result<Vec<Estimate>, Error>
where
    T: SavedNumber,
    <T as Precision>::Form: Form<T> + SavedForm,
{
    let bench = &simulation.bench;
    let number = T::from_f64;
    let settings = FilterSettings {
        accel_noise_g: number(bench.accel_noise_g),
        drift_noise_deg_per_h: number(bench.gyro_noise_deg_per_h),
        ..FilterSettings::at_site(Site::<T>::at_latitude_deg(bench.latitude_deg))
    };
    let radians = |degrees: [f64; 3]| degrees.map(|angle| number(angle.to_radians()));
    let attitude = InitialAttitude::Angles {
        angles_rad: radians(bench.initial_angles_deg.unwrap_or_default()),
        sigma_rad: radians(bench.initial_angles_sigma_deg),
    };
    let mut filter = PlatformFilter::<T>::new(&settings, &attitude)?;
    let record = &simulation.record;
    let mut found = Vec::new();
    for (row, (time_s, sample)) in record.time_s.iter().zip(&record.accel_g).enumerate() {
        let sample = sample.map(number);
        if row == 0 {
            filter.update(&sample)?;
        } else {
            filter.step(number(time_s - record.time_s[row - 1]), &sample)?;
        }
        if times_s.contains(time_s) || (times_s.is_empty() && row + 1 == record.time_s.len()) {
            let covariance = filter.drift_covariance();
            found.push(Estimate {
                drift: doubled(&filter.drift()),
                covariance: SMatrix::from_fn(|i, j| covariance[i][j].to_f64()),
            });
        }
    }
    Ok(found)
}

fn doubled<T: Precision>(drift: &Drift<T>) -> [f64; 9] {
    drift.to_array().map(|value| value.to_f64())
}

/// The largest difference of a coefficient in its sigma after some days.
fn differences(records: u64) -> Result<Vec<Figure>, Error> {
    let population = Population {
        duration_days: [5.0, 5.0],
        ..Population::new(DIFFERENCE_SEED)
    };
    let times_s = DAYS.map(|days| days * DAY_S);
    let worst = (0..records)
        .into_par_iter()
        .map(|number| {
            let simulation = simulate(&population.scenario(number))?;
            let single = estimates::<f32>(&simulation, &times_s)?;
            let double = estimates::<f64>(&simulation, &times_s)?;
            Ok(single.iter().zip(&double).map(apart).collect())
        })
        .collect::<Result<Vec<Vec<f64>>, Error>>()?;
    let figures = DAYS.iter().enumerate().map(|(index, days)| {
        let of_day = worst.iter().filter_map(|record| record.get(index));
        // NaN must not pass for small.
        let largest = of_day.fold(
            0.0,
            |largest: f64, value| {
                if *value <= largest { largest } else { *value }
            },
        );
        Figure::at_most(
            &format!("f32 against f64 after {days} days: largest difference of a coefficient"),
            0.1,
            largest,
            "sigma",
        )
        .over(
            worst.len(),
            format!("population {DIFFERENCE_SEED}, 0 to {}", records - 1),
        )
    });
    Ok(figures.collect())
}

fn apart((single, double): (&Estimate, &Estimate)) -> f64 {
    (0..9).fold(0.0, |largest: f64, i| {
        let difference = (single.drift[i] - double.drift[i]).abs();
        largest.max(difference / double.covariance[(i, i)].sqrt())
    })
}

/// Mean NEES of both precisions on the same records of three days.
fn consistency(records: u64) -> Result<Vec<Figure>, Error> {
    let population = Population {
        duration_days: [3.0, 3.0],
        ..Population::new(CONSISTENCY_SEED)
    };
    let nees = (0..records)
        .into_par_iter()
        .map(|number| {
            let simulation = simulate(&population.scenario(number))?;
            let truth = simulation.truth.coefficients.named();
            let truth = SVector::from(truth.map(|(_, value, _)| value));
            let of = |found: Vec<Estimate>| -> Result<f64, Error> {
                let [estimate] = found.as_slice() else {
                    return Err("a record without a last row".into());
                };
                let error = SVector::from(estimate.drift) - truth;
                let cholesky = estimate.covariance.cholesky();
                let cholesky = cholesky.ok_or("the covariance is not positive definite")?;
                Ok(error.dot(&cholesky.solve(&error)))
            };
            let single = of(estimates::<f32>(&simulation, &[])?)?;
            Ok([single, of(estimates::<f64>(&simulation, &[])?)?])
        })
        .collect::<Result<Vec<[f64; 2]>, Error>>()?;
    let runs = nees.len() as f64;
    let mean = |index: usize| nees.iter().map(|pair| pair[index]).sum::<f64>() / runs;
    let band = mean_square_band(9.0 * runs, runs, 0.999);
    let seeds = format!("population {CONSISTENCY_SEED}, 0 to {}", records - 1);
    let mut single = Figure::within("f32: mean NEES (9 expected)", band, mean(0));
    single.target = format!("{:.2} to {:.2}", band[0], band[1]);
    Ok([
        single,
        Figure::note(
            "f64 on the same records: mean NEES",
            format!("{:.3}", mean(1)),
        ),
    ]
    .map(|figure| figure.over(nees.len(), seeds.clone()))
    .into())
}
