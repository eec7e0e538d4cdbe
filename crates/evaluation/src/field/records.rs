//! Makers of records: clean scenarios of the simulator, and edits of what it makes of them.

use gyrocal_record::{Bench, Record};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::faults::noise::{add_noise, quantised, student, with_noise};
use gyrocal_truth::faults::rows::clip;
use gyrocal_truth::faults::{Broken, any_scenario, leave_angles_out};
use gyrocal_truth::{Hidden, InitialAttitude, Population, Scenario, Simulation, simulate};

use crate::error::EvaluationError;

/// A record, or several to be diagnosed together, each with its bench description.
pub(super) struct Made {
    pub(super) records: Vec<(Record, Bench)>,
    /// The axis that has what is to be told, if it is one.
    pub(super) axis: Option<usize>,
}

pub(super) type Result<T = Made> = core::result::Result<T, EvaluationError>;

/// Purposes of the random streams of signs of wrong keys and of edits.
pub(super) const SIGNS: u64 = 31;
pub(super) const EDITS: u64 = 33;

/// Range of latitudes on both hemispheres: what is 20 degrees off is on the Earth still.
const LATITUDES_DEG: [f64; 2] = [10.0, 65.0];

/// The clean record of a number, with a row each two minutes; all of a seed at one site.
pub(super) fn clean(seed: u64, number: u64) -> Scenario {
    Scenario {
        interval_s: 120.0,
        ..any_scenario(seed, number, LATITUDES_DEG)
    }
}

pub(super) fn between(random: &mut Draw, [low, high]: [f64; 2]) -> f64 {
    low + (high - low) * random.uniform()
}

pub(super) fn axis_of(random: &mut Draw) -> usize {
    *random.one_of(&[0, 1, 2])
}

fn made(records: Vec<(Record, Bench)>) -> Made {
    let axis = None;
    Made { records, axis }
}

pub(super) fn of(Simulation { record, bench, .. }: Simulation, axis: Option<usize>) -> Made {
    let records = vec![(record, bench)];
    Made { records, axis }
}

/// A record of an edited scenario.
pub(super) fn plain(seed: u64, edit: impl FnOnce(&mut Scenario)) -> Result {
    let mut scenario = clean(seed, 0);
    edit(&mut scenario);
    Ok(of(simulate(&scenario)?, None))
}

/// The record of a scenario, spoilt.
fn spoilt(seed: u64, scenario: &Scenario, spoil: impl FnOnce(&mut Broken)) -> Result {
    let mut broken = Broken::of(simulate(scenario)?, Draw::new(seed, EDITS));
    spoil(&mut broken);
    Ok(made(vec![(broken.record, broken.bench)]))
}

/// A clean record with a row each minute, spoilt.
pub(super) fn broken(seed: u64, spoil: impl FnOnce(&mut Broken)) -> Result {
    let scenario = any_scenario(seed, 0, LATITUDES_DEG);
    spoilt(seed, &scenario, spoil)
}

/// Rows 1 to 30 minutes apart, a gap of a tenth, and values missing.
pub(super) fn irregular(Broken { record, random, .. }: &mut Broken, most_missing: f64) {
    let missing = most_missing * random.uniform();
    let first = (between(random, [0.2, 0.7]) * record.len() as f64) as usize;
    let gap = first..first + record.len() / 10;
    let mut kept = Record::default();
    let mut at = 0;
    while at < record.len() {
        if !gap.contains(&at) {
            let keep = |value| match random.uniform() < missing {
                true => f64::NAN,
                false => value,
            };
            kept.time_s.push(record.time_s[at]);
            kept.accel_g.push(record.accel_g[at].map(keep));
        }
        at += random.log_uniform([1.0, 31.0]) as usize;
    }
    *record = kept;
}

pub(super) fn one_bad_value(Broken { record, random, .. }: &mut Broken) {
    let axis = axis_of(random);
    let first = (between(random, [0.1, 0.8]) * record.len() as f64) as usize;
    let bad = first + between(random, [48.0, 192.0]) as usize;
    let lost = (first..first + 240).filter(|at| *at != bad);
    *record = record.without(lost.map(|at| [at, axis]));
    record.accel_g[bad][axis] += 0.05 * random.sign();
}

pub(super) fn third_missing(Broken { record, random, .. }: &mut Broken) {
    let axis = axis_of(random);
    let lost = (0..record.len()).filter(|_| random.uniform() < 1.0 / 3.0);
    *record = record.without(lost.map(|at| [at, axis]));
}

/// Rows are means of eleven of a minute, each with the time of its middle, when the angles were measured.
pub(super) fn means(seed: u64) -> Result {
    const COUNT: usize = 11;
    let Simulation {
        record,
        mut bench,
        truth,
    } = simulate(&any_scenario(seed, 0, LATITUDES_DEG))?;
    let mean = |rows: &[[f64; 3]]| {
        core::array::from_fn(|axis| rows.iter().map(|row| row[axis]).sum::<f64>() / COUNT as f64)
    };
    let times = record.time_s.chunks_exact(COUNT);
    let record = Record {
        time_s: times.map(|times| times[COUNT / 2]).collect(),
        accel_g: record.accel_g.chunks_exact(COUNT).map(mean).collect(),
        temperature_c: None,
    };
    bench.accel_noise_g /= (COUNT as f64).sqrt();
    bench.initial_angles_deg = Some(truth.platform_c_enu[COUNT / 2].angles_deg());
    Ok(made(vec![(record, bench)]))
}

