//! Records of the paper's bench, and the filters that are applied to them.

use std::collections::BTreeMap;

use gyrocal::{Discretisation, Integration, Recentring};
use gyrocal_calibration::Options;
use gyrocal_evaluation::{CalibrationTrial, Target};
use gyrocal_truth::{Coefficients, Scenario, Simulation, euler_rule, simulate};

use crate::harness::{CALIBRATION, Population, Row, of};

/// Number of seeds; the page has those from the first on.
pub(super) const SEEDS: u64 = 60;
pub(super) const SHOWN_SEED: u64 = 1;

/// Days of the paper's simulation.
pub(super) const PAPER_DAYS: u32 = 3;

/// What is found in the records of a seed, by [`key`].
pub(super) type Found = BTreeMap<String, CalibrationTrial>;

/// Simulation of a record.
type Simulator = fn(&Scenario) -> Result<Simulation, gyrocal_truth::Error>;

/// Name of a filter in this program, and its options.
type Filter = (&'static str, fn() -> Options);

const PAPER: fn() -> Options = Options::paper_baseline;
const EVERY: Filter = ("every", Options::streaming);
const BATCH: Filter = ("batch", Options::default);
const SINGLE: Filter = ("single", || streaming(Integration::RK4, Recentring::Never));
const BEYOND: Filter = ("beyond", || {
    streaming(Integration::RK4, Recentring::Beyond(20.0_f64.to_radians()))
});

/// The default streaming filter, with Earth rate as printed in (6).
const PRINTED_FILTER: &str = "printed_filter";

/// Records, their days, and the filters on each.
type Bench = (Simulator, u32, &'static [Filter]);

const BENCHES: [Bench; 4] = [
    (euler_rule, PAPER_DAYS, &[("own_rule", PAPER)]),
    (
        simulate,
        PAPER_DAYS,
        &[
            ("paper", PAPER),
            EVERY,
            BATCH,
            SINGLE,
            BEYOND,
            ("euler_1", || euler(1)),
            ("euler_4", || euler(4)),
            ("euler_16", || euler(16)),
            ("euler_64", || euler(64)),
            (PRINTED_FILTER, Options::streaming),
        ],
    ),
    (simulate, 1, &[SINGLE, BEYOND, EVERY, BATCH]),
    (with_printed_rate, PAPER_DAYS, &[("printed_both", EVERY.1)]),
];

/// The paper's combination, the same filter on exact data, and the corrected filters.
pub(super) const WAYS: [(&str, &str); 4] = [
    ("own_rule", "paper's filter, data by its own rule"),
    ("paper", "paper's filter, exact data"),
    ("every", "default streaming filter, exact data"),
    ("batch", "batch estimator, exact data"),
];

/// Coordinates of the attitude.
pub(super) const COORDINATES: [(&str, &str); 4] = [
    ("single", "Euler angles in one chart, as in the paper"),
    ("beyond", "chart moved beyond 20 deg"),
    ("every", "chart moved at every step"),
    ("batch", "batch estimator"),
];

/// Earth rate as printed in (6), and right.
pub(super) const EARTH_RATES: [(&str, &str); 3] = [
    ("every", "data and filter with latitude"),
    ("printed_both", "data and filter as printed"),
    (PRINTED_FILTER, "data with latitude, filter as printed"),
];

/// Targets of the mean NIS, with their reasons.
const FITS: (Target, &str) = (
    Target::Between([2.95, 3.05]),
    "three, one for each accelerometer; one pass adds or takes a little",
);
const NEARLY_FITS: (Target, &str) = (
    Target::Between([2.9, 3.3]),
    "three, one for each accelerometer; Euler angles as states are over-confident",
);
const DOES_NOT_FIT: (Target, &str) = (Target::AtLeast(100.0), "a wrong rule must be seen");

/// The paper's bench: its coefficients, noise and step.
pub(super) fn scenario(seed: u64, days: u32) -> Scenario {
    Scenario {
        seed,
        coefficients: Coefficients::PAPER_LIKE,
        duration_s: f64::from(days) * 86_400.0,
        ..Scenario::default()
    }
}

/// Exchanging the components of Earth rate is the same as exchanging latitude and co-latitude.
pub(super) fn as_printed(latitude_deg: f64) -> f64 {
    90.0 - latitude_deg
}

/// Key of what a filter finds in the records of so many days.
pub(super) fn key(name: &str, days: u32) -> String {
    format!("{name}, {days} d")
}

/// The bench with Earth rate as printed in (6).
fn with_printed_rate(scenario: &Scenario) -> Result<Simulation, gyrocal_truth::Error> {
    simulate(&Scenario {
        latitude_deg: as_printed(scenario.latitude_deg),
        ..scenario.clone()
    })
}

fn streaming(integration: Integration, recentring: Recentring<f64>) -> Options {
    Options {
        discretisation: Discretisation {
            integration,
            recentring,
            ..Discretisation::default()
        },
        ..Options::streaming()
    }
}

fn euler(substeps: u32) -> Options {
    streaming(Integration::Euler { substeps }, Recentring::EveryStep)
}

/// The population of all filters.
pub(super) fn population() -> Population<'static, Found> {
    let sources = of(CALIBRATION, &[file!()]);
    Population::new("paper", [1, SEEDS, SEEDS], sources, |seed| {
        let mut found = Found::new();
        for (simulated, days, filters) in BENCHES {
            let mut simulation = simulated(&scenario(seed, days))?;
            let latitude_deg = simulation.bench.latitude_deg;
            for (name, options) in filters {
                simulation.bench.latitude_deg = match *name {
                    PRINTED_FILTER => as_printed(latitude_deg),
                    _ => latitude_deg,
                };
                let trial = CalibrationTrial::of_simulation(&simulation, &options())?;
                found.insert(key(name, days), trial);
            }
        }
        Ok(found)
    })
}

/// Mean NIS of a row.
pub(super) fn nis(trial: &CalibrationTrial) -> f64 {
    trial.nis_sum / trial.rows as f64
}

pub(super) fn rows() -> Vec<Row<'static, Found>> {
    let targets = [NEARLY_FITS, DOES_NOT_FIT, FITS, FITS];
    let ways = WAYS.into_iter().zip(targets);
    let others = [
        ("single", "exact data, RK4, Euler angles in one chart"),
        ("printed_both", "Earth rate, data and filter as printed"),
        (
            PRINTED_FILTER,
            "Earth rate, data with latitude, filter as printed",
        ),
    ];
    let others = others.into_iter().zip([NEARLY_FITS, FITS, DOES_NOT_FIT]);
    let of_fit = ways.chain(others).map(|((name, what), (target, reason))| {
        let key = key(name, PAPER_DAYS);
        let nis = move |found: &Found| Some(nis(&found[&key]));
        Row::median(format!("{what}: mean NIS, median"), nis).with_target(target, reason)
    });
    let of_nees = COORDINATES.into_iter().map(|(name, what)| {
        let key = key(name, 1);
        let what = format!("NEES after one day, {what}: median");
        let row = Row::median(what, move |found: &Found| Some(found[&key].nees));
        match name {
            "every" => row.at_most(14.0, "one pass of a filter falls short of the 8.3 of nine"),
            "batch" => row.between([7.8, 8.9], "8.3 of nine, and half of one for linearisation"),
            _ => row,
        }
    });
    of_fit.chain(of_nees).collect()
}
