//! Allan deviations against those of another library, and against noise of known density.

#![cfg(test)]

use gyrocal_statistics::StatisticsError;
use gyrocal_statistics::allan::{
    NoiseFit, NoisePart, NoiseType, allan_deviation, fit_noise, hadamard_deviation, octaves,
    total_deviation,
};
use gyrocal_truth::units::sensor_noise::{Filter, SensorNoise};

/// Made by tests/data/allan_reference.py.
const REFERENCE: &str = include_str!("data/allan_reference.csv");

/// Made by tests/data/allan_estimators_reference.py.
const ESTIMATORS: &str = include_str!("data/allan_estimators_reference.csv");

const ONE_SIGMA: f64 = 0.682_689_492_137_085_9;

/// The 1000 numbers of NIST SP 1065, section 12.4.
fn nist_series() -> Vec<f64> {
    const MODULUS: u64 = 2_147_483_647;
    let numbers = std::iter::successors(Some(1_234_567_890_u64), |n| Some(16_807 * n % MODULUS));
    numbers
        .take(1000)
        .map(|n| n as f64 / MODULUS as f64)
        .collect()
}

fn series(name: &str) -> Vec<f64> {
    let white = nist_series();
    match name {
        "white" => white,
        "difference" => white.windows(2).map(|pair| pair[1] - pair[0]).collect(),
        _ => white
            .iter()
            .scan(0.0, |sum, value| {
                *sum += value - 0.5;
                Some(*sum)
            })
            .collect(),
    }
}

#[test]
fn every_value_of_the_other_library_is_found() {
    let mut rows = 0;
    for line in REFERENCE.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |field: usize| fields[field].parse::<f64>().unwrap();
        let averaging = number(1) as usize;
        let point = allan_deviation(&series(fields[0]), 1.0, &[averaging], ONE_SIGMA).unwrap()[0];
        let exponent = match point.noise {
            NoiseType::WhiteAngle => 2,
            NoiseType::FlickerAngle => 1,
            NoiseType::WhiteRate => 0,
            NoiseType::FlickerRate => -1,
            NoiseType::RandomWalkRate => -2,
            _ => unreachable!(),
        };
        assert_eq!(exponent, number(3) as i32, "{line}");
        // A thousand sums of numbers of order one.
        assert!((point.deviation / number(2) - 1.0).abs() < 1e-11, "{line}");
        assert!(
            (point.degrees_of_freedom / number(4) - 1.0).abs() < 1e-12,
            "{line}"
        );
        // The quantiles of both libraries are iterated to about nine digits.
        assert!((point.interval[0] / number(5) - 1.0).abs() < 1e-7, "{line}");
        assert!((point.interval[1] / number(6) - 1.0).abs() < 1e-7, "{line}");
        rows += 1;
    }
    assert_eq!(rows, 18);
}

#[test]
fn the_printed_table_of_the_handbook_is_found() {
    // NIST SP 1065, table 31: overlapping Allan deviation, printed to seven digits.
    let points = allan_deviation(&nist_series(), 1.0, &[1, 10, 100], ONE_SIGMA).unwrap();
    for (point, printed) in points
        .iter()
        .zip([2.922_319e-1, 9.159_953e-2, 3.241_343e-2])
    {
        assert!((point.deviation / printed - 1.0).abs() < 2e-7);
    }
}

#[test]
fn the_unit_of_time_is_that_of_the_interval() {
    // White noise: the deviation at one averaging time in samples does not depend on the interval.
    let slow = allan_deviation(&nist_series(), 60.0, &[4], ONE_SIGMA).unwrap()[0];
    let fast = allan_deviation(&nist_series(), 0.01, &[4], ONE_SIGMA).unwrap()[0];
    assert!((slow.deviation / fast.deviation - 1.0).abs() < 1e-12);
    assert_eq!((slow.tau_s, fast.tau_s), (240.0, 0.04));
}

#[test]
fn a_drift_of_the_rate_is_no_noise() {
    let drifting = |per_sample: f64| -> Vec<f64> {
        let noise = nist_series().into_iter().enumerate();
        noise
            .map(|(i, value)| value + per_sample * i as f64)
            .collect()
    };
    let averaging = [1, 8, 64, 256];
    let named = |per_sample: f64| {
        let points = allan_deviation(&drifting(per_sample), 1.0, &averaging, ONE_SIGMA).unwrap();
        points.iter().map(|point| point.noise).collect::<Vec<_>>()
    };
    use NoiseType::{RateRamp, WhiteRate};
    assert_eq!(named(0.0), [WhiteRate; 4]);
    // White noise of 0.29 falls to 0.04 over 64 samples, over which the ramp of 0.002 rises by
    // 0.13: its part of the deviation is that over the root of two.
    assert_eq!(named(2e-3), [WhiteRate, WhiteRate, RateRamp, RateRamp]);
    assert_eq!(named(1.0), [RateRamp; 4]);
}

