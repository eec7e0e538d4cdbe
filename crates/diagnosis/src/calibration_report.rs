//! The result of a calibration as plain data.

use gyrocal::trajectory::angles_rad;
use gyrocal_calibration::{
    AzimuthSearch, Calibration, CoefficientEstimate, ConsiderSensitivity, RunResult, SiteQuantity,
    UnobservableCombination, times_overlap,
};
use gyrocal_record::{
    AveragedReport, AzimuthReport, CALIBRATION_SCHEMA_VERSION, CalibrationMethod,
    CalibrationReport, Coefficient, EffectTest, FittedEffects, Manifest, OtherAzimuth, Record,
    RecordReport, RunReport, SetupProblem, SiteReport, TurnOn, UndeterminedReport,
};

use crate::COEFFICIENTS;
use crate::calibration_verdict::CalibrationVerdict;

/// A record that was calibrated, for the result.
#[derive(Clone, Debug)]
pub struct CalibratedRecord<'a> {
    /// Its name, as its path was given.
    pub name: String,
    /// The name of its bench description.
    pub bench_name: String,
    /// The record as it was calibrated.
    pub record: &'a Record,
    /// Rows before averaging.
    pub rows: usize,
    /// Averaging of its rows.
    pub averaged: Option<AveragedReport>,
    /// Gross errors of its set-up that were mended.
    pub setup: &'a [SetupProblem],
}

/// All that the result of a calibration is made of.
#[derive(Clone, Debug)]
pub struct CalibrationEvidence<'a> {
    /// Method of estimation.
    pub method: CalibrationMethod,
    /// The records, in the order of the runs of `calibration`.
    pub records: Vec<CalibratedRecord<'a>>,
    /// The estimates.
    pub calibration: &'a Calibration,
    /// What the diagnoses of the records say.
    pub effects: &'a [EffectTest],
    /// The coefficients with given effects in the model.
    pub with_effects: Option<&'a FittedEffects>,
    /// Verdict on set-up, effects and innovations.
    pub verdict: &'a CalibrationVerdict,
    /// Sigmas of the coefficients from the first record alone, if there are several.
    pub first_record_sigmas: Option<[f64; COEFFICIENTS]>,
}

/// The result of a calibration; its JSON is what `gyrocal calibrate --json` writes.
#[must_use]
pub fn calibration_report(
    evidence: CalibrationEvidence<'_>,
    manifest: Manifest,
) -> CalibrationReport {
    let calibration = evidence.calibration;
    let fit = &calibration.fit;
    let setup = evidence.records.iter().flat_map(|record| record.setup);
    let runs = evidence.records.iter().zip(&calibration.runs);
    CalibrationReport {
        schema_version: CALIBRATION_SCHEMA_VERSION,
        manifest,
        setup: setup.cloned().collect(),
        effects: evidence.effects.to_vec(),
        coefficients: calibration
            .coefficients()
            .into_iter()
            .map(coefficient)
            .collect(),
        covariance: calibration.covariance.map(Vec::from).to_vec(),
        nis_mean: Some(fit.nis_mean()),
        nis_band: Some(fit.nis_band()),
        verdict: evidence.verdict.verdict,
        verdict_text: evidence.verdict.text.clone(),
        iterations: calibration.iterations,
        usable: !fit.is_gross(),
        records: records(&evidence.records),
        rows: fit.rows(),
        final_angles_deg: Some(calibration.final_angles_rad.map(f64::to_degrees)),
        method: evidence.method,
        undetermined: calibration.unobservable.iter().map(undetermined).collect(),
        runs: runs.map(|(record, run)| run_report(record, run)).collect(),
        site: calibration.site_sensitivities.iter().map(site).collect(),
        first_record_sigmas: evidence.first_record_sigmas.map(Vec::from),
        with_effects: evidence.with_effects.cloned(),
    }
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
        let overlaps = earlier.filter(|other| times_overlap(other.record, one.record));
        RecordReport {
            record: one.name.clone(),
            bench: one.bench_name.clone(),
            rows: one.rows,
            duration_s: one.record.duration_s(),
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
