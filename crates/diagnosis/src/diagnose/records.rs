//! Several records of one platform, diagnosed together: one search over the rows of all.

use std::borrow::Cow;

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::{
    CalibrationError, FittedPlatform, GyroAxes, NoiseModel, Run, joined_record, work,
};
use gyrocal_hypothesis::stop;
use gyrocal_record::{Bench, Record, SetupProblem};

use super::answer::{both, record_summary, records_summary};
use super::noise_audited_fit::{AuditedFit, noise_audited_fit};
use super::one_platform::OnePlatform;
use super::{DiagnoseOptions, Diagnosis, Sound, concluded, diagnose_rows};
use crate::error::DiagnosisError;
use crate::error_budget::shares;
use crate::gate::Gate;
use crate::magnitude_test::{MagnitudeTest, magnitude_test};
use crate::noise::{AuditOptions, NoiseAudit, NoiseFinding};
use crate::request;
use crate::series::Innovations;
use crate::stage::Stage;
use gyrocal_answer::{Estimated, FalseAlarmShares, RecordResult};

/// One of several records, with its set-up checked.
pub struct RecordToDiagnose<'a> {
    /// Its name, such as that of its file.
    pub name: String,
    /// The record with what was found of its set-up.
    pub gate: Gate<'a>,
    /// Its bench description.
    pub bench: &'a Bench,
}

/// Diagnoses of several records: together, and each alone.
pub struct RecordsDiagnosis {
    /// All records together; its record is that of [`joined_record`].
    pub together: Diagnosis<'static>,
    /// Each record alone.
    pub alone: Vec<Diagnosis<'static>>,
}

/// A record without gross errors.
struct SoundRecord<'a> {
    name: String,
    record: Cow<'a, Record>,
    bench: &'a Bench,
    axes: Option<GyroAxes>,
    setup: Vec<SetupProblem>,
}

/// Diagnoses several records of one platform together and each alone. Coefficients and causes are those of
/// the platform; attitude, clock, accelerometer noise and the test of the set-up are those of each record.
/// The gain is that of leaving out one record after the other.
///
/// # Errors
/// [`DiagnosisError::OfRecord`] with the error of a record, [`DiagnosisError::SeveralPlatforms`] for records
/// whose coefficients no platform has together, and as [`super::diagnose`].
pub fn diagnose_records(
    records: Vec<RecordToDiagnose<'_>>,
    options: &DiagnoseOptions,
    mut watch: impl FnMut(Stage),
) -> Result<RecordsDiagnosis, DiagnosisError> {
    stop::finished(together_and_alone(records, options, &mut watch))
}

fn together_and_alone(
    records: Vec<RecordToDiagnose<'_>>,
    options: &DiagnoseOptions,
    watch: &mut dyn FnMut(Stage),
) -> Result<RecordsDiagnosis, DiagnosisError> {
    let sound = sound_records(records, options)?;
    let mut alone = Vec::with_capacity(sound.len());
    for one in &sound {
        let setup = one.setup.clone();
        let axes = one.axes.as_ref();
        let own = diagnose_rows(&one.record, one.bench, axes, options, setup, watch)
            .map_err(|error| of(&one.name, error))?;
        alone.push(own.into_owned());
    }
    let mut together = jointly(&sound, options, watch)?;
    let turn_ons = together
        .extended
        .as_ref()
        .unwrap_or(&together.nominal)
        .turn_ons_deg_per_h();
    together.result.records = sound
        .iter()
        .zip(&alone)
        .enumerate()
        .map(|(index, (one, alone))| RecordResult {
            name: one.name.clone(),
            record: record_summary(&one.record),
            turn_on_deg_per_h: turn_ons
                .get(index)
                .map(|axes| axes.map(|[estimate, sigma]| Estimated { estimate, sigma })),
            initial: None,
            open_loop: Vec::new(),
            alone: Some(alone.result.clone()),
            why_not_alone: String::new(),
        })
        .collect();
    let sizes = together.result.records.iter().map(|one| &one.record);
    together.result.record = records_summary(sizes);
    Ok(RecordsDiagnosis { together, alone })
}

/// Diagnoses several records together, without a diagnosis of each alone.
///
/// # Errors
/// As [`diagnose_records`].
pub fn diagnose_together(
    records: Vec<RecordToDiagnose<'_>>,
    options: &DiagnoseOptions,
    mut watch: impl FnMut(Stage),
) -> Result<Diagnosis<'static>, DiagnosisError> {
    let sound = sound_records(records, options)?;
    stop::finished(jointly(&sound, options, &mut watch))
}

