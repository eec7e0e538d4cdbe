//! Makers of records: clean scenarios of the simulator, and edits of what it makes of them.

use gyrocal_record::{AXES, Bench, Record};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{Hidden, InitialAttitude, Population, Scenario, Simulation, simulate};

use crate::error::EvaluationError;

/// A record, or several to be diagnosed together, each with its bench description.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Made {
    pub(super) records: Vec<(Record, Bench)>,
    /// The axis that has what is to be told, if it is one.
    pub(super) axis: Option<usize>,
}

pub(super) type Result<T = Made> = core::result::Result<T, EvaluationError>;

/// Purposes of the random streams of signs of wrong keys, of sites, of edits and of a limit.
pub(super) const SIGNS: u64 = 31;
const SITES: u64 = 32;
pub(super) const EDITS: u64 = 33;
const LIMITS: u64 = 35;

/// Range of latitudes on both hemispheres: what is 20 degrees off is on the Earth still.
const LATITUDES_DEG: [f64; 2] = [10.0, 65.0];

/// The clean record of a number: two to four days, any attitude; all of a seed at one site.
pub(super) fn clean(seed: u64, number: u64) -> Scenario {
    let population = Population {
        duration_days: [2.0, 4.0],
        intervals_s: vec![60.0, 120.0, 180.0, 240.0],
        ..Population::new(seed)
    };
    let random = &mut Draw::new(seed, SITES);
    Scenario {
        latitude_deg: random.sign() * between(random, LATITUDES_DEG),
        ..population.scenario(number)
    }
}

pub(super) fn between(random: &mut Draw, [low, high]: [f64; 2]) -> f64 {
    low + (high - low) * random.uniform()
}

pub(super) fn axis_of(random: &mut Draw) -> usize {
    *random.one_of(&[0, 1, 2])
}

fn made(scenario: &Scenario) -> Result {
    Ok(of(simulate(scenario)?, None))
}

pub(super) fn of(Simulation { record, bench, .. }: Simulation, axis: Option<usize>) -> Made {
    Made {
        records: vec![(record, bench)],
        axis,
    }
}

/// A clean record of an edited scenario.
pub(super) fn plain(seed: u64, edit: impl FnOnce(&mut Scenario)) -> Result {
    let mut scenario = clean(seed, 0);
    edit(&mut scenario);
    made(&scenario)
}

/// A clean record with edited rows.
fn edited(seed: u64, edit: impl FnOnce(&mut Draw, &mut Record)) -> Result {
    let mut made = plain(seed, |_| ())?;
    edit(&mut Draw::new(seed, EDITS), &mut made.records[0].0);
    Ok(made)
}

/// A row between two shares of the record.
fn row(random: &mut Draw, record: &Record, shares: [f64; 2]) -> usize {
    (between(random, shares) * record.len() as f64) as usize
}

pub(super) fn irregular(seed: u64, most_missing: f64) -> Result {
    let mut made = plain(seed, |scenario| scenario.interval_s = 60.0)?;
    let random = &mut Draw::new(seed, EDITS);
    let record = &mut made.records[0].0;
    let missing = most_missing * random.uniform();
    let first = row(random, record, [0.2, 0.7]);
    let gap = first..first + record.len() / 10;
    let mut kept = Record::default();
    let mut at = 0;
    while at < record.len() {
        if !gap.contains(&at) {
            let keep = |value| {
                if random.uniform() < missing {
                    f64::NAN
                } else {
                    value
                }
            };
            kept.time_s.push(record.time_s[at]);
            kept.accel_g.push(record.accel_g[at].map(keep));
        }
        at += random.log_uniform([1.0, 31.0]) as usize;
    }
    *record = kept;
    Ok(made)
}

pub(super) fn one_bad_value(seed: u64) -> Result {
    edited(seed, |random, record| {
        let axis = axis_of(random);
        let count = (14_400.0 / record.duration_s() * record.len() as f64) as usize;
        let first = row(random, record, [0.1, 0.8]);
        let bad = first + (between(random, [0.2, 0.8]) * count as f64) as usize;
        let lost = (first..first + count).filter(|at| *at != bad);
        *record = record.without(lost.map(|at| [at, axis]));
        record.accel_g[bad][axis] += 0.05 * random.sign();
    })
}

