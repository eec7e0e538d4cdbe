//! The diagnosis of a record: what its model lacks, with sets, sizes and the gain on a later record.

use std::sync::Arc;

use gyrocal_answer::{ResidualVerdict, Validation};
use gyrocal_hypothesis::{SearchOptions, Searched};
use gyrocal_inference::stop;

use crate::answer::{answer, remainder, summary};
use crate::cross_validation::cross_validated;
use crate::diagnosed::Diagnosed;
use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::identifiability::Determined;
use crate::judged::{Judged, Standing, standing};
use crate::loaded::LoadedPlant;
use crate::prediction::{errors, horizon_s};
use crate::record::PlantRecord;
use crate::series::RecordSeries;

/// Diagnoses a record; with a later record of the same plant the gain of what was found is measured there.
///
/// # Errors
/// [`PlantError::NoFit`], [`PlantError::NotFinite`], [`PlantError::Singular`], and [`PlantError::Stopped`] if the job was
/// asked to end.
pub fn diagnose(
    plant: &LoadedPlant,
    record: PlantRecord,
    later: Option<PlantRecord>,
    options: &SearchOptions,
) -> Result<Diagnosed, PlantError> {
    stop::finished(diagnose_from(plant, record, later, options, None))
}

/// The same from the values of another fit.
pub(crate) fn diagnose_from(
    plant: &LoadedPlant,
    record: PlantRecord,
    later: Option<PlantRecord>,
    options: &SearchOptions,
    start: Option<&[f64]>,
) -> Result<Diagnosed, PlantError> {
    let Determined {
        nominal,
        directions,
        ..
    } = FittedPlant::determined(plant, record, start)?;
    let later = later.map(Arc::new);
    let selection = nominal.selection()?;
    let Standing {
        judged: Judged { searched, refused },
        selection,
        path,
    } = standing(&nominal, selection, options, later.as_ref(), |found| {
        Ok(remainder(plant, found)?.verdict != ResidualVerdict::Unexplained)
    })?;
    let mut answer = answer(plant, &searched, &selection, options)?;
    answer.undetermined = directions;
    answer.only_in_white_noise = refused.into_iter().map(str::to_owned).collect();
    answer.path = path;
    answer.gain = cross_validated(&searched)?;
    let mut series = None;
    if let Some(later) = later {
        answer.later_record = Some(summary(&later));
        let (validation, predicted) = compare(&searched, later, answer.has_findings())?;
        if let Some(gain) = &mut answer.gain {
            gain.validation = Some(validation);
        }
        series = Some(predicted);
    }
    Ok(Diagnosed {
        answer,
        searched,
        later: series,
    })
}

/// Both models on a later record.
fn compare(
    searched: &Searched<FittedPlant>,
    later: Arc<PlantRecord>,
    has_findings: bool,
) -> Result<(Validation, RecordSeries), PlantError> {
    let plant = searched.fitted.loaded();
    let nominal = searched.nominal.predict(&later)?;
    let extended = searched.fitted.predict(&later)?;
    let rows = 0..later.len();
    let simulated = (&nominal.simulated[..], &extended.simulated[..]);
    let validation = Validation {
        log_score_nats: extended.log_density - nominal.log_density,
        compensation: None,
        open_loop: errors(plant, &later, simulated, rows.clone()),
        horizon_s: Some(horizon_s(plant, &later)),
    };
    let sigmas = searched.fitted.output_sigmas();
    let extended = has_findings.then_some(simulated.1);
    let series = RecordSeries::new(plant, (&later, rows), (simulated.0, extended), &sigmas);
    Ok((validation, series))
}
