//! The noise audit over clean records, over noise other than declared, and over physical causes; whole diagnoses of
//! rounded readings and of outliers. Those of other noise are in the part `clean`.

use std::collections::BTreeMap;

use gyrocal::effect::{EffectKind, Enters, NoiseProperty};
use gyrocal::{EFFECTS, Effect};
use gyrocal_answer::FindingKind;
use gyrocal_diagnosis::{
    AuditOptions, DiagnoseOptions, NoiseAudit, Outlier, audit_noise, diagnose,
};
use gyrocal_testkit::noise_faults::{Fault, FaultyRecord, faulty_record};
use gyrocal_truth::{Population as Platforms, Term};
use serde::{Deserialize, Serialize};

use crate::harness::{Context, DIAGNOSIS, Error, Figure, Population, Row, Sources, of};

/// What can move the results.
const SOURCES: Sources = of(DIAGNOSIS, &[file!()]);

/// Seed of the platforms and their records.
const PLATFORMS: u64 = 20;

/// Records, and those of the small version: clean ones, of each kind of noise, of each physical cause.
const CLEAN: [u64; 2] = [2000, 60];
const EACH: [u64; 2] = [1000, 24];
const CAUSE: [u64; 2] = [100, 8];

/// Least share of records with the right finding, and with the right size; least F1 score.
const RIGHT: f64 = 0.95;
const RIGHT_REASON: &str = "one of twenty may be missed, or have another name or size";

/// Kinds of noise; the first two are diagnosed as a whole.
const KINDS: [(&str, Fault); 5] = [
    ("LSB of 3 sigma", Fault::Quantised(3.0)),
    ("0.5 % outliers of 8 sigma", Fault::Outliers(0.005, 8.0)),
    ("AR(1) of 0.3", Fault::Coloured(0.3)),
    ("sigma 1.2 of declared", Fault::Ratio(1.2)),
    ("sigma 0.8 of declared", Fault::Ratio(0.8)),
];

/// A cause in words, and how it is made.
type Cause = (&'static str, fn() -> Term);

/// Physical causes far larger than any that must be found; the audit of noise should not react. They are not in the
/// catalogue, and made for each record.
const CAUSES: [Cause; 8] = [
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

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let name = "clean records: alarms of the noise audit, one-sided 95 % upper bound";
    let level = "0.25 % are promised: of 2000 five are due, and 12 within the bound";
    let alarm = Row::bound(name, |one: &Audited| !one.found.is_empty()).at_most(0.01, level);
    let mut figures = context.measure(&audits("clean", CLEAN, Fault::None, None), &[alarm])?;
    for (name, fault) in KINDS {
        let audits = audits(name, EACH, fault, None);
        figures.extend(context.measure(&audits, &of_kind(name, fault))?);
    }
    for (name, term) in CAUSES {
        let found = Row::words(format!("{name}: audits that find anything"), alarms);
        let audits = audits(name, CAUSE, Fault::None, Some(term));
        figures.extend(context.measure(&audits, &[found])?);
    }
    figures.extend(context.measure(&wholes(), &of_wholes())?);
    Ok(figures)
}

/// Audits of records with a fault of the noise or with a term.
fn audits(
    name: &str,
    [full, small]: [u64; 2],
    fault: Fault,
    term: Option<fn() -> Term>,
) -> Population<'static, Audited> {
    let job = move |number| {
        let terms: Vec<Term> = term.iter().map(|make| make()).collect();
        audited(&faulty_record(&three_days(), number, fault, &terms))
    };
    Population::new(format!("audit {name}"), [0, full, small], SOURCES, job)
}

/// Three days with a row each minute, at any latitude and attitude, with drift.
fn three_days() -> Platforms {
    let mut platforms = Platforms::new(PLATFORMS);
    platforms.duration_days = [3.0, 3.0];
    platforms
}

fn of_kind(name: &str, fault: Fault) -> Vec<Row<'static, Audited>> {
    let near = match fault {
        Fault::Coloured(_) => "found with its correlation within 0.03",
        _ => "found with its size within 5 %",
    };
    let expected = expected(fault);
    let right = move |one: &Audited| Some(one.found == expected);
    let no_others = format!("{name}: the right noise findings, and no others");
    let mut rows = vec![
        Row::share(no_others, right),
        Row::share(format!("{name}: {near}"), |one: &Audited| Some(one.sized)),
    ];
    if matches!(fault, Fault::Outliers(..)) {
        let f1 = |one: &Audited| Some(one.f1);
        rows.push(Row::mean(format!("{name}: mean F1"), f1));
    }
    let rows = rows.into_iter();
    rows.map(|row| row.at_least(RIGHT, RIGHT_REASON)).collect()
}

