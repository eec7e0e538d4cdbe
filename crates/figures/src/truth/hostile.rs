//! Work of a diagnosis on hostile records, over that on a sound record of the same size.

use gyrocal_calibration::work;
use gyrocal_evaluation::diagnosed;
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::median;
use gyrocal_truth::faults::leave_angles_out;
use gyrocal_truth::faults::noise::flickering;
use gyrocal_truth::{Hidden, InitialAttitude, Scenario, Simulation, simulate};
use serde::{Deserialize, Serialize};

use super::drawn::{self, coefficients, of_gyro};
use crate::cost::on_one_core;
use crate::harness::{Context, Error, Figure, Population, Row, Sources, of};

const SOURCES: Sources = of(
    &["crates/diagnosis", "crates/truth"],
    &[file!(), drawn::FILE],
);

/// Cost of one diagnosis.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Cost {
    kind: String,
    rows: usize,
    work: u64,
    seconds: f64,
}

fn cost(kind: &str, simulation: &Simulation) -> Cost {
    let before = work();
    let (_, seconds) = on_one_core(|| diagnosed(simulation));
    Cost {
        kind: kind.to_owned(),
        rows: simulation.record.len(),
        work: work() - before,
        seconds,
    }
}

pub(crate) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let name = "hostile, sound records beside";
    let sound = |seed| {
        let of = |rows: usize| Ok::<_, Error>(cost("sound", &simulate(&plain(seed, rows))?));
        Ok([of(ROWS)?, of(FEW_ROWS)?])
    };
    let reference = Population::new(name, [3_230_000, 5, 5], SOURCES, sound);
    let reference = context.records(&reference)?;
    let job = |seed| record(seed).map(|(kind, simulation)| cost(kind, &simulation));
    let population = Population::new("hostile", [3_220_000, 200, 5], SOURCES, job);
    // Of a value over the median of sound records of that size.
    let over = move |one: &Cost, value: fn(&Cost) -> f64| {
        let sound = reference.records.iter().flatten();
        let of_size = sound.filter(|sound| sound.rows == one.rows).map(value);
        value(one) / median(&of_size.collect::<Vec<_>>())
    };
    let name = "work of `diagnose` on hostile records over a sound one of that size";
    let work = |one: &Cost| over(one, |one| one.work as f64);
    let time = |all: &[Cost]| {
        let largest = |of: &dyn Fn(&Cost) -> f64| all.iter().map(of).fold(0.0, f64::max);
        let slowest = largest(&|one| over(one, |one| one.seconds));
        let longest_s = largest(&|one| one.seconds);
        let kind = all.iter().max_by(|a, b| work(a).total_cmp(&work(b)));
        let kind = kind.map_or("none", |one| &one.kind);
        format!("{slowest:.1} times, {longest_s:.1} s; most work: {kind}")
    };
    let rows = [
        Row::largest(name, work).at_most(20.0, "the budget of a search, with what comes before it"),
        Row::words("the same in time, largest", time),
    ];
    context.measure(&population, &rows)
}

/// Purpose of the stream of draws.
const STREAM: u64 = 44;

/// Rows of the records, one a minute: two days; and of the shortest.
const ROWS: usize = 2881;
const FEW_ROWS: usize = 145;

/// A plain record of a number of rows.
fn plain(seed: u64, rows: usize) -> Scenario {
    Scenario {
        seed,
        latitude_deg: 48.2,
        initial: InitialAttitude::Random,
        duration_s: 60.0 * (rows - 1) as f64,
        coefficients: coefficients([0.3, 0.3, 0.1], &mut Draw::new(seed, STREAM + 1)),
        ..Scenario::default()
    }
}

/// The record of a seed, with its kind: all kinds in turn.
fn record(seed: u64) -> Result<(&'static str, Simulation), Error> {
    let (name, make) = KINDS[(seed % KINDS.len() as u64) as usize];
    let is_short = name.contains("145 rows");
    let rows = if is_short { FEW_ROWS } else { ROWS };
    let made = make(plain(seed, rows), &mut Draw::new(seed, STREAM))?;
    Ok((name, made))
}

