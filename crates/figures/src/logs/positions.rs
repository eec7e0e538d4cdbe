//! Tests of six and of twelve positions.

use gyrocal_instruments::multi_position::{
    MultiPositionSettings, Term, multi_position_test, prepare_logs,
};
use gyrocal_instruments::{InstrumentError, Log};
use gyrocal_record::AXES;
use gyrocal_statistics::NORMAL_97_5;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::units::position_test::{UnitErrors, positions, stop, vector};
use nalgebra::{Matrix3, Vector3};
use serde::{Deserialize, Serialize};

use super::unit::{DEG_PER_H, EARTH_DEG_PER_H};
use super::{REACHED, described, in_a_set, logs};
use crate::harness::{COVERAGE, Context, Error, Figure, Row};

/// Purpose of the stream of draws.
const ERRORS: u64 = 1804;

const RATE_HZ: f64 = 50.0;
const STOP_S: f64 = 60.0;

/// Sizes of a hidden term in its standard deviations, of six and of twelve positions, and the least share found.
const OF_SIX: ([f64; 2], f64) = ([20.0, 28.0], 0.8);
const OF_TWELVE: ([f64; 2], f64) = ([8.0, 16.0], 0.9);

/// Result of one test.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Test {
    /// Name of the hidden term, if there is one.
    hidden: Option<String>,
    /// Names that were found, each with its alternatives.
    found: Vec<Vec<String>>,
    /// Whether the intervals of the coefficients of gyros and of accelerometers contain the truth.
    gyros: Vec<bool>,
    accelerometers: Vec<bool>,
}

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for (count, first, hidden) in [(6, 820_000, OF_SIX), (12, 830_000, OF_TWELVE)] {
        let (name, job) = (format!("positions-{count}"), move |seed| {
            test(count, hidden.0, seed)
        });
        let population = logs(&name, [first, 300, 30], job);
        figures.extend(context.measure(&population, &rows(count, hidden))?);
    }
    Ok(figures)
}

fn rows(count: usize, (sizes, least): ([f64; 2], f64)) -> [Row<'static, Test>; 6] {
    let of = |name: &str| format!("{count} positions: {name}");
    let first = |test: &Test| {
        let hidden = test.hidden.as_ref()?;
        Some(test.found.first().and_then(|names| names.first()) == Some(hidden))
    };
    let [low, high] = sizes;
    let terms = of(&format!("g terms of d = {low:.0} to {high:.0} found"));
    let found = |test: &Test| test.hidden.as_ref().map(|_| !test.found.is_empty());
    let alone = |test: &Test| in_a_set(test.hidden.as_ref()?, &test.found);
    let clean = |test: &Test| test.hidden.is_none().then_some(test.found.is_empty());
    let gyros = of("coverage of coefficients of the gyros");
    let accelerometers = of("coverage of coefficients of the accelerometers");
    let more = "95 %; more in noise of which none is between stops, which no stop shows";
    let level = "the level is 1 %, and one more for a grid of levels of the noise";
    [
        Row::each(gyros, |test: &Test| test.gyros.clone()).at_least(COVERAGE[0], more),
        Row::each(accelerometers, |test: &Test| test.accelerometers.clone()).of_coverage(),
        Row::share(terms, found).at_least(least, REACHED),
        Row::share(of("where found, named alone or in a set"), alone)
            .at_least(0.95, "sets of 95 %"),
        Row::share(of("the same, the first name"), first),
        Row::share(of("clean tests without a finding"), clean).at_least(0.98, level),
    ]
}

