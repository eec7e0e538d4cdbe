//! Scenarios: files, populations, the Euler rule, hidden terms, and the bits of a record.

#![cfg(test)]

use std::ops::ControlFlow;
use std::path::Path;

use gyrocal_record::{Gravity, InputErrorKind, Prior};
use gyrocal_truth::{
    Coefficients, Error, Hidden, InitialAttitude, Population, Scenario, Term, euler_rule, simulate,
    simulate_watched, simulate_with,
};
use sha2::{Digest, Sha256};

fn short() -> Scenario {
    Scenario {
        coefficients: Coefficients::PAPER_LIKE,
        duration_s: 6.0 * 3600.0,
        ..Scenario::default()
    }
}

fn digest(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[test]
fn a_record_is_the_same_to_the_last_bit_on_every_machine() {
    let record = simulate(&short()).unwrap().record;
    let text = record.to_csv(Path::new("record.csv")).unwrap();
    assert_eq!(
        digest(text.as_bytes()),
        "d9f687adff1e6f732e7c2d71a26ab1c5acbbeb0267b1a93765f7f4e3c9b20494"
    );
}

/// The last effect of each plant, which the servo logs behind a play, and its strength.
#[cfg(feature = "plant")]
#[test]
fn records_of_plants_are_the_same_to_the_last_bit_on_every_machine() {
    use gyrocal_truth::plant::{Kind, Setting, simulate, strength};

    let found = Kind::ALL.map(|kind| {
        let setting = Setting {
            hidden: *kind.facts().effects.last().unwrap(),
            ..Setting::random(kind, 7, 300)
        };
        let run = simulate(&setting, None);
        let values = run.inputs.iter().chain(&run.outputs).flatten().copied();
        let values = values.chain([strength(&setting)]);
        let bytes: Vec<u8> = values.flat_map(f64::to_le_bytes).collect();
        digest(&bytes)[..16].to_owned()
    });
    let expected = [
        "e0a61bafa3231ad1",
        "39c58794bbfaaf9d",
        "5f931166d7c10363",
        "34ebbcee3028b59a",
        "dbe322e86dd40527",
    ];
    assert_eq!(found, expected);
}

#[test]
fn a_scenario_file_is_read_as_it_was_written() {
    let plain = short();
    let full = Scenario {
        seed: 9_007_199_254_740_993,
        latitude_deg: -33.0,
        gravity: Some(Gravity {
            local_m_per_s2: 9.796,
            unit_m_per_s2: 9.806_65,
        }),
        initial: InitialAttitude::Random,
        prior: Prior {
            bias_sigma_deg_per_h: [0.1, 0.2, 0.3],
            ..Prior::default()
        },
        start_s: 1e5,
        gaps_s: vec![[600.0, 1200.5]],
        missing_fraction: 0.01,
        ..plain.clone()
    };
    for scenario in [plain, full] {
        let again = Scenario::parse(&scenario.to_toml(), "scenario.toml").unwrap();
        assert_eq!(again, scenario);
    }
}

#[test]
fn a_mistake_in_a_scenario_file_is_shown_where_it_is() {
    let good = short().to_toml();
    let cases = [
        (
            "seed = 1",
            "sede = 1",
            "s.toml:1:1",
            "`seed`",
            InputErrorKind::UnknownKey,
        ),
        (
            "seed = 1",
            "seed = -1",
            "s.toml:1:8",
            "whole number",
            InputErrorKind::WrongType,
        ),
        (
            "[gyros]",
            "[gyro]",
            "s.toml:10:2",
            "`gyros`",
            InputErrorKind::UnknownKey,
        ),
        (
            "interval_s = 60.0",
            "interval_s = 0",
            "s.toml:21:14",
            "greater than 0",
            InputErrorKind::OutOfRange,
        ),
        (
            "duration_s = 21600.0",
            "duration_s = 1e12",
            "s.toml:20:14",
            "intervals",
            InputErrorKind::OutOfRange,
        ),
        (
            "duration_s = 21600.0\ninterval_s = 60.0",
            "duration_s = 1e11\ninterval_s = 1e9",
            "s.toml:20:14",
            "a hundred years",
            InputErrorKind::OutOfRange,
        ),
        (
            "gaps_s = []",
            "gaps_s = [[9.0, 3.0]]",
            "s.toml:23:11",
            "less than",
            InputErrorKind::OutOfRange,
        ),
        (
            "gaps_s = []",
            "gaps_s = [[0.0, 3.0]]",
            "s.toml:23:10",
            "after 0 s",
            InputErrorKind::OutOfRange,
        ),
        (
            "missing_fraction = 0.0",
            "missing_fraction = 2",
            "s.toml:24:20",
            "from 0 to 1",
            InputErrorKind::OutOfRange,
        ),
    ];
    for (right, wrong, place, expected, kind) in cases {
        assert!(good.contains(right), "{right}");
        let error = Scenario::parse(&good.replace(right, wrong), "s.toml").unwrap_err();
        let shown = error.to_string();
        assert!(shown.starts_with(place), "{shown}");
        assert!(shown.contains(expected), "{shown}");
        let gyrocal_record::Error::Input(input) = error else {
            panic!("{error}")
        };
        assert_eq!(input.kind, kind);
    }
}

#[test]
fn a_drift_that_would_take_ages_is_refused() {
    let good = short().to_toml();
    for (key, wrong) in [
        ("bias_deg_per_h", "[1e6, 0.0, 0.0]"),
        ("g_deg_per_h_per_g", "[0.0, -1e308, 0.0]"),
        ("gg_deg_per_h_per_g2", "[0.0, 0.0, 1e5]"),
        ("gyro_deg_per_h", "1e300"),
    ] {
        let head = format!("\n{key} = ");
        let (before, after) = good.split_once(&head).unwrap();
        let (_, rest) = after.split_once('\n').unwrap();
        let error = Scenario::parse(&format!("{before}{head}{wrong}\n{rest}"), "s.toml");
        let shown = error.unwrap_err().to_string();
        assert!(
            shown.contains("to 10000") && shown.starts_with("s.toml:"),
            "{shown}"
        );
    }
    for (id, parameters) in [
        ("gyro_x.step", [("size", 1e6), ("onset_s", 0.0)]),
        ("gyro_y.diurnal", [("sine", 1.0), ("cosine", -1e9)]),
    ] {
        let error = Hidden::new(id, &parameters).unwrap_err().to_string();
        assert!(error.contains("from -10000 to 10000"), "{error}");
    }
    // What no single number tells: each is in its bounds.
    let tone = Hidden::new("gyro_x.tone", &[("size", 1.0), ("period_h", 1e-12)]).unwrap();
    let scenario = Scenario {
        hidden: vec![tone],
        ..short()
    };
    let error = simulate(&scenario).unwrap_err().to_string();
    assert!(
        error.contains("scenario: drift: found ") && error.contains("more than 200000000 steps"),
        "{error}"
    );
}

#[test]
fn nonsense_in_memory_is_refused() {
    let wrong = [
        Scenario {
            latitude_deg: 91.0,
            ..short()
        },
        Scenario {
            interval_s: 0.0,
            ..short()
        },
        Scenario {
            duration_s: f64::INFINITY,
            ..short()
        },
        Scenario {
            accel_noise_g: f64::NAN,
            ..short()
        },
        Scenario {
            gaps_s: vec![[0.0, 60.0]],
            ..short()
        },
    ];
    for scenario in wrong {
        let error = simulate(&scenario).unwrap_err();
        assert!(matches!(error, Error::InvalidScenario { .. }), "{error}");
        assert_eq!(euler_rule(&scenario).unwrap_err(), error);
    }
}

#[test]
fn a_simulation_ends_at_the_row_where_it_is_told_to() {
    let mut rows = 0;
    let found = simulate_watched(&short(), &[], |row| {
        rows = row;
        match row {
            7 => ControlFlow::Break(()),
            _ => ControlFlow::Continue(()),
        }
    });
    assert_eq!((found.err(), rows), (Some(Error::Stopped), 7));
}

#[test]
fn a_population_fills_its_ranges() {
    let population = Population::new(3);
    let scenarios: Vec<Scenario> = (0..2000)
        .map(|number| population.scenario(number))
        .collect();
    let most = |of: fn(&Scenario) -> f64| scenarios.iter().map(of).fold(f64::MIN, f64::max);
    let least = |of: fn(&Scenario) -> f64| scenarios.iter().map(of).fold(f64::MAX, f64::min);
    // Of 2000 uniform numbers one is within half a percent of each end but for e^-10.
    let fills = |of: fn(&Scenario) -> f64, low: f64, high: f64| {
        let slack = 0.005 * (high - low);
        (low..low + slack).contains(&least(of)) && (high - slack..=high).contains(&most(of))
    };
    assert!(fills(|s| s.latitude_deg, -80.0, 80.0));
    assert!(fills(|s| s.duration_s / 86_400.0, 1.0 - 1e-3, 14.0));
    assert!(fills(|s| s.coefficients.bias_deg_per_h[0], -1.0, 1.0));
    assert!(fills(|s| s.coefficients.g_deg_per_h_per_g[1], -0.3, 0.3));
    assert!(fills(
        |s| s.coefficients.gg_deg_per_h_per_g2[2],
        -0.15,
        0.15
    ));
    // Any attitude: each element of the matrix has mean 0 and mean square 1/3 (sigma 0.0067).
    for row in 0..3 {
        for column in 0..3 {
            let elements = scenarios
                .iter()
                .map(|scenario| scenario.platform().initial_platform_c_enu.matrix()[row][column]);
            let (sum, squares) = elements.fold((0.0, 0.0), |(sum, squares), element| {
                (sum + element, squares + element * element)
            });
            assert!((sum / 2000.0).abs() < 0.05);
            assert!((squares / 2000.0 - 1.0 / 3.0).abs() < 0.03);
        }
    }
    assert_eq!(population.scenario(17), Population::new(3).scenario(17));
    assert_ne!(
        population.scenario(17).seed,
        Population::new(4).scenario(17).seed
    );
}

#[test]
fn a_varied_population_has_every_interval_gaps_and_both_hemispheres() {
    let population = Population::varied(5);
    let scenarios: Vec<Scenario> = (0..400).map(|number| population.scenario(number)).collect();
    let share = |of: &dyn Fn(&Scenario) -> bool| {
        scenarios.iter().filter(|scenario| of(scenario)).count() as f64 / 400.0
    };
    // A share of 1/4 has a sigma of 0.022, a share of 1/2 one of 0.025.
    for interval_s in [10.0, 30.0, 60.0, 120.0] {
        assert!((share(&|s| s.interval_s == interval_s) - 0.25).abs() < 0.09);
    }
    for gaps in 0..=3 {
        assert!((share(&|s| s.gaps_s.len() == gaps) - 0.25).abs() < 0.09);
    }
    assert!((share(&|s| s.latitude_deg < 0.0) - 0.5).abs() < 0.1);
    for scenario in &scenarios {
        assert_eq!(scenario.check(), Ok(()));
        assert!((1.99..=7.0).contains(&(scenario.duration_s / 86_400.0)));
        for gap in &scenario.gaps_s {
            assert!((600.0..21_600.1).contains(&(gap[1] - gap[0])));
            assert!(gap[1] <= scenario.duration_s);
        }
    }
    // Variety is drawn after the rest, which is that of the usual population.
    let mut usual = Population::new(5);
    usual.duration_days = population.duration_days;
    let [varied, usual] = [population, usual].map(|population| population.scenario(3));
    assert_eq!(varied.coefficients, usual.coefficients);
    assert_eq!(varied.seed, usual.seed);
}

#[test]
fn the_euler_rule_is_wrong_in_the_first_order() {
    let error_rad = |interval_s: f64| {
        let scenario = Scenario {
            interval_s,
            initial_angles_sigma_deg: [0.0; 3],
            accel_noise_g: 0.0,
            gyro_noise_deg_per_h: 0.0,
            ..short()
        };
        let exact = simulate(&scenario).unwrap().truth.platform_c_enu_last();
        let euler = euler_rule(&scenario).unwrap().truth.platform_c_enu_last();
        let [x, y, z] = euler.rotation_from_rad(exact);
        (x * x + y * y + z * z).sqrt()
    };
    let (minute, half) = (error_rad(60.0), error_rad(30.0));
    // The second order is 0.4% of the first at a quarter of a degree a step.
    assert!((minute / half - 2.0).abs() < 0.05, "{minute:e} {half:e}");
    // Up to 1e-5 rad a step, 360 steps: far above the accelerometers' noise.
    assert!((1e-4..4e-3).contains(&minute), "{minute:e}");
}

#[test]
fn hidden_terms_enter_where_they_say() {
    let clean = simulate(&short()).unwrap();
    let biased = Scenario {
        coefficients: Coefficients {
            bias_deg_per_h: short().coefficients.bias_deg_per_h.map(|bias| bias + 0.25),
            ..short().coefficients
        },
        ..short()
    };
    let drift = Term::Drift(Box::new(|_| [0.25; 3]));
    let as_term = simulate_with(&short(), &[drift]).unwrap();
    let as_coefficient = simulate(&biased).unwrap();
    assert_ne!(as_term.record, clean.record);
    for (a, b) in as_term
        .record
        .accel_g
        .iter()
        .zip(&as_coefficient.record.accel_g)
    {
        for axis in 0..3 {
            // Another order of the same sum, over six hours.
            assert!((a[axis] - b[axis]).abs() < 1e-13);
        }
    }

    let scale = Term::Output(Box::new(|moment| moment.accel_g.map(|a| 1e-3 * a)));
    let coarse = Term::Noise(Box::new(|_, sample| {
        sample.map(|a| (a * 1e4).round() / 1e4)
    }));
    let seen = simulate_with(&short(), &[scale, coarse]).unwrap();
    assert_eq!(seen.truth, clean.truth);
    for (seen, clean) in seen.record.accel_g.iter().zip(&clean.record.accel_g) {
        for axis in 0..3 {
            // Scale of the noise (1e-8) and half a digit.
            assert!((seen[axis] - 1.001 * clean[axis]).abs() < 0.5e-4 + 1e-7);
            assert_eq!((seen[axis] * 1e4).round() / 1e4, seen[axis]);
        }
    }

    let slow = Term::Time(Box::new(|clock_s| 2.0 * clock_s));
    let quiet = Scenario {
        gyro_noise_deg_per_h: 0.0,
        ..short()
    };
    let doubled = simulate_with(&quiet, &[slow]).unwrap();
    let long = simulate(&Scenario {
        duration_s: 12.0 * 3600.0,
        ..quiet
    })
    .unwrap();
    assert_eq!(doubled.record.time_s, clean.record.time_s);
    let turn = doubled
        .truth
        .platform_c_enu_last()
        .rotation_from_rad(long.truth.platform_c_enu_last());
    // The same motion in other steps.
    assert!(turn.iter().all(|angle| angle.abs() < 1e-13), "{turn:?}");
}
