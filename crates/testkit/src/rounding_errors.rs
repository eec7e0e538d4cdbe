//! Rounding errors of the filters against the same filter in 400-bit arithmetic, whose results are in
//! `tests/data/numerics`.

use gyrocal::estimation::dense::DenseFilter;
use gyrocal::estimation::form::Form;
use gyrocal::estimation::{ArrayStorage, Filter};
use gyrocal::generated::platform::reanchor;
use gyrocal::{Anchored, Chart, EARTH_RATE_RAD_PER_S, Integration, Platform, Recentring, Site};
use nalgebra::{SMatrix, SVector};

const REFERENCE: &str = include_str!("../../../tests/data/numerics/reference.csv");
const SAMPLES: &str = include_str!("../../../tests/data/numerics/samples.csv");

/// Initial values of the script, with the same names.
const STEP_S: f64 = 60.0;
const LATITUDE_RAD: f64 = -0.575;
const ANGLES_RAD: [f64; 3] = [0.3, -0.5, 1.9];
const ANGLE_SIGMA_RAD: f64 = 1.0 / 4096.0;
const RUNS: u32 = 8;
const CHECKPOINTS: [usize; 5] = [1, 2, 10, 100, 1000];
const DRIFT_DENSITY: [f64; 3] = [2.4e-4; 3];
const ACCEL_VARIANCE: [f64; 3] = [1e-10; 3];

/// Ratio of errors up to which two filters count as equally accurate. The rounding error of a run is
/// one random draw; its logarithm has a standard deviation of up to 0.9 over runs, a mean over eight
/// one of 0.3, a ratio one of 0.45. This is two of these.
pub const TIE: f64 = 2.5;

/// Largest error of the factors over that of the dense Joseph filter. Measured: a thousandth, since
/// factors keep small pivots to their own last digit.
pub const FACTORS_LIMIT: f64 = 0.02;

/// Errors of one filter against the reference, over the checkpoints of all runs of 1000 steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Accuracy {
    /// Error of the state in units of its sigma, angles as a rotation vector: root mean square
    /// over a run, geometric mean over runs.
    pub state: f64,
    /// The same of sigmas, relative.
    pub sigma: f64,
    /// The largest error of a state.
    pub worst_state: f64,
    /// The largest error of a sigma.
    pub worst_sigma: f64,
    /// The largest error of a correlation.
    pub worst_correlation: f64,
}

/// Errors of the structured filter, in a form of the covariance.
pub fn structured<F: Form<f64>>(integration: Integration) -> Accuracy {
    let mut state = [0.0; 12];
    state[..3].copy_from_slice(&ANGLES_RAD);
    accuracy(integration, |run| {
        let filter = Filter::<_, _, _, _, 3, 3, F>::with_form(
            Anchored(Platform),
            chart(),
            integration,
            Recentring::EveryStep,
            ArrayStorage::<f64, 3, 3, 12>::new(),
            &state,
            &sigmas(run),
        );
        let mut filter = filter.expect("a valid start");
        move |sample: &[f64; 3]| {
            let predicted = filter.predict(STEP_S, &DRIFT_DENSITY);
            predicted.expect("a finite prediction");
            let updated = filter.update(sample, &ACCEL_VARIANCE);
            updated.expect("a finite update");
            let covariance = |i, j| filter.covariance(i, j);
            Estimate::of(filter.state(), filter.inputs(), covariance)
        }
    })
}

/// Errors of the textbook dense filter in Joseph form.
pub fn dense_joseph(integration: Integration) -> Accuracy {
    let mut state = SVector::<f64, 12>::zeros();
    state.as_mut_slice()[..3].copy_from_slice(&ANGLES_RAD);
    accuracy(integration, |run| {
        let mut filter = DenseFilter::<_, _, 3, 3, 12>::new(
            Anchored(Platform),
            chart(),
            integration,
            Recentring::EveryStep,
            state,
            SMatrix::from_diagonal(&SVector::from(sigmas(run).map(|sigma| sigma * sigma))),
        );
        move |sample: &[f64; 3]| {
            filter.predict(STEP_S, &DRIFT_DENSITY);
            let updated = filter.update(sample, &ACCEL_VARIANCE);
            updated.expect("a positive definite innovation");
            let covariance = |i, j| filter.covariance[(i, j)];
            Estimate::of(filter.state.as_slice(), &filter.inputs, covariance)
        }
    })
}

fn chart() -> Chart<f64> {
    Chart::east_north_up(Site {
        latitude_rad: LATITUDE_RAD,
        earth_rate_rad_per_s: EARTH_RATE_RAD_PER_S,
        gravity_g: 1.0,
    })
}

fn sigmas(run: u32) -> [f64; 12] {
    let coefficient = 1.0 + f64::from(run) / 16.0;
    core::array::from_fn(|i| if i < 3 { ANGLE_SIGMA_RAD } else { coefficient })
}

/// Results of a filter after a step.
struct Estimate {
    platform_c_enu: [[f64; 3]; 3],
    coefficients: [f64; 9],
    covariance: [[f64; 12]; 12],
}

impl Estimate {
    fn of(state: &[f64], chart: &Chart<f64>, covariance: impl Fn(usize, usize) -> f64) -> Self {
        Self {
            platform_c_enu: attitude(state, chart),
            coefficients: core::array::from_fn(|i| state[3 + i]),
            covariance: square(covariance),
        }
    }
}

fn square<const N: usize>(of: impl Fn(usize, usize) -> f64) -> [[f64; N]; N] {
    core::array::from_fn(|i| core::array::from_fn(|j| of(i, j)))
}