type Made = Result<Simulation, Error>;

/// Makes a record of a kind.
type Maker = fn(Scenario, &mut Draw) -> Made;

/// The first five are those of the small version.
const KINDS: [(&str, Maker); 25] = [
    ("noise on all axes and nothing else", |s, r| {
        let size = r.log_uniform([1e-5, 1.0]);
        changed(s, r, |rows, _, r| all(rows, |_| size * r.normal()))
    }),
    ("several huge effects", |s, r| huge(s, r, [10.0, 1000.0])),
    ("heavy tails", |s, r| {
        // Cauchy.
        let deviate = |r: &mut Draw| (r.normal() / r.normal()).clamp(-2e4, 2e4);
        changed(s, r, |rows, _, r| {
            all(rows, |value| value + 1e-5 * deviate(r))
        })
    }),
    ("noise of a hundred times the declared", |s, _| {
        declared(&s, 0.01)
    }),
    ("noise with a correlation of 0.95", |s, _| {
        with(s, "accel.coloured_noise", &[("correlation", 0.95)])
    }),
    ("an axis clipped", |s, r| {
        changed(s, r, |rows, axis, r| {
            let largest = rows.iter().map(|row| row[axis].abs()).fold(0.0, f64::max);
            let bound = largest * (0.3 + 0.6 * r.uniform());
            each(rows, axis, |value| value.clamp(-bound, bound));
        })
    }),
    ("an axis stuck from some row on", |s, r| {
        changed(s, r, |rows, axis, r| {
            let first = (r.uniform() * rows.len() as f64) as usize;
            stick(&mut rows[first..], axis);
        })
    }),
    ("an axis negated", negated),
    ("an axis negated, no angles", |s, r| {
        let mut simulation = negated(s, r)?;
        leave_angles_out(&mut simulation.bench);
        Ok(simulation)
    }),
    ("directions at random", |s, r| {
        changed(s, r, |rows, _, r| {
            for row in rows {
                let drawn: [f64; 3] = core::array::from_fn(|_| r.normal());
                let norm = drawn.iter().map(|x| x * x).sum::<f64>().sqrt();
                *row = drawn.map(|x| x / norm);
            }
        })
    }),
    ("a constant", |s, r| {
        changed(s, r, |rows, _, _| rows.fill(rows[0]))
    }),
    ("145 rows with a stuck axis", |s, r| {
        changed(s, r, |rows, axis, _| stick(rows, axis))
    }),
    ("145 rows with huge effects", |s, r| {
        huge(s, r, [100.0, 1000.0])
    }),
    ("several effects of hundreds of deg/h", |s, r| {
        huge(s, r, [1e4, 1e6])
    }),
    ("walks of 0.002 on all gyros", |s, _| walks(s, 0.002)),
    ("walks of 0.02 on all gyros", |s, _| walks(s, 0.02)),
    ("walks of 0.2 on all gyros", |s, _| walks(s, 0.2)),
    ("flicker on all gyros", |s, r| {
        let level = r.log_uniform([1e-3, 1e-1]);
        Ok(flickering(&s, [level; 3], r)?)
    }),
    ("outliers in a tenth of the values", |s, _| {
        with(s, "accel.outliers", &[("fraction", 0.1), ("size", 300.0)])
    }),
    ("thirty jumps", |mut s, r| {
        for _ in 0..30 {
            let size = r.log_uniform([1e-3, 1.0]);
            let [x, y, z] = core::array::from_fn(|_| size * r.normal());
            let at = s.duration_s * r.uniform();
            let jump = [("x_deg", x), ("y_deg", y), ("z_deg", z), ("onset_s", at)];
            s.hidden.push(Hidden::new("platform.knock", &jump)?);
        }
        Ok(simulate(&s)?)
    }),
    ("noise of a hundredth of the declared", |s, _| {
        declared(&s, 100.0)
    }),
    ("sinusoids of 50 sigma and more", |mut s, r| {
        for instrument in ["gyro_x", "gyro_y", "gyro_z", "accel_x"] {
            let middle = if instrument == "accel_x" { 1e-4 } else { 0.02 };
            let size = middle * r.log_uniform([0.3, 10.0]);
            let tone = [("size", size), ("period_h", r.log_uniform([0.3, 30.0]))];
            s.hidden
                .push(Hidden::new(&format!("{instrument}.tone"), &tone)?);
        }
        Ok(simulate(&s)?)
    }),
    ("friction and dead zones", |mut s, r| {
        for gyro in 0..3 {
            for effect in ["sign_x", "dead_zone"] {
                let size = r.log_uniform([0.003, 0.3]);
                s.hidden.push(of_gyro(gyro, effect, size)?);
            }
        }
        Ok(simulate(&s)?)
    }),
    ("rows in another order", |s, r| {
        changed(s, r, |rows, _, r| {
            for row in 0..rows.len() {
                let other = row + (r.uniform() * 30.0) as usize;
                if other < rows.len() {
                    rows.swap(row, other);
                }
            }
        })
    }),
    ("a latitude some degrees off", |s, r| {
        let size = r.sign() * r.log_uniform([0.1, 10.0]);
        with(s, "site.latitude", &[("size", size)])
    }),
];

