//! Round trips: files are read as they were written, unusual but valid ones too.

#![cfg(test)]

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use gyrocal_record::{
    AveragedReport, AzimuthReport, Bench, CALIBRATION_SCHEMA_VERSION, CalibrationMethod,
    CalibrationReport, Coefficient, EffectTest, Error, FitVerdict, FittedEffect, FittedEffects,
    FittedParameter, GimbalLimits, Gravity, Input, Manifest, NamedCause, NoiseEstimate, NoiseRatio,
    OtherAzimuth, Outputs, Prior, Record, RecordReport, RunReport, SiteReport, SiteUncertainty,
    TurnOn, UndeterminedReport, write_json, write_whole,
};

fn record() -> Record {
    Record {
        time_s: vec![-12.5, 0.1, 1e9 + 1.0 / 3.0],
        accel_g: vec![
            [0.1 + 0.2, -0.0, 0.953_939_201_416_945_6],
            [f64::NAN, 1.0, 5e-324],
            [1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0],
        ],
        temperature_c: None,
    }
}

/// Equal to the bit, `NaN` included.
fn assert_same(a: &Record, b: &Record) {
    assert_eq!(a.time_s, b.time_s);
    assert_eq!(a.temperature_c, b.temperature_c);
    let bits = |record: &Record| -> Vec<[u64; 3]> {
        let rows = record.accel_g.iter();
        rows.map(|row| row.map(|a| if a.is_nan() { 1 } else { a.to_bits() }))
            .collect()
    };
    assert_eq!(bits(a), bits(b));
}