fn attitude(state: &[f64], chart: &Chart<f64>) -> [[f64; 3]; 3] {
    let platform_c_chart = reanchor(&[state[0], state[1], state[2]]).platform_c_chart;
    let chart_c_enu = chart.chart_c_enu();
    let product = |i: usize, l: usize, j: usize| platform_c_chart[i][l] * chart_c_enu[l][j];
    square(|i, j| (0..3).map(|l| product(i, l, j)).sum())
}

/// One line of the reference: quantity, place, and its digits.
struct Entry<'a> {
    quantity: &'a str,
    i: usize,
    j: usize,
    digits: &'a str,
}

fn entries(integration: Integration, run: u32, step: usize) -> Vec<Entry<'static>> {
    let rule = match integration == Integration::EULER {
        true => "euler",
        false => "rk4",
    };
    let start = format!("{rule},{run},{step},");
    let entry = |line: &'static str| {
        let fields: Vec<&str> = line.split(',').collect();
        let [quantity, i, j, digits] = fields[..] else {
            panic!("four fields: {line}")
        };
        let [i, j] = [i, j].map(|text| text.parse().expect("an index"));
        Entry {
            quantity,
            i,
            j,
            digits,
        }
    };
    let lines = REFERENCE.lines();
    let lines = lines.filter_map(|line| line.strip_prefix(&start));
    lines.map(entry).collect()
}

/// `value` minus the number with the given digits, not rounded before the difference is taken.
fn difference(value: f64, digits: &str) -> f64 {
    const DECIMALS: usize = 34;
    let fixed = |text: &str| -> i128 {
        let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
        let cut = &fraction[..fraction.len().min(DECIMALS)];
        format!("{whole}{cut:0<DECIMALS$}")
            .parse()
            .expect("a decimal number below 10^4")
    };
    (fixed(&format!("{value:.DECIMALS$}")) - fixed(digits)) as f64 * 1e-34
}

fn accuracy<F>(integration: Integration, start: impl Fn(u32) -> F) -> Accuracy
where
    F: FnMut(&[f64; 3]) -> Estimate,
{
    let mut total = Accuracy::default();
    let (mut ln_state, mut ln_sigma) = (0.0, 0.0);
    for run in 0..RUNS {
        let mut step = start(run);
        (total.state, total.sigma) = (0.0, 0.0);
        for (row, line) in SAMPLES.lines().skip(1).enumerate() {
            let mut sample = [0.0; 3];
            for (component, text) in sample.iter_mut().zip(line.split(',')) {
                *component = text.parse().expect("a number");
            }
            let estimate = step(&sample);
            if CHECKPOINTS.contains(&(row + 1)) {
                total.add(&estimate, &entries(integration, run, row + 1));
            }
        }
        let count = (12 * CHECKPOINTS.len()) as f64;
        ln_state += 0.5 * (total.state / count).ln() / f64::from(RUNS);
        ln_sigma += 0.5 * (total.sigma / count).ln() / f64::from(RUNS);
    }
    Accuracy {
        state: ln_state.exp(),
        sigma: ln_sigma.exp(),
        ..total
    }
}

impl std::fmt::Display for Accuracy {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(
            formatter,
            "state {:.1e} sigma, sigmas {:.1e}, largest {:.1e} and {:.1e}, correlations {:.1e}",
            self.state, self.sigma, self.worst_state, self.worst_sigma, self.worst_correlation
        )
    }
}

impl Accuracy {
    /// Adds the squares of the errors at one checkpoint, and keeps the largest.
    fn add(&mut self, estimate: &Estimate, entries: &[Entry<'_>]) {
        let due = 9 + 9 + 12 + 12;
        assert_eq!(entries.len(), due, "the reference lacks a checkpoint");
        let number = |entry: &Entry<'_>| entry.digits.parse::<f64>().expect("a number");
        let of = |quantity| {
            let entries = entries.iter();
            entries.filter(move |entry| entry.quantity == quantity)
        };
        let mut sigma = [0.0; 12];
        for entry in of("covariance").filter(|entry| entry.i == entry.j) {
            sigma[entry.i] = number(entry).sqrt();
        }
        let mut state = [0.0; 12];
        let mut attitude = [[0.0; 3]; 3];
        let mut change = [[0.0; 3]; 3];
        for entry in of("attitude") {
            attitude[entry.i][entry.j] = number(entry);
            change[entry.i][entry.j] =
                difference(estimate.platform_c_enu[entry.i][entry.j], entry.digits);
        }
        for (axis, angle) in state[..3].iter_mut().enumerate() {
            let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
            let turn =
                |i: usize, j: usize| -> f64 { (0..3).map(|l| change[i][l] * attitude[j][l]).sum() };
            *angle = 0.5 * (turn(i, j) - turn(j, i));
        }
        for entry in of("coefficient") {
            state[3 + entry.i] = difference(estimate.coefficients[entry.i], entry.digits);
        }
        for (error, sigma) in state.iter().zip(sigma) {
            let error = (error / sigma).abs();
            self.state += error * error;
            self.worst_state = self.worst_state.max(error);
        }
        for entry in of("covariance") {
            let error = difference(estimate.covariance[entry.i][entry.j], entry.digits)
                / (sigma[entry.i] * sigma[entry.j]);
            if entry.i == entry.j {
                let error = 0.5 * error.abs();
                self.sigma += error * error;
                self.worst_sigma = self.worst_sigma.max(error);
            } else {
                self.worst_correlation = self.worst_correlation.max(error.abs());
            }
        }
    }
}
