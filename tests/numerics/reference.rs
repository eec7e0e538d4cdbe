//! Errors of the filters against tests/data/numerics: the same filter in 400-bit arithmetic.

use gyrocal::estimation::dense::DenseFilter;
use gyrocal::estimation::{ArrayStorage, Filter};
use gyrocal::generated::platform::reanchor;
use gyrocal::{Anchored, Chart, EARTH_RATE_RAD_PER_S, Integration, Platform, Recentring, Site};
use nalgebra::{SMatrix, SVector};

const REFERENCE: &str = include_str!("../data/numerics/reference.csv");
const SAMPLES: &str = include_str!("../data/numerics/samples.csv");

/// What the script starts from, under the same names.
const STEP_S: f64 = 60.0;
const LATITUDE_RAD: f64 = -0.575;
const ANGLES_RAD: [f64; 3] = [0.3, -0.5, 1.9];
const ANGLE_SIGMA_RAD: f64 = 1.0 / 4096.0;
const COEFFICIENT_SIGMA: f64 = 1.0;
const DRIFT_DENSITY: [f64; 3] = [2.4e-4; 3];
const ACCEL_VARIANCE: [f64; 3] = [1e-10; 3];

/// Errors of one filter against the reference, over all checkpoints of 1000 steps.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Accuracy {
    /// Error of the state in units of its sigma; angles as a rotation vector; root mean square.
    pub(crate) state: f64,
    /// The largest such error.
    pub(crate) worst_state: f64,
    /// Relative error of sigmas; root mean square.
    pub(crate) sigma: f64,
    /// The largest such error.
    pub(crate) worst_sigma: f64,
    /// Error of off-diagonal covariances as correlations; the largest.
    pub(crate) worst_correlation: f64,
}

/// The factorised filter as shipped.
pub(crate) fn factorised(integration: Integration) -> Accuracy {
    let mut state = [0.0; 12];
    state[..3].copy_from_slice(&ANGLES_RAD);
    let mut filter = Filter::new(
        Anchored(Platform),
        chart(),
        integration,
        Recentring::EveryStep,
        ArrayStorage::<f64, 3, 3, 12>::new(),
        &state,
        &sigmas(),
    )
    .expect("a valid start");
    accuracy(integration, |sample| {
        filter.predict(STEP_S, &DRIFT_DENSITY).expect("a finite prediction");
        filter.update(sample, &ACCEL_VARIANCE).expect("a finite update");
        Estimate {
            platform_c_enu: attitude(filter.state(), filter.inputs()),
            coefficients: core::array::from_fn(|i| filter.state()[3 + i]),
            covariance: core::array::from_fn(|i| {
                core::array::from_fn(|j| filter.covariance(i, j))
            }),
        }
    })
}