/// A simulated record with changed rows.
fn changed(
    scenario: Scenario,
    random: &mut Draw,
    change: impl FnOnce(&mut [[f64; 3]], usize, &mut Draw),
) -> Made {
    let mut simulation = simulate(&scenario)?;
    let axis = *random.one_of(&[0, 1, 2]);
    change(&mut simulation.record.accel_g, axis, random);
    Ok(simulation)
}

fn each(rows: &mut [[f64; 3]], axis: usize, mut change: impl FnMut(f64) -> f64) {
    for row in rows {
        row[axis] = change(row[axis]);
    }
}

fn all(rows: &mut [[f64; 3]], mut change: impl FnMut(f64) -> f64) {
    for axis in 0..3 {
        each(rows, axis, &mut change);
    }
}

/// Repeats the first value of an axis.
fn stick(rows: &mut [[f64; 3]], axis: usize) {
    let value = rows[0][axis];
    each(rows, axis, |_| value);
}

fn negated(scenario: Scenario, random: &mut Draw) -> Made {
    changed(scenario, random, |rows, axis, _| {
        each(rows, axis, |value| -value);
    })
}

fn with(mut scenario: Scenario, id: &str, parameters: &[(&str, f64)]) -> Made {
    scenario.hidden.push(Hidden::new(id, parameters)?);
    Ok(simulate(&scenario)?)
}

/// Six effects of sizes that many sigmas of theirs are.
fn huge(mut scenario: Scenario, random: &mut Draw, range: [f64; 2]) -> Made {
    let onset_s = scenario.duration_s * random.uniform();
    let mut size = |sigma: f64| random.sign() * sigma * random.log_uniform(range);
    let effects: [(&str, &[(&str, f64)]); 6] = [
        ("gyro_x.step", &[("size", size(2e-4)), ("onset_s", onset_s)]),
        (
            "gyro_y.warmup",
            &[("size", size(5e-4)), ("time_constant_h", 6.0)],
        ),
        ("gyro_z.ramp", &[("size", size(5e-4))]),
        ("gyro_y.g_z", &[("size", size(2e-4))]),
        (
            "gyro_z.diurnal",
            &[("sine", size(2e-4)), ("cosine", size(2e-4))],
        ),
        ("gyro_x.g_xy", &[("size", size(2e-4))]),
    ];
    for (id, parameters) in effects {
        scenario.hidden.push(Hidden::new(id, parameters)?);
    }
    Ok(simulate(&scenario)?)
}

fn walks(mut scenario: Scenario, size: f64) -> Made {
    for gyro in 0..3 {
        scenario.hidden.push(of_gyro(gyro, "random_walk", size)?);
    }
    Ok(simulate(&scenario)?)
}

/// A record whose bench description declares its noise so many times too large.
fn declared(scenario: &Scenario, factor: f64) -> Made {
    let mut simulation = simulate(scenario)?;
    simulation.bench.accel_noise_g *= factor;
    simulation.bench.gyro_noise_deg_per_h *= factor;
    Ok(simulation)
}