#[test]
fn a_record_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.csv");
    let plain = record();
    let warm = Record {
        temperature_c: Some(vec![21.5, -3.0, 1e-7]),
        ..record()
    };
    for record in [plain, warm] {
        record.write(&path).unwrap();
        assert_same(&Record::read(&path).unwrap(), &record);
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn odd_but_allowed_records_are_read() {
    let plain = "time_s,accel_x_g,accel_y_g,accel_z_g\n5,0,0,1\n7.25,nan,0,1\n900,NaN,-0.1,+1.0\n";
    let expected = Record::parse(plain, "plain").unwrap();
    assert_eq!(expected.time_s, [5.0, 7.25, 900.0]);
    let windows = plain.replace('\n', "\r\n");
    let blank = format!("{plain}\n  \n");
    let spaced = plain.replace(',', " , ");
    let quoted = plain
        .replace("nan", "\"nan\"")
        .replace("time_s", "\"time_s\"");
    let unfinished = plain.trim_end().to_owned();
    for text in [windows, blank, spaced, quoted, unfinished] {
        assert_same(&Record::parse(&text, "odd").unwrap(), &expected);
    }
    let marked = format!("\u{feff}{plain}");
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("marked.csv");
    fs::write(&path, marked).unwrap();
    assert_same(&Record::read(&path).unwrap(), &expected);

    let shuffled =
        "accel_z_g,temperature_c,time_s,accel_x_g,accel_y_g\n1,20,0,0,0.25\n1,21,60,0,0.25\n";
    let record = Record::parse(shuffled, "shuffled").unwrap();
    assert_eq!(record.accel_g[1], [0.0, 0.25, 1.0]);
    assert_eq!(record.temperature_c, Some(vec![20.0, 21.0]));
    assert_eq!(record.duration_s(), 60.0);
}

#[test]
fn a_record_that_no_one_could_read_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("record.csv");
    let mut short = record();
    short.accel_g.pop();
    let mut infinite = record();
    infinite.accel_g[0][2] = f64::INFINITY;
    let mut backwards = record();
    backwards.time_s.swap(0, 1);
    let mut timeless = record();
    timeless.time_s[1] = f64::NAN;
    for wrong in [short, infinite, backwards, timeless] {
        let error = wrong.write(&path).unwrap_err();
        assert!(matches!(error, Error::InvalidValue { .. }), "{error}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

fn bench() -> Bench {
    Bench {
        identification: BTreeMap::new(),
        latitude_deg: -33.25,
        gravity: None,
        uncertainty: SiteUncertainty::default(),
        magnetic_field_gauss: None,
        initial_angles_deg: Some([20.0, -35.0, 1.0 / 3.0]),
        initial_angles_sigma_deg: [0.01, 1e-7, 0.5],
        gimbal_limits: GimbalLimits::default(),
        accel_noise_g: 1e-5,
        gyro_noise_deg_per_h: 0.002,
        prior: Prior::default(),
    }
}

#[test]
fn a_bench_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("bench.toml");
    let facts = [
        ("serial number", "\"7\" \\ ü"),
        ("date", "2026-03-01"),
        ("note", "a\nb"),
    ];
    let full = Bench {
        identification: facts
            .map(|(key, value)| (key.to_owned(), value.to_owned()))
            .into(),
        gravity: Some(Gravity {
            local_m_per_s2: 9.796_1,
            unit_m_per_s2: 9.806_65,
        }),
        uncertainty: SiteUncertainty {
            latitude_sigma_deg: Some(0.002),
            earth_rate_relative_sigma: Some(1e-8),
            gravity_relative_sigma: Some(1e-6),
        },
        magnetic_field_gauss: Some([0.0, 0.3, -0.4]),
        gimbal_limits: GimbalLimits {
            deg: [Some([-30.0, 45.5]), None, Some([10.0, 10.0])],
        },
        prior: Prior {
            g_sigma_deg_per_h_per_g: [0.1, 0.2, 0.3],
            turn_on_sigma_deg_per_h: [0.05, 0.0, 0.01],
            ..Prior::default()
        },
        ..bench()
    };
    let unknown_attitude = Bench {
        initial_angles_deg: None,
        initial_angles_sigma_deg: [180.0; 3],
        ..bench()
    };
    assert_eq!(bench().specific_force_at_rest(), 1.0);
    assert_eq!(full.specific_force_at_rest(), 9.796_1 / 9.806_65);
    for bench in [bench(), full, unknown_attitude] {
        bench.write(&path).unwrap();
        assert_eq!(Bench::read(&path).unwrap(), bench);
    }
    let wrong = Bench {
        accel_noise_g: 0.0,
        ..bench()
    };
    let error = wrong.write(Path::new("bench.toml")).unwrap_err();
    assert!(error.to_string().contains("greater than 0"), "{error}");
}

fn report() -> CalibrationReport {
    CalibrationReport {
        schema_version: CALIBRATION_SCHEMA_VERSION,
        manifest: Manifest {
            program: "gyrocal".to_owned(),
            version: "0.1.0".to_owned(),
            model_hash: "abc".to_owned(),
            inputs: vec![],
            seed: 0,
            command: "gyrocal calibrate".to_owned(),
        },
        setup: Vec::new(),
        effects: vec![EffectTest {
            record: "r.csv".to_owned(),
            causes: vec![NamedCause {
                effect: "gyro_y.g_z".to_owned(),
                alternatives: vec!["gyro_y.magnetic".to_owned()],
                z: 16.1,
                p_value: Some(1e-40),
            }],
            noise: vec!["accel.coloured_noise".to_owned()],
            white: Some(true),
            residual_p_value: Some(0.4),
            settled: true,
        }],
        coefficients: vec![Coefficient {
            name: "gyro_x.bias".to_owned(),
            estimate: 0.1 + 0.2,
            sigma: 1e-5,
            unit: "deg/h".to_owned(),
            determined: true,
        }],
        covariance: vec![vec![1e-10]],
        nis_mean: Some(2.99),
        nis_band: Some([2.9, 3.1]),
        verdict: FitVerdict::Consistent,
        verdict_text: "fits".to_owned(),
        iterations: 2,
        usable: true,
        records: vec![record_report()],
        rows: 4321,
        final_angles_deg: Some([1.0, 2.0, 3.0]),
        method: CalibrationMethod::Batch,
        undetermined: vec![UndeterminedReport {
            text: "1.00 gyro_x.bias".to_owned(),
            weights: vec![1.0],
            share_of_prior: 0.3,
        }],
        runs: vec![run_report()],
        site: vec![SiteReport {
            quantity: "latitude".to_owned(),
            unit: "deg".to_owned(),
            assumed_error: 1e-3,
            declared_sigma: None,
            from_record_sigma: Some(1e-3),
            bias_per_unit: vec![-0.3],
        }],
        first_record_sigmas: Some(vec![2e-5]),
        with_effects: Some(FittedEffects {
            effects: vec![FittedEffect {
                effect: "gyro_x.warmup".to_owned(),
                name: "warm-up of gyro x".to_owned(),
                parameters: vec![FittedParameter {
                    name: "time_constant_h".to_owned(),
                    estimate: 3.5,
                    sigma: None,
                    interval: Some(vec![[2.0, 7.5]]),
                    unit: "h".to_owned(),
                }],
            }],
            gained_nats: 12.5,
            coefficients: Vec::new(),
            covariance: vec![vec![1e-8]],
        }),
    }
}

fn record_report() -> RecordReport {
    RecordReport {
        record: "r.csv".to_owned(),
        bench: "b.toml".to_owned(),
        rows: 259_201,
        duration_s: 259_200.0,
        averaged: Some(AveragedReport {
            interval_s: 60.0,
            means: 4321,
            left_out: 2,
            noise_ratio: 0.129,
            walk_share: 0.01,
        }),
        overlaps: Vec::new(),
    }
}

fn run_report() -> RunReport {
    let noise = NoiseRatio {
        ratio: 1.01,
        interval: [0.98, 1.04],
    };
    let turn_on = TurnOn {
        estimate: -0.02,
        sigma: 1e-3,
    };
    RunReport {
        record: "r.csv".to_owned(),
        initial_angles_deg: [0.5, 0.25, -1.0],
        final_angles_deg: [1.0, 2.0, 3.0],
        turn_on: Some([turn_on; 3]),
        azimuth: Some(AzimuthReport {
            starts: 12,
            ambiguous: false,
            other: Some(OtherAzimuth {
                relative_deg: 179.5,
                log_likelihood_deficit: 31.0,
            }),
        }),
        noise: Some(NoiseEstimate {
            accel: [noise; 3],
            gyro: [noise; 3],
        }),
        bounded_values: 7,
    }
}

#[test]
fn a_report_is_read_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.json");
    write_json(&path, &report()).unwrap();
    let text = fs::read_to_string(&path).unwrap();
    assert_eq!(
        serde_json::from_str::<CalibrationReport>(&text).unwrap(),
        report()
    );
    assert!(text.contains("\"verdict\": \"consistent\""), "{text}");
    assert!(text.ends_with("}\n"));
}

#[test]
fn inputs_are_hashed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("abc");
    fs::write(&path, "abc").unwrap();
    // The example of FIPS 180-4.
    let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
    assert_eq!(Input::of(&path).unwrap().sha256, expected);
}

