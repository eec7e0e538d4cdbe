//! Errors of `gyrocal calibrate`, with advice.

use gyrocal::EstimationError;
use gyrocal_calibration::{CalibrationError, Run, is_gyro_noise_implausible};
use gyrocal_record::{CalibrationMethod, CalibrationReport};

use crate::advice::{advised, on_no_fit};

/// The records could not be calibrated; its help is the advice.
#[derive(Debug, thiserror::Error)]
#[error("{records}: no calibration")]
pub struct NotCalibrated {
    records: String,
    method: CalibrationMethod,
    factorised: bool,
    /// Whether the bench file declares an implausibly small gyro noise.
    tiny_gyro_noise: bool,
    source: CalibrationError,
}

impl NotCalibrated {
    /// The failure of runs of these names, of which the source may tell one.
    #[must_use]
    pub fn new(
        names: &[String],
        runs: &[Run<'_>],
        method: CalibrationMethod,
        factorised: bool,
        source: CalibrationError,
    ) -> Self {
        let failed = match place(&source) {
            Some(place) => place..place + 1,
            None => 0..names.len(),
        };
        let runs = runs.get(failed.clone()).unwrap_or_default();
        Self {
            records: names.get(failed).unwrap_or_default().join(", "),
            method,
            factorised,
            tiny_gyro_noise: runs.iter().any(|run| is_gyro_noise_implausible(run.bench)),
            source,
        }
    }

    fn advice(&self) -> &'static str {
        self.advice_on(&self.source)
    }

    fn advice_on(&self, why: &CalibrationError) -> &'static str {
        use CalibrationError as Why;
        use EstimationError as Filter;

        let batch = self.method == CalibrationMethod::Batch;
        let lost = match why {
            Why::OfSeveral { source, .. } => return self.advice_on(source),
            Why::TooShort { .. } => return "record for longer",
            Why::NoAttitude => {
                return "leave out --streaming or --paper: the batch estimator finds the attitude";
            }
            Why::NotLevelled | Why::NoAzimuth { .. } => {
                return "give initial_angles_deg and initial_angles_sigma_deg in [platform]";
            }
            Why::NoDescent { .. } | Why::NotConverged { .. } => {
                return on_no_fit(self.tiny_gyro_noise);
            }
            Why::NotPositiveDefinite => true,
            Why::Filter { source, .. } | Why::Pass { source, .. } => matches!(
                source,
                Filter::LostPrecision { .. } | Filter::NotPositiveDefinite { .. }
            ),
            _ => false,
        };
        if self.method == CalibrationMethod::Paper {
            "the paper's filter fails where the second platform angle comes near 90 deg: leave \
             out --paper"
        } else if lost && !batch && !self.factorised {
            "the prior is very wide against the noise: give realistic values of [prior] and \
             initial_angles_sigma_deg, or use the factorised covariance (--factorised)"
        } else {
            "the values of the bench file are implausible, or inconsistent with the record: check \
             [noise], [prior] and initial_angles_sigma_deg"
        }
    }
}

/// A gross error of a set-up leaves nothing sound.
#[derive(Debug, thiserror::Error)]
#[error("{text}")]
pub(super) struct WrongSetup {
    text: String,
    written: String,
}

impl WrongSetup {
    pub(super) fn new(report: &CalibrationReport, written: &[(String, String)]) -> Self {
        let written = written.iter();
        Self {
            text: report.verdict_text.clone(),
            written: written
                .map(|(path, what)| format!("; {path}: {what}"))
                .collect(),
        }
    }

    fn advice(&self) -> String {
        let Self { written, .. } = self;
        format!(
            "mend the record or its bench file: docs/setup-checks.md lists what is checked{written}"
        )
    }
}

/// The place of the record that failed, if one did.
fn place(why: &CalibrationError) -> Option<usize> {
    match why {
        CalibrationError::Pass { run, .. } | CalibrationError::OfSeveral { run, .. } => {
            Some(run - 1)
        }
        _ => None,
    }
}

advised! {
    WrongSetup, "gyrocal::calibrate::setup";
    NotCalibrated, "gyrocal::calibrate";
}
