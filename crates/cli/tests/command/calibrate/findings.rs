//! Results of `gyrocal calibrate` other than the coefficients, and its options.

use gyrocal_record::{CalibrationMethod, CalibrationReport, FitVerdict, Record};

use super::{JSON, folder, report, truth, unwrapped};
use crate::diagnose;
use crate::folder::{Folder, assert_says, example};

#[test]
fn an_azimuth_is_found_near_a_pole_though_gravity_tells_it_slowly() {
    let folder = Folder::new();
    let scenario = example("three_days.scenario.toml");
    folder.simulate(&scenario.replace("latitude_deg = 48.2", "latitude_deg = 89.0"));
    folder.forget_attitude("b.toml");
    let said = unwrapped(&folder.succeed("calibrate r.csv --bench b.toml"));
    assert_says(&said, "Data, model and declared noise agree.");
    assert_says(&said, "no other azimuth fits");
    let said = folder.succeed("diagnose r.csv --bench b.toml");
    assert!(said.starts_with("NO FAULT FOUND"), "{said}");
}

#[test]
fn the_sigmas_include_a_declared_latitude_sigma_through_its_sensitivity() {
    let folder = folder();
    folder.succeed(JSON);
    let known = report(&folder);
    let sigma_deg = 0.001;
    let declared = format!("latitude_deg = 48.2\nlatitude_sigma_deg = {sigma_deg}");
    let bench = example("three_days.bench.toml").replace("latitude_deg = 48.2", &declared);
    folder.put("b.toml", bench);
    let said = unwrapped(&folder.succeed(JSON));
    let considered = report(&folder);
    let site = &considered.site;
    let latitude = site
        .iter()
        .find(|site| site.quantity == "latitude")
        .unwrap();
    assert_eq!(
        (latitude.declared_sigma, &latitude.unit[..]),
        (Some(sigma_deg), "deg")
    );
    let pairs = known.coefficients.iter().zip(&considered.coefficients);
    for ((before, after), bias) in pairs.zip(&latitude.bias_per_unit) {
        assert_eq!(
            before.estimate, after.estimate,
            "latitude is considered, not estimated"
        );
        let expected = before.sigma.hypot(bias * sigma_deg);
        // The same sum of squares, rounded otherwise.
        assert!(
            (after.sigma / expected - 1.0).abs() < 1e-9,
            "{}",
            after.name
        );
    }
    assert_says(&said, "Latitude is known to 3.600 arcsec");
    // Of 3.0 arc seconds.
    let told = latitude.from_record_sigma.unwrap();
    assert!((2.0..4.0).contains(&(3600.0 * told)), "{told}");
    assert_says(&said, "better than declared");
    assert_says(&said, "latitude +3.600 arcsec (1 sigma)");
}

#[test]
fn a_bias_of_latitude_is_what_another_latitude_gives() {
    let folder = folder();
    folder.succeed(JSON);
    let first = report(&folder);
    let error_deg = 2e-4;
    let bench = example("three_days.bench.toml").replace("48.2", &format!("{}", 48.2 - error_deg));
    folder.put("b.toml", bench);
    folder.succeed(JSON);
    let second = report(&folder);
    let site = &first.site;
    let latitude = site
        .iter()
        .find(|site| site.quantity == "latitude")
        .unwrap();
    let pairs = first.coefficients.iter().zip(&second.coefficients);
    for ((before, after), bias) in pairs.zip(&latitude.bias_per_unit) {
        let shift = after.estimate - before.estimate;
        // Linear, but for 1e-3 of a sigma where both solutions stop.
        let expected = bias * error_deg;
        let tolerance = 0.01 * expected.abs() + 1e-3 * before.sigma;
        assert!(
            (shift - expected).abs() < tolerance,
            "{}: {shift} {expected}",
            before.name
        );
    }
}

