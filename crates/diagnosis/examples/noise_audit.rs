//! Operating characteristics of the noise audit over random records.
//!
//! `cargo run --release -p gyrocal-diagnosis --example noise_audit -- [RUNS] [SEED] [DAYS] [INTERVAL_S] [MISSING]`
#![allow(clippy::unwrap_used, clippy::expect_used)] // a measurement: what fails must stop it

use std::collections::BTreeMap;

use gyrocal_diagnosis::{AuditOptions, NoiseAudit, audit_noise};
use gyrocal_truth::{Population, Term};
use population::{Case, Fault, case};

#[path = "../tests/noise/population.rs"]
mod population;

fn main() {
    let numbers: Vec<f64> = std::env::args()
        .skip(1)
        .map(|text| text.parse().expect("a number"))
        .collect();
    let argument =
        |position: usize, default: f64| numbers.get(position).copied().unwrap_or(default);
    let runs = argument(0, 200.0) as u64;
    let mut population = Population::new(argument(1, 1.0) as u64);
    let days = argument(2, 3.0);
    population.duration_days = [days, days];
    population.common.interval_s = argument(3, 60.0);
    population.common.missing_fraction = argument(4, 0.0);
    let everything: [(&str, Fault, u64, &[&str]); 7] = [
        ("clean", Fault::None, 2, &[]),
        (
            "LSB 3 sigma",
            Fault::Quantised(3.0),
            1,
            &[
                "accel_x.quantisation",
                "accel_y.quantisation",
                "accel_z.quantisation",
            ],
        ),
        (
            "0.5 % at 8 sigma",
            Fault::Outliers(0.005, 8.0),
            1,
            &["accel.outliers"],
        ),
        (
            "AR(1) 0.3",
            Fault::Coloured(0.3),
            1,
            &["accel.coloured_noise"],
        ),
        (
            "sigma 1.2",
            Fault::Ratio(1.2),
            1,
            &["accel_x.noise", "accel_y.noise", "accel_z.noise"],
        ),
        (
            "sigma 0.8",
            Fault::Ratio(0.8),
            1,
            &["accel_x.noise", "accel_y.noise", "accel_z.noise"],
        ),
        ("gyros 3", Fault::GyroRatio(3.0), 1, &[]),
    ];
    for (name, fault, times, expected) in everything {
        let make = |number| case(&population, number, fault, &[]);
        measure(name, runs * times, fault, expected, make);
    }
    type Hidden = (&'static str, fn() -> Term);
    let hidden: [Hidden; 7] = [
        ("step .01 deg/h", || {
            Term::Drift(Box::new(|m| {
                [0.0, if m.time_s > 1e5 { 0.01 } else { 0.0 }, 0.0]
            }))
        }),
        ("step of 0.3 deg/h", || {
            Term::Drift(Box::new(|m| {
                [0.0, if m.time_s > 1e5 { 0.3 } else { 0.0 }, 0.0]
            }))
        }),
        ("accel step 40 sigma", || {
            Term::Output(Box::new(|m| {
                [if m.time_s > 1e5 { 4e-4 } else { 0.0 }, 0.0, 0.0]
            }))
        }),
        ("quadratic 1e-4", || {
            Term::Output(Box::new(|m| m.accel_g.map(|a| 1e-4 * a * a)))
        }),
        ("tone 7 rows 0.2 sigma", || {
            Term::Output(Box::new(|m| [2e-6 * (m.time_s / 67.0).sin(), 0.0, 0.0]))
        }),
        ("tone 1 h .01 deg/h", || {
            Term::Drift(Box::new(|m| [0.01 * (m.time_s * 1.7e-3).sin(), 0.0, 0.0]))
        }),
        ("sign 0.05 deg/h", || {
            Term::Drift(Box::new(|m| m.accel_g.map(|a| 0.05 * a.signum())))
        }),
    ];
    for (name, term) in hidden {
        let make = |number| case(&population, number, Fault::None, &[term()]);
        measure(name, runs / 2, Fault::None, &[], make);
    }
}

fn measure(name: &str, runs: u64, fault: Fault, expected: &[&str], make: impl Fn(u64) -> Case) {
    let mut named: BTreeMap<&str, u64> = BTreeMap::new();
    let (mut right, mut sized, mut time, mut scores) = (0, 0, 0.0, 0.0);
    let mut values: Vec<[f64; 6]> = Vec::new();
    for number in 0..runs {
        let case = make(number);
        let begun = std::time::Instant::now();
        let audit = audit_noise(
            &case.record,
            &case.innovations,
            &case.declared,
            &AuditOptions::default(),
        )
        .unwrap();
        time += begun.elapsed().as_secs_f64();
        let mut found: Vec<&str> = audit
            .findings
            .iter()
            .map(|finding| finding.effect)
            .collect();
        found.sort_unstable();
        right += u64::from(found == expected);
        for effect in found {
            *named.entry(effect).or_default() += 1;
        }
        let score = f1(&case, &audit);
        scores += score;
        sized += u64::from(is_sized(fault, &audit, score));
        if let (Some(r), Some(c), Some(g)) =
            (audit.accel_ratio, audit.correlation, audit.gyro_ratio)
        {
            values.push([
                r[0].estimate,
                r[1].estimate,
                c.estimate,
                g.estimate,
                r[0].sigma,
                c.sigma,
            ]);
        }
    }
    let mean = |i: usize| values.iter().map(|v| v[i]).sum::<f64>() / values.len() as f64;
    let sd = |i: usize| {
        (values.iter().map(|v| (v[i] - mean(i)).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
    };
    println!(
        "{name:22} runs {runs:5} right {right:5} size holds {sized:5} F1 {:.4} {:.1} ms  {named:?}",
        scores / runs as f64,
        1e3 * time / runs as f64,
    );
    println!(
        "    ratio x {:.4} sd {:.4} (says {:.4}), y {:.4}; correlation {:.4} sd {:.4} (says {:.4}); walk {:.2} sd {:.2}",
        mean(0),
        sd(0),
        mean(4),
        mean(1),
        mean(2),
        sd(2),
        mean(5),
        mean(3),
        sd(3)
    );
}

/// Of outliers found against true ones; 1 if there are neither.
fn f1(case: &Case, audit: &NoiseAudit) -> f64 {
    let hit = |o: &&gyrocal_diagnosis::Outlier| case.outliers.contains(&(o.row, o.axis));
    let hits = audit.outliers.iter().filter(hit).count();
    let both = case.outliers.len() + audit.outliers.len();
    if both == 0 {
        1.0
    } else {
        2.0 * hits as f64 / both as f64
    }
}

/// Whether sizes are within 5 %, the correlation within 0.03, the outliers' F1 0.95 or more.
fn is_sized(fault: Fault, audit: &NoiseAudit, score: f64) -> bool {
    let within = |effect: &str, parameter: usize, truth: f64, tolerance: f64| {
        audit.finding(effect).is_some_and(|finding| {
            (finding.parameters[parameter].estimate - truth).abs() <= tolerance
        })
    };
    let each = |kind: &str, truth: f64| {
        ["x", "y", "z"]
            .iter()
            .all(|axis| within(&format!("accel_{axis}.{kind}"), 0, truth, 0.05 * truth))
    };
    match fault {
        Fault::None | Fault::GyroRatio(_) => audit.findings.is_empty(),
        Fault::Quantised(step) => each("quantisation", step * 1e-5),
        Fault::Outliers(_, size) => {
            score >= 0.95 && within("accel.outliers", 1, size * 1e-5, 0.05 * size * 1e-5)
        }
        Fault::Coloured(correlation) => within("accel.coloured_noise", 0, correlation, 0.03),
        Fault::Ratio(ratio) => each("noise", ratio),
    }
}
