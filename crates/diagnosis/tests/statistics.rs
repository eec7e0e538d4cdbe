//! The statistics of residuals on white innovations, and on such that are not.
#![allow(clippy::unwrap_used, clippy::expect_used)] // a test stops at what fails

use gyrocal_diagnosis::{autocorrelation, magnitude_channel, nis, periodogram, strongest};
use gyrocal_record::Record;
use rand_chacha::ChaCha12Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

struct Normals(ChaCha12Rng);

impl Normals {
    fn of_seed(seed: u64) -> Self {
        Self(ChaCha12Rng::seed_from_u64(seed))
    }

    fn uniform(&mut self) -> f64 {
        ((self.0.next_u64() >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (core::f64::consts::TAU * self.uniform()).cos()
    }

    /// White innovations, 3 % of them missing.
    fn innovations(&mut self, rows: usize) -> Vec<[f64; 3]> {
        let mut value = || {
            let normal = self.normal();
            if self.uniform() < 0.03 {
                f64::NAN
            } else {
                normal
            }
        };
        (0..rows)
            .map(|_| core::array::from_fn(|_| value()))
            .collect()
    }
}

const RECORDS: u64 = 600;
const FALSE_ALARM: f64 = 0.05;
/// Of 600 records 30 are expected beyond the 5 % level, with a sigma of 5.3: four sigmas.
const ALARMS: core::ops::RangeInclusive<usize> = 9..=51;

fn alarms(test: impl Fn(&[[f64; 3]]) -> f64) -> usize {
    let p_values = (0..RECORDS).map(|seed| test(&Normals::of_seed(seed).innovations(700)));
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
        strongest(&[line(0), line(1), line(2)]).1
    });
    assert!(ALARMS.contains(&of_lines), "lines {of_lines}");
}

#[test]
fn power_is_one_in_the_mean_and_stays_below_the_level() {
    let time_s: Vec<f64> = (0..2000).map(|k| 60.0 * f64::from(k)).collect();
    let white = Normals::of_seed(5).innovations(2000);
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
    let mut innovations = Normals::of_seed(9).innovations(4000);
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

#[test]
fn the_norm_sees_accelerometers_whatever_the_attitude() {
    let (sigma_g, bias_g) = (1e-5, 2e-6);
    let record = |bias_g: f64, scale: f64| {
        let mut normals = Normals::of_seed(3);
        let accel_g = (0..5000).map(|_| {
            let direction: [f64; 3] = core::array::from_fn(|_| normals.normal());
            let length = direction.iter().map(|d| d * d).sum::<f64>().sqrt();
            core::array::from_fn(|axis| {
                let error =
                    sigma_g * scale * normals.normal() + if axis == 0 { bias_g } else { 0.0 };
                direction[axis] / length + error
            })
        });
        Record {
            time_s: (0..5000).map(|k| 60.0 * f64::from(k)).collect(),
            accel_g: accel_g.collect(),
            temperature_c: None,
        }
    };
    let clean = magnitude_channel(&record(0.0, 1.0), &[sigma_g; 3], 1.0, 10).unwrap();
    // One seed: probabilities of ordinary size.
    assert!(clean.mean_p_value > 1e-3 && clean.variance_p_value > 1e-3);
    assert!(clean.on_component.iter().all(|on| on.p_value > 1e-3));
    // |E|² has twice the noise of a component, along specific force.
    assert!((clean.sigma_g2[7] / (2.0 * sigma_g) - 1.0).abs() < 1e-4);
    let biased = magnitude_channel(&record(bias_g, 1.0), &[sigma_g; 3], 1.0, 10).unwrap();
    // 2 b a_x: 0.2 sigma a_x, so 0.2 sqrt(5000 / 3) = 8 sigmas, on x and on x alone.
    assert!(biased.on_component[0].p_value < 1e-6);
    assert!(biased.on_component[1].p_value > 1e-3 && biased.on_component[2].p_value > 1e-3);
    let noisy = magnitude_channel(&record(0.0, 1.2), &[sigma_g; 3], 1.0, 10).unwrap();
    // 5000 values: the variance 1.44 is known to 2 %.
    assert!((noisy.variance_ratio - 1.44).abs() < 0.12 && noisy.variance_p_value < 1e-9);
}
