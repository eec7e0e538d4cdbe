//! Gross errors of the set-up, before anything is fitted: the tests of `gyrocal_setup`, and the fits
//! that decide what rows alone do not.

use std::borrow::Cow;

use gyrocal::Platform;
use gyrocal_calibration::{CalibrationError, FittedPlatform, GyroAxes, NoiseModel, Options, Run};
use gyrocal_record::{Bench, Record, RecordFile, SetupProblem};
use gyrocal_setup::{Correction, PlatformKind, SetupFinding, check_setup_of};

/// Rows that a record is thinned to before it is fitted as given and as corrected: enough to tell a
/// mean NIS of 3 from one of 4, and fitted in a tenth of a second.
const FITTED_ROWS: usize = 288;

/// Log-likelihood that a correction must gain to confirm an error, nats: both set-ups fit the record,
/// and only the prior of the drift per g tells them apart. Coefficients from that prior gain as much
/// by chance in one of 300 000 records.
const CONFIRMED_NATS: f64 = 10.0;

/// Mean NIS below which a fit explains a record: three are expected, and noise is declared within a
/// factor of three.
const SOUND_NIS: f64 = 30.0;

/// What was found of a set-up, with what is left of the record.
#[derive(Clone, Debug)]
pub struct Gate<'a> {
    /// The record as it was given.
    pub record: &'a Record,
    /// Gross errors, in the order of the tests.
    pub problems: Vec<SetupProblem>,
    /// The record with what can be mended left out or corrected; `None` if an error leaves nothing
    /// sound, so that no model may be fitted.
    pub usable: Option<Cow<'a, Record>>,
    /// Axes of the instruments at each row of the record as it was given, if they are fixed to a body.
    pub gyro_axes: Option<GyroAxes>,
}

impl<'a> Gate<'a> {
    /// Looks for gross errors of the set-up of a record. Where the rows do not decide on the sign of
    /// the latitude, both are fitted; of errors that a correction of axes or latitude removes, the mean
    /// NIS of both fits is in the evidence.
    #[must_use]
    pub fn new(kind: PlatformKind, run: &Run<'a>, options: &Options) -> Self {
        let check = check_setup_of(kind, run.record, run.bench);
        let findings = check.findings.iter();
        let fitted = Run {
            record: check.mended.as_ref().unwrap_or(run.record),
            bench: run.bench,
        };
        let problems = findings.map(|finding| with_fits(finding, &fitted, options));
        let mut problems: Vec<SetupProblem> = problems.collect();
        let mut usable = check.usable;
        if let (Some(finding), Some(record)) = (&check.unconfirmed, &usable) {
            let bench = run.bench;
            if let Some(problem) = confirmed(finding, &Run { record, bench }, options) {
                problems.push(problem);
                usable = None;
            }
        }
        Self {
            record: run.record,
            usable: usable.map(|usable| match problems.is_empty() {
                true => Cow::Borrowed(run.record),
                false => Cow::Owned(usable),
            }),
            problems,
            gyro_axes: None,
        }
    }

    /// The same of a strapdown unit, with the axes of its instruments at each row of the record: the model is
    /// then that of gyros and accelerometers in these axes.
    #[must_use]
    pub fn with_gyro_axes(self, axes: Option<GyroAxes>) -> Self {
        Self {
            gyro_axes: axes,
            ..self
        }
    }

    /// The axes at the rows that are left; `None` of a stabilised platform, and where nothing is left.
    ///
    /// # Errors
    /// [`CalibrationError::GyroAxes`] if there is not one attitude for each row.
    pub fn usable_axes(&self) -> Result<Option<GyroAxes>, CalibrationError> {
        let (Some(axes), Some(usable)) = (&self.gyro_axes, &self.usable) else {
            return Ok(None);
        };
        let (rows, attitudes) = (self.record.len(), axes.len());
        if rows != attitudes {
            return Err(CalibrationError::GyroAxes { rows, attitudes });
        }
        let left = axes.of_rows(&self.record.time_s, &usable.time_s);
        let attitudes = 0;
        let rows = usable.len();
        left.map(Some)
            .ok_or(CalibrationError::GyroAxes { rows, attitudes })
    }