#[test]
fn noise_is_told_beside_the_declared_unless_it_is_not_wanted() {
    let folder = folder();
    let doubled = example("three_days.bench.toml").replace("accel_g = 1e-5", "accel_g = 2e-5");
    folder.put("b.toml", doubled);
    let said = unwrapped(&folder.succeed(JSON));
    assert_says(&said, "The innovations are smaller than the declared noise");
    assert_says(&said, "accel_x (smaller), accel_y (smaller)");
    let noise = report(&folder).runs[0].noise.unwrap();
    for accel in noise.accel {
        // 4321 samples tell a standard deviation to 1.1 %.
        assert!((0.475..0.525).contains(&accel.ratio), "{accel:?}");
        assert!(accel.interval[0] < accel.ratio && accel.ratio < accel.interval[1]);
    }
    let said = folder.succeed(format!("{JSON} --no-noise"));
    assert!(!said.contains("Estimated over declared noise"), "{said}");
    assert_eq!(report(&folder).runs[0].noise, None);
}

#[test]
fn an_attitude_that_is_not_given_is_found() {
    let folder = folder();
    folder.succeed(JSON);
    let given = report(&folder);
    let bench = example("three_days.bench.toml");
    let free: Vec<&str> = bench
        .lines()
        .filter(|line| !line.contains("initial"))
        .collect();
    folder.put("b.toml", free.join("\n"));
    let said = unwrapped(&folder.succeed(JSON));
    let found = report(&folder);
    let azimuth = found.runs[0].azimuth.unwrap();
    assert!(azimuth.starts > 1 && !azimuth.ambiguous, "{azimuth:?}");
    assert_eq!(given.runs[0].azimuth, None);
    for (one, other) in found.coefficients.iter().zip(&given.coefficients) {
        // The declared 0.01 deg told little that three days do not.
        assert!(
            (one.estimate - other.estimate).abs() < 0.5 * other.sigma,
            "{}",
            one.name
        );
    }
    for (one, declared) in found.runs[0]
        .initial_angles_deg
        .iter()
        .zip([12.0, -25.0, 40.0])
    {
        // Five times the error of 0.01 deg that the scenario drew about these.
        assert!((one - declared).abs() < 0.05, "{one} {declared}");
    }
    assert_says(
        &said,
        "not declared. Levelled by the first samples, azimuth from a search over",
    );
}

/// Rows from..to of the record that ships.
fn cut(from: usize, to: usize) -> String {
    let whole = example("three_days.csv");
    let mut lines = whole.lines();
    let header = lines.next().unwrap();
    let rows: Vec<&str> = lines.skip(from).take(to - from).collect();
    format!("{header}\n{}\n", rows.join("\n"))
}

