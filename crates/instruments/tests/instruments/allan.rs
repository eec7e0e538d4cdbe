//! Allan deviations of logs with samples that no noise explains.

use gyrocal_instruments::{AllanColumn, AllanSettings, Log, allan_log};
use gyrocal_statistics::allan::AllanEstimator;
use gyrocal_truth::units::sensor_noise::SensorNoise;

const SAMPLES: usize = 4000;

/// A log of one sample a second of three gyros with a random walk of 30 and flicker of 5 deg/h, and its analysis.
fn analysed(seed: u64, change: impl Fn(&mut Vec<f64>)) -> Vec<AllanColumn> {
    let noise = SensorNoise {
        random_walk: 30.0,
        bias_instability: 5.0,
        ..SensorNoise::default()
    };
    let mut gyros: Vec<Vec<f64>> = (0..3)
        .map(|gyro| noise.rates(SAMPLES, 3 * seed + gyro))
        .collect();
    change(&mut gyros[0]);
    let samples = (0..SAMPLES).map(|at| [gyros[0][at], gyros[1][at], gyros[2][at]]);
    let log = Log::from_samples(1.0, samples.collect(), vec![[0.0, 0.0, 1.0]; SAMPLES]);
    let settings = AllanSettings {
        rate_hz: 1.0,
        scale: 1.0,
        confidence: 0.95,
        estimator: AllanEstimator::Overlapping,
    };
    allan_log(&log, ["x", "y", "z"], &settings).unwrap()
}

fn random_walk(column: &AllanColumn) -> f64 {
    let noise = column.noise.as_ref().unwrap();
    let own = noise
        .coefficients
        .iter()
        .find(|one| one.part.unit_suffix() == " √s");
    own.unwrap().estimate.unwrap()
}

#[test]
fn wild_samples_are_told_and_left_out() {
    for seed in 0..2 {
        let columns = analysed(seed, |rates| {
            rates[1000] = 7e6;
            rates[2500] -= 300.0;
        });
        let left_out = columns[0].left_out.as_ref().unwrap();
        assert_eq!(left_out.count, 2);
        assert_eq!(left_out.samples[0].sample, 1001);
        assert!((left_out.samples[0].time_s - 1000.0).abs() < 1e-9);
        // Five sigmas of a coefficient of 4000 samples.
        let found = random_walk(&columns[0]);
        assert!((found / 30.0 - 1.0).abs() < 0.1, "{seed}: {found}");
        assert!(columns[1].left_out.is_none() && columns[2].left_out.is_none());
    }
}
