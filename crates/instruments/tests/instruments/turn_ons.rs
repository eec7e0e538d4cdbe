//! Several logs of one unit in the rate domain, whose bias changes from log to log.

use gyrocal_instruments::Log;
use gyrocal_statistics::deviates::Normals;
use nalgebra::{Matrix3, Vector3};

use crate::rates::{evaluated, log, near};

/// Logs of 40 s, one in each of these attitudes, of gyros without a term in specific force whose bias in each log is drawn
/// with a standard deviation `change` \[deg/h\]; with a temperature that is another in each log.
fn turned_on_anew(attitudes: &[Vector3<f64>], change: f64, seed: u64) -> Vec<Log> {
    let mut normals = Normals::of_seed(1000 + seed);
    let still = |_: usize| 0.0;
    let logs = attitudes.iter().enumerate().map(|(number, up)| {
        let bias = Vector3::from([(); 3].map(|()| change * normals.normal()));
        let seed = 100 * seed + number as u64;
        let mut log = log(*up, 400, &still, &Matrix3::identity(), &|_| bias, seed);
        let at = 20.0 + 10.0 * normals.normal();
        let temperature = (0..400).map(|_| at + 0.02 * normals.normal());
        log.temperature_c = Some(temperature.collect());
        log
    });
    logs.collect()
}

/// Each axis up, then each down.
fn six_attitudes() -> [Vector3<f64>; 6] {
    let [x, y, z] = [Vector3::x(), Vector3::y(), Vector3::z()];
    [z, x, y, -z, -x, -y]
}

#[test]
fn positions_that_are_measured_once_assume_an_equal_bias() {
    let logs = turned_on_anew(&six_attitudes(), 100.0, 0);
    let assumes = |logs: &[Log]| {
        let gyros = evaluated(logs, "").gyros;
        [0, 1, 2].map(|gyro| gyros[gyro].assumes_equal_bias)
    };
    // Four logs, four coefficients; one log has nothing to compare.
    assert_eq!(assumes(&logs[..4]), [true; 3]);
    assert_eq!(assumes(&logs[..5]), [false; 3]);
    assert_eq!(assumes(&logs[..1]), [false; 3]);
}

#[test]
fn a_change_of_the_bias_between_logs_is_no_term() {
    const UNITS: u64 = 20;
    // As large as the noise of a mean with Earth rate of an unknown heading, and far larger.
    for change in [10.0, 100.0] {
        let (mut inside, mut all) = (0, 0);
        for unit in 0..UNITS {
            let logs = turned_on_anew(&six_attitudes()[..5], change, unit);
            for gyro in &evaluated(&logs, "").gyros {
                // The three terms share the one difference that is left.
                let mut terms = gyro.coefficients[1..4].iter();
                inside += usize::from(terms.all(|term| {
                    let [low, high] = term.interval();
                    (low..=high).contains(&0.0)
                }));
                all += 1;
            }
        }
        // All three in 90 % of the gyros, less four standard deviations.
        assert!(4 * inside >= 3 * all, "{inside} of {all} at {change}");
    }
}

#[test]
fn one_difference_of_logs_leaves_few_degrees_of_freedom_however_small_it_is() {
    // One to five, by the noise of the logs that tell a term; more than a hundred if a small difference were none.
    for unit in 0..4 {
        let logs = turned_on_anew(&six_attitudes()[..5], 0.0, unit);
        for gyro in &evaluated(&logs, "").gyros {
            for term in &gyro.coefficients[1..4] {
                assert!(term.degrees_of_freedom < 10.0, "{term:?}");
            }
        }
    }
}

#[test]
fn a_change_of_the_bias_between_logs_is_no_effect() {
    // A course of temperature or time goes through so few logs, whatever their biases.
    for unit in 0..4 {
        for count in [2, 4, 5] {
            let logs = turned_on_anew(&six_attitudes()[..count], 1e3, unit);
            for gyro in &evaluated(&logs, "").gyros {
                assert!(gyro.effects.is_empty(), "{count}: {:?}", gyro.effects);
            }
        }
    }
}

#[test]
fn a_step_within_one_of_two_logs_is_found_beside_a_change_of_the_bias() {
    let still = |_: usize| 0.0;
    let one = Matrix3::identity();
    let first = Vector3::new(80.0, -150.0, 0.0);
    let second =
        |sample: usize| Vector3::new(-60.0, if sample > 1100 { 130.0 } else { 110.0 }, 0.0);
    let logs = [
        log(Vector3::z(), 2000, &still, &one, &|_| first, 11),
        log(Vector3::z(), 2000, &still, &one, &second, 12),
    ];
    let report = evaluated(&logs, "");
    let found = |gyro: usize| -> Vec<&str> {
        let effects = report.gyros[gyro].effects.iter();
        effects.map(|effect| &*effect.name).collect()
    };
    assert_eq!(
        [found(0), found(1), found(2)],
        [vec![], vec!["gyro_y.step"], vec![]]
    );
    near(&report.gyros[1], "gyro_y.step", 20.0);
}
