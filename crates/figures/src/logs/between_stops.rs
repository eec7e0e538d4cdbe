//! Multi-position tests of gyros whose noise between stops no stop shows.

use core::ops::Range;

use gyrocal_instruments::multi_position::{
    Instrument, MultiPositionSettings, Positions, Term, multi_position_test,
};
use gyrocal_instruments::{InstrumentError, Log, stop_means};
use gyrocal_statistics::NORMAL_97_5;
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::units::position_test::vector;
use gyrocal_truth::units::sensor_noise::SensorNoise;
use nalgebra::{DMatrix, DVector, Vector3};
use serde::{Deserialize, Serialize};

use super::unit::DEG_PER_H;
use super::{REACHED, in_a_set, logs};
use crate::harness::{Context, Error, Figure, Row};

/// Purpose of the stream of draws.
const POSITIONS: u64 = 1806;

/// Samples of a stop and of a turn, one a second.
const STOP: usize = 32;
const TURN: usize = 8;

/// Standard error of a stop \[deg/h\].
const ERROR_DEG_PER_H: f64 = 10.0;

/// Noise between stops, in standard errors of a stop: its name, scatter, flicker (B), walk from stop to stop.
const NOISES: [(&str, [f64; 3]); 6] = [
    ("white", [0.0; 3]),
    ("flicker", [0.0, 7.0, 0.0]),
    ("walk", [0.0, 0.0, 5.0]),
    ("scatter of 3", [3.0, 0.0, 0.0]),
    ("scatter of 10", [10.0, 0.0, 0.0]),
    ("scatter and flicker", [3.0, 2.0, 0.0]),
];

/// Noises in which terms are hidden too: their standard deviation is known.
const OF_KNOWN_SIGMA: [usize; 3] = [0, 3, 4];

/// Stops, first seed, size of hidden terms in standard deviations, and least share of them that is found.
const TESTS: [(usize, u64, f64, f64); 6] = [
    (6, 840_000, 20.0, 0.8),
    (8, 850_000, 12.0, 0.85),
    (12, 860_000, 8.0, 0.9),
    (14, 890_000, 8.0, 0.9),
    (20, 870_000, 8.0, 0.9),
    (38, 905_000, 8.0, 0.9),
];

/// A sixth of the records of the full size are of each noise: half of those in which terms are hidden have one.
const FULL: u64 = 12_000;
const SMALL: u64 = 72;

/// Result of one test.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Test {
    noise: usize,
    hidden: Option<String>,
    /// Names that were found, each with its alternatives.
    found: Vec<Vec<String>>,
    /// Whether the intervals of the coefficients hold the truth.
    within: Vec<bool>,
}

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = Vec::new();
    for (stops, first, size, least) in TESTS {
        let (name, job) = (format!("between-stops-{stops}"), move |seed| {
            test(stops, size, seed)
        });
        let population = logs(&name, [first, FULL, SMALL], job);
        figures.extend(context.measure(&population, &rows(stops, size, least))?);
    }
    Ok(figures)
}

fn rows(stops: usize, size: f64, least: f64) -> Vec<Row<'static, Test>> {
    let mut rows = Vec::new();
    for (noise, (name, _)) in NOISES.iter().enumerate() {
        let of = |what: &str| format!("{stops} stops, {name}: {what}");
        let is_sound = move |test: &Test| test.noise == noise && test.hidden.is_none();
        let named = move |test: &Test| is_sound(test).then_some(!test.found.is_empty());
        let within = move |test: &Test| match is_sound(test) {
            true => test.within.clone(),
            false => Vec::new(),
        };
        let white = "95 %; more in white noise, which no stop shows to be all there is";
        rows.extend([
            Row::share(of("a term named in sound gyros"), named)
                .at_most(0.021, "1 % is promised; of a thousand, 21 hold 99.9 %"),
            Row::each(of("coefficients in their intervals"), within).at_least(0.93, white),
        ]);
    }
    let of = |what: &str| format!("{stops} stops: terms of {size:.0} sigma{what}");
    let found = |test: &Test| test.hidden.as_ref().map(|_| !test.found.is_empty());
    rows.extend([
        Row::share(of(" found"), found).at_least(least, REACHED),
        Row::share(of(", where found, in their set"), |test: &Test| {
            in_a_set(test.hidden.as_ref()?, &test.found)
        })
        .at_least(0.95, "sets of 95 %"),
    ]);
    rows
}