pub(super) fn undeclared_south(seed: u64) -> Result {
    let mut scenario = clean(seed, 0);
    scenario.latitude_deg = -scenario.latitude_deg.abs();
    spoilt(seed, &scenario, |all| leave_angles_out(&mut all.bench))
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

/// A record whose noise is `deviate` times the declared one, given the share of the record that is over.
pub(super) fn noisy(seed: u64, deviate: fn(&mut Draw, f64) -> f64) -> Result {
    let random = &mut Draw::new(seed, EDITS);
    let simulation = with_noise(&clean(seed, 0), |share| deviate(random, share))?;
    Ok(of(simulation, None))
}

/// One axis ends at 0.7 to 0.95 of its largest force, with noise of t4 after the limit.
pub(super) fn clipped(seed: u64) -> Result {
    let scenario = clean(seed, 0);
    let quiet = Scenario {
        accel_noise_g: 0.0,
        ..scenario.clone()
    };
    spoilt(seed, &quiet, |broken| {
        clip(broken, 0.0);
        let Broken { record, random, .. } = broken;
        add_noise(record, scenario.accel_noise_g, |_| student(random, 4));
        broken.bench = scenario.bench();
    })
}

pub(super) fn coarse_bits(seed: u64) -> Result {
    let hidden = quantised(20.0 * clean(seed, 0).accel_noise_g)?.to_vec();
    plain(seed, |scenario| scenario.hidden = hidden)
}

pub(super) fn clock_rate(seed: u64) -> Result {
    let mut scenario = clean(seed, 0);
    scenario.hidden = vec![Hidden::new("clock.rate", &[("size", 5e-5)])?];
    spoilt(seed, &scenario, |Broken { record, random, .. }| {
        let times_s = record.time_s.iter_mut();
        times_s.for_each(|time_s| *time_s += 0.3 * random.normal());
    })
}

/// Two records of two days each at one site, from two attitudes. D_F, D_I and D_II of the second's gyros are
/// larger or smaller by so much.
pub(super) fn two(seed: u64, [bias, g, gg]: [f64; 3]) -> Result {
    let random = &mut Draw::new(seed, EDITS);
    let coefficients = clean(seed, 0).coefficients;
    let mut records = Vec::new();
    for number in [0, 1] {
        let mut own = Scenario {
            coefficients,
            duration_s: 2.0 * 86_400.0,
            ..clean(seed, number)
        };
        let mut change = |all: &mut [f64; 3], by: f64| {
            *all = all.map(|one| one + number as f64 * by * random.sign());
        };
        change(&mut own.coefficients.bias_deg_per_h, bias);
        change(&mut own.coefficients.g_deg_per_h_per_g, g);
        change(&mut own.coefficients.gg_deg_per_h_per_g2, gg);
        let Simulation { record, bench, .. } = simulate(&own)?;
        records.push((record, bench));
    }
    Ok(made(records))
}

pub(super) fn second_in_other_unit(seed: u64) -> Result {
    let mut made = two(seed, [0.0; 3])?;
    let values = made.records[1].0.accel_g.iter_mut().flatten();
    values.for_each(|value| *value *= 9.806_65);
    Ok(made)
}

/// A record of 2 to 400 rows, of which up to 30 % are missing as a whole and up to 30 % of the values; one in three
/// has its angles left out, one in three a noise that is three times the declared.
pub(super) fn short(seed: u64) -> Result {
    let mut scenario = any_scenario(seed, 0, LATITUDES_DEG);
    let random = &mut Draw::new(seed, SIGNS);
    let rows = random.log_uniform([2.0, 400.0]).floor();
    scenario.interval_s = random.log_uniform([10.0, 1800.0]);
    scenario.duration_s = (rows - 1.0) * scenario.interval_s;
    if random.uniform() < 1.0 / 3.0 {
        scenario.hidden = vec![Hidden::new("accel_x.noise", &[("ratio", 3.0)])?];
    }
    spoilt(seed, &scenario, |broken| {
        if broken.random.uniform() < 1.0 / 3.0 {
            leave_angles_out(&mut broken.bench);
        }
        let [rows, values] = [0; 2].map(|_| 0.3 * broken.random.uniform());
        let mut kept = Record::default();
        for row in 0..broken.record.len() {
            // Two rows stay.
            if row > 1 && broken.random.uniform() < rows {
                continue;
            }
            let random = &mut broken.random;
            let keep = |value| match random.uniform() < values {
                true => f64::NAN,
                false => value,
            };
            kept.time_s.push(broken.record.time_s[row]);
            kept.accel_g.push(broken.record.accel_g[row].map(keep));
        }
        broken.record = kept;
    })
}
