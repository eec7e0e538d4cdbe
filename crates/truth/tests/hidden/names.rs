//! Ids and parameters, right and wrong.

use gyrocal_truth::{Coefficients, Error, Hidden, Scenario, euler_rule, simulate};

use crate::{DAY_S, quiet, with};

fn refused(id: &str, parameters: &[(&str, f64)]) -> String {
    Hidden::new(id, parameters).unwrap_err().to_string()
}

#[test]
fn an_unknown_effect_is_answered_with_the_nearest() {
    let cases = [
        ("gyro_y.gz", "did you mean `gyro_y.g_z`"),
        ("gyro_y.g_zy", "`gyro_y.g_yz`"),
        ("accel.outlier", "did you mean `accel.outliers`"),
        ("site.lattitude", "did you mean `site.latitude`?"),
        ("Gyro_x.ramp", "`gyro_x.ramp`"),
        ("qqqqqqqqqqqqqqqq", "see the list of effects"),
        ("filter.discretisation", "it belongs to a filter"),
    ];
    for (id, advice) in cases {
        let error = refused(id, &[("size", 1.0)]);
        assert!(error.contains(&format!("unknown effect `{id}`")), "{error}");
        assert!(error.contains(advice), "{error}");
    }
}

/// An id, parameters, and the expected text of the error.
type Case<'a> = (&'a str, &'a [(&'a str, f64)], &'a str);

#[test]
fn wrong_parameters_are_named() {
    let cases: [Case<'_>; 7] = [
        (
            "gyro_x.step",
            &[("size", 1.0), ("onset", 2.0)],
            "gyro_x.step: found the unknown parameter `onset`, expected `size` or `onset_s`",
        ),
        (
            "gyro_x.step",
            &[("size", 1.0)],
            "gyro_x.step: found no `onset_s`, expected `onset_s = ` a finite number not less than 0",
        ),
        (
            "gyro_x.ramp",
            &[("size", f64::NAN)],
            "gyro_x.ramp: size: found NaN, expected a number from -10000 to 10000",
        ),
        (
            "gyro_x.ramp",
            &[("size", 1.0), ("size", 2.0)],
            "gyro_x.ramp: size: found two values, expected one value",
        ),
        (
            "accel.coloured_noise",
            &[("correlation", 1.0)],
            "correlation: found 1, expected a number from -0.999 to 0.999",
        ),
        (
            "gyro_x.warmup",
            &[("size", 1.0), ("time_constant_h", 0.0)],
            "time_constant_h: found 0, expected a finite number greater than 0",
        ),
        (
            "accel_x.noise",
            &[("ratio", -1.0)],
            "ratio: found -1, expected a finite number not less than 0",
        ),
    ];
    for (id, parameters, message) in cases {
        let error = refused(id, parameters);
        assert!(error.contains(message), "{message}\nis not in\n{error}");
    }
}

#[test]
fn what_a_scenario_lacks_is_said() {
    let scenario = quiet(Coefficients::NONE);
    let bare = Scenario {
        temperature: None,
        magnetic_field_gauss: None,
        ..scenario.clone()
    };
    let size = [("size", 1.0)];
    let late = [("size", 1.0), ("onset_s", DAY_S + 1.0)];
    let ramp = Hidden::new("gyro_x.ramp", &size).unwrap();
    let cases = [
        (
            with(&bare, "gyro_x.temperature", &size),
            "without a temperature",
        ),
        (
            with(&bare, "accel_x.temperature", &size),
            "without a temperature",
        ),
        (
            with(&bare, "gyro_x.magnetic", &size),
            "without a magnetic field",
        ),
        (with(&scenario, "gyro_x.step", &late), "onset in the record"),
        (
            with(&scenario, "site.latitude", &[("size", 60.0)]),
            "99.1 with the effect site.latitude",
        ),
        (
            Scenario {
                hidden: vec![ramp.clone(), ramp],
                ..scenario.clone()
            },
            "gyro_x.ramp twice",
        ),
    ];
    for (scenario, message) in cases {
        let error = simulate(&scenario).unwrap_err();
        assert!(matches!(error, Error::InvalidScenario { .. }), "{error}");
        assert!(error.to_string().contains(message), "{error}");
    }
    let error = euler_rule(&with(&scenario, "gyro_x.ramp", &size)).unwrap_err();
    assert!(
        error.to_string().contains("knows no hidden effects"),
        "{error}"
    );
}

#[test]
fn scaling_an_effect_scales_its_sizes_and_nothing_else() {
    let warmup = [("size", 0.1), ("time_constant_h", 3.0)];
    let hidden = Hidden::new("gyro_x.warmup", &warmup).unwrap();
    let expected = [("size", 0.05, "deg/h"), ("time_constant_h", 3.0, "h")];
    assert_eq!(hidden.scaled(0.5).unwrap().parameters(), expected);
    let diurnal = Hidden::new("gyro_x.diurnal", &[("cosine", 0.1)]).unwrap();
    let expected = [("sine", 0.0, "deg/h"), ("cosine", -0.2, "deg/h")];
    assert_eq!(diurnal.scaled(-2.0).unwrap().parameters(), expected);
    let walk = Hidden::new("gyro_x.random_walk", &[("size", 0.1)]).unwrap();
    assert!(walk.scaled(-1.0).is_err());
}
