//! Several records of one plant: one search over all, initial states for each.

use std::collections::HashMap;

use gyrocal_answer::RecordResult;
use gyrocal_hypothesis::{FittedModel as _, SearchOptions};
use gyrocal_inference::stop;

use crate::answer::{coefficients, summary};
use crate::diagnosed::Diagnosed;
use crate::diagnosis::{diagnose, diagnose_from};
use crate::error::PlantError;
use crate::loaded::LoadedPlant;
use crate::prediction::errors;
use crate::record::{NamedRecord, PlantRecord};

/// Consecutive rows with equal values that show that two records share them.
const SHARED_ROWS: usize = 24;

/// The diagnosis of several records of one plant.
pub struct DiagnosedRecords {
    /// Of all together: parameters and effects are shared, initial states are those of each record.
    pub together: Diagnosed,
    /// Of each of several alone; a record may determine too little for that. Empty of one record.
    pub alone: Vec<Result<Diagnosed, PlantError>>,
}

/// Diagnoses records of one plant together, and each alone. Parameters and effects are shared; each record
/// has initial states of its own, and a sudden change acts in the record that it happens in. With a later
/// record the gain of what was found is measured there.
///
/// # Errors
/// [`PlantError::Input`] without a record, or if two records have rows in common, and as [`diagnose`].
pub fn diagnose_records(
    plant: &LoadedPlant,
    records: Vec<NamedRecord>,
    later: Option<PlantRecord>,
    options: &SearchOptions,
) -> Result<DiagnosedRecords, PlantError> {
    if records.is_empty() {
        return Err(PlantError::Input {
            origin: plant.description.name.clone(),
            problem: "no record".to_owned(),
            advice: "give one or more".to_owned(),
        });
    }
    refuse_twins(&records)?;
    if let [only] = &records[..] {
        return Ok(DiagnosedRecords {
            together: diagnose(plant, only.record.clone(), later, options)?,
            alone: Vec::new(),
        });
    }
    let alone: Vec<Result<Diagnosed, PlantError>> = records
        .iter()
        .map(|one| diagnose(plant, one.record.clone(), None, options))
        .collect();
    let parts: Vec<PlantRecord> = records.iter().map(|one| one.record.clone()).collect();
    let start = start(plant, &alone);
    let record = PlantRecord::joined(&parts);
    let together = diagnose_from(plant, record, later, options, start.as_deref());
    let mut together = stop::finished(together)?;
    together.answer.records = results(plant, &together, &records, &alone);
    Ok(DiagnosedRecords { together, alone })
}

/// Where the fit to all begins: parameters of the first record that can be fitted alone, initial states of
/// each. `None` where no record can.
fn start(plant: &LoadedPlant, alone: &[Result<Diagnosed, PlantError>]) -> Option<Vec<f64>> {
    let states = plant.description.states.len();
    let values = |one: &Result<Diagnosed, PlantError>| {
        let one = one.as_ref().ok()?;
        Some(one.searched.nominal.values().to_vec())
    };
    let initial = |one| values(one).map_or_else(|| vec![0.0; states], |own| own[..states].to_vec());
    let parameters = alone.iter().find_map(values)?;
    let (first, others) = alone.split_first()?;
    let mut start = initial(first);
    start.extend_from_slice(&parameters[states..]);
    start.extend(others.iter().flat_map(initial));
    Some(start)
}

fn results(
    plant: &LoadedPlant,
    together: &Diagnosed,
    records: &[NamedRecord],
    alone: &[Result<Diagnosed, PlantError>],
) -> Vec<RecordResult> {
    let (nominal, fitted) = (&together.searched.nominal, &together.searched.fitted);
    let joined = fitted.record();
    let simulated = (nominal.simulated(), fitted.simulated());
    let initial = nominal.initial_states().into_iter();
    let mut initial = initial.zip(fitted.initial_states());
    let rows = joined.records().zip(records.iter().zip(alone));
    rows.map(|(rows, (one, alone))| {
        let (nominal, extended) = initial.next().unwrap_or_default();
        let states = plant.description.states.iter();
        let states = states.zip(nominal.into_iter().zip(extended));
        let states = states.map(|(state, (nominal, extended))| {
            let name = format!("initial {}", state.id);
            (name, state.unit.clone(), state.initial, [nominal, extended])
        });
        RecordResult {
            name: one.name.clone(),
            record: summary(&one.record),
            turn_on_deg_per_h: None,
            initial: Some(coefficients(states, together.answer.has_findings())),
            open_loop: errors(plant, joined, (&simulated.0, &simulated.1), rows),
            alone: alone.as_ref().ok().map(|alone| alone.answer.clone()),
            why_not_alone: match alone {
                Ok(_) => String::new(),
                Err(reason) => reason.to_string(),
            },
        }
    })
    .collect()
}

/// Refuses records that have rows in common: they would count twice.
fn refuse_twins(records: &[NamedRecord]) -> Result<(), PlantError> {
    for (index, one) in records.iter().enumerate() {
        for other in &records[index + 1..] {
            if let Some(row) = shared(&one.record, &other.record) {
                return Err(PlantError::Input {
                    origin: other.name.clone(),
                    problem: format!(
                        "from row {} on it has rows that {} has too, which would count twice",
                        row + 1,
                        one.name
                    ),
                    advice: "leave one of them out, or cut the rows that both have from one"
                        .to_owned(),
                });
            }
        }
    }
    Ok(())
}

/// The first of many consecutive rows of another record that a record has too.
fn shared(one: &PlantRecord, other: &PlantRecord) -> Option<usize> {
    let rows = SHARED_ROWS.min(one.len()).min(other.len());
    let windows = |record: &PlantRecord| -> Vec<Vec<u64>> {
        let values = |values: &[f64], row: usize| -> Vec<u64> {
            let width = values.len() / record.len();
            let own = &values[row * width..(row + 1) * width];
            own.iter().map(|value| value.to_bits()).collect()
        };
        let of_row = |row| [values(&record.outputs, row), values(&record.inputs, row)].concat();
        let rows: Vec<Vec<u64>> = (0..record.len()).map(of_row).collect();
        rows
    };
    let (own, theirs) = (windows(one), windows(other));
    // A stretch of rows that stand still says nothing.
    let moves =
        |part: &[Vec<u64>]| part.windows(2).filter(|pair| pair[0] != pair[1]).count() > rows / 2;
    let known: HashMap<&[Vec<u64>], usize> = own.windows(rows).zip(0..).collect();
    theirs
        .windows(rows)
        .position(|part| known.contains_key(part) && moves(part))
}