/// A unit of ordinary errors in positions as somebody sets them, one log each, with a term across in
/// every second test.
fn test(count: usize, sizes: [f64; 2], seed: u64) -> Result<Test, InstrumentError> {
    let mut draw = Draw::new(seed, ERRORS);
    let samples = (STOP_S * RATE_HZ) as usize;
    let latitude_deg = 120.0 * draw.uniform() - 60.0;
    let (sine, cosine) = latitude_deg.to_radians().sin_cos();
    let noise = draw.log_uniform([2e-3, 1e-2]);
    let mut unit = unit(noise, &mut draw);
    let forces = positions(count, &mut draw);
    let hidden = (draw.uniform() < 0.5).then(|| {
        let gyro = (3.0 * draw.uniform()) as usize;
        (gyro, (gyro + 1 + (2.0 * draw.uniform()) as usize) % 3)
    });
    if let Some((gyro, axis)) = hidden {
        let of_noise = noise / DEG_PER_H / (samples as f64).sqrt();
        // A random heading adds half of the squared horizontal Earth rate at most.
        let of_heading = EARTH_DEG_PER_H * cosine;
        let sigma = (of_noise * of_noise + 0.5 * of_heading * of_heading).sqrt();
        let squares: f64 = forces.iter().map(|force| force[axis] * force[axis]).sum();
        let size = sizes[0] + (sizes[1] - sizes[0]) * draw.uniform();
        unit.gyro_g[(gyro, axis)] = draw.sign() * size * sigma / squares.sqrt() * DEG_PER_H;
    }
    let earth = [sine, cosine].map(|part| part * EARTH_DEG_PER_H * DEG_PER_H);
    let made = |force: &Vector3<f64>| {
        let made = stop(&unit, *force, samples, earth, &mut draw);
        let log = Log::from_samples(1.0 / RATE_HZ, made.gyro, made.accel);
        (log, made.stops)
    };
    let logs: Vec<_> = forces.iter().map(made).collect();
    let prepared = prepare_logs(&logs, &described(RATE_HZ, latitude_deg, "")?)?;
    let report = multi_position_test(&prepared.positions, &MultiPositionSettings::default())?;
    let contains =
        |truth: f64, estimate: f64, sigma: f64| (estimate - truth).abs() <= NORMAL_97_5 * sigma;
    let of_gyros = report.gyros.iter().enumerate().flat_map(|(gyro, law)| {
        let unit = &unit;
        law.extended.coefficients.iter().filter_map(move |one| {
            let mut terms = Term::NOMINAL.into_iter().chain(Term::catalogue(gyro));
            let term = terms.find(|term| term.id(gyro) == one.name)?;
            let truth = of_gyro(unit, gyro, term) / DEG_PER_H;
            Some(contains(truth, one.estimate, one.sigma))
        })
    });
    let truths = of_accelerometers(&unit);
    let of_accelerometers = prepared.accel_errors.iter().flat_map(|errors| {
        let all = errors.coefficients.iter().zip(&truths);
        let all = all.filter(|(one, _)| one.determined);
        all.map(|(one, truth)| contains(*truth, one.estimate, one.sigma))
    });
    let found = report.findings.iter();
    let found = found.map(|one| one.with_alternatives().map(str::to_owned).collect());
    Ok(Test {
        hidden: hidden.map(|(gyro, axis)| format!("gyro_{}.g_{}", AXES[gyro], AXES[axis])),
        found: found.collect(),
        gyros: of_gyros.collect(),
        accelerometers: of_accelerometers.collect(),
    })
}

fn unit(noise: f64, draw: &mut Draw) -> UnitErrors {
    let mut vector = |size: f64| vector(draw) * size;
    // Misalignments as large as the calibration expects them to be.
    let (scale, misalignment) = (vector(0.005), vector(0.01));
    let mut accel_matrix = Matrix3::from_diagonal(&(Vector3::repeat(1.0) + scale));
    accel_matrix[(0, 1)] = misalignment.x * accel_matrix[(0, 0)];
    accel_matrix[(0, 2)] = misalignment.y * accel_matrix[(0, 0)];
    accel_matrix[(1, 2)] = misalignment.z * accel_matrix[(1, 1)];
    UnitErrors {
        // Half a degree a second.
        gyro_bias: vector(0.5_f64.to_radians()),
        gyro_g: Matrix3::from_diagonal(&vector(50.0 * DEG_PER_H)),
        gyro_gg: vector(20.0 * DEG_PER_H),
        accel_bias: vector(0.02),
        accel_matrix,
        gyro_noise: noise,
        accel_noise: 1e-3,
    }
}

/// True coefficient of a gyro \[rad/s and g\].
fn of_gyro(unit: &UnitErrors, gyro: usize, term: Term) -> f64 {
    match term.factors(gyro)[..] {
        [] if term == Term::Nominal(0) => unit.gyro_bias[gyro],
        [axis] => unit.gyro_g[(gyro, axis)],
        [one, other] if one == gyro && other == gyro => unit.gyro_gg[gyro],
        _ => 0.0,
    }
}

/// True errors of the accelerometers in the order of the result.
fn of_accelerometers(unit: &UnitErrors) -> Vec<f64> {
    let matrix = &unit.accel_matrix;
    let scales = (0..3).map(|axis| matrix[(axis, axis)] - 1.0);
    let across = [(0, 1), (0, 2), (1, 2)];
    let misalignments = across.map(|(axis, other)| matrix[(axis, other)] / matrix[(axis, axis)]);
    let biases = unit.accel_bias.iter().copied();
    biases.chain(scales).chain(misalignments).collect()
}