#[test]
fn two_records_are_one_calibration() {
    let folder = folder();
    folder.put("one.csv", cut(0, 1500));
    folder.put("two.csv", cut(1500, 3000));
    let bench = example("three_days.bench.toml");
    let free: Vec<&str> = bench
        .lines()
        .filter(|line| !line.contains("initial"))
        .collect();
    folder.put("free.toml", free.join("\n"));
    let arguments = "calibrate one.csv two.csv --bench b.toml --bench free.toml --json o.json";
    let said = folder.succeed(arguments);
    let both = report(&folder);
    assert_eq!((both.rows, both.runs.len()), (3000, 2));
    assert_eq!(
        (&both.records[1].record[..], &both.records[1].bench[..]),
        ("two.csv", "free.toml")
    );
    assert!(both.runs[0].azimuth.is_none() && both.runs[1].azimuth.is_some());
    assert_eq!(both.verdict, FitVerdict::Consistent);
    assert_says(
        &said,
        "\none.csv: 1500 rows over 1.04 days\n\ntwo.csv: 1500 rows",
    );
    assert_says(&said, "first record alone");
    // What it proposes is a command that runs.
    let next = said.lines().find(|line| line.contains("gyrocal diagnose"));
    let (next, _) = next.unwrap().split_once("#").unwrap();
    let words: Vec<&str> = next.split_whitespace().skip(2).collect();
    assert_eq!(words[..3], ["diagnose", "one.csv", "two.csv"], "{said}");
    folder.succeed(&words);
    let alone = both.first_record_sigmas.clone().unwrap();
    for (coefficient, alone) in both.coefficients.iter().zip(&alone) {
        assert!(coefficient.sigma < *alone, "{} {alone}", coefficient.sigma);
    }
    for (found, (name, value, _)) in both.coefficients.iter().zip(truth().coefficients.named()) {
        let error = (found.estimate - value) / found.sigma;
        // As of the whole record above.
        assert!(error.abs() < 4.0, "{name}: {error} sigmas");
    }
    folder.succeed("calibrate one.csv --bench b.toml --json o.json");
    for (coefficient, sigma) in report(&folder).coefficients.iter().zip(&alone) {
        assert_eq!(coefficient.sigma, *sigma);
    }

    // Turn-ons that may differ leave their mean less certain than either.
    let prior = "\n[prior]\nturn_on_sigma_deg_per_h = 0.01\n";
    folder.put("b.toml", bench.clone() + prior);
    folder.put("free.toml", free.join("\n") + prior);
    let said = folder.succeed(arguments);
    let turned = report(&folder);
    for run in &turned.runs {
        for turn_on in run.turn_on.unwrap() {
            // Both records are of one turn-on in truth: each is half of a difference of 1e-3.
            assert!(turn_on.estimate.abs() < 3e-3, "{turn_on:?}");
        }
    }
    // 0.01 deg/h over the root of two turn-ons.
    assert!((turned.coefficients[0].sigma / 7.07e-3 - 1.0).abs() < 0.02);
    assert_says(
        &said,
        "Offsets of the turn-ons from the mean constant drifts",
    );
}

#[test]
fn bounded_influence_withstands_outliers() {
    let folder = folder();
    let mut record = Record::parse(&example("three_days.csv"), "r.csv").unwrap();
    for row in (7..record.len()).step_by(97) {
        // Ten sigmas, of one sign: a mean would feel it.
        record.accel_g[row][row % 3] += 1e-4;
    }
    folder.succeed(JSON);
    let clean = report(&folder);
    record.write(&folder.path("r.csv")).unwrap();
    let errors = |report: &CalibrationReport| -> f64 {
        let pairs = report.coefficients.iter().zip(&clean.coefficients);
        pairs
            .map(|(one, other)| ((one.estimate - other.estimate) / other.sigma).powi(2))
            .sum()
    };
    folder.succeed(JSON);
    let trusting = report(&folder);
    let said = unwrapped(&folder.succeed(format!("{JSON} --robust")));
    let robust = report(&folder);
    // A quarter at least; a third of the limit stays of ten sigmas, a ninth in squares.
    assert!(
        4.0 * errors(&robust) < errors(&trusting),
        "{} {}",
        errors(&robust),
        errors(&trusting)
    );
    // 45 outliers and 0.27 % of 12 963 good values.
    let bounded = robust.runs[0].bounded_values;
    assert!((60..110).contains(&bounded), "{bounded}");
    assert_says(
        &said,
        &format!("Robust estimation: reduced weight of {bounded} values"),
    );
}

#[test]
fn fast_records_are_averaged() {
    let folder = Folder::new();
    let scenario = example("three_days.scenario.toml")
        .replace("duration_s = 259200.0", "duration_s = 86400.0")
        .replace("interval_s = 60.0", "interval_s = 5.0")
        .replace("accel_g = 1e-5", "accel_g = 3e-5");
    folder.simulate(&scenario);
    let said = unwrapped(&folder.succeed(format!("{JSON} --average 60")));
    let report = report(&folder);
    // A last row by itself is no mean.
    assert_says(
        &said,
        "r.csv: 17281 rows over 1.00 days, averaged over 60 s to 1440 means of 0.289 times the \
             noise; 3 values left out",
    );
    assert_eq!(report.rows, 1440);
    assert_eq!(report.verdict, FitVerdict::Consistent);
    let averaged = report.records[0].averaged.unwrap();
    assert_eq!((averaged.interval_s, averaged.means), (60.0, 1440));
    assert_eq!(report.records[0].rows, 17_281);
    for (found, (name, value, _)) in report.coefficients.iter().zip(truth().coefficients.named()) {
        let error = (found.estimate - value) / found.sigma;
        // As of the whole record above; without the attitude at the first row it would be tens.
        assert!(error.abs() < 4.0, "{name}: {error} sigmas");
    }
}

