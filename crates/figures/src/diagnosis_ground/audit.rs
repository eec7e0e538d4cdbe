//! The noise audit over clean records, over noise other than declared, and over physical causes.

use std::collections::BTreeMap;

use gyrocal::effect::NoiseProperty;
use gyrocal_diagnosis::{AuditOptions, NoiseAudit, Outlier, audit_noise};
use gyrocal_statistics::{Proportion, mean};
use gyrocal_testkit::noise_faults::{Fault, FaultyRecord, faulty_record};
use gyrocal_truth::Term;
use serde::{Deserialize, Serialize};

use super::records::{KINDS, Kind, POPULATION, accelerometer_noise, record, three_days};
use super::{Error, campaign};
use crate::figure::Figure;

/// Clean records; records of each kind; records with each physical cause. With `--small` fewer.
const RUNS: [u64; 3] = [2000, 1000, 100];
const SMALL_RUNS: [u64; 3] = [60, 24, 8];

/// Least fractions of the records with the right finding, and with the right size.
const RIGHT: f64 = 0.95;

/// Least F1 score of the outliers.
const F1: f64 = 0.95;

/// Confidence of the upper bound on the fraction of alarms.
const ALARMS: f64 = 0.01;

/// Result of the audit of one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Audited {
    /// Ids of the findings, in alphabetical order.
    found: Vec<String>,
    /// `true` if the sizes are within their limits.
    sized: bool,
    /// F1 score of the outliers.
    f1: f64,
}

/// A term that is not in the catalogue, made for each record.
type Make = fn() -> Term;

/// Physical causes far larger than any that must be found; the audit of noise should not react.
const CAUSES: [(&str, Make); 8] = [
    ("a step of 0.01 deg/h", || drift_step(0.01)),
    ("a step of 0.3 deg/h", || drift_step(0.3)),
    ("an accelerometer's step of 40 sigma", || {
        Term::Output(Box::new(|m| {
            [if m.time_s > 1e5 { 4e-4 } else { 0.0 }, 0.0, 0.0]
        }))
    }),
    ("squares of 1e-4 g/g²", || {
        Term::Output(Box::new(|m| m.accel_g.map(|a| 1e-4 * a * a)))
    }),
    ("a tone of 0.2 sigma with a period of 7 rows", || {
        Term::Output(Box::new(|m| [2e-6 * (m.time_s / 67.0).sin(), 0.0, 0.0]))
    }),
    ("a tone of 5 sigma with a period of 7 rows", || {
        Term::Output(Box::new(|m| [5e-5 * (m.time_s / 67.0).sin(), 0.0, 0.0]))
    }),
    ("a tone of 0.01 deg/h with a period of 1 h", || {
        Term::Drift(Box::new(|m| [0.01 * (m.time_s * 1.7e-3).sin(), 0.0, 0.0]))
    }),
    ("friction of 0.05 deg/h", || {
        Term::Drift(Box::new(|m| m.accel_g.map(|a| 0.05 * a.signum())))
    }),
];

fn drift_step(size_deg_per_h: f64) -> Term {
    Term::Drift(Box::new(move |m| {
        let on = if m.time_s > 1e5 { 1.0 } else { 0.0 };
        [0.0, on * size_deg_per_h, 0.0]
    }))
}

pub(super) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let [clean, each, causes] = if small { SMALL_RUNS } else { RUNS };
    let mut figures = clean_records(clean, small)?;
    for kind in KINDS {
        figures.extend(of_kind(kind, each, small)?);
    }
    for (name, term) in CAUSES {
        let audited = audited(&format!("cause {name}"), causes, small, |number| {
            faulty_record(&three_days(), number, Fault::None, &[term()])
        })?;
        figures.push(
            Figure::note(
                &format!("{name}: audits that find anything"),
                alarms(&audited),
            )
            .over(audited.len(), seeds(audited.len())),
        );
    }
    Ok(figures)
}

fn clean_records(runs: u64, small: bool) -> Result<Vec<Figure>, Error> {
    let audited = audited("clean", runs, small, |number| record(number, Fault::None))?;
    let share = Proportion::of(audited.iter().map(|one| !one.found.is_empty()));
    let mut first = Figure::within(
        "clean records: alarms of the noise audit, one-sided 95 % upper bound",
        [f64::NEG_INFINITY, ALARMS],
        share.upper_bound(0.95),
    );
    if small {
        first = first.judged(share.at_most(ALARMS));
    }
    let note = Figure::note("clean records: alarms (0.25 % nominal)", alarms(&audited));
    let figures = [first, note].map(|figure| figure.over(audited.len(), seeds(audited.len())));
    Ok(figures.into())
}