fn sound_records<'a>(
    records: Vec<RecordToDiagnose<'a>>,
    options: &DiagnoseOptions,
) -> Result<Vec<SoundRecord<'a>>, DiagnosisError> {
    let mut sound = Vec::with_capacity(records.len());
    for RecordToDiagnose { name, gate, bench } in records {
        let axes = gate.usable_axes();
        let axes = axes.map_err(|error| of(&name, error.into()))?;
        let (record, setup) = gate.sound(options).map_err(|error| of(&name, error))?;
        request::check(&options.also, &record, bench).map_err(|error| of(&name, error))?;
        sound.push(SoundRecord {
            bench,
            name,
            record,
            axes,
            setup,
        });
    }
    Ok(sound)
}

/// The error of a record, with its name.
fn of(name: &str, error: DiagnosisError) -> DiagnosisError {
    DiagnosisError::OfRecord {
        name: name.to_owned(),
        source: Box::new(error),
    }
}

/// Noise audit, first fit and magnitude test of each of several records.
struct Audited<'a> {
    audits: Vec<AuditedFit<'a>>,
    magnitude: Option<MagnitudeTest>,
    /// Work done on them.
    work: u64,
    /// What no test of the whole has spent.
    shares: FalseAlarmShares,
}

fn audited<'a>(
    sound: &'a [SoundRecord<'_>],
    options: &DiagnoseOptions,
) -> Result<Audited<'a>, DiagnosisError> {
    let before = work();
    let mut shares = shares(options.false_alarm_probability);
    let count = sound.len().max(1) as f64;
    // Each record spends its part.
    let of_audit = AuditOptions::with_share(shares.noise_audit / count);
    let of_magnitude = shares.magnitude_test / count;
    let mut audits = Vec::with_capacity(sound.len());
    let mut magnitudes = Vec::new();
    for one in sound {
        let run = Run {
            record: &one.record,
            bench: one.bench,
        };
        let (axes, declared) = (one.axes.as_ref(), NoiseModel::default());
        let audited = noise_audited_fit(&run, axes, &declared, &of_audit, &options.calibration)
            .map_err(|error| of(&one.name, error))?;
        let noise_g = audited
            .noise_model
            .accel_ratio
            .map(|ratio| ratio * one.bench.accel_noise_g);
        let cleaned = audited.audit.cleaned.apply(&one.record);
        let tested = magnitude_test(&cleaned, one.bench, &noise_g, of_magnitude).ok();
        magnitudes.extend(tested.map(|tested| (one.name.as_str(), tested)));
        audits.push(audited);
    }
    // No test of the whole is left of what the records have spent.
    shares.noise_audit = of_audit.false_alarm * count;
    Ok(Audited {
        audits,
        magnitude: least(magnitudes, count),
        work: work() - before,
        shares,
    })
}

/// One search over all records, if they are of one platform.
fn jointly(
    sound: &[SoundRecord<'_>],
    options: &DiagnoseOptions,
    watch: &mut dyn FnMut(Stage),
) -> Result<Diagnosis<'static>, DiagnosisError> {
    watch(Stage::Audit);
    let audited = audited(sound, options)?;
    let one_platform = OnePlatform::new(&audited.audits);
    let found = searched_together(sound, audited, options, watch);
    let refuted = match &found {
        Ok(found) => one_platform.refuted_by(found.extended.as_ref().unwrap_or(&found.nominal)),
        Err(DiagnosisError::Calibration(
            CalibrationError::NoDescent { .. }
            | CalibrationError::NotConverged { .. }
            | CalibrationError::Pass { .. },
        )) => one_platform.difference,
        Err(_) => None,
    };
    match refuted {
        Some(other) => Err(DiagnosisError::SeveralPlatforms {
            name: sound[other.record].name.clone(),
            first: sound[0].name.clone(),
            coefficient: DRIFT[other.place].id,
            sigmas: other.sigmas,
        }),
        None => found,
    }
}

