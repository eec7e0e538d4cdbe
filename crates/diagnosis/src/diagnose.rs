//! The whole diagnosis of one record: [`diagnose`] and its steps.

mod answer;
mod coefficients;
mod findings;
mod given;
mod gyro_noise;
mod later;
mod noise_audited_fit;
mod of_blocks;
mod of_calibration;
mod one_platform;
mod options;
mod records;
mod shared_or_own;
mod stopped;
mod untestable_rows;

use std::borrow::Cow;

use gyrocal_calibration::{CalibrationError, FittedPlatform, GyroAxes, NoiseModel, Run, work};
use gyrocal_hypothesis::{ScoreTable, Searched, stop};
use gyrocal_record::{Bench, Record, SetupProblem};
use gyrocal_setup::PlatformKind;
use gyrocal_statistics::allan_test;

use crate::error::DiagnosisError;
use crate::error_budget::shares;
use crate::filter_test::filter_test;
use crate::gate::Gate;
use crate::magnitude_test::{MagnitudeTest, magnitude_test};
use crate::noise::{AuditOptions, NoiseAudit, Outlier};
use crate::power::powers;
use crate::request;
use crate::residual_test::{decorrelated, residual_test, whitened};
use crate::residuals::residuals;
use crate::series::Innovations;
use crate::stage::Stage;
use crate::validation::{CrossValidated, LaterPrediction, cross_validate, gain};
use answer::Evidence;
pub use answer::{manifest, record_summary, records_summary};
pub use given::fit_effects;
use gyro_noise::{gyro_noise_findings, over_declared};
use gyrocal_answer::{Answer, FalseAlarmShares, Gain};
pub use later::predict_later;
use noise_audited_fit::{AuditedFit, noise_audited_fit};
use of_blocks::{diagnose_in_blocks, diagnose_sound};
pub(crate) use of_calibration::diagnose_calibrated;
pub use options::DiagnoseOptions;
use options::{search_options, selection};
pub use records::{
    RecordToDiagnose, RecordsDiagnosis, diagnose_records, diagnose_together, problems_of,
};
use shared_or_own::sizes_by_record;
use untestable_rows::detect_outliers;

/// Most causes beside which a record is diagnosed once more with correlated noise: such a search takes a few
/// times the work of that of a clean record.
const MOST_CAUSES: usize = 2;

/// A diagnosis: the answer, and the fits and series behind it.
pub struct Diagnosis<'a> {
    /// The answer.
    pub result: Answer,
    /// The record that was diagnosed: without what gross errors of the set-up spoilt, and as means of
    /// [`Blocks`](crate::Blocks) where its rows come faster than anything moves.
    pub record: Cow<'a, Record>,
    /// Its bench description, with the noise of one of these rows; of several records that of the last.
    pub bench: Cow<'a, Bench>,
    /// The nominal model at its best fit.
    pub nominal: FittedPlatform<'a>,
    /// The model with all accepted causes, if there are any.
    pub extended: Option<FittedPlatform<'a>>,
    /// The noise that the search assumed.
    pub noise_model: NoiseModel,
    /// The noise audit with the values that it left out.
    pub audit: NoiseAudit,
    /// Innovations of the nominal model as the streaming filter makes them.
    pub innovations: Innovations,
    /// Whitened innovations with all causes in the model, row by row; NaN where there is no value.
    pub whitened: Vec<[f64; 3]>,
    /// Scores on the effects that no finding holds: what the record adds to the evidence of a fleet.
    pub scores: ScoreTable,
    /// The predicted later record, after [`Self::validate`].
    pub later: Option<LaterPrediction>,
}

impl Diagnosis<'_> {
    /// The same with copies of what it borrows.
    fn into_owned(self) -> Diagnosis<'static> {
        Diagnosis {
            result: self.result,
            record: Cow::Owned(self.record.into_owned()),
            bench: Cow::Owned(self.bench.into_owned()),
            nominal: self.nominal.into_owned(),
            extended: self.extended.map(FittedPlatform::into_owned),
            noise_model: self.noise_model,
            audit: self.audit,
            innovations: self.innovations,
            whitened: self.whitened,
            scores: self.scores,
            later: self.later,
        }
    }
}

/// Diagnoses a record: set-up, noise audit, search, residual test, gain, answer. What gross errors
/// of the set-up spoilt is left out, and told in the answer.
///
/// # Errors
/// [`DiagnosisError::Setup`] with the answer if a gross error of the set-up leaves nothing sound;
/// [`DiagnosisError::Stopped`] if the job was asked to end; other [`DiagnosisError`]s.
pub fn diagnose<'a>(
    record: &'a Record,
    bench: &'a Bench,
    options: &DiagnoseOptions,
) -> Result<Diagnosis<'a>, DiagnosisError> {
    request::check(&options.also, record, bench)?;
    let run = Run { record, bench };
    let found = Gate::new(PlatformKind::Stabilised, &run, &options.calibration);
    diagnose_gated(found, bench, options)
}

