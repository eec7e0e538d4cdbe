//! Tests of whiteness on white series, and on series that are not.
#![cfg(test)]

use gyrocal_statistics::deviates::Normals;
use gyrocal_statistics::{
    NoiseCourse, allan_test, autocorrelation, nis, periodogram, strongest_line,
};

/// White innovations, 3 % of them missing.
fn innovations(seed: u64, rows: usize) -> Vec<[f64; 3]> {
    let mut normals = Normals::of_seed(seed);
    let mut value = || {
        let normal = normals.normal();
        if normals.uniform() < 0.03 {
            f64::NAN
        } else {
            normal
        }
    };
    (0..rows)
        .map(|_| core::array::from_fn(|_| value()))
        .collect()
}

const RECORDS: u64 = 600;
const FALSE_ALARM: f64 = 0.05;
/// Of 600 records 30 are expected beyond the 5 % level, with a sigma of 5.3: four sigmas.
const ALARMS: core::ops::RangeInclusive<usize> = 9..=51;

fn alarms(test: impl Fn(&[[f64; 3]]) -> f64) -> usize {
    let p_values = (0..RECORDS).map(|seed| test(&innovations(seed, 700)));
    p_values.filter(|p| *p < FALSE_ALARM).count()
}

#[test]
fn white_innovations_alarm_as_often_as_they_say() {
    let of_nis = alarms(|white| nis(white, FALSE_ALARM).unwrap().p_value);
    let of_box = alarms(|white| autocorrelation(white, 20, FALSE_ALARM).unwrap().p_value);
    assert!(ALARMS.contains(&of_nis), "NIS {of_nis}");
    assert!(ALARMS.contains(&of_box), "Ljung and Box {of_box}");
    // The gap is zeros in the transform.
    let time_s: Vec<f64> = (0..700)
        .map(|k| 60.0 * f64::from(if k < 300 { k } else { k + 111 }))
        .collect();
    let of_lines = alarms(|white| {
        let line = |axis: usize| {
            let series: Vec<f64> = white.iter().map(|row| row[axis]).collect();
            periodogram(&time_s, &series, FALSE_ALARM).unwrap().line
        };
        strongest_line(&[line(0), line(1), line(2)]).1
    });
    assert!(ALARMS.contains(&of_lines), "lines {of_lines}");
}

#[test]
fn power_is_one_in_the_mean_and_stays_below_the_level() {
    let time_s: Vec<f64> = (0..2000).map(|k| 60.0 * f64::from(k)).collect();
    let white = innovations(5, 2000);
    let series: Vec<f64> = white.iter().map(|row| row[0]).collect();
    let found = periodogram(&time_s, &series, 0.01).unwrap();
    let mean = found.power.iter().sum::<f64>() / found.power.len() as f64;
    // 1000 independent exponentials: 3 %.
    assert!((mean - 1.0).abs() < 0.12, "{mean}");
    assert!(found.line.power < found.level && found.line.p_value > 0.01);
    let finest = found.frequency_hz[0];
    assert!(
        finest < 1.0 / (4.0 * 120_000.0)
            && found.frequency_hz.last().unwrap() + 1.5 * finest > 1.0 / 120.0
    );
}

#[test]
fn correlation_between_axes_and_rows_is_seen() {
    let mut innovations = innovations(9, 4000);
    // x follows the y of the row before with 0.1: six sigmas of a correlation of 4000 rows.
    for row in (1..innovations.len()).rev() {
        if !innovations[row - 1][1].is_nan() {
            innovations[row][0] += 0.1 * innovations[row - 1][1];
        }
    }
    let found = autocorrelation(&innovations, 10, 0.01).unwrap();
    assert!(found.p_value < 1e-3, "{}", found.p_value);
    let within =
        |(c, s): (&[f64; 3], &[f64; 3])| (0..3).all(|axis| c[axis].abs() < found.band * s[axis]);
    assert!(found.correlation.iter().zip(&found.sigma).all(within));
    assert!(autocorrelation(&innovations[..39], 10, 0.01).is_err());
}

/// Minutes of a day.
const DAY: usize = 1440;

fn minutes() -> Vec<f64> {
    (0..DAY).map(|row| 60.0 * row as f64).collect()
}

#[test]
fn white_noise_alarms_the_allan_test_no_more_often_than_it_may() {
    const RECORDS: u64 = 400;
    let alarms = (0..RECORDS)
        .filter(|seed| {
            let white = Normals::of_seed(*seed).rows(DAY);
            let found = allan_test(&minutes(), &white, FALSE_ALARM).unwrap();
            found.course != NoiseCourse::White
        })
        .count();
    // At most 20 are expected, with a sigma of 4.4: four sigmas. Averages that share samples need
    // less than each its share; none at all would be a test that sees nothing.
    assert!((2..=38).contains(&alarms), "{alarms}");
}

#[test]
fn noise_that_does_not_average_out_is_told_by_its_course() {
    let course = |of: &dyn Fn(usize, f64, &mut [f64; 3]) -> f64| {
        let mut held = [0.0; 3];
        let mut series = Normals::of_seed(5).rows(DAY);
        for (row, values) in series.iter_mut().enumerate() {
            for value in values {
                *value = of(row, *value, &mut held);
            }
        }
        let found = allan_test(&minutes(), &series, 1e-3).unwrap();
        // Each is far from white.
        assert!(found.p_value < 1e-3 && found.most.is_some());
        found.course
    };
    // Variance 2.25 where 1440 values know 1 to 4 %.
    assert_eq!(course(&|_, white, _| 1.5 * white), NoiseCourse::LargerWhite);
    // A walk of 0.1 a row is over white noise after ten rows.
    let walk = |_: usize, white: f64, held: &mut [f64; 3]| {
        held[0] += 0.3 * white;
        held[0]
    };
    assert_eq!(course(&walk), NoiseCourse::Slow);
}
