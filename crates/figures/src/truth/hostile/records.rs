//! Hostile records: what instruments, loggers and users do that no model explains.

use gyrocal_record::{AXES, Bench, Record};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::{
    Coefficients, Hidden, InitialAttitude, Scenario, Simulation, Term, simulate, simulate_with,
};

use crate::error::Error;

/// Purpose of the stream of draws.
const STREAM: u64 = 44;

/// Rows of the records, one a minute: two days; and of the shortest.
const ROWS: usize = 2881;
const FEW_ROWS: usize = 145;

/// Number of kinds.
pub(super) const KINDS: usize = 25;

/// A plain record of a number of rows.
pub(super) fn sound(seed: u64, rows: usize) -> Result<Simulation, Error> {
    Ok(simulate(&plain(seed, rows))?)
}

fn plain(seed: u64, rows: usize) -> Scenario {
    let mut random = Draw::new(seed, STREAM + 1);
    let mut three = |size: f64| core::array::from_fn(|_| size * random.normal());
    Scenario {
        seed,
        latitude_deg: 48.2,
        initial: InitialAttitude::Random,
        duration_s: 60.0 * (rows - 1) as f64,
        coefficients: Coefficients {
            bias_deg_per_h: three(0.3),
            g_deg_per_h_per_g: three(0.3),
            gg_deg_per_h_per_g2: three(0.1),
        },
        ..Scenario::default()
    }
}

/// The record of a kind, with its name.
pub(super) fn record(kind: usize, seed: u64) -> Result<(&'static str, Simulation), Error> {
    let mut random = Draw::new(seed, STREAM);
    let (name, make): Kind = ALL[kind];
    let plain = plain(
        seed,
        if name.contains("145 rows") {
            FEW_ROWS
        } else {
            ROWS
        },
    );
    Ok((name, make(plain, &mut random)?))
}

type Kind = (
    &'static str,
    fn(Scenario, &mut Draw) -> Result<Simulation, Error>,
);

