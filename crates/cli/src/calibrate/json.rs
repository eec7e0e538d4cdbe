//! The JSON result.

use std::path::Path;

use gyrocal::generated::MODEL_HASH;
use gyrocal::trajectory::angles_rad;
use gyrocal_calibration::{
    AzimuthSearch, ConsiderSensitivity, RunResult, SiteQuantity, UnobservableCombination,
};
use gyrocal_record::{
    AzimuthReport, CalibrationMethod, CalibrationReport, Coefficient, OtherAzimuth, RunReport,
    SCHEMA_VERSION, SetupProblem, SiteReport, TurnOn, UndeterminedReport,
};

use super::CalibrationRun;
use super::inputs::Measurement;
use crate::Failure;
use crate::noise;
use crate::outputs::manifest;

pub(super) fn report(
    found: &CalibrationRun,
    inputs: &[&Path],
) -> Result<CalibrationReport, Failure> {
    let calibration = &found.calibration;
    let fit = &calibration.fit;
    let runs = found.measurements.iter().zip(&calibration.runs);
    Ok(CalibrationReport {
        schema_version: SCHEMA_VERSION,
        manifest: manifest(MODEL_HASH, 0, inputs)?,
        setup: found.setup().cloned().collect(),
        effects: found.effects.clone(),
        coefficients: calibration
            .coefficients()
            .into_iter()
            .map(|coefficient| Coefficient {
                name: coefficient.id.to_owned(),
                estimate: coefficient.estimate,
                sigma: coefficient.sigma,
                unit: coefficient.unit.to_owned(),
                determined: coefficient.determined,
            })
            .collect(),
        covariance: calibration.covariance.map(Vec::from).to_vec(),
        nis_mean: Some(fit.nis_mean()),
        nis_band: Some(fit.nis_band()),
        verdict: found.verdict.verdict,
        verdict_text: found.verdict.text.clone(),
        iterations: calibration.iterations,
        rows: fit.rows(),
        final_angles_deg: Some(calibration.final_angles_rad.map(f64::to_degrees)),
        method: found.method,
        undetermined: calibration.unobservable.iter().map(undetermined).collect(),
        runs: runs
            .map(|(measurement, run)| run_report(measurement, run))
            .collect(),
        site: calibration.site_sensitivities.iter().map(site).collect(),
        first_record_sigmas: found.first_run_sigmas.map(Vec::from),
        with_effects: found.with_effects.clone(),
    })
}

/// The result for records whose set-up is wrong.
pub(super) fn of_wrong_setup(
    method: CalibrationMethod,
    setup: Vec<SetupProblem>,
    inputs: &[&Path],
) -> Result<CalibrationReport, Failure> {
    let manifest = manifest(MODEL_HASH, 0, inputs)?;
    Ok(CalibrationReport::of_wrong_setup(manifest, method, setup))
}

fn undetermined(combination: &UnobservableCombination) -> UndeterminedReport {
    UndeterminedReport {
        text: combination.text(),
        weights: combination.weights.clone(),
        share_of_prior: combination.posterior_to_prior_ratio,
    }
}

fn run_report(measurement: &Measurement, run: &RunResult) -> RunReport {
    let angles_deg = |platform_c_enu| angles_rad(platform_c_enu).map(f64::to_degrees);
    RunReport {
        record: measurement.path.display().to_string(),
        bench: measurement.bench_path.display().to_string(),
        rows: measurement.record.len(),
        averaged: measurement.averaged.map(|averaged| averaged.report),
        initial_angles_deg: angles_deg(&run.first_platform_c_enu),
        final_angles_deg: angles_deg(&run.last_platform_c_enu),
        turn_on: run
            .turn_on_deg_per_h
            .map(|gyros| gyros.map(|[estimate, sigma]| TurnOn { estimate, sigma })),
        azimuth: run.azimuth.as_ref().map(azimuth),
        noise: run.noise.as_ref().map(noise::report),
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
        from_record_sigma: sigma.is_finite().then_some(sigma),
        bias_per_unit: influence.bias_per_unit.to_vec(),
    }
}