/// Gyros without any drift but, in some, one term, at stops in attitudes of which half are at faces and edges.
fn test(stops: usize, size: f64, seed: u64) -> Result<Test, InstrumentError> {
    let mut draw = Draw::new(seed, POSITIONS);
    let noise = (seed % NOISES.len() as u64) as usize;
    let hides = OF_KNOWN_SIGMA.contains(&noise) && seed / NOISES.len() as u64 % 2 == 1;
    let forces: Vec<Vector3<f64>> = (0..stops).map(|stop| attitude(stop, &mut draw)).collect();
    let (_, [scatter, flicker, walk]) = NOISES[noise];
    let law = SensorNoise {
        random_walk: ERROR_DEG_PER_H * (STOP as f64).sqrt(),
        bias_instability: ERROR_DEG_PER_H * flicker,
        rate_random_walk: ERROR_DEG_PER_H * walk / ((STOP + TURN) as f64).sqrt(),
        ..SensorNoise::default()
    };
    let samples = stops * (STOP + TURN);
    let rates = (0..3).map(|gyro| law.rates(samples, seed * 3 + gyro));
    let mut rates: Vec<Vec<f64>> = rates.collect();
    for rates in &mut rates {
        for stop in rates.chunks_exact_mut(STOP + TURN) {
            let own = ERROR_DEG_PER_H * scatter * draw.normal();
            stop.iter_mut().for_each(|rate| *rate += own);
        }
    }
    let sigma = ERROR_DEG_PER_H * (1.0 + scatter * scatter).sqrt();
    let hidden = match hides {
        true => hide(&mut rates, &forces, size * sigma, &mut draw),
        false => None,
    };
    let positions = positions(&rates, &forces)?;
    let (found, within) = tested(&positions)?;
    Ok(Test {
        noise,
        hidden,
        found,
        within,
    })
}

fn attitude(stop: usize, draw: &mut Draw) -> Vector3<f64> {
    if stop % 2 == 1 {
        return vector(draw).normalize();
    }
    // The first six of these are the faces in a random order of signs, the others edges.
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut force = draw.sign() * axes[stop / 2 % 3];
    if stop >= 6 {
        force += draw.sign() * axes[(stop / 2 + 1) % 3];
    }
    (force.normalize() + 0.02 * vector(draw)).normalize()
}

/// Adds a term of so much over what the nominal law leaves of its column; `None` of one that it leaves little of.
fn hide(
    rates: &mut [Vec<f64>],
    forces: &[Vector3<f64>],
    size_deg_per_h: f64,
    draw: &mut Draw,
) -> Option<String> {
    /// Least length of a column beside the nominal law.
    const LEAST_LEFT: f64 = 0.3;
    let gyro = (3.0 * draw.uniform()) as usize;
    let mut terms: Vec<Term> = Term::catalogue(gyro).into_iter().collect();
    terms.retain(|term| *term != Term::Ramp);
    let term = terms[(terms.len() as f64 * draw.uniform()) as usize];
    let of = |force: &Vector3<f64>, term: Term| -> f64 {
        let factors = term.factors(gyro).into_iter();
        factors.map(|axis| force[axis]).product()
    };
    let column = DVector::from_iterator(forces.len(), forces.iter().map(|force| of(force, term)));
    let law = DMatrix::from_fn(forces.len(), Term::NOMINAL.len(), |stop, power| {
        of(&forces[stop], Term::NOMINAL[power])
    });
    let span = law.qr().q();
    let left = (&column - &span * span.tr_mul(&column)).norm();
    if left < LEAST_LEFT {
        return None;
    }
    let coefficient = draw.sign() * size_deg_per_h / left;
    for (stop, value) in rates[gyro].chunks_exact_mut(STOP + TURN).zip(&column) {
        stop.iter_mut()
            .for_each(|rate| *rate += coefficient * value);
    }
    Some(term.id(gyro).to_owned())
}

fn positions(rates: &[Vec<f64>], forces: &[Vector3<f64>]) -> Result<Positions, InstrumentError> {
    let samples = rates[0].len();
    let gyro = (0..samples).map(|at| core::array::from_fn(|axis| rates[axis][at] * DEG_PER_H));
    let accel = (0..samples).map(|at| forces[at / (STOP + TURN)].into());
    let log = Log::from_samples(1.0, gyro.collect(), accel.collect());
    let begins = (0..forces.len()).map(|stop| stop * (STOP + TURN));
    let stops: Vec<Range<usize>> = begins.map(|from| from..from + STOP).collect();
    let instrument = Instrument {
        accel: None,
        outputs_per_rad_per_s: [1.0; 3],
        latitude_deg: None,
    };
    Ok(Positions::new(&stop_means(&log, &stops)?, &instrument))
}

/// Names that a test finds, and whether its coefficients, which are zero, are in their intervals.
fn tested(positions: &Positions) -> Result<(Vec<Vec<String>>, Vec<bool>), InstrumentError> {
    let report = multi_position_test(positions, &MultiPositionSettings::default())?;
    let found = report.findings.iter();
    let found = found.map(|finding| finding.with_alternatives().map(str::to_owned).collect());
    let coefficients = report.gyros.iter();
    let coefficients = coefficients.flat_map(|gyro| &gyro.extended.coefficients);
    let within = coefficients.map(|one| one.estimate.abs() <= NORMAL_97_5 * one.sigma);
    Ok((found.collect(), within.collect()))
}