#[test]
fn octaves_end_at_a_third() {
    assert_eq!(octaves(100), [1, 2, 4, 8, 16, 32]);
    assert!(octaves(2).is_empty());
}

#[test]
fn what_cannot_be_computed_is_refused() {
    use StatisticsError::{AveragingTooLong, InvalidArgument, NotFinite};
    let rate = nist_series();
    let error = |rate: &[f64], interval_s: f64, averaging: &[usize], confidence: f64| {
        allan_deviation(rate, interval_s, averaging, confidence).unwrap_err()
    };
    assert_eq!(
        error(&rate, 1.0, &[334], 0.9),
        AveragingTooLong {
            found: 1000,
            expected: 1002
        }
    );
    for (interval_s, averaging, confidence) in [(0.0, 1, 0.9), (1.0, 0, 0.9), (1.0, 1, 1.0)] {
        let found = error(&rate, interval_s, &[averaging], confidence);
        assert!(matches!(found, InvalidArgument { .. }), "{found}");
    }
    let gap = [0.0, f64::NAN, 1.0];
    assert_eq!(error(&gap, 1.0, &[1], 0.9), NotFinite { sample: 2 });
}

#[test]
fn total_and_hadamard_deviations_are_those_of_the_other_library() {
    let mut rows = 0;
    for line in ESTIMATORS.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let number = |field: usize| fields[field].parse::<f64>().unwrap();
        let averaging = [number(1) as usize];
        let rate = series(fields[0]);
        let total = total_deviation(&rate, 1.0, &averaging, ONE_SIGMA).unwrap()[0];
        let hadamard = hadamard_deviation(&rate, 1.0, &averaging, ONE_SIGMA).unwrap()[0];
        // A thousand sums of numbers of order one.
        assert!((total.deviation / number(2) - 1.0).abs() < 1e-11, "{line}");
        assert!(
            (hadamard.deviation / number(4) - 1.0).abs() < 1e-11,
            "{line}"
        );
        // Only where the noise of the series is the one identified.
        let is = match fields[0] {
            "white" => NoiseType::WhiteRate,
            "difference" => NoiseType::WhiteAngle,
            _ => NoiseType::RandomWalkRate,
        };
        if total.noise == is && !number(3).is_nan() {
            assert!(
                (total.degrees_of_freedom / number(3) - 1.0).abs() < 1e-12,
                "{line}"
            );
        }
        // The reference takes samples for a continuous record, which shows at short times.
        if hadamard.noise == is && averaging[0] >= 32 {
            let ratio = hadamard.degrees_of_freedom / number(5);
            assert!((ratio - 1.0).abs() < 0.01, "{ratio} {line}");
        }
        // There it is the ratio of squared trace and trace of the square of the quadratic form.
        let exact = match (fields[0], averaging[0]) {
            ("white", 1) => 513.521_769_049,
            ("white", 8) => 154.227_674_369,
            _ => hadamard.degrees_of_freedom,
        };
        assert!(
            (hadamard.degrees_of_freedom / exact - 1.0).abs() < 1e-9,
            "{line}"
        );
        rows += 1;
    }
    assert_eq!(rows, 21);
}

/// Noise of an angle random walk of one.
const WHITE: SensorNoise = SensorNoise {
    quantisation: 0.0,
    random_walk: 1.0,
    bias_instability: 0.0,
    rate_random_walk: 0.0,
    filter: Filter::None,
};

fn assert_in_interval(fit: &NoiseFit, part: NoisePart, truth: f64) {
    let found = fit.coefficient(part).unwrap();
    let [low, high] = found.interval.unwrap();
    assert!(
        low < truth && truth < high && high < 1.5 * truth,
        "{found:?}"
    );
}

#[test]
fn coefficients_of_known_noise_are_in_their_intervals() {
    let noise = SensorNoise {
        quantisation: 2.0,
        bias_instability: 0.1,
        rate_random_walk: 1e-3,
        ..WHITE
    };
    let rates = noise.rates(40_000, 3);
    let fit = fit_noise(&rates, 1.0).unwrap();
    let truth = [2.0, 1.0, 0.1, 1e-3];
    for (part, truth) in NoisePart::ALL.into_iter().zip(truth) {
        let found = fit.coefficient(part).unwrap();
        let [low, high] = found.interval.unwrap();
        assert!(low < truth && truth < high, "{found:?}");
    }
    assert!(fit.is_described() && fit.tones.is_empty() && fit.filter_corner_hz.is_none());
    assert!(fit.not_explained_s.is_empty() && fit.samples_per_value.is_none());
    // The parts of the curve add to it.
    for point in &fit.curve {
        let sum: f64 = point.parts.iter().map(|part| part * part).sum();
        assert!((sum.sqrt() / point.deviation - 1.0).abs() < 1e-9);
    }
    // The same samples ten times a second: the units of time follow.
    let faster = fit_noise(&rates, 0.1).unwrap();
    let ratio = |part: NoisePart| {
        let of = |fit: &NoiseFit| fit.coefficient(part).unwrap().estimate.unwrap();
        of(&faster) / of(&fit)
    };
    assert!((ratio(NoisePart::Quantisation) - 0.1).abs() < 1e-9);
    assert!((ratio(NoisePart::RandomWalk) - 0.1_f64.sqrt()).abs() < 1e-9);
    assert!((ratio(NoisePart::RateRandomWalk) - 10.0_f64.sqrt()).abs() < 1e-8);
}

