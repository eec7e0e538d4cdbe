//! Inputs that no fit stands.

use gyrocal_record::CalibrationReport;

use super::{JSON, bench, record};
use crate::folder::{Folder, assert_says};

/// Arguments of one pass, in either form.
fn one_pass(form: &str) -> String {
    format!("{JSON} --streaming {form}")
}

#[test]
fn numbers_that_the_filter_cannot_stand_stop_it_with_advice() {
    for (right, wrong, row) in [
        ("= 1e-5", "= 1e-200", "row 1 of the data (t = 0 s)"),
        ("= 0.002", "= 1e200", "row 2 of the data (t = 60 s)"),
    ] {
        // --factorised is no answer to these, with or without it.
        for form in ["", "--factorised"] {
            let folder = Folder::new();
            folder.put("r.csv", record(20));
            folder.put("b.toml", bench().replace(right, wrong));
            let errors = folder.fail(one_pass(form));
            assert_says(&errors, "r.csv: no calibration\n");
            assert_says(&errors, &format!("the filter stopped at {row}\n"));
            assert_says(
                &errors,
                "help: the values of the bench file are implausible",
            );
        }
        let folder = Folder::new();
        folder.put("r.csv", record(20));
        folder.put("b.toml", bench().replace(right, wrong));
        let errors = folder.fail(JSON);
        assert_says(&errors, "r.csv: no calibration\n");
    }
}

#[test]
fn a_gyro_noise_out_of_proportion_is_told() {
    let folder = Folder::new();
    folder.put("r.csv", record(200));
    // From 1e-10 on, the linearised cost is rounding error.
    folder.put("b.toml", bench().replace("= 0.002", "= 1e-12"));
    for command in ["calibrate", "diagnose"] {
        let errors = folder.fail([command, "r.csv", "--bench", "b.toml"]);
        assert_says(&errors, "no shorter step fits");
        assert_says(&errors, "`gyro_deg_per_h` in [noise] is out of proportion");
    }
}

#[test]
fn a_fit_on_a_flat_cost_ends_at_the_values_of_a_larger_noise() {
    let folder = Folder::new();
    folder.put("r.csv", record(200));
    let [coarse, fine] = ["= 1e-7", "= 1e-9"].map(|noise| {
        folder.put("b.toml", bench().replace("= 0.002", noise));
        folder.succeed(JSON);
        let report: CalibrationReport = folder.json("o.json");
        report.coefficients
    });
    assert_eq!(coarse.len(), 9);
    for (coarse, fine) in coarse.iter().zip(&fine) {
        // A fit may end within a hundredth of a sigma of the least cost.
        let difference = (coarse.estimate - fine.estimate).abs();
        assert!(difference < 0.01 * coarse.sigma, "{coarse:?} {fine:?}");
    }
}

#[test]
fn a_prior_too_wide_for_the_covariance_itself_is_one_for_its_factors() {
    let folder = Folder::new();
    folder.put("r.csv", record(20));
    let prior = "\n[prior]\nbias_sigma_deg_per_h = 1e7\n";
    folder.put("b.toml", bench() + prior);
    let errors = folder.fail(one_pass(""));
    assert_says(&errors, "the filter stopped at row 2 of the data");
    assert_says(
        &errors,
        "help: the prior is very wide against the noise: give realistic",
    );
    assert_says(&errors, "use the factorised covariance (--factorised)");
    // Every cause is said once.
    let cause = "the prior is too wide against the noise of output";
    for said in ["the filter stopped", cause] {
        assert_eq!(errors.matches(said).count(), 1, "{errors}");
    }
    folder.succeed(one_pass("--factorised"));
}

#[test]
fn one_pass_needs_an_attitude() {
    let folder = Folder::new();
    folder.put("r.csv", record(20));
    let good = bench();
    let free: Vec<&str> = good
        .lines()
        .filter(|line| !line.contains("initial"))
        .collect();
    folder.put("b.toml", free.join("\n"));
    for option in ["--streaming", "--paper"] {
        let errors = folder.fail(format!("{JSON} {option}"));
        assert_says(&errors, "the bench file gives no initial angles");
        assert_says(&errors, "help: leave out --streaming or --paper");
    }
    // Without angles the platform is levelled by all three accelerometers.
    let blank: Vec<String> = record(40)
        .lines()
        .enumerate()
        .map(|(index, line)| match (index, line.rsplit_once(',')) {
            (1.., Some((rest, _))) => format!("{rest},nan"),
            _ => line.to_owned(),
        })
        .collect();
    folder.put("r.csv", blank.join("\n"));
    let errors = folder.fail_writing(JSON, &["o.json"]);
    assert_says(
        &errors,
        "The set-up is wrong: r.csv: Accelerometer z has no values.",
    );
    assert_says(&errors, "values in 0 of 40 rows");
}
