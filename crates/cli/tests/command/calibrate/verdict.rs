//! The verdict of `gyrocal calibrate`, in the scale of the diagnosis, and what follows from it.

use gyrocal_answer::Answer;
use gyrocal_document::Standing;
use gyrocal_record::{CalibrationReport, FitVerdict};
use gyrocal_words::calibration_screen;

use super::{JSON, folder, report, unwrapped};
use crate::diagnose;
use crate::folder::{Folder, assert_says, example};

/// A folder with the record with a hidden fault and its bench description.
fn hidden_fault() -> Folder {
    let folder = Folder::new();
    folder.put("r.csv", example("hidden_fault.csv"));
    folder.put("b.toml", example("hidden_fault.bench.toml"));
    folder
}

#[test]
fn a_fault_that_the_diagnosis_finds_is_told_with_its_probability() {
    let folder = hidden_fault();
    let said = unwrapped(&folder.succeed(JSON));
    assert_says(
        &said,
        "The record shows an effect that the model lacks: the coefficients may be biased. The record shows \
             gyro_y.g_z (",
    );
    assert!(
        !said.contains("data, model and declared noise agree"),
        "{said}"
    );
    let next = "next gyrocal diagnose r.csv --bench b.toml # looks for the causes";
    assert!(said.contains(next), "{said}");
    let found = report(&folder);
    assert_eq!(found.verdict, FitVerdict::EffectsFound);
    let diagnosis: Answer = serde_json::from_str(&diagnose::hidden_fault()).unwrap();
    let [test] = &found.effects[..] else {
        panic!("{:?}", found.effects)
    };
    let ([told], [named, ..]) = (&test.causes[..], &diagnosis.findings[..]) else {
        panic!("{test:?}")
    };
    assert_eq!(told.effect, named.effect);
    let alternatives = named.alternatives.iter().map(|one| &*one.effect);
    assert_eq!(told.alternatives, alternatives.collect::<Vec<_>>());
    assert_eq!((told.z, told.p_value), (named.z, named.p_value));
    assert!(told.z > 15.0, "{test:?}");
    // Both give the mean of a row.
    let nis = diagnosis.residuals.unwrap().nis.unwrap().mean;
    assert!((nis / found.nis_mean.unwrap() - 1.0).abs() < 0.01, "{nis}");
}

#[test]
fn a_record_that_fits_is_told_as_such_with_what_to_run_next() {
    let folder = folder();
    let said = unwrapped(&folder.succeed(JSON));
    assert_says(
        &said,
        "no effect of the catalogue is significant, innovations white.",
    );
    assert_says(
        &said,
        "next gyrocal diagnose r.csv --bench b.toml # all tests",
    );
    let mut found = report(&folder);
    assert_eq!(found.verdict, FitVerdict::Consistent);
    assert!(found.effects[0].causes.is_empty() && found.effects[0].settled);
    // Without its diagnosis it is less sure.
    assert_eq!(calibration_screen(&found).standing, Standing::Good);
    found.effects.clear();
    let screen = calibration_screen(&found);
    assert_eq!(screen.standing, Standing::Doubtful);
    assert!(
        screen.what.ends_with("no diagnosis could be made"),
        "{screen:?}"
    );
}

#[test]
fn noise_that_is_declared_too_small_is_no_effect() {
    let folder = folder();
    let bench = example("three_days.bench.toml").replace("deg_per_h = 0.002", "deg_per_h = 0.0008");
    assert_ne!(bench, example("three_days.bench.toml"));
    folder.put("b.toml", bench);
    folder.succeed(JSON);
    let found = report(&folder);
    assert_eq!(found.verdict, FitVerdict::TooLarge, "{:?}", found.effects);
}

#[test]
fn coefficients_that_mean_nothing_are_not_tabled() {
    let folder = folder();
    // A hundredth of the noise that the record has.
    let bench = example("three_days.bench.toml").replace("accel_g = 1e-5", "accel_g = 1e-7");
    folder.put("b.toml", bench);
    let output = folder.run(JSON);
    assert_eq!(output.status.code(), Some(1));
    let said = unwrapped(&String::from_utf8(output.stdout).unwrap());
    assert_says(&said, "the coefficients are not usable");
    assert!(
        !said.contains("determine") && !said.contains("gyro_x.bias"),
        "{said}"
    );
    let found: CalibrationReport = report(&folder);
    assert_eq!(found.verdict, FitVerdict::TooLarge);
    assert!(found.coefficients.iter().all(|one| !one.determined));
}

/// A record with an effect hidden, and its bench description, calibrated.
fn calibrated(hidden: &str) -> (String, CalibrationReport) {
    let folder = Folder::new();
    folder.simulate(&format!(
        "{}\n{hidden}",
        example("three_days.scenario.toml")
    ));
    let said = unwrapped(&folder.succeed(JSON));
    (said, report(&folder))
}

#[test]
fn innovations_that_are_not_white_are_not_called_calibrated() {
    // A tone of half the sigma of a sample.
    let (said, found) =
        calibrated("[[hidden]]\neffect = \"accel_x.tone\"\nsize = 5e-6\nperiod_h = 0.5\n");
    assert_eq!(found.verdict, FitVerdict::Unexplained, "{said}");
    assert_says(&said, "the innovations are not white");
    assert_eq!(found.effects[0].white, Some(false));
    assert!(found.effects[0].causes.is_empty());
}

#[test]
fn noise_that_the_audit_finds_is_told() {
    let (said, found) =
        calibrated("[[hidden]]\neffect = \"accel.coloured_noise\"\ncorrelation = 0.2\n");
    assert_eq!(found.verdict, FitVerdict::NoiseDiffers, "{said}");
    assert_eq!(found.effects[0].noise, ["accel.coloured_noise"]);
    assert_eq!(found.effects[0].white, Some(true));
    assert_says(&said, "accel.coloured_noise");
    assert_says(&said, "No ratio for the gyros");
    // One gyro has more noise than declared, which the mean NIS of all channels hardly shows.
    let (said, found) = calibrated("[[hidden]]\neffect = \"gyro_x.noise\"\nratio = 2.0\n");
    assert_eq!(found.effects[0].noise, ["gyro_x.noise"], "{said}");
    assert_ne!(found.verdict, FitVerdict::Consistent);
}