const ALL: [Kind; KINDS] = [
    ("an axis clipped", |s, r| {
        changed(s, r, |record, axis, r| {
            let bound = largest(record, axis) * (0.3 + 0.6 * r.uniform());
            each(record, axis, |_, value| value.clamp(-bound, bound));
        })
    }),
    ("an axis stuck from some row on", |s, r| {
        changed(s, r, |record, axis, r| {
            let first = (r.uniform() * record.len() as f64) as usize;
            let value = record.accel_g[first][axis];
            each(
                record,
                axis,
                |row, own| if row < first { own } else { value },
            );
        })
    }),
    ("an axis negated", |s, r| {
        changed(s, r, |record, axis, _| {
            each(record, axis, |_, value| -value)
        })
    }),
    ("an axis negated, no angles", |s, r| {
        without_angles(changed(s, r, |record, axis, _| {
            each(record, axis, |_, value| -value);
        })?)
    }),
    ("noise on all axes and nothing else", |s, r| {
        let size = r.log_uniform([1e-5, 1.0]);
        changed(s, r, |record, _, r| {
            for axis in 0..3 {
                each(record, axis, |_, _| size * r.normal());
            }
        })
    }),
    ("directions at random", |s, r| {
        changed(s, r, |record, _, r| {
            for row in &mut record.accel_g {
                let drawn = core::array::from_fn(|_| r.normal());
                let norm = drawn.iter().map(|x| x * x).sum::<f64>().sqrt();
                *row = drawn.map(|x| x / norm);
            }
        })
    }),
    ("a constant", |s, r| {
        changed(s, r, |record, _, _| {
            let first = record.accel_g[0];
            record.accel_g.fill(first);
        })
    }),
    ("145 rows with a stuck axis", |s, r| {
        changed(s, r, |record, axis, _| {
            let value = record.accel_g[0][axis];
            each(record, axis, |_, _| value);
        })
    }),
    ("145 rows with huge effects", |s, r| {
        huge(s, r, [100.0, 1000.0])
    }),
    ("several huge effects", |s, r| huge(s, r, [10.0, 1000.0])),
    ("several effects of hundreds of deg/h", |s, r| {
        huge(s, r, [1e4, 1e6])
    }),
    ("walks of 0.002 on all gyros", |s, _| walks(s, 0.002)),
    ("walks of 0.02 on all gyros", |s, _| walks(s, 0.02)),
    ("walks of 0.2 on all gyros", |s, _| walks(s, 0.2)),
    ("flicker on all gyros", |s, r| {
        let level = r.log_uniform([1e-3, 1e-1]);
        flicker(&s, level, r)
    }),
    ("heavy tails", |s, r| {
        changed(s, r, |record, _, r| {
            for axis in 0..3 {
                each(record, axis, |_, value| {
                    // Cauchy.
                    value + 1e-5 * (r.normal() / r.normal()).clamp(-2e4, 2e4)
                });
            }
        })
    }),
    ("outliers in a tenth of the values", |mut s, _| {
        let parameters = [("fraction", 0.1), ("size", 300.0)];
        s.hidden.push(Hidden::new("accel.outliers", &parameters)?);
        Ok(simulate(&s)?)
    }),
    ("thirty jumps", |s, r| {
        let hidden = (0..30).map(|_| {
            let size = r.log_uniform([1e-3, 1.0]);
            let mut angle = || size * r.normal();
            let angles = [angle(), angle(), angle()];
            let onset_s = s.duration_s * r.uniform();
            Hidden::new(
                "platform.knock",
                &[
                    ("x_deg", angles[0]),
                    ("y_deg", angles[1]),
                    ("z_deg", angles[2]),
                    ("onset_s", onset_s),
                ],
            )
        });
        let hidden = hidden.collect::<Result<Vec<_>, _>>()?;
        Ok(simulate(&Scenario { hidden, ..s })?)
    }),
    ("noise of a hundred times the declared", |s, _| {
        declared(s, 0.01)
    }),
    ("noise of a hundredth of the declared", |s, _| {
        declared(s, 100.0)
    }),
    ("noise with a correlation of 0.95", |mut s, _| {
        let parameters = [("correlation", 0.95)];
        s.hidden
            .push(Hidden::new("accel.coloured_noise", &parameters)?);
        Ok(simulate(&s)?)
    }),
    ("sinusoids of 50 sigma and more", |mut s, r| {
        for gyro in ["gyro_x", "gyro_y", "gyro_z", "accel_x"] {
            let size = if gyro == "accel_x" { 1e-4 } else { 0.02 };
            let size = size * r.log_uniform([0.3, 10.0]);
            let parameters = [("size", size), ("period_h", r.log_uniform([0.3, 30.0]))];
            s.hidden
                .push(Hidden::new(&format!("{gyro}.tone"), &parameters)?);
        }
        Ok(simulate(&s)?)
    }),
    ("friction and dead zones", |mut s, r| {
        for gyro in AXES {
            let size = r.log_uniform([0.003, 0.3]);
            s.hidden.push(Hidden::new(
                &format!("gyro_{gyro}.sign_x"),
                &[("size", size)],
            )?);
            let size = r.log_uniform([0.003, 0.3]);
            s.hidden.push(Hidden::new(
                &format!("gyro_{gyro}.dead_zone"),
                &[("size", size)],
            )?);
        }
        Ok(simulate(&s)?)
    }),
    ("rows in another order", |s, r| {
        changed(s, r, |record, _, r| {
            for row in 0..record.len() {
                let other = row + (r.uniform() * 30.0) as usize;
                if other < record.len() {
                    record.accel_g.swap(row, other);
                }
            }
        })
    }),
    ("a latitude some degrees off", |mut s, r| {
        let parameters = [("size", r.sign() * r.log_uniform([0.1, 10.0]))];
        s.hidden.push(Hidden::new("site.latitude", &parameters)?);
        Ok(simulate(&s)?)
    }),
];