pub(super) fn third_missing(seed: u64) -> Result {
    edited(seed, |random, record| {
        let axis = axis_of(random);
        let lost = (0..record.len()).filter(|_| random.uniform() < 1.0 / 3.0);
        *record = record.without(lost.map(|at| [at, axis]));
    })
}

/// Rows are means of ten minutes, each with the time of its middle, when the angles were measured.
pub(super) fn means(seed: u64) -> Result {
    const COUNT: usize = 11;
    let mut scenario = clean(seed, 0);
    scenario.interval_s = 60.0;
    let mut simulation = simulate(&scenario)?;
    let mean = |rows: &[[f64; 3]]| {
        core::array::from_fn(|axis| rows.iter().map(|row| row[axis]).sum::<f64>() / COUNT as f64)
    };
    let Record {
        time_s, accel_g, ..
    } = &simulation.record;
    simulation.record = Record {
        time_s: time_s
            .chunks_exact(COUNT)
            .map(|times| times[COUNT / 2])
            .collect(),
        accel_g: accel_g.chunks_exact(COUNT).map(mean).collect(),
        temperature_c: None,
    };
    simulation.bench.accel_noise_g /= (COUNT as f64).sqrt();
    let measured = simulation.truth.platform_c_enu[COUNT / 2].angles_deg();
    simulation.bench.initial_angles_deg = Some(measured);
    Ok(of(simulation, None))
}

pub(super) fn undeclared_south(seed: u64) -> Result {
    let mut made = plain(seed, |one| one.latitude_deg = -one.latitude_deg.abs())?;
    let bench = &mut made.records[0].1;
    bench.initial_angles_deg = None;
    bench.initial_angles_sigma_deg = [180.0; 3];
    Ok(made)
}

pub(super) fn near_singular(seed: u64) -> Result {
    plain(seed, |scenario| {
        let [x_deg, _, z_deg] = scenario.declared_angles_deg();
        scenario.initial = InitialAttitude::AnglesDeg([x_deg, 89.99, z_deg]);
    })
}

pub(super) fn coarse_gyros(seed: u64, range_deg_per_h: [f64; 2]) -> Result {
    let random = &mut Draw::new(seed, EDITS);
    plain(seed, |scenario| {
        let bias = core::array::from_fn(|_| random.sign() * random.log_uniform(range_deg_per_h));
        scenario.coefficients.bias_deg_per_h = bias;
        scenario.prior.bias_sigma_deg_per_h = [range_deg_per_h[1]; 3];
    })
}

pub(super) fn fine_gyros(seed: u64) -> Result {
    plain(seed, |scenario| {
        let fine = Population {
            largest_bias_deg_per_h: 1e-4,
            largest_g_deg_per_h_per_g: 1e-4,
            largest_gg_deg_per_h_per_g2: 1e-4,
            ..Population::new(seed)
        };
        scenario.coefficients = fine.scenario(0).coefficients;
        scenario.gyro_noise_deg_per_h = 1e-4;
    })
}

/// A deviate of Student's distribution (Bailey 1994).
pub(super) fn student(random: &mut Draw, degrees: f64) -> f64 {
    loop {
        let mut uniform = || 2.0 * random.uniform() - 1.0;
        let (u, v) = (uniform(), uniform());
        let square = u * u + v * v;
        if square > 0.0 && square < 1.0 {
            return u * (degrees * (libm::pow(square, -2.0 / degrees) - 1.0) / square).sqrt();
        }
    }
}

