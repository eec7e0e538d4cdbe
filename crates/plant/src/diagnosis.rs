//! The diagnosis of a record: what its model lacks, with sets, sizes and the gain on a later record.

use std::sync::Arc;

use gyrocal_hypothesis::{
    EffectEstimate, Finding, FittedModel as _, Pattern, SearchOptions, Searched, Selection,
    Unmodelled, search,
};
use gyrocal_statistics::chi_square_tail;

use crate::answer::{
    Comparison, Diagnosis, Estimate, Found, Interval95, LeftOut, NoiseLevel, OutputError,
    Remainder, Size, Unexplained,
};
use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::identifiability::NullDirection;
use crate::loaded::LoadedPlant;
use crate::prediction::{Prediction, horizon_rows};
use crate::record::PlantRecord;

/// Lags of the test of whiteness.
const LAGS: usize = 20;

/// Two-sided 95 % of a normal deviate.
const NORMAL_95: f64 = 1.96;

/// A diagnosis with the fits that it rests on.
pub struct Diagnosed {
    /// The answer.
    pub answer: Diagnosis,
    /// The search, with the nominal and the extended model.
    pub searched: Searched<FittedPlant>,
}

/// Diagnoses a record; with a later record of the same plant the gain of what was found is measured there.
///
/// # Errors
/// [`PlantError::NoFit`], [`PlantError::NotFinite`], [`PlantError::Singular`].
pub fn diagnose(
    plant: &LoadedPlant,
    record: PlantRecord,
    later: Option<PlantRecord>,
    options: &SearchOptions,
) -> Result<Diagnosed, PlantError> {
    let still = record.still_inputs(&plant.description);
    let first = FittedPlant::nominal(plant, record, &[])?;
    let (held, directions) = first.to_hold()?;
    let nominal = if held.is_empty() {
        first
    } else {
        FittedPlant::nominal(plant, first.record().clone(), &held)?
    };
    let selection = nominal.selection()?;
    let rows = nominal.rows();
    let searched = search(nominal, rows, &selection, options)?;
    let mut answer = answer(plant, &searched, &selection, directions)?;
    answer.still_inputs = still;
    if let Some(later) = later {
        answer.later_record = Some(compare(&searched, later)?);
    }
    Ok(Diagnosed { answer, searched })
}

/// Both models on a later record.
fn compare(searched: &Searched<FittedPlant>, later: PlantRecord) -> Result<Comparison, PlantError> {
    let plant = searched.fitted.loaded();
    let horizon = horizon_rows(plant, later.len());
    let last = later.time_s[horizon - 1];
    let horizon_s = last - later.time_s[0];
    let later = Arc::new(later);
    let nominal = searched.nominal.predict(&later)?;
    let extended = searched.fitted.predict(&later)?;
    Ok(Comparison {
        rows: later.len(),
        gain_nats: extended.log_density - nominal.log_density,
        horizon_s,
        errors: errors(plant, &nominal, &extended),
    })
}

fn errors(plant: &LoadedPlant, nominal: &Prediction, extended: &Prediction) -> Vec<OutputError> {
    of_outputs(plant, &nominal.rms, &extended.rms)
}

fn of_outputs(plant: &LoadedPlant, nominal: &[f64], extended: &[f64]) -> Vec<OutputError> {
    let outputs = plant.description.outputs.iter();
    outputs
        .zip(nominal.iter().zip(extended))
        .map(|(output, (nominal, extended))| OutputError {
            output: output.id.clone(),
            unit: output.unit.clone(),
            nominal: *nominal,
            extended: *extended,
        })
        .collect()
}

fn answer(
    plant: &LoadedPlant,
    searched: &Searched<FittedPlant>,
    selection: &Selection,
    directions: Vec<NullDirection>,
) -> Result<Diagnosis, PlantError> {
    let fitted = &searched.fitted;
    let record = fitted.record();
    let scale = record.search_scale();
    let findings = searched.findings.iter();
    let unmodelled = searched.unmodelled.iter();
    let left_out = selection.unavailable.iter().map(|one| LeftOut {
        effect: one.effect.to_owned(),
        why: one.why.clone(),
    });
    Ok(Diagnosis {
        plant: plant.description.name.clone(),
        rows: record.len(),
        duration_s: record.duration_s(),
        tested: selection.effects.len(),
        still_inputs: Vec::new(),
        starts: searched.nominal.starts().clone(),
        undetermined: directions,
        findings: findings.map(|one| found(plant, one, scale)).collect(),
        unexplained: unmodelled.map(|one| unexplained(one, scale)).collect(),
        left_out: left_out.collect(),
        parameters: parameters(plant, &searched.nominal, fitted),
        noise: noise(plant, searched),
        errors: of_outputs(
            plant,
            &searched.nominal.simulation_rms(),
            &fitted.simulation_rms(),
        ),
        horizon_s: record.time_s[horizon_rows(plant, record.len()) - 1] - record.time_s[0],
        remainder: remainder(plant, fitted)?,
        later_record: None,
    })
}