/// Number of records with findings, and the findings.
fn alarms(audited: &[Audited]) -> String {
    let mut named: BTreeMap<&str, usize> = BTreeMap::new();
    for effect in audited.iter().flat_map(|one| &one.found) {
        *named.entry(effect).or_default() += 1;
    }
    let named = named
        .iter()
        .map(|(effect, count)| format!("{effect} {count}"));
    let named: Vec<String> = named.collect();
    let count = audited.iter().filter(|one| !one.found.is_empty()).count();
    let share = format!("{count} of {}", audited.len());
    match named.as_slice() {
        [] => share,
        named => format!("{share} ({})", named.join(", ")),
    }
}

fn audited(case: &FaultyRecord) -> Result<Audited, Error> {
    let options = AuditOptions::default();
    let audit = audit_noise(&case.record, &case.innovations, &case.declared, &options)?;
    let findings = audit.findings.iter();
    let mut found: Vec<String> = findings.map(|one| one.effect.to_owned()).collect();
    found.sort_unstable();
    Ok(Audited {
        found,
        sized: is_sized(case.fault, &audit),
        f1: f1(case, &audit),
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

/// Sigma of the accelerometers, g.
const SIGMA_G: f64 = 1e-5;

/// What the audit must find of a fault: property, number of the parameter, its value and its tolerance, which is 5 %
/// but for a correlation.
fn truth(fault: Fault) -> Option<(NoiseProperty, usize, f64, f64)> {
    let within = |property, parameter, value: f64| Some((property, parameter, value, 0.05 * value));
    match fault {
        Fault::None | Fault::GyroRatio(_) => None,
        Fault::Quantised(step) => within(NoiseProperty::Quantisation, 0, step * SIGMA_G),
        Fault::Outliers(_, size) => within(NoiseProperty::Outliers, 1, size * SIGMA_G),
        Fault::Coloured(value) => Some((NoiseProperty::Correlation, 0, value, 0.03)),
        Fault::Ratio(ratio) => within(NoiseProperty::Level, 0, ratio),
    }
}

/// `true` if each finding of a fault has the right value.
fn is_sized(fault: Fault, audit: &NoiseAudit) -> bool {
    let Some((_, parameter, value, tolerance)) = truth(fault) else {
        return audit.findings.is_empty();
    };
    expected(fault).iter().all(|effect| {
        let found = audit.finding(effect);
        found.is_some_and(|found| (found.parameters[parameter].estimate - value).abs() <= tolerance)
    })
}

/// Ids of the effects that the audit must find: the property of the noise of each accelerometer, in alphabetical
/// order.
fn expected(fault: Fault) -> Vec<&'static str> {
    let is_it = |effect: &&Effect| {
        let property = truth(fault).map(|(property, ..)| EffectKind::Noise(property));
        Some(effect.kind) == property && matches!(effect.enters, Enters::Outputs(_))
    };
    let ids = EFFECTS.iter().filter(is_it).map(|effect| effect.id);
    let mut ids: Vec<&str> = ids.collect();
    ids.sort_unstable();
    ids
}

/// Result of the whole diagnosis of one record.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Whole {
    /// `true` if there is a physical finding.
    is_physical: bool,
    /// `true` if the noise findings are the right ones, and no others.
    is_right: bool,
}

/// Whole diagnoses of the first two kinds in turn; their numbers are above those of the audits.
fn wholes() -> Population<'static, Whole> {
    Population::new("whole noise", [10_000, 100, 6], SOURCES, |number| {
        let (_, fault) = KINDS[(number % 2) as usize];
        let case = faulty_record(&three_days(), number, fault, &[]);
        let bench = three_days().scenario(number).bench();
        let found = diagnose(&case.record, &bench, &DiagnoseOptions::default())?.result;
        let noise = found.of_kind(FindingKind::Noise);
        let mut noise: Vec<&str> = noise.map(|finding| finding.effect.as_str()).collect();
        noise.sort_unstable();
        Ok(Whole {
            is_physical: found.causes().next().is_some(),
            is_right: noise == expected(fault),
        })
    })
}

fn of_wholes() -> [Row<'static, Whole>; 2] {
    let name = |what: &str| format!("rounded readings, outliers: whole diagnoses with {what}");
    let is_right = |one: &Whole| Some(one.is_right);
    [
        Row::share(name("a physical finding"), |one: &Whole| {
            Some(one.is_physical)
        })
        .at_most(0.01, "the level is 1 %"),
        Row::share(name("the right noise findings, and no others"), is_right)
            .at_least(RIGHT, RIGHT_REASON),
    ]
}