/// A record whose noise is `deviate` times the declared one, given the share of the record that is over.
pub(super) fn noisy(seed: u64, deviate: fn(&mut Draw, f64) -> f64) -> Result {
    let noise_g = clean(seed, 0).accel_noise_g;
    let mut made = plain(seed, |scenario| scenario.accel_noise_g = 0.0)?;
    let random = &mut Draw::new(seed, EDITS);
    let (record, bench) = &mut made.records[0];
    bench.accel_noise_g = noise_g;
    let rows = record.len() as f64;
    for (at, values) in record.accel_g.iter_mut().enumerate() {
        *values = values.map(|value| value + noise_g * deviate(random, at as f64 / rows));
    }
    Ok(made)
}

/// One axis ends at 0.7 to 0.95 of its largest force.
pub(super) fn clipped(seed: u64) -> Result {
    let mut made = noisy(seed, |random, _| student(random, 4.0))?;
    let random = &mut Draw::new(seed, LIMITS);
    let (record, bench) = &mut made.records[0];
    let axis = axis_of(random);
    let forces = record.accel_g.iter().map(|row| row[axis].abs());
    let limit_g = forces.fold(0.0, f64::max) * between(random, [0.7, 0.95]);
    for row in &mut record.accel_g {
        if row[axis].abs() > limit_g {
            let noise_g = bench.accel_noise_g * student(random, 4.0);
            row[axis] = limit_g.copysign(row[axis]) + noise_g;
        }
    }
    Ok(made)
}

pub(super) fn coarse_bits(seed: u64) -> Result {
    let mut scenario = clean(seed, 0);
    for axis in AXES {
        let lsb = [("lsb", 20.0 * scenario.accel_noise_g)];
        let id = format!("accel_{axis}.quantisation");
        scenario.hidden.push(Hidden::new(&id, &lsb)?);
    }
    made(&scenario)
}

pub(super) fn exchanged(seed: u64) -> Result {
    edited(seed, |random, record| {
        let [one, other] = *random.one_of(&[[0, 1], [1, 2], [0, 2]]);
        let from = row(random, record, [0.3, 0.7]);
        record.accel_g[from..]
            .iter_mut()
            .for_each(|row| row.swap(one, other));
    })
}

pub(super) fn clock_jump(seed: u64, by_s: f64) -> Result {
    edited(seed, |random, record| {
        let from = row(random, record, [0.3, 0.7]);
        record.time_s[from..]
            .iter_mut()
            .for_each(|time_s| *time_s += by_s);
    })
}

pub(super) fn clock_rate(seed: u64) -> Result {
    let mut scenario = clean(seed, 0);
    scenario.hidden = vec![Hidden::new("clock.rate", &[("size", 5e-5)])?];
    let mut made = made(&scenario)?;
    let random = &mut Draw::new(seed, EDITS);
    let times_s = made.records[0].0.time_s.iter_mut();
    times_s.for_each(|time_s| *time_s += 0.3 * random.normal());
    Ok(made)
}

/// Two records of two days each at one site, from two attitudes. D_F, D_I and D_II of the second's gyros are
/// larger or smaller by so much.
pub(super) fn two(seed: u64, [bias, g, gg]: [f64; 3]) -> Result {
    let random = &mut Draw::new(seed, EDITS);
    let first = clean(seed, 0);
    let mut records = Vec::new();
    for number in [0, 1] {
        let mut own = Scenario {
            coefficients: first.coefficients,
            interval_s: 120.0,
            duration_s: 2.0 * 86_400.0,
            ..clean(seed, number)
        };
        let mut change = |all: &mut [f64; 3], by: f64| {
            *all = all.map(|one| one + number as f64 * by * random.sign());
        };
        change(&mut own.coefficients.bias_deg_per_h, bias);
        change(&mut own.coefficients.g_deg_per_h_per_g, g);
        change(&mut own.coefficients.gg_deg_per_h_per_g2, gg);
        records.extend(made(&own)?.records);
    }
    let axis = None;
    Ok(Made { records, axis })
}

pub(super) fn second_in_other_unit(seed: u64) -> Result {
    let mut made = two(seed, [0.0; 3])?;
    let values = made.records[1].0.accel_g.iter_mut().flatten();
    values.for_each(|value| *value *= 9.806_65);
    Ok(made)
}
