//! The diagnosis of a record: what its model lacks, with sets, sizes and the gain on a later record.

use core::ops::Range;
use std::sync::Arc;

use gyrocal_hypothesis::{
    EffectEstimate, Finding, FittedModel as _, Pattern, Ranked, SearchOptions, Searched, Selection,
    Unmodelled, search,
};
use gyrocal_statistics::{NORMAL_97_5, chi_square_tail};

use crate::answer::{
    Comparison, Diagnosis, Estimate, Found, Interval95, LeftOut, NoiseLevel, OutputError,
    RankedEffect, Remainder, Size, Unexplained,
};
use crate::cross_validation::cross_validated;
use crate::diagnosed::Diagnosed;
use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::identifiability::NullDirection;
use crate::loaded::LoadedPlant;
use crate::prediction::{horizon_s, rms};
use crate::record::PlantRecord;
use crate::series::{RecordSeries, correlations, of_output};

/// Lags of the test of whiteness.
const LAGS: usize = 20;

/// Name of the onset among the parameters of an effect.
const ONSET: &str = "onset_s";

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
    diagnose_from(plant, record, later, options, None)
}

/// The same from the values of another fit.
pub(crate) fn diagnose_from(
    plant: &LoadedPlant,
    record: PlantRecord,
    later: Option<PlantRecord>,
    options: &SearchOptions,
    start: Option<&[f64]>,
) -> Result<Diagnosed, PlantError> {
    let still = record.still_inputs(&plant.description);
    let first = FittedPlant::nominal_from(plant, record, &[], start)?;
    let (held, directions) = first.to_hold()?;
    let nominal = if held.is_empty() {
        first
    } else {
        FittedPlant::nominal_from(plant, first.record().clone(), &held, start)?
    };
    let selection = nominal.selection()?;
    let rows = nominal.rows();
    let searched = search(nominal, rows, &selection, options)?;
    let probability = options.false_alarm_probability;
    let mut answer = answer(plant, &searched, &selection, (directions, probability))?;
    answer.still_inputs = still;
    answer.cross_validation = cross_validated(&searched)?;
    let mut series = None;
    if let Some(later) = later {
        let (comparison, predicted) = compare(&searched, later, answer.has_findings())?;
        answer.later_record = Some(comparison);
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
    later: PlantRecord,
    has_findings: bool,
) -> Result<(Comparison, RecordSeries), PlantError> {
    let plant = searched.fitted.loaded();
    let later = Arc::new(later);
    let nominal = searched.nominal.predict(&later)?;
    let extended = searched.fitted.predict(&later)?;
    let rows = 0..later.len();
    let simulated = (&nominal.simulated[..], &extended.simulated[..]);
    let comparison = Comparison {
        rows: later.len(),
        gain_nats: extended.log_density - nominal.log_density,
        horizon_s: horizon_s(plant, &later),
        errors: errors(plant, &later, simulated, rows.clone()),
    };
    let sigmas = searched.fitted.output_sigmas();
    let extended = has_findings.then_some(simulated.1);
    let series = RecordSeries::new(plant, (&later, rows), (simulated.0, extended), &sigmas);
    Ok((comparison, series))
}

/// Errors of simulations by the nominal and the extended model over some rows.
pub(crate) fn errors(
    plant: &LoadedPlant,
    record: &PlantRecord,
    (nominal, extended): (&[f64], &[f64]),
    rows: Range<usize>,
) -> Vec<OutputError> {
    let nominal = rms(record, nominal, rows.clone());
    of_outputs(plant, &nominal, &rms(record, extended, rows))
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
    (directions, false_alarm_probability): (Vec<NullDirection>, f64),
) -> Result<Diagnosis, PlantError> {
    let fitted = &searched.fitted;
    let record = fitted.record();
    let scale = record.search_scale();
    let (nominal, extended) = (searched.nominal.simulated(), fitted.simulated());
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
        false_alarm_probability,
        threshold: searched.threshold,
        ranking: searched.ranking.iter().map(ranked).collect(),
        still_inputs: Vec::new(),
        starts: searched.nominal.starts().clone(),
        undetermined: directions,
        findings: findings.map(|one| found(fitted, one, scale)).collect(),
        unexplained: unmodelled.map(|one| unexplained(one, scale)).collect(),
        left_out: left_out.collect(),
        parameters: parameters(plant, &searched.nominal, fitted),
        records: Vec::new(),
        noise: noise(plant, searched),
        errors: errors(plant, record, (&nominal, &extended), 0..record.len()),
        horizon_s: horizon_s(plant, record),
        remainder: remainder(plant, fitted)?,
        cross_validation: None,
        later_record: None,
        next_runs: Vec::new(),
    })
}

