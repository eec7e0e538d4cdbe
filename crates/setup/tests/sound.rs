//! Sound records of all sorts do not set the check off, and no record makes it panic.
#![cfg(test)]

use gyrocal_record::{Bench, Record};
use gyrocal_setup::{SetupKind, check_setup};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::faults::{large_effects, sound, varied_record, varied_scenario};

const FIRST_SEED: u64 = 2_000_000;
const RECORDS: u64 = 300;

#[test]
fn sound_records_are_left_alone() {
    let alarms: Vec<u64> = (FIRST_SEED..FIRST_SEED + RECORDS)
        .filter(|seed| {
            let mut scenario = varied_scenario(*seed).unwrap();
            if seed % 2 == 1 {
                let effects = large_effects(&scenario, &mut Draw::new(*seed, 4));
                scenario.hidden.extend(effects);
            }
            let simulation = varied_record(*seed, &scenario).unwrap();
            let check = check_setup(&simulation.record, &simulation.bench);
            !check.findings.is_empty() || check.usable.as_ref() != Some(&simulation.record)
        })
        .collect();
    // One in 200 is allowed: with 300 records six have a probability below 0.5 % of that.
    assert!(alarms.len() < 6, "{alarms:?}");
}

fn bench() -> Bench {
    sound(1).unwrap().bench
}

#[test]
fn no_record_makes_it_panic() {
    let constant = |value: f64, rows: usize| Record {
        time_s: (0..rows).map(|row| 60.0 * row as f64).collect(),
        accel_g: vec![[value; 3]; rows],
        temperature_c: None,
    };
    for rows in [0, 1, 2, 3, 5, 11, 12, 13, 30, 100, 1000] {
        for value in [
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            0.0,
            -0.0,
            0.577,
            1e300,
            5e-324,
        ] {
            for latitude_deg in [0.0, 45.0, -90.0, f64::NAN, f64::INFINITY] {
                let mut record = constant(value, rows);
                let bench = Bench {
                    latitude_deg,
                    ..bench()
                };
                let _ = check_setup(&record, &bench);
                record.time_s.reverse();
                let _ = check_setup(&record, &bench);
            }
        }
    }
    // Columns of other lengths.
    let mut record = constant(0.577, 100);
    record.accel_g.truncate(50);
    let check = check_setup(&record, &bench());
    assert_eq!(check.findings[0].kind, SetupKind::Missing);
    let mut record = constant(0.577, 100);
    record.temperature_c = Some(vec![20.0; 3]);
    assert!(check_setup(&record, &bench()).usable.is_none());
}

#[test]
fn pieces_of_a_record_are_judged_without_panic_and_without_alarm() {
    let simulation = sound(2_000_900).unwrap();
    for rows in [
        0, 1, 5, 11, 12, 13, 20, 36, 60, 120, 200, 361, 500, 721, 1000, 1441,
    ] {
        let record = Record {
            time_s: simulation.record.time_s[..rows].to_vec(),
            accel_g: simulation.record.accel_g[..rows].to_vec(),
            temperature_c: None,
        };
        let check = check_setup(&record, &simulation.bench);
        assert!(check.findings.is_empty(), "{rows}: {:?}", check.findings);
    }
}

/// A record with each so-many-th row of another.
fn thinned(record: &Record, stride: usize) -> Record {
    Record {
        time_s: record.time_s.iter().copied().step_by(stride).collect(),
        accel_g: record.accel_g.iter().copied().step_by(stride).collect(),
        temperature_c: None,
    }
}

#[test]
fn rows_far_apart_are_no_jumps() {
    for seed in 2_000_910..2_000_920 {
        let simulation = sound(seed).unwrap();
        let interval_s = simulation.record.time_s[1] - simulation.record.time_s[0];
        for minutes in [20.0, 36.0, 45.0, 60.0, 90.0, 120.0] {
            let stride = (60.0 * minutes / interval_s) as usize;
            let check = check_setup(&thinned(&simulation.record, stride), &simulation.bench);
            let jumps = check
                .findings
                .iter()
                .find(|found| found.kind == SetupKind::Jump);
            assert!(jumps.is_none(), "{seed}, {minutes} min: {jumps:?}");
        }
    }
}

/// The part of a bias along the axis of the Earth is in the magnitude at all attitudes, and no more of it.
#[test]
fn a_bias_of_one_accelerometer_is_no_gravity() {
    for seed in 2_000_920..2_000_940 {
        let simulation = sound(seed).unwrap();
        for axis in 0..3 {
            let mut record = simulation.record.clone();
            for row in &mut record.accel_g {
                row[axis] += 3e-4;
            }
            // Over whole days the mean of gravity is along the axis of the Earth.
            let mean: [f64; 3] = core::array::from_fn(|axis| {
                let column = record.accel_g.iter().map(|row| row[axis]);
                column.filter(|value| !value.is_nan()).sum::<f64>()
            });
            let size = mean.iter().map(|value| value * value).sum::<f64>().sqrt();
            let angle_deg = (mean[axis].abs() / size).acos().to_degrees();
            let check = check_setup(&record, &simulation.bench);
            // Four degrees are those of a twentieth; drift moves the mean by some more.
            let is_told = !check.findings.is_empty();
            assert!(
                !is_told || angle_deg < 8.0,
                "{seed}, axis {axis}: {angle_deg}"
            );
        }
    }
}

#[test]
fn random_damage_makes_no_panic() {
    let simulation = sound(2_000_901).unwrap();
    let mut random = Draw::new(2_000_901, 9);
    let odd = [f64::NAN, f64::INFINITY, 0.0, 1e308, -1e308, 1e-308, -999.0];
    for _ in 0..60 {
        let mut record = simulation.record.clone();
        let rows = 1 + (random.uniform() * 400.0) as usize;
        record.time_s.truncate(rows);
        record.accel_g.truncate(rows);
        for _ in 0..(random.uniform() * 300.0) as usize {
            let at = (random.uniform() * rows as f64) as usize;
            record.accel_g[at][(random.uniform() * 3.0) as usize] = *random.one_of(&odd);
            if random.uniform() < 0.02 {
                record.time_s[at] = *random.one_of(&odd);
            }
        }
        let _ = check_setup(&record, &simulation.bench);
    }
}