/// The textbook dense filter in Joseph form.
pub(crate) fn dense_joseph(integration: Integration) -> Accuracy {
    let mut state = SVector::<f64, 12>::zeros();
    state.as_mut_slice()[..3].copy_from_slice(&ANGLES_RAD);
    let variances = sigmas().map(|sigma| sigma * sigma);
    let mut filter = DenseFilter::<_, _, 3, 3, 12>::new(
        Anchored(Platform),
        chart(),
        integration,
        Recentring::EveryStep,
        state,
        SMatrix::from_diagonal(&SVector::from(variances)),
    );
    accuracy(integration, |sample| {
        filter.predict(STEP_S, &DRIFT_DENSITY);
        filter.update(sample, &ACCEL_VARIANCE).expect("a positive definite innovation");
        Estimate {
            platform_c_enu: attitude(filter.state.as_slice(), &filter.inputs),
            coefficients: core::array::from_fn(|i| filter.state[3 + i]),
            covariance: core::array::from_fn(|i| {
                core::array::from_fn(|j| filter.covariance[(i, j)])
            }),
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

fn sigmas() -> [f64; 12] {
    core::array::from_fn(|i| if i < 3 { ANGLE_SIGMA_RAD } else { COEFFICIENT_SIGMA })
}

/// What a filter says after a step.
struct Estimate {
    platform_c_enu: [[f64; 3]; 3],
    coefficients: [f64; 9],
    covariance: [[f64; 12]; 12],
}

fn attitude(state: &[f64], chart: &Chart<f64>) -> [[f64; 3]; 3] {
    let platform_c_chart = reanchor(&[state[0], state[1], state[2]]).platform_c_chart;
    let chart_c_enu = chart.chart_c_enu();
    core::array::from_fn(|i| {
        core::array::from_fn(|j| (0..3).map(|l| platform_c_chart[i][l] * chart_c_enu[l][j]).sum())
    })
}

/// One line of the reference: what, where, and its digits.
struct Entry<'a> {
    quantity: &'a str,
    i: usize,
    j: usize,
    digits: &'a str,
}

fn entries(integration: Integration, step: usize) -> Vec<Entry<'static>> {
    let rule = if integration == Integration::EULER { "euler" } else { "rk4" };
    let start = format!("{rule},{step},");
    let lines = REFERENCE.lines().filter_map(|line| line.strip_prefix(&start));
    lines
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let [quantity, i, j, digits] = fields[..] else { panic!("four fields: {line}") };
            let index = |text: &str| text.parse().expect("an index");
            Entry { quantity, i: index(i), j: index(j), digits }
        })
        .collect()
}

/// `value` minus the number with the given digits, not rounded before the difference is taken.
fn difference(value: f64, digits: &str) -> f64 {
    const DECIMALS: usize = 34;
    let fixed = |text: &str| -> i128 {
        let (whole, fraction) = text.split_once('.').unwrap_or((text, ""));
        let cut = &fraction[..fraction.len().min(DECIMALS)];
        format!("{whole}{cut:0<DECIMALS$}").parse().expect("a decimal number below 10^4")
    };
    (fixed(&format!("{value:.DECIMALS$}")) - fixed(digits)) as f64 * 1e-34
}

fn accuracy(integration: Integration, mut step: impl FnMut(&[f64; 3]) -> Estimate) -> Accuracy {
    let mut total = Accuracy::default();
    let mut checkpoints = 0;
    for (row, line) in SAMPLES.lines().skip(1).enumerate() {
        let mut sample = [0.0; 3];
        for (component, text) in sample.iter_mut().zip(line.split(',')) {
            *component = text.parse().expect("a number");
        }
        let estimate = step(&sample);
        let entries = entries(integration, row + 1);
        if !entries.is_empty() {
            checkpoints += 1;
            total.add(&estimate, &entries);
        }
    }
    assert!(checkpoints >= 5, "the reference has lost its checkpoints");
    let count = f64::from(12 * checkpoints);
    total.state = (total.state / count).sqrt();
    total.sigma = (total.sigma / count).sqrt();
    total
}

impl Accuracy {
    /// All errors with their names.
    pub(crate) fn figures(&self) -> [(&'static str, f64); 5] {
        [
            ("state, rms, in sigmas", self.state),
            ("state, largest, in sigmas", self.worst_state),
            ("sigmas, rms, relative", self.sigma),
            ("sigmas, largest, relative", self.worst_sigma),
            ("correlations, largest", self.worst_correlation),
        ]
    }

    /// Adds the squares of the errors at one checkpoint, and keeps the largest.
    fn add(&mut self, estimate: &Estimate, entries: &[Entry<'_>]) {
        let number = |entry: &Entry<'_>| entry.digits.parse::<f64>().expect("a number");
        let of = |quantity| entries.iter().filter(move |entry| entry.quantity == quantity);
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
            let turn = |i: usize, j: usize| -> f64 {
                (0..3).map(|l| change[i][l] * attitude[j][l]).sum()
            };
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