#[test]
fn outputs_appear_together_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("a"), folder.path().join("b"));
    fs::write(&first, "old").unwrap();

    let mut outputs = Outputs::new();
    outputs.stage(&first, b"new").unwrap();
    let nowhere = folder.path().join("no/such/folder/c");
    let error = outputs.stage(&nowhere, b"new").unwrap_err();
    assert!(matches!(error, Error::Unwritable { .. }), "{error}");
    drop(outputs);
    assert_eq!(fs::read_to_string(&first).unwrap(), "old");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);

    let mut outputs = Outputs::new();
    outputs.stage(&first, b"new").unwrap();
    outputs.stage(&second, b"new too").unwrap();
    outputs.commit().unwrap();
    assert_eq!(fs::read_to_string(&first).unwrap(), "new");
    assert_eq!(fs::read_to_string(&second).unwrap(), "new too");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);

    let error = write_whole(folder.path(), b"a folder").unwrap_err();
    assert!(error.to_string().contains("cannot be written"), "{error}");
}

#[cfg(unix)]
#[test]
fn outputs_have_the_rights_of_new_files_and_links_stay() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = tempfile::tempdir().unwrap();
    let (plain, ours) = (folder.path().join("plain"), folder.path().join("ours"));
    let link = folder.path().join("link");
    fs::write(&plain, "").unwrap();
    write_whole(&ours, b"1").unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode();
    assert_eq!(mode(&plain), mode(&ours));

    symlink(&ours, &link).unwrap();
    write_whole(&link, b"2").unwrap();
    assert!(link.is_symlink());
    assert_eq!(fs::read_to_string(&ours).unwrap(), "2");

    // Of a link the link is removed.
    let mut outputs = Outputs::new();
    outputs.remove(&link);
    outputs.commit().unwrap();
    assert!(!link.exists() && ours.exists());
}

#[cfg(unix)]
#[test]
fn a_file_that_is_replaced_keeps_its_rights() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("private");
    // Less and more than a new file has.
    for mode in [0o600, 0o640, 0o666, 0o777] {
        fs::write(&path, "old").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
        write_whole(&path, b"new").unwrap();
        let found = fs::metadata(&path).unwrap().permissions().mode() & 0o7777;
        assert_eq!(found, mode, "{found:o}");
    }
}

#[test]
fn a_new_folder_appears_with_its_files_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let there = |path: &str| folder.path().join(path);
    let staged = || {
        let mut outputs = Outputs::new();
        outputs.folder(&there("new/pictures")).unwrap();
        outputs.folder(&there("new/pictures/more")).unwrap();
        for file in ["new/pictures/a", "new/pictures/more/b", "new/c"] {
            outputs.stage(&there(file), file.as_bytes()).unwrap();
        }
        assert!(!there("new/pictures").exists());
        outputs
    };
    drop(staged());
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    staged().commit().unwrap();
    for file in ["new/pictures/a", "new/pictures/more/b", "new/c"] {
        assert_eq!(fs::read_to_string(there(file)).unwrap(), file);
    }
    assert_eq!(fs::read_dir(there("new")).unwrap().count(), 2);
    assert_eq!(fs::read_dir(there("new/pictures")).unwrap().count(), 2);

    // Two runs that make the same folder both have their files there.
    let [one, other] = ["one", "other"].map(|file| {
        let mut outputs = Outputs::new();
        outputs.folder(&there("shared")).unwrap();
        let path = there("shared").join(file);
        outputs.stage(&path, file.as_bytes()).unwrap();
        outputs
    });
    one.commit().unwrap();
    other.commit().unwrap();
    assert_eq!(fs::read_dir(there("shared")).unwrap().count(), 2);

    // What an earlier run wrote goes with the commit, and only then.
    let mut outputs = Outputs::new();
    outputs.remove(&there("new/c"));
    outputs.remove(&there("never"));
    assert!(there("new/c").exists());
    outputs.commit().unwrap();
    assert!(!there("new/c").exists());
}

#[cfg(target_os = "linux")]
#[test]
fn a_device_is_written_to_and_not_replaced() {
    use std::os::unix::fs::FileTypeExt as _;
    write_whole(Path::new("/dev/null"), b"gone").unwrap();
    let kind = fs::metadata("/dev/null").unwrap().file_type();
    assert!(kind.is_char_device());
}
