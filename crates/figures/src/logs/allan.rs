//! Coefficients of the noise of gyros at rest.

use gyrocal_evaluation::Statistic;
use gyrocal_instruments::{AllanSettings, allan_values};
use gyrocal_statistics::NORMAL_97_5;
use gyrocal_statistics::allan::{AllanEstimator, NoiseFit, NoisePart};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::units::sensor_noise::{Filter, SensorNoise};
use serde::{Deserialize, Serialize};

use super::logs;
use crate::harness::{Context, Error, Figure, Row};

/// Purpose of the stream of draws.
const LEVELS: u64 = 1801;

/// Samples of a record.
const SAMPLES: [f64; 2] = [3e3, 2e4];

/// What is in a record beside noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
enum Kind {
    Clean,
    Spikes,
    Tone,
    Filtered,
    Quantised,
    Held,
}

/// Kinds of records in words; the seed of a record tells its own.
const KINDS: [(Kind, &str); 6] = [
    (Kind::Clean, "clean"),
    (Kind::Spikes, "spikes, 1 of 1000 samples"),
    (Kind::Tone, "a tone"),
    (Kind::Filtered, FILTERED),
    (Kind::Quantised, "quantised"),
    (Kind::Held, "held samples"),
];

const FILTERED: &str = "a low-pass filter, corner 0.012 to 0.4 of the rate";

/// Result for one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Record {
    kind: Kind,
    /// Whether each part is told and its interval contains the truth.
    covered: [Option<bool>; 4],
    /// Difference of the halves of the record in standard deviations, for parts that the record tells within
    /// a half.
    halves: [Option<f64>; 4],
    /// Whether the record has the tone, the filter or the repetition of its kind, and no other.
    told: bool,
}

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    context.measure(&logs("allan", [810_000, 1200, 24], record), &rows())
}

fn rows() -> Vec<Row<'static, Record>> {
    let mut rows = Vec::new();
    for (index, part) in NoisePart::ALL.into_iter().enumerate() {
        let name = format!("Allan, {}: coverage of 95 % intervals", part.description());
        rows.push(Row::share(name, move |one: &Record| one.covered[index]));
    }
    for (kind, words) in KINDS {
        let name = format!("Allan, all parts, {words}: coverage of 95 % intervals");
        rows.push(Row::each(name, move |one: &Record| {
            let own = if one.kind == kind { 4 } else { 0 };
            one.covered.into_iter().take(own).flatten()
        }));
    }
    let cover = |row: Row<'static, Record>| row.of_coverage();
    let mut rows: Vec<Row<'_, Record>> = rows.into_iter().map(cover).collect();
    let halves = |records: &[Record]| {
        let halves = records.iter().flat_map(|one| one.halves).flatten();
        Statistic::RmsRatio(halves.map(|z| [z, 1.0]).collect())
    };
    let between = "Allan, between halves of one record: rms z of parts told within a half";
    let reason = "one is expected; a tenth of sigma for the normal shape of intervals";
    let told = "Allan, records whose tone, filter or repetition is told, and no other";
    let sums = "Allan, records with coefficients: the others are told to be no sum of the parts";
    rows.extend([
        Row::new(between, halves).between([0.9, 1.1], reason),
        Row::share(told, |one: &Record| Some(one.told)),
        Row::share(sums, |one: &Record| Some(one.covered[1].is_some())),
    ]);
    rows
}

/// A record of 1 Hz with an angle random walk of one. Crossovers of the parts are uniform in the logarithm
/// of the averaging time, many of them beyond the record.
fn record(seed: u64) -> Result<Record, Error> {
    let (kind, _) = KINDS[seed as usize % KINDS.len()];
    let mut draw = Draw::new(seed, LEVELS);
    let count = draw.log_uniform(SAMPLES);
    let flat = draw.log_uniform([10.0, 3.0 * count]);
    let walk = draw.log_uniform([30.0, 3.0 * count]);
    let quantised = draw.log_uniform([0.3, 30.0]) / 3.0_f64.sqrt();
    let time = draw.log_uniform([0.4, 13.0]);
    let filters = [
        Filter::Lag(time),
        Filter::TwoLags(time),
        Filter::MovingMean(2 + time as usize),
    ];
    let noise = SensorNoise {
        quantisation: f64::from(kind == Kind::Quantised) * quantised,
        random_walk: 1.0,
        bias_instability: 1.0 / (NoisePart::FLAT_VARIANCE * flat).sqrt(),
        rate_random_walk: 3.0_f64.sqrt() / walk,
        filter: match kind {
            Kind::Filtered => *draw.one_of(&filters),
            _ => Filter::None,
        },
    };
    let mut rates = noise.rates(count as usize, seed);
    let each = add(kind, &mut rates, &mut draw);
    let interval_s = 1.0 / each as f64;
    let whole = fitted(&rates, interval_s)?;
    let middle = rates.len() / 2;
    let first = fitted(&rates[..middle], interval_s)?;
    let last = fitted(&rates[middle..], interval_s)?;
    let (flicker, walk) = (noise.bias_instability, noise.rate_random_walk);
    let truth = [noise.quantisation, 1.0, flicker, walk];
    let covered = |part: usize| {
        let [low, high] = whole.coefficients[part].interval?;
        Some((low..=high).contains(&truth[part]))
    };
    let found = [
        whole.tones.len() == 1,
        whole.filter_corner_hz.is_some(),
        whole.samples_per_value == Some(each as f64),
    ];
    let expected = [Kind::Tone, Kind::Filtered, Kind::Held].map(|of| kind == of);
    Ok(Record {
        kind,
        covered: core::array::from_fn(covered),
        halves: [0, 1, 2, 3].map(|part| {
            let difference = difference(&first, &last, part)?;
            is_told(&whole, part).then_some(difference)
        }),
        told: found == expected && whole.tones.len() < 2,
    })
}

/// Adds what is no noise of a kind to a record; returns the samples for each value.
fn add(kind: Kind, rates: &mut Vec<f64>, draw: &mut Draw) -> usize {
    match kind {
        Kind::Spikes => {
            for place in (500..rates.len()).step_by(1000) {
                rates[place] += draw.sign() * draw.log_uniform([15.0, 1500.0]);
            }
        }
        Kind::Tone => {
            let amplitude = draw.log_uniform([0.3, 3.0]);
            let turn = core::f64::consts::TAU * draw.log_uniform([0.005, 0.4]);
            for (row, rate) in rates.iter_mut().enumerate() {
                *rate += amplitude * (turn * row as f64).sin();
            }
        }
        Kind::Held => {
            let each = 2 + draw.log_uniform([1.0, 8.0]) as usize;
            *rates = rates.iter().flat_map(|rate| vec![*rate; each]).collect();
            return each;
        }
        _ => {}
    }
    1
}

fn fitted(rates: &[f64], interval_s: f64) -> Result<NoiseFit, Error> {
    let settings = AllanSettings {
        rate_hz: 1.0 / interval_s,
        scale: 1.0,
        confidence: 0.95,
        estimator: AllanEstimator::Overlapping,
    };
    let column = allan_values("rate", rates, &settings)?;
    column.noise.ok_or_else(|| "a record without a fit".into())
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
