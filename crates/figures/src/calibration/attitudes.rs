//! Information of a second record at another attitude.

use gyrocal_calibration::{Options, calibrate_runs};
use gyrocal_evaluation::run_of;
use gyrocal_statistics::mean;
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, simulate};

use crate::harness::{CALIBRATION, Context, Error, Figure, Population, Row, of};

const ONE_DEG: [f64; 3] = [0.0; 3];
const OTHER_DEG: [f64; 3] = [90.0, 45.0, 0.0];

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let sources = of(CALIBRATION, &[file!()]);
    let population = Population::new("second attitude", [1, 20, 2], sources, ratios);
    let row = |over: &str, which: usize| {
        let name = format!("sigma with a second attitude over sigma of {over}, geometric mean");
        Row::mean(name, move |of: &[f64; 2]| Some(of[which]))
    };
    let rows = [
        row("one", 0).at_most(0.71, "twice the data of one kind give 0.71"),
        row("as long a record", 1)
            .at_most(1.0, "another attitude is not worse than more of the same"),
    ];
    context.measure(&population, &rows)
}

/// Sigmas of two days and two at another attitude over those of two days, and over those of four: geometric means
/// of the nine.
fn ratios(seed: u64) -> Result<[f64; 2], Error> {
    let [one, long, both] = [
        &[(seed, 2.0, ONE_DEG)][..],
        &[(seed, 4.0, ONE_DEG)],
        &[(seed, 2.0, ONE_DEG), (seed + 1, 2.0, OTHER_DEG)],
    ]
    .map(log_sigma);
    let both = both?;
    Ok([one?, long?].map(|other| (both - other).exp()))
}

/// Mean logarithm of the sigmas of the nine, of records of a seed, a number of days and an attitude.
fn log_sigma(records: &[(u64, f64, [f64; 3])]) -> Result<f64, Error> {
    let simulations = records.iter().map(|(seed, days, angles_deg)| {
        simulate(&Scenario {
            seed: *seed,
            coefficients: Coefficients::PAPER_LIKE,
            initial: InitialAttitude::AnglesDeg(*angles_deg),
            duration_s: days * 86_400.0,
            ..Scenario::default()
        })
    });
    let simulations = simulations.collect::<Result<Vec<_>, _>>()?;
    let runs = simulations.iter().map(run_of);
    let found = calibrate_runs(&runs.collect::<Vec<_>>(), &Options::default(), |_| ())?;
    Ok(mean((0..9).map(|i| 0.5 * found.covariance[i][i].ln())))
}
