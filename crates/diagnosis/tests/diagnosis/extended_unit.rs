//! The filter of a model file of a strapdown unit over simulated records, against their truth and against
//! the fit to the whole record.

use gyrocal::Discretisation;
use gyrocal_calibration::{GyroAxes, Run, declared_attitude, filter_settings};
use gyrocal_diagnosis::{DiagnoseOptions, fit_effects};
use gyrocal_extended::unit::{PARAMETERS, Unit};
use gyrocal_extended::{UnitFilter, unit_filter};
use gyrocal_truth::units::strapdown::{StrapdownUnit, UnitRun};
use nalgebra::{Cholesky, DMatrix, DVector};

/// Coefficients, then the parameters of the effects by their ids.
const DRIFT: [f64; 9] = [0.2, 0.1, -0.05, -0.1, 0.3, 0.04, 0.05, -0.2, 0.1];
const GYRO_RAMP: f64 = 0.004;
/// About the sigma with which the filter starts.
const ACCEL_RAMP: f64 = 8e-6;

fn gyro_error(force: [f64; 3], days: f64) -> [f64; 3] {
    let mut error = core::array::from_fn(|i| {
        let [bias, along, square] = core::array::from_fn(|term| DRIFT[3 * i + term]);
        bias + force[i] * (along + force[i] * square)
    });
    error[1] += GYRO_RAMP * days;
    error
}

fn unit(turn_rad_per_s: [f64; 3], interval_s: f64, days: f64, seed: u64) -> StrapdownUnit {
    let run = UnitRun {
        attitude_rad: [0.4, -0.7, 1.1],
        turn_rad_per_s,
        interval_s,
        rows: (days * 86_400.0 / interval_s) as usize,
        seed,
        gyro_error: &gyro_error,
        accel_error: &|_, days| [ACCEL_RAMP * days, 0.0, 0.0],
    };
    run.simulate()
}

fn filtered(unit: &StrapdownUnit) -> UnitFilter<f64> {
    let settings = filter_settings(&unit.bench, Discretisation::default());
    let attitude = declared_attitude(&unit.bench).unwrap();
    let mut filter = unit_filter(&settings, &attitude).unwrap();
    let mut before_s = 0.0;
    for (row, sample) in unit.record.accel_g.iter().enumerate() {
        let interval_s = unit.record.time_s[row] - before_s;
        let [middle, end] = unit.axes(row);
        filter
            .take_turning(interval_s, [&middle, &end], sample)
            .unwrap();
        before_s = unit.record.time_s[row];
    }
    filter
}

fn truth(id: &str) -> f64 {
    match id {
        "gyro_y.ramp" => GYRO_RAMP,
        "accel_x.ramp" => ACCEL_RAMP,
        id => panic!("{id}"),
    }
}

#[test]
fn coefficients_and_effects_of_a_turning_unit_are_found_within_their_covariance() {
    const SEEDS: u64 = 6;
    let mut squares = 0.0;
    for seed in 0..SEEDS {
        // Two degrees a minute about an axis across all three.
        let filter = filtered(&unit([4e-4, -3e-4, 3e-4], 60.0, 1.0, seed));
        let kernel = filter.filter();
        let errors = PARAMETERS.iter().enumerate().map(|(index, parameter)| {
            let coefficient = DRIFT.get(index).copied();
            kernel.state()[3 + index] - coefficient.unwrap_or_else(|| truth(parameter.id))
        });
        let errors = DVector::from_iterator(Unit::PARAMETERS, errors);
        for index in 0..9 {
            // The prior has one: the record determines all nine.
            assert!(
                kernel.sigma(3 + index) < 0.02,
                "{index}: {}",
                kernel.sigma(3 + index)
            );
        }
        let covariance = DMatrix::from_fn(Unit::PARAMETERS, Unit::PARAMETERS, |i, j| {
            kernel.covariance(3 + i, 3 + j)
        });
        let solved = Cholesky::new(covariance).unwrap().solve(&errors);
        squares += solved.dot(&errors);
    }
    // Chi squared with 66 degrees of freedom: 99.9 % lie between these.
    assert!((35.0..110.0).contains(&squares), "{squares}");
}

#[test]
fn the_filter_agrees_with_the_fit_to_a_record_at_rest() {
    let unit = unit([0.0; 3], 300.0, 2.0, 1);
    let filter = filtered(&unit);
    let axes = GyroAxes::new(&unit.platform_q_body);
    let run = Run {
        record: &unit.record,
        bench: &unit.bench,
    };
    let effects = ["gyro_y.ramp", "accel_x.ramp"].map(str::to_owned);
    let options = DiagnoseOptions::default();
    let fit = fit_effects(&run, Some(&axes), &effects, &options).unwrap();
    let kernel = filter.filter();
    for (index, parameter) in PARAMETERS.iter().enumerate() {
        let (estimate, sigma) = (kernel.state()[3 + index], kernel.sigma(3 + index));
        let (expected, expected_sigma) = match fit.coefficients.get(index) {
            Some(one) => (one.estimate, one.sigma),
            None => {
                let mut all = fit.effects.iter();
                let one = all.find(|effect| effect.effect == parameter.id).unwrap();
                let one = &one.parameters[0];
                assert!((one.estimate - truth(parameter.id)).abs() < 4.0 * one.sigma.unwrap());
                (one.estimate, one.sigma.unwrap())
            }
        };
        // One linearises at each step and with the declared noise, the other about its result and with the
        // noise that it estimates, which is known to some percent.
        let apart = (estimate - expected).abs() / sigma;
        assert!(
            apart < 0.3,
            "{}: {estimate} {expected} {sigma}",
            parameter.id
        );
        let ratio = sigma / expected_sigma;
        assert!((0.9..1.1).contains(&ratio), "{}: {ratio}", parameter.id);
    }
}
