//! The JSON result.

use std::path::Path;

use gyrocal::generated::MODEL_HASH;
use gyrocal_diagnosis::{CalibratedRecord, CalibrationEvidence, calibration_report};
use gyrocal_record::{CalibrationMethod, CalibrationReport, InputRole, SetupProblem};

use super::CalibrationRun;
use super::inputs::Measurement;
use crate::Failure;
use crate::outputs::manifest_of;

pub(super) fn report(
    found: &CalibrationRun,
    inputs: &[(InputRole, &Path)],
) -> Result<CalibrationReport, Failure> {
    let evidence = CalibrationEvidence {
        method: found.method,
        records: found.measurements.iter().map(record).collect(),
        calibration: &found.calibration,
        effects: &found.effects,
        with_effects: found.with_effects.as_ref(),
        verdict: &found.verdict,
        first_record_sigmas: found.first_run_sigmas,
    };
    let manifest = manifest_of(MODEL_HASH, 0, inputs)?;
    Ok(calibration_report(evidence, manifest))
}

/// The result for records whose set-up is wrong.
pub(super) fn of_wrong_setup(
    method: CalibrationMethod,
    setup: Vec<SetupProblem>,
    inputs: &[(InputRole, &Path)],
) -> Result<CalibrationReport, Failure> {
    let manifest = manifest_of(MODEL_HASH, 0, inputs)?;
    Ok(CalibrationReport::of_wrong_setup(manifest, method, setup))
}

fn record(measurement: &Measurement) -> CalibratedRecord<'_> {
    CalibratedRecord {
        name: measurement.path.display().to_string(),
        bench_name: measurement.bench_path.display().to_string(),
        record: &measurement.record,
        rows: measurement.rows,
        averaged: measurement.averaged,
        setup: &measurement.setup,
    }
}