fn searched_together(
    sound: &[SoundRecord<'_>],
    audited: Audited<'_>,
    options: &DiagnoseOptions,
    watch: &mut dyn FnMut(Stage),
) -> Result<Diagnosis<'static>, DiagnosisError> {
    let Audited { audits, .. } = audited;
    let start = work();
    let benches: Vec<&Bench> = sound.iter().map(|one| one.bench).collect();
    let fits: Vec<FittedPlatform<'_>> = audits.iter().map(|one| one.nominal.clone()).collect();
    let nominal = FittedPlatform::joined(&fits, &benches)?;
    let records: Vec<&Record> = sound.iter().map(|one| &*one.record).collect();
    let (record, starts) = joined_record(&records);
    let Some(first) = sound.first() else {
        return Err(DiagnosisError::Calibration(CalibrationError::NoRecords));
    };
    let joined = Sound {
        run: Run {
            record: &record,
            bench: first.bench,
        },
        setup: sound
            .iter()
            .flat_map(|one| problems_of(&one.name, one.setup.clone()))
            .collect(),
        magnitude: audited.magnitude,
        audited: merged(audits, nominal, &record, &starts),
        work: audited.work + (work() - start),
        shares: audited.shares,
    };
    let mut found = concluded(joined, options, watch)?.into_owned();
    // The next run follows the last record.
    let last = sound.last().unwrap_or(first);
    found.bench = Cow::Owned(last.bench.clone());
    Ok(found)
}

/// Problems of the set-up of one of several records, with its name.
#[must_use]
pub fn problems_of(name: &str, mut problems: Vec<SetupProblem>) -> Vec<SetupProblem> {
    for problem in &mut problems {
        problem.description = format!("{name}: {}", problem.description);
    }
    problems
}

/// The magnitude test with the least p-value of all records.
fn least(magnitudes: Vec<(&str, MagnitudeTest)>, count: f64) -> Option<MagnitudeTest> {
    let (name, mut least) = magnitudes
        .into_iter()
        .min_by(|a, b| a.1.p_value.total_cmp(&b.1.p_value))?;
    least.p_value = (count * least.p_value).min(1.0);
    if !least.description.is_empty() {
        least.description = format!("{name}: {}", least.description);
    }
    Some(least)
}

/// The audits of all records as one, beside the joint fit.
fn merged<'a>(
    audits: Vec<AuditedFit<'_>>,
    nominal: FittedPlatform<'a>,
    record: &Record,
    starts: &[usize],
) -> AuditedFit<'a> {
    let count = audits.len() as f64;
    let firsts = core::iter::once(0).chain(starts.iter().copied());
    let mut innovations = Innovations::default();
    let mut suspects = Vec::new();
    let mut all: Option<NoiseAudit> = None;
    for (first, one) in firsts.zip(audits) {
        append(&mut innovations, one.innovations);
        suspects.extend(one.suspects.into_iter().map(|mut suspect| {
            suspect.row += first;
            suspect
        }));
        let mut audit = one.audit;
        for finding in &mut audit.findings {
            finding.p_value = (count * finding.p_value).min(1.0);
        }
        for outlier in &mut audit.outliers {
            outlier.row += first;
        }
        match &mut all {
            None => all = Some(audit),
            Some(all) => add(all, audit),
        }
    }
    innovations.time_s.clone_from(&record.time_s);
    let noise_model = nominal.noise_model().clone();
    let audit = all.unwrap_or_default();
    AuditedFit {
        nominal,
        noise_model,
        innovations,
        audit,
        suspects,
    }
}

/// Adds the audit of another record. What differs between records is told of each alone.
fn add(all: &mut NoiseAudit, other: NoiseAudit) {
    for finding in other.findings {
        let same: Option<&mut NoiseFinding> = all
            .findings
            .iter_mut()
            .find(|known| known.effect == finding.effect);
        match same {
            Some(known) if known.p_value <= finding.p_value => {}
            Some(known) => *known = finding,
            None => all.findings.push(finding),
        }
    }
    all.findings.sort_by(|a, b| a.p_value.total_cmp(&b.p_value));
    all.accel_ratio = None;
    all.correlation = None;
    all.gyro_ratio = None;
    for (step, own) in all.quantisation_g.iter_mut().zip(other.quantisation_g) {
        *step = step.or(own);
    }
    all.outliers.extend(other.outliers);
    all.gaps = both(&all.gaps, 1.0, &other.gaps, 1.0);
    all.cleaned.keep.extend(other.cleaned.keep);
    for axis in 0..3 {
        let own = &mut all.cleaned;
        own.sample_ratio[axis] = own.sample_ratio[axis].max(other.cleaned.sample_ratio[axis]);
        own.slow_ratio[axis] = own.slow_ratio[axis].max(other.cleaned.slow_ratio[axis]);
    }
    if other.cleaned.correlation.abs() > all.cleaned.correlation.abs() {
        all.cleaned.correlation = other.cleaned.correlation;
    }
}

fn append(all: &mut Innovations, one: Innovations) {
    all.time_s.extend(one.time_s);
    all.residual_g.extend(one.residual_g);
    all.normalised.extend(one.normalised);
    all.weighted_per_g.extend(one.weighted_per_g);
    all.specific_force_g.extend(one.specific_force_g);
}