#[test]
fn a_filter_is_told_and_does_not_spoil_the_random_walk() {
    let noise = SensorNoise {
        bias_instability: 0.05,
        filter: Filter::Lag(4.0),
        ..WHITE
    };
    let fit = fit_noise(&noise.rates(40_000, 9), 0.1).unwrap();
    // A lag of four samples: half the power where 2 sin(π f) is exp(1 / 8) - exp(-1 / 8), at 0.4 Hz. Flicker and few
    // ordinates below it leave a fifth.
    let corner_hz = fit.filter_corner_hz.unwrap();
    assert!((corner_hz / 0.4 - 1.0).abs() < 0.2, "{corner_hz}");
    assert_in_interval(&fit, NoisePart::RandomWalk, 0.1_f64.sqrt());
    let quantisation = fit.coefficient(NoisePart::Quantisation).unwrap();
    assert_eq!(quantisation.estimate, None);
    // The curve is that of what passes the filter.
    let [open, behind] = [fit.curve[0].parts[1], fit.curve[0].deviation];
    assert!(behind < 0.2 * open, "{behind} {open}");
}

#[test]
fn tones_are_told_with_their_size() {
    let mut rates = WHITE.rates(20_000, 5);
    for (row, rate) in rates.iter_mut().enumerate() {
        *rate += 3.0 * (0.7 * row as f64).sin() + 0.2 * (0.01 * row as f64).cos();
    }
    let fit = fit_noise(&rates, 0.5).unwrap();
    assert_in_interval(&fit, NoisePart::RandomWalk, 0.5_f64.sqrt());
    assert!(fit.is_described(), "{fit:?}");
    let truth = [(3.0, 0.7), (0.2, 0.01)];
    assert_eq!(fit.tones.len(), truth.len());
    for (tone, (amplitude, turn)) in fit.tones.iter().zip(truth) {
        let [low, high] = tone.interval;
        assert!(low < amplitude && amplitude < high, "{tone:?}");
        // Four standard deviations.
        let off_hz = tone.frequency_hz - 2.0 * turn / core::f64::consts::TAU;
        assert!(off_hz.abs() < 4.0 * tone.frequency_sigma_hz, "{tone:?}");
    }
}

#[test]
fn values_that_are_held_are_taken_once() {
    let rates = WHITE.rates(5000, 6);
    let held: Vec<f64> = (0..20_000).map(|row| rates[row / 4]).collect();
    let fit = fit_noise(&held, 0.25).unwrap();
    assert_eq!(fit.samples_per_value, Some(4.0));
    assert_in_interval(&fit, NoisePart::RandomWalk, 1.0);
}

#[test]
fn what_is_no_such_noise_is_told_with_its_averaging_times() {
    // Noise of a resonance at 0.05 Hz.
    let mut rates = WHITE.rates(20_000, 7);
    let mut state = [0.0; 2];
    for (row, drive) in WHITE.rates(20_000, 8).into_iter().enumerate() {
        let next = 2.0 * 0.9 * (0.1 * core::f64::consts::PI).cos() * state[0] - 0.81 * state[1];
        state = [next + 0.3 * drive, state[0]];
        rates[row] += state[0];
    }
    let fit = fit_noise(&rates, 1.0).unwrap();
    assert!(!fit.is_described(), "{fit:?}");
    assert!(
        fit.coefficients
            .iter()
            .all(|one| one.estimate.is_none() && one.interval.is_none())
    );
    // It counts most in the Allan deviation at 0.37 / 0.05 Hz.
    let holds = |[from, to]: &[f64; 2]| (*from..*to).contains(&7.4);
    assert!(
        fit.not_explained_s.iter().any(holds),
        "{:?}",
        fit.not_explained_s
    );
}

#[test]
fn what_has_no_noise_to_fit_is_refused() {
    assert!(fit_noise(&WHITE.rates(47, 1), 1.0).is_err());
    assert!(fit_noise(&[2.0; 1000], 1.0).is_err());
    assert!(fit_noise(&[f64::NAN; 1000], 1.0).is_err());
}