    /// The same of a record in a file, whose problems then have file and lines.
    ///
    /// # Errors
    /// [`gyrocal_record::Error::Input`] if what is left of the record is no platform's, or has fewer
    /// rows than the nominal model has states.
    pub fn of_file(
        kind: PlatformKind,
        file: &'a RecordFile,
        bench: &'a Bench,
        options: &Options,
    ) -> Result<Self, gyrocal_record::Error> {
        let record = file.record();
        let mut found = Self::new(kind, &Run { record, bench }, options);
        file.locate(&mut found.problems);
        if let Some(usable) = &found.usable {
            file.check(usable, Platform::STATES)?;
        }
        Ok(found)
    }

    /// Whether an error leaves nothing sound.
    #[must_use]
    pub fn stops(&self) -> bool {
        self.usable.is_none()
    }
}

/// A finding as results tell it, with the mean NIS of both fits if it has a correction.
fn with_fits(finding: &SetupFinding, run: &Run<'_>, options: &Options) -> SetupProblem {
    let mut problem = finding.problem();
    if let Some(correction) = &finding.correction {
        let fits = Fits::of(correction, run, options);
        problem.evidence = format!("{}; {}", problem.evidence, fits.text(correction));
    }
    problem
}

/// A finding that the fits confirm.
fn confirmed(finding: &SetupFinding, run: &Run<'_>, options: &Options) -> Option<SetupProblem> {
    let correction = finding.correction.as_ref()?;
    let fits = Fits::of(correction, run, options);
    let corrected = fits.corrected?;
    let words = match fits.given {
        Some(given) => {
            let nats = 0.5 * (given.cost - corrected.cost);
            if nats < CONFIRMED_NATS {
                return None;
            }
            format!(
                "the log-likelihood is {nats:.1} nats lower as given, {CONFIRMED_NATS} are allowed"
            )
        }
        // Nothing fits, which the correction mends.
        None if corrected.nis_mean < SOUND_NIS => "no fit can be made as given".to_owned(),
        None => return None,
    };
    let mut problem = finding.problem();
    problem.evidence = format!("{words}; {}; {}", fits.text(correction), problem.evidence);
    Some(problem)
}

/// Fits of a thinned record as given and as corrected; `None` where no fit could be made.
struct Fits {
    rows: usize,
    given: Option<Fit>,
    corrected: Option<Fit>,
}

#[derive(Clone, Copy)]
struct Fit {
    nis_mean: f64,
    /// Twice the negative log-likelihood, priors included, but for a constant.
    cost: f64,
}

impl Fits {
    fn of(correction: &Correction, run: &Run<'_>, options: &Options) -> Self {
        let thin = thinned(run.record);
        let (record, bench) = correction.apply(&thin, run.bench);
        Self {
            rows: thin.len(),
            given: fit(&thin, run.bench, options),
            corrected: fit(&record, &bench, options),
        }
    }

    fn text(&self, correction: &Correction) -> String {
        let nis = |fit: Option<Fit>| {
            fit.map_or("none, as no fit converges,".to_owned(), |fit| {
                format!("{:.3}", fit.nis_mean)
            })
        };
        format!(
            "mean NIS of {} rows, 3 is expected: {} as given, {} corrected ({} at {:.4} deg)",
            self.rows,
            nis(self.given),
            nis(self.corrected),
            correction.axes.describe(),
            correction.latitude_deg,
        )
    }
}

fn fit(record: &Record, bench: &Bench, options: &Options) -> Option<Fit> {
    let run = Run { record, bench };
    let fitted = FittedPlatform::nominal_once(&run, options, &NoiseModel::default()).ok()?;
    Some(Fit {
        nis_mean: fitted.nis_mean(),
        cost: fitted.cost(),
    })
}

fn thinned(record: &Record) -> Record {
    let step = record.len().div_ceil(FITTED_ROWS).max(1);
    let temperature_c = record.temperature_c.as_ref();
    Record {
        time_s: record.time_s.iter().copied().step_by(step).collect(),
        accel_g: record.accel_g.iter().copied().step_by(step).collect(),
        temperature_c: temperature_c.map(|column| column.iter().copied().step_by(step).collect()),
    }
}
