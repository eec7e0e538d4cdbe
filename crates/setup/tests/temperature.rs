//! Temperatures in another unit, and values that cannot be temperatures.
#![cfg(test)]

use gyrocal_record::Record;
use gyrocal_setup::{SetupCheck, SetupKind, check_setup};
use gyrocal_truth::{InitialAttitude, Scenario, simulate};

/// The check of a sound record whose rows have these temperatures.
fn checked(temperature_c: impl Fn(usize) -> f64) -> (SetupCheck, Record) {
    let scenario = Scenario {
        seed: 2_200_000,
        initial: InitialAttitude::Random,
        interval_s: 300.0,
        ..Scenario::default()
    };
    let simulation = simulate(&scenario).unwrap();
    let mut record = simulation.record;
    record.temperature_c = Some((0..record.len()).map(temperature_c).collect());
    (check_setup(&record, &simulation.bench), record)
}

/// A course of a day in °C.
fn course(row: usize) -> f64 {
    22.0 + 3.0 * (row as f64 / 40.0).sin()
}

fn temperatures(check: &SetupCheck) -> Option<&Vec<f64>> {
    check.usable.as_ref()?.temperature_c.as_ref()
}

#[test]
fn a_temperature_in_degrees_celsius_is_left_as_it_is() {
    for shift in [0.0, 60.0, -80.0] {
        let (check, record) = checked(|row| course(row) + shift);
        assert_eq!(check.findings, []);
        assert_eq!(check.usable.as_ref(), Some(&record));
    }
}

#[test]
fn kelvins_are_told_and_converted() {
    let (check, record) = checked(|row| course(row) + 273.15);
    let [finding] = &check.findings[..] else {
        panic!("{:?}", check.findings)
    };
    assert_eq!(
        (finding.kind, finding.stops),
        (SetupKind::Temperature, false)
    );
    for words in ["seems to be in K", "subtract 273.15", "--columns MAP.toml"] {
        assert!(finding.description.contains(words), "{finding:?}");
    }
    assert_eq!(finding.rows, Some(0..record.len()));
    let converted = temperatures(&check).unwrap();
    for (row, value) in converted.iter().enumerate() {
        // Rounding of numbers up to 1e3.
        assert!((value - course(row)).abs() < 1e-12 * 1e3, "{value}");
    }
}

#[test]
fn values_that_are_no_temperatures_are_interpolated_or_left_out() {
    let (check, _) = checked(|row| {
        if (50..60).contains(&row) {
            -999.0
        } else {
            course(row)
        }
    });
    let [finding] = &check.findings[..] else {
        panic!("{:?}", check.findings)
    };
    assert_eq!(finding.rows, Some(50..60));
    assert!(
        finding
            .evidence
            .contains("-999.0 in row 51; 10 rows outside of -100 to 250"),
        "{finding:?}"
    );
    let mended = temperatures(&check).unwrap();
    let [before, after] = [course(49), course(60)];
    for (step, row) in (50..60).enumerate() {
        let between = before + (step + 1) as f64 / 11.0 * (after - before);
        assert!((mended[row] - between).abs() < 1e-12 * 1e3);
    }
    let (check, _) = checked(|_| 30_000.0);
    assert!(check.findings[0].description.contains("left out"));
    assert_eq!(temperatures(&check), None);
    assert!(check.usable.is_some());
}