fn found(plant: &LoadedPlant, finding: &Finding, scale: f64) -> Found {
    let entry = |id: &str| {
        let mut effects = plant.description.effects.iter();
        effects.find(|effect| effect.id == id)
    };
    let own = entry(finding.effect);
    let sizes = finding
        .parameters
        .iter()
        .map(|one| size(plant, finding.effect, one, scale));
    Found {
        effect: finding.effect.to_owned(),
        name: own.map_or_else(String::new, |own| own.name.clone()),
        formula: own.map_or_else(String::new, |own| own.formula.clone()),
        sizes: sizes.collect(),
        z: finding.z,
        p_value: finding.p_value,
        rivals: finding
            .alternatives
            .iter()
            .map(|other| (other.effect.to_owned(), other.log_likelihood_deficit))
            .collect(),
        equivalents: finding
            .exact_equivalents
            .iter()
            .map(|other| other.effect.to_owned())
            .collect(),
        none_of_these: finding.none_of_these,
    }
}

/// A size, or an onset, in units of the plant: the search has another unit of time.
fn size(plant: &LoadedPlant, effect: &str, one: &EffectEstimate, scale: f64) -> Size {
    let mut effects = plant.description.effects.iter();
    let is_ramp =
        effects.any(|entry| entry.id == effect && entry.kind == crate::description::Kind::Ramp);
    let factor = if one.name == "onset_s" {
        scale.recip()
    } else if is_ramp {
        scale
    } else {
        1.0
    };
    let interval = one.interval.as_ref().map(|pieces| {
        pieces
            .iter()
            .map(|[low, high]| [factor * low, factor * high])
            .collect()
    });
    Size {
        name: one.name.to_owned(),
        value: factor * one.estimate,
        sigma: one.sigma.map(|sigma| factor * sigma),
        interval,
        unit: one.unit.to_owned(),
    }
}

fn unexplained(one: &Unmodelled, scale: f64) -> Unexplained {
    let channel = one.describes;
    Unexplained {
        channel: channel.name.to_owned(),
        form: match one.pattern {
            Pattern::Line { period_h } => {
                format!("a line with a period of {:.4} s", period_h * 3600.0 / scale)
            }
            Pattern::Curve { name, .. } => {
                format!("a function of {name} that is in no term of the catalogue")
            }
        },
        size: one.size,
        unit: channel.unit.to_owned(),
        ln_p_value: one.ln_probability,
    }
}

fn parameters(plant: &LoadedPlant, nominal: &FittedPlant, fitted: &FittedPlant) -> Vec<Estimate> {
    let states = plant.description.states.len();
    let initial = plant.description.states.iter().map(|state| {
        let name = format!("initial {}", state.id);
        (name, state.unit.clone(), state.initial)
    });
    let parameters = plant.description.parameters.iter();
    let parameters = parameters.map(|one| (one.id.clone(), one.unit.clone(), one.value));
    let all = parameters.zip(states..).chain(initial.zip(0..));
    all.map(|((name, unit, declared), place)| Estimate {
        name,
        unit,
        declared,
        nominal: declared + nominal.values()[place],
        value: declared + fitted.values()[place],
        sigma: fitted.covariance()[(place, place)].sqrt(),
    })
    .collect()
}

fn noise(plant: &LoadedPlant, searched: &Searched<FittedPlant>) -> Vec<NoiseLevel> {
    let rates = plant.tables().rates.len();
    let (ratios, sigmas) = (&searched.noise.noise.white, &searched.noise.white_sigma);
    let description = &plant.description;
    let outputs = description.outputs.iter().map(|one| one.id.clone());
    let driven = description.noises.iter();
    let driven = driven.map(|one| format!("rate of {}", description.states[one.state].id));
    outputs
        .chain(driven)
        .zip(ratios[rates..].iter().zip(&sigmas[rates..]))
        .map(|(of, (ratio, sigma))| {
            let factor = gyrocal_statistics::math::exp(NORMAL_95 * sigma);
            NoiseLevel {
                of,
                ratio: *ratio,
                interval: [ratio / factor, ratio * factor] as Interval95,
            }
        })
        .collect()
}

/// Ljung and Box's test of the innovations that the extended model leaves.
fn remainder(plant: &LoadedPlant, fitted: &FittedPlant) -> Result<Vec<Remainder>, PlantError> {
    let whitened = fitted.whitened()?;
    let outputs = plant.description.outputs.iter().enumerate();
    let all = outputs.map(|(index, output)| {
        let own: Vec<f64> = whitened
            .iter()
            .filter(|(_, output, _)| *output == index)
            .map(|(.., value)| *value)
            .collect();
        let (lags, rows) = (LAGS.min(own.len() / 4), own.len() as f64);
        let power: f64 = own.iter().map(|value| value * value).sum();
        let mut statistic = 0.0;
        for lag in 1..=lags {
            let pairs = own.iter().zip(&own[lag..]);
            let correlation = pairs.map(|(a, b)| a * b).sum::<f64>() / power;
            statistic += correlation * correlation / (rows - lag as f64);
        }
        Remainder {
            output: output.id.clone(),
            p_value: chi_square_tail(rows * (rows + 2.0) * statistic, lags as f64).unwrap_or(1.0),
        }
    });
    Ok(all.collect())
}
