//! Validation of a diagnosis on a later record of the same platform.

use gyrocal_calibration::{FittedPlatform, GyroAxes, NoiseModel, Run};
use gyrocal_hypothesis::stop;
use gyrocal_record::{Bench, SetupProblem};
use gyrocal_setup::PlatformKind;

use super::answer::record_summary;
use super::noise_audited_fit::noise_audited_fit;
use super::{DiagnoseOptions, Diagnosis};
use crate::blocks::Blocks;
use crate::error::DiagnosisError;
use crate::error_budget::shares;
use crate::gate::Gate;
use crate::noise::AuditOptions;
use crate::request;
use crate::validation::{LaterPrediction, predict};
use gyrocal_answer::{Compensation, Validation};

impl Diagnosis<'_> {
    /// Predicts a later record of the same platform with the nominal and the extended model, and
    /// adds that to the answer. Without an extended model there is nothing to compare, and the answer
    /// says only that the record was given. What gross errors of the set-up spoilt in it is left out,
    /// and told in the answer.
    ///
    /// # Errors
    /// [`DiagnosisError`], of the later record.
    pub fn validate(
        &mut self,
        later: &Run<'_>,
        options: &DiagnoseOptions,
    ) -> Result<(), DiagnosisError> {
        let found = Gate::new(PlatformKind::Stabilised, later, &options.calibration);
        self.validate_gated(found, later.bench, options)
    }

    /// The same with a later record whose set-up was checked.
    ///
    /// # Errors
    /// As [`Self::validate`].
    pub fn validate_gated(
        &mut self,
        later: Gate<'_>,
        later_bench: &Bench,
        options: &DiagnoseOptions,
    ) -> Result<(), DiagnosisError> {
        self.result.later_record = Some(record_summary(later.record));
        let axes = later.usable_axes()?;
        let (usable, setup) = later.sound(options)?;
        self.result.setup.extend(setup.into_iter().map(of_later));
        let (usable, later_bench, averaged) = Blocks::or_rows(usable, later_bench, axes.as_ref());
        if let Some(later) = &mut self.result.later_record {
            later.averaged = averaged;
        }
        let later = &Run {
            record: &usable,
            bench: &later_bench,
        };
        let (record, bench) = (self.record.clone(), self.bench.clone());
        let first = &Run {
            record: &record,
            bench: &bench,
        };
        let Some(extended) = &self.extended else {
            return Ok(());
        };
        let models = [&self.nominal, extended];
        let later = (later, axes.as_ref());
        let prediction = predict_later(models, &self.noise_model, first, later, options)?;
        if let Some(gain) = &mut self.result.gain {
            gain.validation = Some(validation(&prediction));
        }
        self.later = Some(prediction);
        Ok(())
    }
}

/// Predicts a later record with the nominal and an extended model of a first one, which were fitted
/// with the noise `assumed`. The gyros are taken to be as noisy in the later record; its outliers
/// are left out. The axes are those of the instruments in the later record, of a strapdown unit.
///
/// # Errors
/// [`DiagnosisError`], of the later record.
pub fn predict_later(
    [nominal, extended]: [&FittedPlatform<'_>; 2],
    assumed: &NoiseModel,
    first: &Run<'_>,
    (later, axes): (&Run<'_>, Option<&GyroAxes>),
    options: &DiagnoseOptions,
) -> Result<LaterPrediction, DiagnosisError> {
    request::check(&[], later.record, later.bench)?;
    let assumed = NoiseModel {
        gyro_ratio: assumed.gyro_ratio,
        gyro_walk_deg_per_h_per_sqrt_h: assumed.gyro_walk_deg_per_h_per_sqrt_h,
        ..NoiseModel::default()
    };
    let audit = AuditOptions::with_share(shares(options.false_alarm_probability).noise_audit);
    let fitted = noise_audited_fit(later, axes, &assumed, &audit, &options.calibration);
    let fitted = stop::finished(fitted)?.nominal;
    let predicted = predict(nominal, extended, first, &fitted, later);
    stop::finished(predicted.map_err(DiagnosisError::from))
}

/// A problem of the later record, told as such.
fn of_later(problem: SetupProblem) -> SetupProblem {
    SetupProblem {
        description: format!("In the later record: {}", problem.description),
        ..problem
    }
}

fn validation(prediction: &LaterPrediction) -> Validation {
    let attitude = &prediction.attitude;
    let [nominal_arcmin, extended_arcmin, expected_arcmin] = attitude.at_end_arcmin();
    Validation {
        log_score_nats: prediction.gain_nats(),
        compensation: Some(Compensation {
            starts: attitude.starts,
            after_h: attitude.time_s.last().copied().unwrap_or(0.0) / 3600.0,
            nominal_arcmin,
            extended_arcmin,
            expected_arcmin,
        }),
        open_loop: Vec::new(),
        horizon_s: None,
    }
}
