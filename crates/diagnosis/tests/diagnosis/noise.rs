//! The noise audit over simulated records: the right finding, with its size, and nothing else.
//!
//! `cargo figures diagnosis --part ground` measures the same over populations; here each fault has a few
//! records.

use gyrocal_diagnosis::{AuditOptions, DiagnosisError, NoiseAudit, audit_noise};
use gyrocal_testkit::noise_faults::{Fault, FaultyRecord, faulty_record};
use gyrocal_truth::{Population, Term};

fn three_days() -> Population {
    let mut population = Population::new(20);
    population.duration_days = [3.0, 3.0];
    population
}

fn audit(case: &FaultyRecord) -> NoiseAudit {
    let options = AuditOptions::default();
    audit_noise(&case.record, &case.innovations, &case.declared, &options).unwrap()
}

fn names(audit: &NoiseAudit) -> Vec<&str> {
    let mut names: Vec<&str> = audit
        .findings
        .iter()
        .map(|finding| finding.effect)
        .collect();
    names.sort_unstable();
    names
}

/// Estimate and sigma of the first parameter of an effect.
fn size(audit: &NoiseAudit, effect: &str) -> (f64, f64) {
    let parameter = audit.finding(effect).unwrap().parameters[0];
    (parameter.estimate, parameter.sigma)
}

#[test]
fn clean_records_of_any_interval_have_no_finding() {
    for (interval_s, missing) in [(20.0, 0.0), (60.0, 0.03), (120.0, 0.0), (600.0, 0.01)] {
        let mut population = three_days();
        population.common.interval_s = interval_s;
        population.common.missing_fraction = missing;
        population.common.gaps_s = vec![[40_000.0, 52_000.0]];
        for number in 0..3 {
            let case = faulty_record(&population, number, Fault::None, &[]);
            let audit = audit(&case);
            assert!(
                audit.findings.is_empty(),
                "{interval_s} s: {:?}",
                audit.findings
            );
            assert_eq!(audit.cleaned.sample_ratio, [1.0; 3]);
            assert_eq!(audit.cleaned.apply(&case.record).len(), case.record.len());
            assert_eq!(audit.gaps.count, 1);
            // Half a gap's row at either end.
            assert!((audit.gaps.missing_s - 12_000.0).abs() <= interval_s);
            assert!((audit.gaps.missing_values - missing).abs() < 0.01);
            for ratio in audit.accel_ratio.unwrap() {
                // Twelve numbers a case; five sigmas are passed once in 1e6.
                assert!(
                    (ratio.estimate - 1.0).abs() < 5.0 * ratio.sigma,
                    "{ratio:?}"
                );
            }
        }
    }
}

#[test]
fn a_converter_is_found_with_its_step() {
    for number in 0..3 {
        let audit = audit(&faulty_record(
            &three_days(),
            number,
            Fault::Quantised(3.0),
            &[],
        ));
        let expected = [
            "accel_x.quantisation",
            "accel_y.quantisation",
            "accel_z.quantisation",
        ];
        assert_eq!(names(&audit), expected);
        for (axis, effect) in expected.iter().enumerate() {
            let (step_g, sigma_g) = size(&audit, effect);
            // Values are exact multiples but for rounding, 1e-16 against 3e-5.
            assert!(
                (step_g / 3e-5 - 1.0).abs() < 1e-9 && sigma_g < 1e-12,
                "{step_g} {sigma_g}"
            );
            // Noise and a uniform error of 3 sigma: 1 + 9 / 12.
            assert!((audit.cleaned.sample_ratio[axis].powi(2) - 1.75).abs() < 1e-6);
        }
    }
}

#[test]
fn outliers_are_found_one_by_one() {
    for number in 0..3 {
        let case = faulty_record(&three_days(), number, Fault::Outliers(0.005, 8.0), &[]);
        let audit = audit(&case);
        assert_eq!(names(&audit), ["accel.outliers"]);
        let right = |o: &&gyrocal_diagnosis::Outlier| case.outliers.contains(&(o.row, o.axis));
        let hits = audit.outliers.iter().filter(right).count();
        let f1 = 2.0 * hits as f64 / (audit.outliers.len() + case.outliers.len()) as f64;
        assert!(f1 >= 0.95, "{f1}");
        let size = audit.finding("accel.outliers").unwrap().parameters[1];
        // Some 65 outliers of 8 sigma, each seen with the noise of one sample: 1.6 %.
        assert!((size.estimate / 8e-5 - 1.0).abs() < 0.05, "{size:?}");
        let masked = audit
            .cleaned
            .keep
            .iter()
            .flatten()
            .filter(|keep| !**keep)
            .count();
        assert_eq!(masked, audit.outliers.len());
    }
}

