//! Coefficients of the noise of gyros at rest, from Allan deviations.

use gyrocal_evaluation::Statistic;
use gyrocal_statistics::allan::{NoiseFit, NoisePart, allan_deviation, fit_noise, octaves};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::{NORMAL_97_5, StatisticsError};
use gyrocal_truth::units::sensor_noise::{Filter, SensorNoise};
use serde::{Deserialize, Serialize};

use super::logs;
use crate::error::Error;
use crate::figure::Figure;
use crate::harness::{COVERAGE, COVERAGE_REASON, Context, Row};

/// Purpose of the stream of draws.
const LEVELS: u64 = 1801;

/// Samples of a record.
const SAMPLES: [f64; 2] = [3e3, 2e4];

/// Result for one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Record {
    filtered: bool,
    correlated: bool,
    /// Whether each part is told and its interval contains the truth.
    covered: [Option<bool>; 4],
    /// Difference of the halves of the record in standard deviations, for parts that the record tells within
    /// a half.
    halves: [Option<f64>; 4],
}

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    context.measure(&logs("allan", [810_000, 500, 12], record), &rows())
}

fn rows() -> Vec<Row<'static, Record>> {
    let mut rows = Vec::new();
    for (index, part) in NoisePart::ALL.into_iter().enumerate() {
        let name = format!("Allan, {}: coverage of 95 % intervals", part.description());
        rows.push(Row::share(name, move |one: &Record| one.covered[index]));
    }
    for (filtered, kind) in [(false, "not filtered"), (true, "filtered")] {
        let name = format!("Allan, all parts, records {kind}: coverage of 95 % intervals");
        rows.push(Row::each(name, move |one: &Record| {
            let own = if one.filtered == filtered { 4 } else { 0 };
            one.covered.into_iter().take(own).flatten()
        }));
    }
    let cover = |row: Row<'static, Record>| row.between(COVERAGE, COVERAGE_REASON);
    let mut rows: Vec<Row<'_, Record>> = rows.into_iter().map(cover).collect();
    let halves = |records: &[Record]| {
        let halves = records
            .iter()
            .flat_map(|one| one.halves.into_iter().flatten());
        Statistic::RmsRatio(halves.map(|z| [z, 1.0]).collect())
    };
    let of_kind =
        |filtered: bool| move |one: &Record| (one.filtered == filtered).then_some(one.correlated);
    rows.extend([
        Row::new(
            "Allan, between halves of one record: rms z of parts told within a half",
            halves,
        )
        .between(
            [0.9, 1.1],
            "one is expected; a tenth of sigma for the normal shape of intervals",
        ),
        Row::share(
            "Allan, filtered records whose samples are told to be correlated",
            of_kind(true),
        ),
        Row::share(
            "Allan, the same of records that are not filtered",
            of_kind(false),
        ),
        Row::share(
            "Allan, records with coefficients: the others are told to be no sum of the parts",
            |one: &Record| Some(one.covered[1].is_some()),
        ),
    ]);
    rows
}

/// A record of 1 Hz with an angle random walk of one. Crossovers of the parts are uniform in the logarithm
/// of the averaging time, many of them beyond the record.
fn record(seed: u64) -> Result<Record, StatisticsError> {
    let mut draw = Draw::new(seed, LEVELS);
    let count = draw.log_uniform(SAMPLES);
    let quantised = draw.log_uniform([0.3, 30.0]);
    let quantisation = if draw.uniform() < 0.5 {
        quantised / 3.0_f64.sqrt()
    } else {
        0.0
    };
    let flat = draw.log_uniform([10.0, 3.0 * count]);
    let bias_instability = 1.0 / (NoisePart::FLAT_VARIANCE * flat).sqrt();
    let walk = draw.log_uniform([30.0, 3.0 * count]);
    let kind = draw.uniform();
    let time = draw.log_uniform([1.0, 10.0]);
    let filter = match kind {
        kind if kind < 0.5 => Filter::None,
        kind if kind < 0.67 => Filter::Lag(time),
        kind if kind < 0.84 => Filter::TwoLags(time),
        _ => Filter::MovingMean(2 + time as usize),
    };
    let noise = SensorNoise {
        quantisation,
        random_walk: 1.0,
        bias_instability,
        rate_random_walk: 3.0_f64.sqrt() / walk,
        filter,
    };
    let rates = noise.rates(count as usize, seed);
    let whole = fitted(&rates)?;
    let middle = rates.len() / 2;
    let [first, last] = [fitted(&rates[..middle])?, fitted(&rates[middle..])?];
    let truth = [quantisation, 1.0, bias_instability, noise.rate_random_walk];
    let covered = |part: usize| {
        let [low, high] = whole.coefficients[part].interval?;
        Some((low..=high).contains(&truth[part]))
    };
    Ok(Record {
        filtered: filter != Filter::None,
        correlated: whole.correlated_samples,
        covered: core::array::from_fn(covered),
        halves: core::array::from_fn(|part| {
            is_told(&whole, part)
                .then(|| difference(&first, &last, part))
                .flatten()
        }),
    })
}

fn fitted(rates: &[f64]) -> Result<NoiseFit, StatisticsError> {
    let points = allan_deviation(rates, 1.0, &octaves(rates.len()), 0.95)?;
    fit_noise(&points, rates.len())
}

/// `true` if the interval begins above half of the estimate.
fn is_told(fit: &NoiseFit, part: usize) -> bool {
    let coefficient = fit.coefficients[part];
    let ends = coefficient.estimate.zip(coefficient.interval);
    ends.is_some_and(|(estimate, [low, _])| low > 0.5 * estimate)
}

/// Difference over the ends of the intervals that face each other.
fn difference(first: &NoiseFit, last: &NoiseFit, part: usize) -> Option<f64> {
    let of = |fit: &NoiseFit| {
        let coefficient = fit.coefficients[part];
        Some((coefficient.estimate?, coefficient.interval?))
    };
    let ((one, [one_low, one_high]), (other, [other_low, other_high])) = (of(first)?, of(last)?);
    let (a, b) = match one > other {
        true => (one - one_low, other_high - other),
        false => (one_high - one, other - other_low),
    };
    Some(NORMAL_97_5 * (one - other) / (a * a + b * b).sqrt())
}
