//! The answer of a record of whose set-up nothing sound is left.

use std::borrow::Cow;

use gyrocal_record::{Record, SetupProblem};

use super::DiagnoseOptions;
use super::answer::{manifest, record_summary};
use crate::error::DiagnosisError;
use crate::error_budget::shares;
use crate::gate::Gate;
use gyrocal_answer::{Answer, ResidualTest, ResidualVerdict, SCHEMA_VERSION, Subject, Verdict};

impl<'a> Gate<'a> {
    /// The record without what gross errors spoilt, and these errors.
    ///
    /// # Errors
    /// [`DiagnosisError::Setup`] with the answer if one leaves nothing sound.
    pub fn sound(
        self,
        options: &DiagnoseOptions,
    ) -> Result<(Cow<'a, Record>, Vec<SetupProblem>), DiagnosisError> {
        let subject = match self.gyro_axes.is_some() {
            true => Subject::Strapdown,
            false => Subject::Platform,
        };
        match self.usable {
            Some(usable) => Ok((usable, self.problems)),
            None => Err(DiagnosisError::Setup {
                result: Box::new(Answer {
                    subject,
                    ..result(self.record, options, self.problems)
                }),
            }),
        }
    }
}

/// The result of a record of whose set-up nothing sound is left: nothing was fitted.
fn result(record: &Record, options: &DiagnoseOptions, setup: Vec<SetupProblem>) -> Answer {
    Answer {
        schema_version: SCHEMA_VERSION,
        manifest: manifest(options.seed),
        record: record_summary(record),
        records: Vec::new(),
        subject: Subject::Platform,
        later_record: None,
        verdict: Verdict::Setup,
        false_alarm_probability: options.false_alarm_probability,
        false_alarm_shares: Some(shares(options.false_alarm_probability)),
        setup,
        norm: None,
        residuals: None,
        findings: Vec::new(),
        coefficients: None,
        open_loop: Vec::new(),
        horizon_s: None,
        gain: None,
        remainder: ResidualTest {
            verdict: ResidualVerdict::NotTested,
            p_value: None,
            outputs: Vec::new(),
            description: "the set-up is wrong: nothing was fitted".to_owned(),
            line: None,
            correlation: None,
            unmodelled: Vec::new(),
        },
        set_ups: None,
        still_inputs: Vec::new(),
        undetermined: Vec::new(),
        starts: None,
        ranking: Vec::new(),
        threshold: None,
        power: Vec::new(),
        noise: Vec::new(),
        undeclared_noise: Vec::new(),
        only_in_white_noise: Vec::new(),
        path: Vec::new(),
        model_noise: None,
        noise_audit: None,
        allan: None,
        not_searched: Vec::new(),
        search_complete: true,
        filter: None,
        next_runs: Vec::new(),
    }
}