fn ranked(one: &Ranked) -> RankedEffect {
    RankedEffect {
        effect: one.effect.to_owned(),
        statistic: one.statistic,
    }
}

fn found(fitted: &FittedPlant, finding: &Finding, scale: f64) -> Found {
    let plant = fitted.loaded();
    let entry = |id: &str| {
        let mut effects = plant.description.effects.iter();
        effects.find(|effect| effect.id == id)
    };
    let own = entry(finding.effect);
    let mut sizes: Vec<Size> = finding
        .parameters
        .iter()
        .map(|one| size(plant, finding.effect, one, scale))
        .collect();
    let record = in_its_record(fitted.record(), &mut sizes);
    Found {
        record,
        effect: finding.effect.to_owned(),
        name: own.map_or_else(String::new, |own| own.name.clone()),
        formula: own.map_or_else(String::new, |own| own.formula.clone()),
        sizes,
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
        none_of_these: finding.none_of_these.map(|none| none.probability()),
    }
}

/// Puts an onset on the clock of the record that it lies in; gives the number of that record, from one, if
/// there are several.
fn in_its_record(record: &PlantRecord, sizes: &mut [Size]) -> Option<usize> {
    let onset = sizes.iter_mut().find(|size| size.name == ONSET)?;
    let first_s = record.time_s.first()?;
    let of_row = |row: &usize| record.time_s[*row] - first_s;
    let before = record.starts.iter();
    let before = before.take_while(|row| of_row(row) <= onset.value).count();
    let start_s = before
        .checked_sub(1)
        .map_or(0.0, |last| of_row(&record.starts[last]));
    onset.value -= start_s;
    for end in onset.interval.iter_mut().flatten().flatten() {
        *end -= start_s;
    }
    (!record.starts.is_empty()).then_some(before + 1)
}

/// A size, or an onset, in units of the plant: the search has another unit of time.
fn size(plant: &LoadedPlant, effect: &str, one: &EffectEstimate, scale: f64) -> Size {
    let mut effects = plant.description.effects.iter();
    let is_ramp =
        effects.any(|entry| entry.id == effect && entry.kind == crate::description::Kind::Ramp);
    let factor = if one.name == ONSET {
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
    // Several records have initial states of their own.
    let only = fitted.record().starts.is_empty();
    let own = plant.description.states.iter().filter(|_| only);
    let initial = own.map(|state| {
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
        nominal_sigma: nominal.covariance()[(place, place)].sqrt(),
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
            let factor = gyrocal_statistics::math::exp(NORMAL_97_5 * sigma);
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
        let own = of_output(&whitened, index);
        let rows = own.len() as f64;
        let correlations = correlations(&own, LAGS);
        let lags = correlations.len() as f64;
        let terms = correlations.iter().zip(1..);
        let statistic: f64 = terms
            .map(|(correlation, lag)| correlation * correlation / (rows - f64::from(lag)))
            .sum();
        Remainder {
            output: output.id.clone(),
            p_value: chi_square_tail(rows * (rows + 2.0) * statistic, lags).unwrap_or(1.0),
        }
    });
    Ok(all.collect())
}