#[test]
fn one_pass_of_the_filter_is_there_on_request() {
    let folder = folder();
    folder.succeed(JSON);
    let batch = report(&folder);
    for form in ["", "--factorised"] {
        let said = folder.succeed(format!("{JSON} --streaming {form}"));
        let streaming = report(&folder);
        assert_eq!(streaming.method, CalibrationMethod::Streaming);
        assert_eq!(streaming.iterations, 1);
        assert!(streaming.runs.is_empty() && streaming.site.is_empty());
        assert_says(&said, "The streaming filter takes latitude");
        for (one, other) in streaming.coefficients.iter().zip(&batch.coefficients) {
            // Linearisation of one pass costs fractions of a sigma.
            assert!(
                (one.estimate - other.estimate).abs() < other.sigma,
                "{}",
                one.name
            );
            assert_ne!(one.estimate, other.estimate);
        }
    }
}

#[test]
fn what_a_short_record_does_not_determine_is_named() {
    let folder = folder();
    folder.put("r.csv", cut(0, 40));
    let said = unwrapped(&folder.succeed(JSON));
    let report = report(&folder);
    assert!(!report.undetermined.is_empty());
    for combination in &report.undetermined {
        assert!(said.contains(&combination.text), "{said}");
        let length: f64 = combination
            .weights
            .iter()
            .map(|weight| weight * weight)
            .sum();
        // A unit vector, rounded.
        assert!((length - 1.0).abs() < 1e-9 && combination.share_of_prior >= 0.1);
    }
    assert_says(&said, "Not determined: gyro_x.bias, gyro_x.g_x");
}

/// The table of the extended model without a search.
#[test]
fn given_effects_are_in_the_model() {
    let folder = Folder::new();
    folder.put("r.csv", example("hidden_fault.csv"));
    folder.put("b.toml", example("hidden_fault.bench.toml"));
    let with = |effects: &str| format!("{JSON} --with {effects}");
    let said = folder.succeed(with("gyro_y.g_z"));
    assert_says(&said, "with gyro_y.g_z");
    assert_says(&said, "Effects in the model, which gain");
    let report = report(&folder);
    let given = report.with_effects.unwrap();
    let [effect] = given.effects.as_slice() else {
        panic!("{given:?}");
    };
    let [size] = effect.parameters.as_slice() else {
        panic!("{given:?}");
    };
    // What a diagnosis of the same record finds.
    let found: serde_json::Value = serde_json::from_str(&diagnose::hidden_fault()).unwrap();
    let same = |own: f64, sigma: f64, other: &serde_json::Value| {
        // Both fits end where a step changes less than a hundredth of a sigma.
        (own - other.as_f64().unwrap()).abs() < 0.02 * sigma
    };
    let other = &found["findings"][0]["parameters"][0]["estimate"];
    let sigma = size.sigma.unwrap();
    assert!(same(size.estimate, sigma, other), "{size:?} {other}");
    for (index, own) in given.coefficients.iter().enumerate() {
        let other = &found["coefficients"]["extended"][index]["estimate"];
        assert!(same(own.estimate, own.sigma, other), "{own:?} {other}");
        let variance = given.covariance[index][index];
        assert!((variance.sqrt() / own.sigma - 1.0).abs() < 1e-12);
    }

    for (effects, message) in [
        ("gyro_y.gz", "the nearest are `gyro_y.g_z`"),
        ("site.latitude,clock.rate", "cannot be in one model"),
        ("gyro_x.noise", "is no effect that a model can have"),
        ("gyro_x.temperature", "the record has no column"),
    ] {
        let said = unwrapped(&folder.fail(with(effects)));
        assert!(said.contains(message), "{effects}: {said}");
    }
}
