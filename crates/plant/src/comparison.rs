//! Several plants fitted to one record, beside each other.

use gyrocal_answer::{ComparedFit, PlantComparison};

use crate::description::Description;
use crate::error::PlantError;
use crate::fit::fit;
use crate::loaded::LoadedPlant;
use crate::record::NamedRecord;

/// Fits each of several plants, by name, to one record, as [`fit()`] does; a nominal plant and the extended one, or rival
/// equations of the same plant. `read` reads the record and the later one for a plant. What `first_rows` and `at` are is
/// told there.
///
/// # Errors
/// [`PlantError::Input`] of fewer than two plants, and of one that has other inputs or outputs than the first, or takes
/// other readings of the record: likelihoods would not compare. [`PlantError::OfModel`] of a plant that cannot be fitted,
/// and those of `read`.
pub fn compare(
    plants: &[(String, LoadedPlant)],
    read: impl Fn(&Description) -> Result<(NamedRecord, Option<NamedRecord>), PlantError>,
    first_rows: usize,
    at: &mut dyn FnMut(&'static str, f64),
) -> Result<PlantComparison, PlantError> {
    let [first, second, ..] = plants else {
        let origin = plants.iter().map(|(name, _)| name.clone()).collect();
        let problem = "one plant cannot be compared".to_owned();
        return Err(refuse(
            origin,
            problem,
            "give two or more before the record",
        ));
    };
    let count = plants.len() as f64;
    for other in core::iter::once(second).chain(&plants[2..]) {
        refuse_other(first, other)?;
    }
    let mut readings: Vec<u64> = Vec::new();
    let mut models = Vec::with_capacity(plants.len());
    for (index, (name, plant)) in plants.iter().enumerate() {
        let (record, later) = read(plant.description())?;
        let own: Vec<u64> = record
            .record
            .outputs
            .iter()
            .map(|one| one.to_bits())
            .collect();
        if index > 0 && own != readings {
            let problem = format!(
                "it takes other readings of {} than {}",
                record.name, first.0
            );
            let advice = "declare the same `saturates` in all scripts";
            return Err(refuse(name.clone(), problem, advice));
        }
        readings = own;
        let at = &mut |stage, share| at(stage, (index as f64 + share) / count);
        let fitted = fit(plant, record, later, first_rows, at);
        let fitted = fitted.map_err(|reason| of_model(name, reason))?;
        models.push(ComparedFit {
            name: name.clone(),
            fit: fitted.answer,
        });
    }
    Ok(PlantComparison { models })
}

/// A failure that a plant alone has is told with its name; that of a record has its own.
fn of_model(name: &str, reason: PlantError) -> PlantError {
    match reason {
        PlantError::Input { .. } | PlantError::Stopped(_) => reason,
        reason => PlantError::OfModel {
            name: name.to_owned(),
            reason: Box::new(reason),
        },
    }
}

fn refuse(origin: String, problem: String, advice: &str) -> PlantError {
    PlantError::Input {
        origin,
        problem,
        advice: advice.to_owned(),
    }
}

/// Refuses a plant with other inputs or outputs than the first.
fn refuse_other(
    (name, first): &(String, LoadedPlant),
    (other_name, other): &(String, LoadedPlant),
) -> Result<(), PlantError> {
    let listed = |plant: &LoadedPlant| {
        let description = plant.description();
        let of = |id: &String, unit: &String| format!("{id} [{unit}]");
        let inputs = description.inputs.iter().map(|one| of(&one.id, &one.unit));
        let outputs = description.outputs.iter().map(|one| of(&one.id, &one.unit));
        [
            inputs.collect::<Vec<_>>().join(", "),
            outputs.collect::<Vec<_>>().join(", "),
        ]
    };
    let kinds = ["inputs", "outputs"].into_iter();
    for (kind, (own, others)) in kinds.zip(listed(first).into_iter().zip(listed(other))) {
        if own != others {
            let problem = format!("it has the {kind} {others}, and {name} has {own}");
            let advice = "compare plants with the same inputs and outputs, in one order";
            return Err(refuse(other_name.clone(), problem, advice));
        }
    }
    Ok(())
}