/// The same of a record whose set-up was checked.
///
/// # Errors
/// As [`diagnose`].
pub fn diagnose_gated<'a>(
    found: Gate<'a>,
    bench: &'a Bench,
    options: &DiagnoseOptions,
) -> Result<Diagnosis<'a>, DiagnosisError> {
    diagnose_watched(found, bench, options, |_| ())
}

/// The same, telling which stage begins.
///
/// # Errors
/// As [`diagnose`].
pub fn diagnose_watched<'a>(
    found: Gate<'a>,
    bench: &'a Bench,
    options: &DiagnoseOptions,
    mut watch: impl FnMut(Stage),
) -> Result<Diagnosis<'a>, DiagnosisError> {
    // The gate may have made fits.
    stop::check()?;
    let axes = found.usable_axes()?;
    let (usable, setup) = found.sound(options)?;
    request::check(&options.also, &usable, bench)?;
    let watch: &mut dyn FnMut(Stage) = &mut watch;
    let axes = axes.as_ref();
    stop::finished(match usable {
        Cow::Borrowed(record) => diagnose_sound(record, bench, axes, options, setup, watch),
        Cow::Owned(record) => {
            diagnose_sound(&record, bench, axes, options, setup, watch).map(Diagnosis::into_owned)
        }
    })
}

/// A record without gross errors, or several as one, with the noise audited and the nominal model fitted.
struct Sound<'e, 'a> {
    run: Run<'e>,
    /// Gross errors that the set-up had.
    setup: Vec<SetupProblem>,
    magnitude: Option<MagnitudeTest>,
    audited: AuditedFit<'a>,
    /// Work done on the record so far.
    work: u64,
    shares: FalseAlarmShares,
}

/// Diagnoses the rows of a record without gross errors as they are; `setup` are those that it had, `axes` those of the
/// instruments of a strapdown unit.
fn diagnose_rows<'a>(
    record: &'a Record,
    bench: &'a Bench,
    axes: Option<&GyroAxes>,
    options: &DiagnoseOptions,
    setup: Vec<SetupProblem>,
    watch: &mut dyn FnMut(Stage),
) -> Result<Diagnosis<'a>, DiagnosisError> {
    let mut with = |left_correlated: Option<f64>| {
        watch(Stage::Audit);
        let run = Run { record, bench };
        let sound = sound(&run, axes, options, setup.clone(), left_correlated)?;
        concluded(sound, options, watch)
    };
    let first = with(None)?;
    let Some(p_value) = left_correlated(&first) else {
        return Ok(first);
    };
    // It stands if it explains what was left, and no cause comes with it.
    Ok(match with(Some(p_value)) {
        Ok(again)
            if !again.result.is_unexplained()
                && again.result.causes().count() <= first.result.causes().count() =>
        {
            again
        }
        _ => first,
    })
}

/// p-value of the correlation of neighbouring innovations that no noise of a diagnosis explains; `None` of a
/// search that named so much that a second one would take too long.
fn left_correlated(found: &Diagnosis<'_>) -> Option<f64> {
    let correlation = found.result.remainder.correlation.as_ref()?;
    let is_left = correlation.significant && found.audit.cleaned.correlation == 0.0;
    let is_short = found.result.search_complete && found.result.causes().count() <= MOST_CAUSES;
    (is_left && is_short).then_some(correlation.p_value)
}

/// Noise audit, first fit and magnitude test of a record; `left_correlated` is that of [`AuditOptions`].
fn sound<'a>(
    run: &Run<'a>,
    axes: Option<&GyroAxes>,
    options: &DiagnoseOptions,
    setup: Vec<SetupProblem>,
    left_correlated: Option<f64>,
) -> Result<Sound<'a, 'a>, DiagnosisError> {
    let Run { record, bench } = *run;
    let before = work();
    let shares = shares(options.false_alarm_probability);
    let declared = NoiseModel::default();
    let audit = AuditOptions {
        left_correlated,
        ..AuditOptions::with_share(shares.noise_audit)
    };
    let audited = noise_audited_fit(run, axes, &declared, &audit, &options.calibration)?;
    let accel_noise_g = audited
        .noise_model
        .accel_ratio
        .map(|ratio| ratio * bench.accel_noise_g);
    let cleaned = audited.audit.cleaned.apply(record);
    let magnitude = magnitude_test(&cleaned, bench, &accel_noise_g, shares.magnitude_test).ok();
    Ok(Sound {
        run: *run,
        setup,
        magnitude,
        audited,
        work: work() - before,
        shares,
    })
}

