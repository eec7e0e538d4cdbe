//! Errors in parts that were left out of the fit, in words.

use gyrocal_answer::{PathStep, Refusal};

use super::rms;
use crate::files::joined;

/// What left-out parts say of the effects, a sentence for each output and one for each reason of a refusal.
#[must_use]
pub fn path(path: &[PathStep]) -> Vec<String> {
    let Some((nominal, effects)) = path.split_first() else {
        return Vec::new();
    };
    let stand = || effects.iter().filter(|step| step.refused.is_none());
    let outputs = nominal.outputs.iter().enumerate();
    let mut all: Vec<String> = outputs
        .map(|(output, first)| {
            let error = |step: &PathStep| {
                rms(step.outputs.get(output).and_then(|own| own.left_out))
            };
            let (name, unit) = (&first.output, &first.unit);
            let mut text = format!(
                "Parts of {name} that were left out of the fit are simulated to {} {unit} rms by the nominal model",
                error(nominal)
            );
            for step in stand() {
                let effect = step.effect.as_deref().unwrap_or_default();
                text += &format!(", with {effect} to {}", error(step));
            }
            text + "."
        })
        .collect();
    for refusal in [
        Refusal::LeftOutParts,
        Refusal::FunctionsOfTime,
        Refusal::Diverges,
    ] {
        let own = effects.iter().filter(|step| step.refused == Some(refusal));
        let names = joined(own.filter_map(|step| step.effect.as_deref()), ", ");
        if !names.is_empty() {
            all.push(format!("Not named: {names}. {}", why(refusal)));
        }
    }
    all
}

/// Why an effect does not stand, a sentence.
#[must_use]
pub fn why(refusal: Refusal) -> &'static str {
    match refusal {
        Refusal::LeftOutParts => {
            "It fits the rows that it is fitted to, and simulates left-out parts no better."
        }
        Refusal::FunctionsOfTime => {
            "Beside one such function of time another gains much: the course of time is none of the catalogue."
        }
        Refusal::Diverges => {
            "With it a simulation leaves all bounds where the inputs swing by half as much again."
        }
    }
}
