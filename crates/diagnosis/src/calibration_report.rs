//! A calibration with the diagnoses of its records, and its result as plain data.

use gyrocal::trajectory::angles_rad;
use gyrocal_calibration::{
    AzimuthSearch, Calibration, CalibrationError, CoefficientEstimate, ConsiderSensitivity,
    GyroAxes, Options, Run, RunResult, SiteQuantity, UnobservableCombination, calibrate_runs,
    calibrate_strapdown, first_run_sigmas, times_overlap,
};
use gyrocal_hypothesis::stop;
use gyrocal_record::{
    AveragedReport, AzimuthReport, CALIBRATION_SCHEMA_VERSION, CalibrationMethod,
    CalibrationReport, Coefficient, EffectTest, FittedEffects, Manifest, OtherAzimuth,
    RecordReport, RunReport, SetupProblem, SiteReport, TurnOn, UndeterminedReport,
};

use crate::calibration_verdict::calibration_verdict;
use crate::diagnose::{DiagnoseOptions, diagnose_calibrated};
use crate::error::DiagnosisError;

/// A record to be calibrated.
#[derive(Clone, Debug)]
pub struct CalibratedRecord<'a> {
    /// Its name, as its path was given.
    pub name: String,
    /// The name of its bench description.
    pub bench_name: String,
    /// The record as it is calibrated.
    pub run: Run<'a>,
    /// The record as it is diagnosed: before fast rows became means of blocks.
    pub diagnosed: Run<'a>,
    /// Rows before averaging.
    pub rows: usize,
    /// Averaging of its rows.
    pub averaged: Option<AveragedReport>,
    /// Gross errors of its set-up that were mended.
    pub setup: &'a [SetupProblem],
}

/// What is calibrated, and how.
#[derive(Clone, Debug)]
pub struct CalibrationRequest<'a> {
    /// Method of estimation, which `options` are of.
    pub method: CalibrationMethod,
    /// Settings of the estimation.
    pub options: Options,
    /// The records.
    pub records: Vec<CalibratedRecord<'a>>,
    /// Axes of the instruments in each record, of a strapdown unit; else empty.
    pub axes: &'a [GyroAxes],
    /// The coefficients with given effects in the model.
    pub with_effects: Option<FittedEffects>,
    /// Origin of the result.
    pub manifest: Manifest,
}

