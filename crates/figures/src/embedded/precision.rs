//! The filter in single precision beside the one in double: differences on one record, and
//! consistency over many.

use gyrocal::{
    Drift, FactorisedPlatformFilter, FilterSettings, InitialAttitude, Platform, Precision, Site,
};
use gyrocal_truth::{Population, Simulation, simulate};

use crate::harness::{self, Context, Error, Figure, Row, Sources, in_turn, of};

const DAY_S: f64 = 86_400.0;
const DIFFERENCE_SEED: u64 = 20_261_122;
const CONSISTENCY_SEED: u64 = 20_261_124;
/// Largest coefficient of the records of [`consistency`]: deg/h, deg/h/g, deg/h/g².
const LARGEST: f64 = 0.3;
/// Days after which both precisions are compared.
const DAYS: [f64; 3] = [1.0, 3.0, 5.0];

const SOURCES: Sources = of(&["", "crates/truth"], &[file!()]);

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    in_turn(context, &[differences, consistency])
}

/// Coefficients, and their covariance as the factors U D Uᵀ that the filter holds: nothing is
/// rounded on the way to a figure.
struct Estimate {
    drift: [f64; 9],
    sigma: [f64; 9],
    factor: [[f64; 9]; 9],
    pivots: [f64; 9],
}

impl Estimate {
    fn of<T: Precision>(filter: &FactorisedPlatformFilter<T>) -> Self {
        let view = filter.kernel().view();
        let moving = Platform::STATES - Platform::PARAMETERS;
        let number = |value: T| value.to_f64();
        // U is stored by columns.
        let factor = |i: usize, j: usize| view.matrix[(moving + j) * Platform::STATES + moving + i];
        Self {
            drift: filter.drift().to_array().map(number),
            sigma: filter.drift_sigma().to_array().map(number),
            factor: core::array::from_fn(|i| core::array::from_fn(|j| number(factor(i, j)))),
            pivots: core::array::from_fn(|i| number(view.pivots[moving + i])),
        }
    }

    /// Normalised estimation error squared: |D^-1/2 U⁻¹ e|².
    fn nees(&self, truth: &[f64; 9]) -> f64 {
        let mut error: [f64; 9] = core::array::from_fn(|i| self.drift[i] - truth[i]);
        for i in (0..9).rev() {
            for j in i + 1..9 {
                error[i] -= self.factor[i][j] * error[j];
            }
        }
        let squares = error.iter().zip(self.pivots);
        squares.map(|(error, pivot)| error * error / pivot).sum()
    }
}

/// The estimates of the filter at some times of a record, with a prior of the same sigma for all
/// coefficients.
fn estimates<T: Precision>(
    simulation: &Simulation,
    sigma: f64,
    times_s: &[f64],
) -> Result<Vec<Estimate>, Error> {
    let bench = &simulation.bench;
    let number = T::from_f64;
    let settings = FilterSettings {
        drift_sigma: Drift::from_array([number(sigma); Platform::PARAMETERS]),
        accel_noise_g: number(bench.accel_noise_g),
        drift_noise_deg_per_h: number(bench.gyro_noise_deg_per_h),
        ..FilterSettings::at_site(Site::<T>::at_latitude_deg(bench.latitude_deg))
    };
    let radians = |degrees: [f64; 3]| degrees.map(|angle| number(angle.to_radians()));
    let attitude = InitialAttitude::Angles {
        angles_rad: radians(bench.initial_angles_deg.unwrap_or_default()),
        sigma_rad: radians(bench.initial_angles_sigma_deg),
    };
    let mut filter = FactorisedPlatformFilter::<T>::factorised(&settings, &attitude)?;
    let record = &simulation.record;
    let mut found = Vec::new();
    for (row, (time_s, sample)) in record.time_s.iter().zip(&record.accel_g).enumerate() {
        let sample = sample.map(number);
        if row == 0 {
            filter.update(&sample)?;
        } else {
            filter.step(number(time_s - record.time_s[row - 1]), &sample)?;
        }
        if times_s.contains(time_s) {
            found.push(Estimate::of(&filter));
        }
    }
    Ok(found)
}

/// The largest difference of a coefficient in its sigma after some days.
fn differences(context: &Context) -> Result<Vec<Figure>, Error> {
    let records = Population {
        duration_days: [DAYS[2]; 2],
        ..Population::new(DIFFERENCE_SEED)
    };
    let times_s = DAYS.map(|days| days * DAY_S);
    let job = |number| {
        let simulation = simulate(&records.scenario(number))?;
        let single = estimates::<f32>(&simulation, 1.0, &times_s)?;
        let double = estimates::<f64>(&simulation, 1.0, &times_s)?;
        Ok(single.iter().zip(&double).map(apart).collect())
    };
    let population = harness::Population::new("f32 against f64", [0, 40, 4], SOURCES, job);
    let rows = core::array::from_fn::<_, 3, _>(|place| {
        let days = DAYS[place];
        let name =
            format!("f32 against f64 after {days} days: largest difference of a coefficient");
        let of_day = move |record: &Vec<f64>| record.get(place).copied().unwrap_or(f64::NAN);
        Row::largest(name, of_day).at_most(0.1, "a tenth of a sigma more is half a percent of it")
    });
    context.measure(&population, &rows)
}

fn apart((single, double): (&Estimate, &Estimate)) -> f64 {
    (0..9).fold(0.0, |largest: f64, i| {
        let difference = (single.drift[i] - double.drift[i]).abs();
        largest.max(difference / double.sigma[i])
    })
}

/// Mean NEES of both precisions on the same records of three days. Coefficients are drawn from the
/// prior, which is narrow enough for an extended Kalman filter: from a wide one its linearisation
/// costs more than any rounding.
fn consistency(context: &Context) -> Result<Vec<Figure>, Error> {
    let records = Population {
        duration_days: [DAYS[1]; 2],
        largest_bias_deg_per_h: LARGEST,
        largest_g_deg_per_h_per_g: LARGEST,
        largest_gg_deg_per_h_per_g2: LARGEST,
        ..Population::new(CONSISTENCY_SEED)
    };
    // Of a uniform distribution.
    let sigma = LARGEST / 3.0_f64.sqrt();
    let end_s = [DAYS[1] * DAY_S];
    let job = |number| {
        let simulation = simulate(&records.scenario(number))?;
        let truth = simulation.truth.coefficients.named();
        let truth = truth.map(|(_, value, _)| value);
        let of = |found: Vec<Estimate>| match found.as_slice() {
            [estimate] => Ok(estimate.nees(&truth)),
            _ => Err(Error::from("a record without a last row")),
        };
        let single = of(estimates::<f32>(&simulation, sigma, &end_s)?)?;
        Ok([single, of(estimates::<f64>(&simulation, sigma, &end_s)?)?])
    };
    let population = harness::Population::new("NEES of f32 and f64", [0, 500, 40], SOURCES, job);
    let of = |which: usize| move |pair: &[f64; 2]| Some(pair[which]);
    let reason = "nine coefficients; the uniform prior and what is not linear leave a few percent";
    let rows = [
        Row::mean("f32: mean NEES (9 expected)", of(0)).between([8.7, 9.3], reason),
        Row::mean("f64 on the same records: mean NEES", of(1)),
    ];
    context.measure(&population, &rows)
}
