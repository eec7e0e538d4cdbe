//! The gate: what rows alone do not decide is decided by fits of both signs of the latitude.

use gyrocal_answer::Answer;
use gyrocal_calibration::{Options, Run, calibrate};
use gyrocal_diagnosis::{DiagnoseOptions, Gate, diagnose};
use gyrocal_record::RecordFile;
use gyrocal_setup::{PlatformKind, check_setup};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::faults::leave_angles_out;
use gyrocal_truth::{Coefficients, InitialAttitude, Scenario, Simulation, simulate};
use gyrocal_words::first_screen;

/// A record without angles, with coefficients from the prior of 1 deg/h.
fn record(seed: u64, latitude_deg: f64, hours: f64) -> Simulation {
    let mut random = Draw::new(seed, 0);
    let mut three = || core::array::from_fn(|_| random.normal());
    let scenario = Scenario {
        seed,
        latitude_deg,
        initial: InitialAttitude::Random,
        duration_s: 3600.0 * hours,
        coefficients: Coefficients {
            bias_deg_per_h: three(),
            g_deg_per_h_per_g: three(),
            gg_deg_per_h_per_g2: three(),
        },
        ..Scenario::default()
    };
    let mut simulation = simulate(&scenario).unwrap();
    leave_angles_out(&mut simulation.bench);
    simulation
}

fn kinds(simulation: &Simulation) -> Vec<String> {
    let (record, bench) = (&simulation.record, &simulation.bench);
    let run = Run { record, bench };
    let found = Gate::new(PlatformKind::Stabilised, &run, &Options::default());
    assert_eq!(found.stops(), !found.problems.is_empty());
    found.problems.into_iter().map(|p| p.kind).collect()
}

#[test]
fn a_wrong_sign_of_the_latitude_is_told_where_rates_do_not_decide() {
    // Near the equator; over a short record.
    for (latitude_deg, hours, first) in [(12.0, 24.0, 2_180_000), (-40.0, 9.0, 2_180_100)] {
        for seed in first..first + 6 {
            let mut simulation = record(seed, latitude_deg, hours);
            let check = check_setup(&simulation.record, &simulation.bench);
            assert!(check.findings.is_empty() && check.unconfirmed.is_some());
            assert_eq!(kinds(&simulation), [""; 0], "{latitude_deg} deg, {seed}");
            simulation.bench.latitude_deg *= -1.0;
            // 1.5 (2 Ω sin φ)² is 58 nats at 12 deg, with a sigma of 11.
            assert_eq!(kinds(&simulation), ["handedness"], "{latitude_deg}, {seed}");
        }
    }
}

#[test]
fn nothing_tells_the_sign_at_the_equator_or_with_a_wide_prior() {
    let mut simulation = record(2_180_200, 2.0, 48.0);
    simulation.bench.latitude_deg *= -1.0;
    let check = check_setup(&simulation.record, &simulation.bench);
    assert!(check.findings.is_empty() && check.unconfirmed.is_none());
    let mut simulation = record(2_180_201, 10.0, 24.0);
    simulation.bench.latitude_deg *= -1.0;
    simulation.bench.prior.g_sigma_deg_per_h_per_g = [10.0; 3];
    assert_eq!(kinds(&simulation), [""; 0]);
}

#[test]
fn problems_of_a_file_have_its_lines_and_the_rest_is_checked() {
    let mut simulation = record(2_180_300, 45.0, 24.0);
    for row in &mut simulation.record.accel_g[300..320] {
        row[1] = -999.0;
    }
    let bench = &simulation.bench;
    let text = simulation.record.to_csv("r.csv".as_ref()).unwrap();
    let of = |text: &str| {
        let file = RecordFile::parse(text, "r.csv").unwrap();
        let kind = PlatformKind::Stabilised;
        let found = Gate::of_file(kind, &file, bench, &Options::default());
        found.map(|found| (found.problems, found.usable.map(|usable| usable.len())))
    };
    let (problems, rows) = of(&text).unwrap();
    assert_eq!(problems.len(), 1);
    assert_eq!(problems[0].lines, Some([302, 321]));
    assert!(
        problems[0]
            .text()
            .starts_with("r.csv:302-321: Missing values")
    );
    assert_eq!(rows, Some(simulation.record.len()));
    // One row of nonsense is no set-up: it is refused at its place.
    let mut lines: Vec<&str> = text.lines().collect();
    lines[100] = "5940.0,0.0,0.0,9.81";
    let error = of(&(lines.join("\n") + "\n")).unwrap_err().to_string();
    assert!(error.starts_with("r.csv:101:1: found a norm"), "{error}");
}

fn diagnosed(simulation: &Simulation) -> Answer {
    let options = DiagnoseOptions::default();
    let found = diagnose(&simulation.record, &simulation.bench, &options);
    found.unwrap().result
}

/// The turn of gravity is not known of an hour, and the answer says so.
#[test]
fn what_a_short_record_does_not_tell_of_the_set_up_is_told() {
    for (hours, is_told) in [(1.0, true), (12.0, false)] {
        let found = diagnosed(&record(2_180_400, 47.0, hours));
        let facts = first_screen(&found).facts;
        let told = facts.iter().any(|fact| fact.label == "set-up");
        assert_eq!(told, is_told, "{hours} h: {facts:?}");
    }
}

/// One band for the NIS of both commands.
#[test]
fn calibration_and_diagnosis_expect_the_same_of_the_innovations() {
    let simulation = record(2_180_500, 47.0, 24.0);
    let found = diagnosed(&simulation).residuals.unwrap().nis.unwrap();
    let (record, bench) = (&simulation.record, &simulation.bench);
    let calibration = calibrate(record, bench, &Options::default(), |_| ()).unwrap();
    for (diagnosed, calibrated) in found.band.into_iter().zip(calibration.fit.nis_band()) {
        // The same quantile, divided in another order.
        assert!((diagnosed / calibrated - 1.0).abs() < 1e-12, "{found:?}");
    }
}

/// Exchanged axes fit every record without angles: the answer says so, and proposes no run for it.
#[test]
fn set_ups_that_fit_alike_are_told_without_angles() {
    let mut simulation = record(2_180_300, 47.0, 24.0);
    let found = diagnosed(&simulation);
    assert!(found.set_ups.is_some());
    let screen = first_screen(&found);
    assert!(screen.facts.iter().any(|fact| fact.label == "axes"));
    // With axes exchanged in a circle it is as sound a record.
    for [x, y, z] in &mut simulation.record.accel_g {
        (*x, *y, *z) = (*y, *z, *x);
    }
    assert_eq!(diagnosed(&simulation).verdict, found.verdict);
}