#[test]
fn correlated_noise_is_called_that() {
    for (number, correlation) in [(0, 0.3), (1, 0.3), (2, -0.3), (3, 0.6)] {
        let audit = audit(&faulty_record(
            &three_days(),
            number,
            Fault::Coloured(correlation),
            &[],
        ));
        assert_eq!(names(&audit), ["accel.coloured_noise"]);
        let (found, sigma) = size(&audit, "accel.coloured_noise");
        // 12 000 values: sigma 0.013.
        assert!(
            (found - correlation).abs() < 3.0 * sigma && sigma < 0.02,
            "{found} {sigma}"
        );
        let slow = ((1.0 + found) / (1.0 - found)).sqrt();
        assert!((audit.cleaned.slow_ratio[0] - slow).abs() < 1e-12);
    }
}

#[test]
fn noise_of_another_size_is_called_that() {
    let expected = ["accel_x.noise", "accel_y.noise", "accel_z.noise"];
    for (number, ratio) in [(0, 1.2), (1, 0.8), (2, 3.0), (3, 0.2)] {
        let audit = audit(&faulty_record(
            &three_days(),
            number,
            Fault::Ratio(ratio),
            &[],
        ));
        assert_eq!(names(&audit), expected, "{ratio}");
        for (axis, effect) in expected.iter().enumerate() {
            let (found, _) = size(&audit, effect);
            // 4000 values of an axis: sigma 1.2 %.
            assert!((found / ratio - 1.0).abs() < 0.05, "{ratio} {found}");
            assert!((audit.cleaned.sample_ratio[axis] - found).abs() < 1e-12);
        }
    }
}

#[test]
fn physical_effects_are_no_noise() {
    // Each is hundreds of standard deviations of its Cramér-Rao bound.
    let terms: [fn() -> Term; 4] = [
        || {
            Term::Drift(Box::new(|m| {
                [0.0, if m.time_s > 1e5 { 0.3 } else { 0.0 }, 0.0]
            }))
        },
        || {
            Term::Output(Box::new(|m| {
                [if m.time_s > 1e5 { 4e-4 } else { 0.0 }, 0.0, 0.0]
            }))
        },
        || Term::Output(Box::new(|m| m.accel_g.map(|a| 1e-4 * a * a))),
        || Term::Drift(Box::new(|m| [0.1 * m.accel_g[1] * m.accel_g[2], 0.0, 0.0])),
    ];
    for (number, term) in terms.into_iter().enumerate() {
        let audit = audit(&faulty_record(
            &three_days(),
            number as u64,
            Fault::None,
            &[term()],
        ));
        assert!(
            audit.findings.is_empty(),
            "term {number}: {:?}",
            audit.findings
        );
    }
    let audit = audit(&faulty_record(&three_days(), 4, Fault::GyroRatio(3.0), &[]));
    assert!(audit.findings.is_empty(), "{:?}", audit.findings);
    let walk = audit.gyro_ratio.unwrap();
    // Three times the declared noise is nine times its variance, known here to two.
    assert!(
        (walk.estimate - 3.0).abs() < 5.0 * walk.sigma && walk.sigma < 0.5,
        "{walk:?}"
    );
}

#[test]
fn what_cannot_be_audited_says_why() {
    let mut case = faulty_record(&three_days(), 0, Fault::None, &[]);
    let options = AuditOptions::default();
    case.record.time_s.truncate(100);
    case.record.accel_g.truncate(100);
    let error = audit_noise(&case.record, &case.innovations, &case.declared, &options);
    assert!(matches!(
        error,
        Err(DiagnosisError::UnequalLengths { expected: 100, .. })
    ));
    for series in [
        &mut case.innovations.residual_g,
        &mut case.innovations.normalised,
    ] {
        series.truncate(100);
    }
    case.innovations.time_s.truncate(100);
    case.innovations.weighted_per_g.truncate(100);
    case.innovations.specific_force_g.truncate(100);
    // One block of 64 rows per axis is too few for a spectrum.
    let short = audit(&case);
    assert!(short.accel_ratio.is_none() && short.findings.is_empty());
    case.declared.accel_g[1] = 0.0;
    let error = audit_noise(&case.record, &case.innovations, &case.declared, &options);
    assert!(matches!(error, Err(DiagnosisError::InvalidArgument { .. })));
}