fn of_kind(kind: Kind, runs: u64, small: bool) -> Result<Vec<Figure>, Error> {
    let audited = audited(kind.name, runs, small, |number| record(number, kind.fault))?;
    let share = |name: &str, of: &dyn Fn(&Audited) -> bool| {
        let found = Proportion::of(audited.iter().map(of));
        let name = format!("{}: {name}", kind.name);
        let figure = Figure::within(&name, [RIGHT, f64::INFINITY], found.share())
            .of_share(found)
            .over(audited.len(), seeds(audited.len()));
        match small {
            true => figure.judged(found.at_least(RIGHT)),
            false => figure,
        }
    };
    let near = match kind.fault {
        Fault::Coloured(_) => "found with its correlation within 0.03",
        _ => "found with its size within 5 %",
    };
    let expected = kind.expected();
    let mut figures = vec![
        share("the right noise findings, and no others", &|one| {
            one.found == expected
        }),
        share(near, &|one| one.sized),
    ];
    if matches!(kind.fault, Fault::Outliers(..)) {
        let scores: Vec<f64> = audited.iter().map(|one| one.f1).collect();
        let name = format!("{}: mean F1", kind.name);
        figures.push(
            Figure::within(&name, [F1, f64::INFINITY], mean(&scores))
                .over(audited.len(), seeds(audited.len())),
        );
    }
    Ok(figures)
}

fn seeds(runs: usize) -> String {
    format!("population {POPULATION}, 0 to {}", runs.saturating_sub(1))
}

/// Number of records with findings, and the findings.
fn alarms(audited: &[Audited]) -> String {
    let mut named: BTreeMap<&str, usize> = BTreeMap::new();
    for effect in audited.iter().flat_map(|one| &one.found) {
        *named.entry(effect).or_default() += 1;
    }
    let named: Vec<String> = named
        .into_iter()
        .map(|(effect, count)| format!("{effect} {count}"))
        .collect();
    let count = audited.iter().filter(|one| !one.found.is_empty()).count();
    if named.is_empty() {
        format!("{count} of {}", audited.len())
    } else {
        format!("{count} of {} ({})", audited.len(), named.join(", "))
    }
}

fn audited(
    cell: &str,
    runs: u64,
    small: bool,
    make: impl Fn(u64) -> FaultyRecord + Sync,
) -> Result<Vec<Audited>, Error> {
    let job = |number| -> Result<Audited, Error> { audit(&make(number)) };
    let outcome = campaign(&format!("audit {cell}"), 0..runs, small)?.run(job, |_| ())?;
    if let Some(failure) = outcome.failures().next() {
        let (seed, error) = (failure.seed, failure.message);
        return Err(format!("record {seed} of `{cell}` could not be audited: {error}").into());
    }
    Ok(outcome.successes().map(|(_, one)| one.clone()).collect())
}

fn audit(case: &FaultyRecord) -> Result<Audited, Error> {
    let options = AuditOptions::default();
    let audit = audit_noise(&case.record, &case.innovations, &case.declared, &options)?;
    let mut found: Vec<String> = audit
        .findings
        .iter()
        .map(|finding| finding.effect.to_owned())
        .collect();
    found.sort_unstable();
    let f1 = f1(case, &audit);
    Ok(Audited {
        found,
        sized: is_sized(case.fault, &audit),
        f1,
    })
}

/// F1 score of found against true outliers; 1 if there are neither.
fn f1(case: &FaultyRecord, audit: &NoiseAudit) -> f64 {
    let hit = |outlier: &&Outlier| case.outliers.contains(&(outlier.row, outlier.axis));
    let hits = audit.outliers.iter().filter(hit).count();
    match case.outliers.len() + audit.outliers.len() {
        0 => 1.0,
        both => 2.0 * hits as f64 / both as f64,
    }
}

/// `true` if each finding of a fault has its size within 5 %, a correlation within 0.03.
fn is_sized(fault: Fault, audit: &NoiseAudit) -> bool {
    let each = |property: NoiseProperty, parameter: usize, truth: f64, tolerance: f64| {
        accelerometer_noise(property).iter().all(|effect| {
            audit.finding(effect).is_some_and(|finding| {
                (finding.parameters[parameter].estimate - truth).abs() <= tolerance
            })
        })
    };
    match fault {
        Fault::None | Fault::GyroRatio(_) => audit.findings.is_empty(),
        Fault::Quantised(step) => {
            let step_g = step * 1e-5;
            each(NoiseProperty::Quantisation, 0, step_g, 0.05 * step_g)
        }
        Fault::Outliers(_, size) => {
            each(NoiseProperty::Outliers, 1, size * 1e-5, 0.05 * size * 1e-5)
        }
        Fault::Coloured(correlation) => each(NoiseProperty::Correlation, 0, correlation, 0.03),
        Fault::Ratio(ratio) => each(NoiseProperty::Level, 0, ratio, 0.05 * ratio),
    }
}
