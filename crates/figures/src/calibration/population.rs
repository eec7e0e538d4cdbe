//! A population of random records, calibrated by the batch estimator and compared with the truth.

use gyrocal_calibration::Options;
use gyrocal_evaluation::{BandedMean, CalibrationSummary, CalibrationTrial, Outcome};
use gyrocal_statistics::{Judgement, Proportion, mean};
use gyrocal_truth::Population;

use super::Error;
use crate::figure::{Figure, coverage};
use crate::resumable;

/// Seed of the population, fixed beforehand; no record of it is ever drawn again.
const SEED: u64 = 20_150_904;

/// Records of the population, and of the part of it that is run with `--small`.
const RECORDS: u64 = 2000;
const FEW: u64 = 60;

/// Root mean square error over Cramér–Rao bound.
const RATIO: [f64; 2] = [0.93, 1.07];

/// Coverage of 95 % intervals.
const COVERAGE: [f64; 2] = [0.93, 0.97];

/// Normal quantile of the two-sided 99.9 % interval.
const NORMAL_99_9: f64 = 3.2905;

pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let outcome = run(if small { FEW } else { RECORDS })?;
    let summary = CalibrationSummary::of(&outcome);
    let runs = summary.runs;
    let seeds = format!(
        "population {SEED}, 0 to {}",
        runs + summary.failures.len() - 1
    );
    let mut figures = vec![
        Figure::within(
            "records without a calibration",
            [0.0, 0.0],
            summary.failures.len() as f64,
        ),
        banded("mean NEES of the nine coefficients", summary.nees)?,
        Figure::note(
            "the same, expected of truths from this population",
            format!("{:.3}", 9.0 - mean(lacking(&outcome, |variance| variance))),
        ),
        banded(
            "mean NEES of the determined coefficients",
            summary.nees_determined,
        )?,
        nis(&outcome, summary.nis)?,
    ];
    for coefficient in &summary.coefficients {
        let name = &coefficient.name;
        let determined = coefficient.determined;
        let ratio = coefficient.rmse_over_bound.ok_or("a bound is missing")?;
        let what = format!("{name}: RMSE / Cramér–Rao bound");
        let mut figure = measured(&what, RATIO, ratio.value, ratio.interval, determined);
        if small {
            // The root of a mean square of so many scatters by this.
            let off = (ratio.value - 1.0).abs() - (RATIO[1] - 1.0);
            let scatter = NORMAL_99_9 / (2.0 * determined as f64).sqrt();
            let [low, high] = ratio.interval;
            let met = RATIO[0] <= low && high <= RATIO[1];
            figure = figure.judged(Judgement::of(met, off > scatter));
        }
        figures.push(figure);
        let of = coefficient.coverage.ok_or("no coverage")?;
        let what = format!("{name}: % of 95 % intervals that hold the truth");
        let percent = of.interval.map(|bound| 100.0 * bound);
        let bounds = COVERAGE.map(|bound| 100.0 * bound);
        let covered = Proportion {
            hits: (of.value * determined as f64).round() as u64,
            trials: determined as u64,
        };
        let mut figure = measured(&what, bounds, 100.0 * of.value, percent, determined);
        if small {
            figure = figure.judged(coverage(covered, COVERAGE));
        }
        figures.push(figure.of_share(covered));
    }
    for figure in &mut figures {
        if figure.runs == 1 {
            figure.runs = runs;
        }
        figure.seeds.clone_from(&seeds);
    }
    Ok(figures)
}

fn measured(what: &str, bounds: [f64; 2], value: f64, interval: [f64; 2], runs: usize) -> Figure {
    let mut figure = Figure::within(what, bounds, value);
    figure.measured += &format!(" (95 %: {:.3} to {:.3})", interval[0], interval[1]);
    figure.over(runs, "")
}

/// A mean of normalised squares in its 99.9 % band.
fn banded(what: &str, banded: Option<BandedMean>) -> Result<Figure, Error> {
    let banded = banded.ok_or("no record was calibrated")?;
    let mut figure = Figure::within(what, banded.band, banded.mean);
    let [low, high] = banded.band;
    figure.target = format!("{low:.3} to {high:.3} ({:.3} expected)", banded.expected);
    figure.measured += &format!(" (median {:.3})", banded.median);
    Ok(figure)
}

/// Mean NIS in its band. The least sum of squares has an element for each prior, which expects a
/// truth drawn from it.
fn nis(outcome: &Outcome<CalibrationTrial>, nis: Option<BandedMean>) -> Result<Figure, Error> {
    let nis = nis.ok_or("no record was calibrated")?;
    let rows: usize = outcome.successes().map(|(_, trial)| trial.rows).sum();
    let lacking = lacking(outcome, |variance| 1.0 - variance);
    let shift = lacking.iter().sum::<f64>() / rows as f64;
    let [low, high] = nis.band.map(|bound| bound - shift);
    let expected = nis.expected - shift;
    let what = "mean NIS of a row, for truths from this population";
    let mut figure = Figure::within(what, [low, high], nis.mean);
    figure.target = format!("{low:.5} to {high:.5} ({expected:.5} expected)");
    figure.measured = format!("{:.5} (median {:.5})", nis.mean, nis.median);
    Ok(figure)
}

/// Expected deficit of the normalised squares of each record to their number, because truths are uniform
/// and not from the prior, a normal distribution of sigma 1.
///
/// For consistent covariances, a truth of variance v takes (1 - v) P from the NEES of all nine
/// coefficients and (1 - v) (1 - P) from the least sum of squares, P being the coefficient's
/// posterior variance; `share` is of that.
fn lacking(outcome: &Outcome<CalibrationTrial>, share: impl Fn(f64) -> f64) -> Vec<f64> {
    let population = Population::new(SEED);
    let variances = [
        population.largest_bias_deg_per_h,
        population.largest_g_deg_per_h_per_g,
        population.largest_gg_deg_per_h_per_g2,
    ]
    .map(|largest| largest * largest / 3.0);
    let of = |trial: &CalibrationTrial| {
        let sigmas = trial.sigma.iter().enumerate();
        sigmas
            .map(|(i, sigma)| share(sigma * sigma) * (1.0 - variances[i % 3]))
            .sum()
    };
    outcome.successes().map(|(_, trial)| of(trial)).collect()
}

/// Runs the population; the full version is resumable.
fn run(records: u64) -> Result<Outcome<CalibrationTrial>, Error> {
    let population = Population::new(SEED);
    let options = Options::default();
    resumable::campaign("calibration", "population", 0..records, records == FEW)?
        .run(
            |number| CalibrationTrial::of(&population.scenario(number), &options),
            |progress| {
                if progress.done % 100 == 0 {
                    eprintln!("{} of {} records", progress.done, progress.total);
                }
            },
        )
        .map_err(Into::into)
}