/// A simulated record with changed rows.
fn changed(
    scenario: Scenario,
    random: &mut Draw,
    change: impl FnOnce(&mut Record, usize, &mut Draw),
) -> Result<Simulation, Error> {
    let mut simulation = simulate(&scenario)?;
    let axis = *random.one_of(&[0, 1, 2]);
    change(&mut simulation.record, axis, random);
    Ok(simulation)
}

fn each(record: &mut Record, axis: usize, mut change: impl FnMut(usize, f64) -> f64) {
    for (row, values) in record.accel_g.iter_mut().enumerate() {
        values[axis] = change(row, values[axis]);
    }
}

fn largest(record: &Record, axis: usize) -> f64 {
    let values = record.accel_g.iter().map(|row| row[axis].abs());
    values.fold(0.0, f64::max)
}

fn without_angles(mut simulation: Simulation) -> Result<Simulation, Error> {
    gyrocal_testkit::broken_setups::leave_angles_out(&mut simulation.bench);
    Ok(simulation)
}

/// Six effects of sizes that many sigmas of theirs are.
fn huge(mut scenario: Scenario, random: &mut Draw, range: [f64; 2]) -> Result<Simulation, Error> {
    let onset_s = scenario.duration_s * random.uniform();
    let mut size = |sigma: f64| random.sign() * sigma * random.log_uniform(range);
    let effects = [
        (
            "gyro_x.step",
            vec![("size", size(2e-4)), ("onset_s", onset_s)],
        ),
        (
            "gyro_y.warmup",
            vec![("size", size(5e-4)), ("time_constant_h", 6.0)],
        ),
        ("gyro_z.ramp", vec![("size", size(5e-4))]),
        ("gyro_y.g_z", vec![("size", size(2e-4))]),
        (
            "gyro_z.diurnal",
            vec![("sine", size(2e-4)), ("cosine", size(2e-4))],
        ),
        ("gyro_x.g_xy", vec![("size", size(2e-4))]),
    ];
    for (id, parameters) in effects {
        scenario.hidden.push(Hidden::new(id, &parameters)?);
    }
    Ok(simulate(&scenario)?)
}

fn walks(mut scenario: Scenario, size: f64) -> Result<Simulation, Error> {
    for gyro in AXES {
        let id = format!("gyro_{gyro}.random_walk");
        scenario.hidden.push(Hidden::new(&id, &[("size", size)])?);
    }
    Ok(simulate(&scenario)?)
}

/// A record whose bench description declares its noise so many times too large.
fn declared(scenario: Scenario, factor: f64) -> Result<Simulation, Error> {
    let mut simulation = simulate(&scenario)?;
    let bench: &mut Bench = &mut simulation.bench;
    bench.accel_noise_g *= factor;
    bench.gyro_noise_deg_per_h *= factor;
    Ok(simulation)
}

/// Sums of Gauss-Markov processes of equal variance, deg/h.
fn flicker(scenario: &Scenario, level: f64, random: &mut Draw) -> Result<Simulation, Error> {
    const TIMES_H: [f64; 5] = [0.1, 1.0, 10.0, 100.0, 1000.0];
    let step_s = scenario.interval_s;
    let rows = (scenario.duration_s / step_s) as usize + 2;
    let mut states: [[f64; 3]; _] = TIMES_H.map(|_| core::array::from_fn(|_| random.normal()));
    let mut series = vec![[0.0; 3]; rows];
    for drifts in &mut series {
        for (state, time_h) in states.iter_mut().zip(TIMES_H) {
            let kept = (-step_s / 3600.0 / time_h).exp();
            for (drift, state) in drifts.iter_mut().zip(state) {
                *drift += level * *state;
                *state = kept * *state + (1.0 - kept * kept).sqrt() * random.normal();
            }
        }
    }
    let term = Term::Drift(Box::new(move |moment| {
        series[((moment.time_s / step_s) as usize).min(rows - 1)]
    }));
    Ok(simulate_with(scenario, &[term])?)
}