/// How far a calibration is.
#[derive(Debug)]
pub enum CalibrationStep<'a> {
    /// So many rows were read, of one filter pass.
    Row(usize),
    /// The coefficients are estimated; the diagnoses of the records follow.
    Fitted(&'a Calibration),
    /// A record that could not be diagnosed.
    NotDiagnosed(&'a str, &'a DiagnosisError),
    /// The first of several records cannot be calibrated alone, which is no failure of all together.
    FirstNotAlone(&'a CalibrationError),
}

/// Calibrates records and diagnoses each: the result whose JSON is what `gyrocal calibrate --json` writes. `told` hears
/// how far it is.
///
/// # Errors
/// [`CalibrationError`] if the coefficients cannot be estimated, or if the job was asked to end.
pub fn calibrate_and_diagnose(
    request: CalibrationRequest<'_>,
    mut told: impl FnMut(CalibrationStep<'_>),
) -> Result<CalibrationReport, CalibrationError> {
    let (given, axes, options) = (&request.records, request.axes, &request.options);
    let runs: Vec<Run<'_>> = given.iter().map(|one| one.run).collect();
    let calibration = match axes {
        [] => calibrate_runs(&runs, options, |row| told(CalibrationStep::Row(row))),
        axes => calibrate_strapdown(&runs, axes, options, |_| ()),
    }?;
    told(CalibrationStep::Fitted(&calibration));
    let tests = given.iter().enumerate().filter_map(|(index, one)| {
        let options = DiagnoseOptions::default();
        diagnose_calibrated(&one.name, &one.diagnosed, axes.get(index), &options)
            .inspect_err(|error| told(CalibrationStep::NotDiagnosed(&one.name, error)))
            .ok()
    });
    let effects: Vec<EffectTest> = tests.collect();
    let first = first_run_sigmas(&runs, axes, options);
    let first = first.inspect_err(|error| told(CalibrationStep::FirstNotAlone(error)));
    // Records that could not be diagnosed are told: those of a stopped job could.
    stop::check()?;
    let fit = &calibration.fit;
    let verdict = calibration_verdict(fit, &effects);
    let setup = given.iter().flat_map(|record| record.setup);
    let runs = given.iter().zip(&calibration.runs);
    let mut report = CalibrationReport {
        schema_version: CALIBRATION_SCHEMA_VERSION,
        setup: setup.cloned().collect(),
        effects,
        coefficients: calibration
            .coefficients()
            .into_iter()
            .map(coefficient)
            .collect(),
        covariance: calibration.covariance.map(Vec::from).to_vec(),
        nis_mean: Some(fit.nis_mean()),
        nis_band: Some(fit.nis_band()),
        verdict,
        verdict_text: String::new(),
        iterations: calibration.iterations,
        usable: !fit.is_gross(),
        records: records(given),
        rows: fit.rows(),
        final_angles_deg: Some(calibration.final_angles_rad.map(f64::to_degrees)),
        method: request.method,
        undetermined: calibration.unobservable.iter().map(undetermined).collect(),
        runs: runs.map(|(record, run)| run_report(record, run)).collect(),
        site: calibration.site_sensitivities.iter().map(site).collect(),
        first_record_sigmas: first.unwrap_or(None).map(Vec::from),
        with_effects: request.with_effects,
        manifest: request.manifest,
    };
    report.verdict_text = gyrocal_words::calibration_verdict(&report);
    Ok(report)
}

fn coefficient(found: CoefficientEstimate) -> Coefficient {
    Coefficient {
        name: found.id.to_owned(),
        estimate: found.estimate,
        sigma: found.sigma,
        unit: found.unit.to_owned(),
        determined: found.determined,
    }
}

fn undetermined(combination: &UnobservableCombination) -> UndeterminedReport {
    UndeterminedReport {
        text: combination.text(),
        weights: combination.weights.clone(),
        share_of_prior: combination.posterior_to_prior_ratio,
    }
}

fn records(all: &[CalibratedRecord<'_>]) -> Vec<RecordReport> {
    let told = all.iter().enumerate().map(|(place, one)| {
        let earlier = all[..place].iter();
        let overlaps = earlier.filter(|other| times_overlap(other.run.record, one.run.record));
        RecordReport {
            record: one.name.clone(),
            bench: one.bench_name.clone(),
            rows: one.rows,
            duration_s: one.diagnosed.record.duration_s(),
            averaged: one.averaged,
            overlaps: overlaps.map(|other| other.name.clone()).collect(),
        }
    });
    told.collect()
}

fn run_report(record: &CalibratedRecord<'_>, run: &RunResult) -> RunReport {
    let angles_deg = |platform_c_enu| angles_rad(platform_c_enu).map(f64::to_degrees);
    RunReport {
        record: record.name.clone(),
        initial_angles_deg: angles_deg(&run.first_platform_c_enu),
        final_angles_deg: angles_deg(&run.last_platform_c_enu),
        turn_on: run
            .turn_on_deg_per_h
            .map(|gyros| gyros.map(|[estimate, sigma]| TurnOn { estimate, sigma })),
        azimuth: run.azimuth.as_ref().map(azimuth),
        noise: run.noise,
        bounded_values: run.bounded_values,
    }
}

fn azimuth(search: &AzimuthSearch) -> AzimuthReport {
    AzimuthReport {
        starts: search.starts,
        ambiguous: search.is_ambiguous(),
        other: search.margin.is_finite().then(|| OtherAzimuth {
            relative_deg: search.other_rad.to_degrees(),
            log_likelihood_deficit: search.margin,
        }),
    }
}

fn site(influence: &ConsiderSensitivity) -> SiteReport {
    let (quantity, unit) = match influence.quantity {
        SiteQuantity::Latitude => ("latitude", "deg"),
        SiteQuantity::EarthRate => ("earth_rate", "1"),
        SiteQuantity::Gravity => ("gravity", "1"),
        _ => ("other", "1"),
    };
    let sigma = influence.from_record_sigma;
    SiteReport {
        quantity: quantity.to_owned(),
        unit: unit.to_owned(),
        declared_sigma: influence.declared_sigma,
        assumed_error: influence.assumed_error(),
        from_record_sigma: sigma.is_finite().then_some(sigma),
        bias_per_unit: influence.bias_per_unit.to_vec(),
    }
}