/// Search, residual test, gain and answer.
fn concluded<'e, 'a: 'e>(
    sound: Sound<'e, 'a>,
    options: &DiagnoseOptions,
    watch: &mut dyn FnMut(Stage),
) -> Result<Diagnosis<'e>, DiagnosisError> {
    let Sound {
        run,
        setup,
        magnitude,
        audited,
        work,
        shares,
    } = sound;
    let Run { record, bench } = run;
    let mut audit = audited.audit;
    let accel_noise_g = audited
        .noise_model
        .accel_ratio
        .map(|ratio| ratio * bench.accel_noise_g);
    let selection = selection(record, bench, options);
    let search = search_options(options, &shares, work);
    watch(Stage::Search);
    let rows = audited.nominal.rows(record);
    let searched = gyrocal_hypothesis::search(audited.nominal, rows, &selection, &search)?;
    let nominal = searched.nominal.clone();
    let noise_model = searched.fitted.noise_model().clone();
    let estimate = over_declared(&searched.fitted)?;
    let outliers = unexplained_outliers(record, &audited.suspects, &searched, accel_noise_g);
    audit.add_outliers(outliers, bench.accel_noise_g);
    let gyro_noise =
        gyro_noise_findings(&searched.fitted, &searched.noise, &audit, shares.gyro_noise)?;
    let by_record = sizes_by_record(&searched)?;

    watch(Stage::Validation);
    let whitened = whitened(&searched.fitted, record)?;
    let (time_s, alpha) = (&record.time_s, shares.residual_test);
    let tested = decorrelated(&whitened, audit.cleaned.correlation);
    let remainder = residual_test(time_s, &tested, &searched.unmodelled, alpha);
    let allan = allan_test(time_s, &tested, shares.allan_test).ok();

    let validated = cross_validate(&nominal, &searched)?;
    let gain = model_gain(&nominal, &searched, &validated, &run, &noise_model)?;
    watch(Stage::Answer);
    let test = |filter| filter_test(record, bench, filter);
    let filter = options.filter.map(test).transpose()?;
    let alpha = options.false_alarm_probability;
    let result = Evidence {
        run: &run,
        options,
        shares,
        setup,
        magnitude,
        residuals: residuals(&nominal, &audited.innovations, record, alpha)?,
        audit: &audit,
        gyro_noise,
        nominal: &nominal,
        power: powers(&nominal, record, &searched.ranking, searched.threshold)?,
        searched: &searched,
        by_record,
        estimate: &estimate,
        remainder,
        allan,
        validated: &validated,
        gain,
        filter,
    }
    .answer();
    Ok(Diagnosis {
        result,
        record: Cow::Borrowed(record),
        bench: Cow::Borrowed(bench),
        nominal,
        extended: validated.extended,
        noise_model,
        audit,
        innovations: audited.innovations,
        whitened,
        scores: searched.scores,
        later: None,
    })
}

/// Suspected outliers that no cause explains.
fn unexplained_outliers(
    record: &Record,
    suspects: &[Outlier],
    searched: &Searched<FittedPlatform<'_>>,
    accel_noise_g: [f64; 3],
) -> Vec<Outlier> {
    let mut rows: Vec<usize> = suspects.iter().map(|outlier| outlier.row).collect();
    rows.dedup();
    let mut outliers = detect_outliers(record, &rows, &searched.fitted, accel_noise_g);
    outliers.retain(|one| suspects.iter().any(|other| other.place() == one.place()));
    outliers
}

/// Gain of the extended model; of the model with all causes if none is accepted, `None` if there is
/// none.
fn model_gain(
    nominal: &FittedPlatform<'_>,
    searched: &Searched<FittedPlatform<'_>>,
    validated: &CrossValidated<'_>,
    run: &Run<'_>,
    noise_model: &NoiseModel,
) -> Result<Option<Gain>, CalibrationError> {
    let Some(scores) = validated
        .scores
        .clone()
        .filter(|_| !searched.findings.is_empty())
    else {
        return Ok(None);
    };
    let extended = validated.extended.as_ref().unwrap_or(&searched.fitted);
    let causes = searched.findings.iter().zip(&validated.decisions);
    let effects = causes
        .filter(|(_, decision)| decision.accepted || validated.extended.is_none())
        .map(|(finding, _)| finding.effect.to_owned());
    gain(
        [nominal, extended],
        (scores, validated.prediction),
        run.record,
        noise_model,
        run.bench.accel_noise_g,
        effects.collect(),
    )
    .map(Some)
}
