//! Where a plan starts from: a diagnosis that was made, or one that was written.

use std::borrow::Cow;

use gyrocal_answer::{Answer, RecordSummary};
use gyrocal_calibration::{CalibrationError, FittedPlatform, Options, Run};
use gyrocal_diagnosis::{
    Blocks, DiagnoseOptions, Diagnosis, DiagnosisError, RecordToDiagnose, problems_of,
    record_summary, records_summary,
};
use gyrocal_record::{Bench, Record, SetupProblem};

use crate::error::DesignError;
use crate::named_cause::{NamedCause, fitted_to_records, noise_of};

/// Starting point of a plan.
pub struct Known<'a> {
    /// The record without what gross errors of the set-up spoilt; several are one.
    pub record: Cow<'a, Record>,
    /// Its bench description; that of the last of several, which the next run follows.
    pub bench: Cow<'a, Bench>,
    /// Its size as it was given.
    pub summary: RecordSummary,
    /// Gross errors that were mended.
    pub setup: Vec<SetupProblem>,
    /// The model with what was found.
    pub fitted: FittedPlatform<'a>,
    /// What was found.
    pub named: Vec<NamedCause>,
}

/// A written diagnosis is no starting point.
#[derive(Debug, thiserror::Error)]
pub enum NotKnown {
    /// Nothing of a record is sound.
    #[error(transparent)]
    Record(#[from] DiagnosisError),
    /// The model with its findings cannot be fitted.
    #[error(transparent)]
    Fit(#[from] DesignError),
}

impl<'a> From<Diagnosis<'a>> for Known<'a> {
    fn from(found: Diagnosis<'a>) -> Self {
        Self {
            named: NamedCause::all(&found.result),
            fitted: found.extended.unwrap_or(found.nominal),
            record: found.record,
            bench: found.bench,
            summary: found.result.record,
            setup: found.result.setup,
        }
    }
}

impl<'a> Known<'a> {
    /// What a written diagnosis names, fitted again to its records: one, or several by their joint diagnosis.
    ///
    /// # Errors
    /// A record of which nothing is sound, and those of [`NamedCause::fitted_of_unit`] and [`fitted_to_records`].
    pub fn written(
        diagnosis: &Answer,
        checked: Vec<RecordToDiagnose<'a>>,
    ) -> Result<Self, NotKnown> {
        let named = NamedCause::all(diagnosis);
        let options = Options::default();
        let is_one = checked.len() == 1;
        let (mut setup, mut axes, mut sound) = (Vec::new(), Vec::new(), Vec::new());
        let mut summaries = Vec::new();
        for RecordToDiagnose { name, gate, bench } in checked {
            let of_record = |source| match is_one {
                true => source,
                false => DiagnosisError::OfRecord {
                    name: name.clone(),
                    source: Box::new(source),
                },
            };
            let own = gate.usable_axes();
            axes.extend(own.map_err(|source| of_record(source.into()))?);
            let (record, problems) = gate.sound(&DiagnoseOptions::default()).map_err(of_record)?;
            setup.extend(match is_one {
                true => problems,
                false => problems_of(&name, problems),
            });
            summaries.push(record_summary(&record));
            sound.push((record, Cow::Borrowed(bench)));
        }
        // Records that are searched together are not averaged.
        if let ([(record, bench)], [summary]) = (&mut sound[..], &mut summaries[..]) {
            let run = Run { record, bench };
            if let Some(means) = Blocks::of(&run, axes.first()) {
                summary.averaged = Some(means.report);
                (*record, *bench) = (Cow::Owned(means.record), Cow::Owned(means.bench));
            }
        }
        let runs = sound.iter();
        let runs: Vec<Run<'_>> = runs.map(|(record, bench)| Run { record, bench }).collect();
        let (fitted, joint) = match &runs[..] {
            [run] => {
                let (noise, axes) = (noise_of(diagnosis), axes.first());
                let fitted = NamedCause::fitted_of_unit(&named, run, axes, &noise, &options)?;
                (fitted.into_owned(), None)
            }
            runs => {
                let (fitted, joint) = fitted_to_records(diagnosis, runs, &axes, &options)?;
                (fitted, Some(joint))
            }
        };
        let summary = match &summaries[..] {
            [one] => *one,
            all => records_summary(all),
        };
        let Some((own, bench)) = sound.pop() else {
            return Err(DesignError::from(CalibrationError::NoRecords).into());
        };
        Ok(Self {
            record: joint.map_or(own, Cow::Owned),
            bench,
            summary,
            setup,
            fitted,
            named,
        })
    }
}
