//! The answer of a diagnosis from its search.

use gyrocal_answer::{
    Alternative, AlternativeKind, Answer, CoefficientEstimate, Coefficients, Finding, FindingKind,
    Gaps, NoiseLevel, NotTested, NotTestedReason, OutputTest, Parameter, RankedEffect,
    RecordSummary, ResidualTest, ResidualVerdict, SCHEMA_VERSION, Subject, UnmodelledPattern,
    UnmodelledTerm,
};
use gyrocal_hypothesis::{
    EffectEstimate, FittedModel as _, Pattern, SearchOptions, Searched, Selection, Unmodelled,
};
use gyrocal_record::Manifest;
use gyrocal_statistics::math::exp;
use gyrocal_statistics::{chi_square_tail, p_of_least};

use crate::catalogue::KNEE;
use crate::correlation::{correlations, of_output};
use crate::description::Kind;
use crate::error::PlantError;
use crate::fitted::FittedPlant;
use crate::knee_interval::profile;
use crate::loaded::LoadedPlant;
use crate::prediction::{errors, horizon_s};
use crate::record::PlantRecord;
use gyrocal_words::plant::{coloured, is_coloured, unmodelled};

/// Lags of the test of whiteness.
const LAGS: usize = 20;

/// Name of the onset among the parameters of an effect.
const ONSET: &str = "onset_s";

/// The answer of a search, but for what other passes over the record tell.
pub(crate) fn answer(
    plant: &LoadedPlant,
    searched: &Searched<FittedPlant>,
    selection: &Selection,
    options: &SearchOptions,
) -> Result<Answer, PlantError> {
    let fitted = &searched.fitted;
    let record = fitted.record();
    let (nominal, extended) = (searched.nominal.simulated(), fitted.simulated());
    let findings = searched.findings.iter();
    let findings: Result<Vec<Finding>, _> = findings.map(|one| finding(fitted, one)).collect();
    let findings = findings?;
    let remainder = remainder(plant, searched)?;
    let has_findings = !(findings.is_empty() && remainder.unmodelled.is_empty());
    let search_complete = !searched.is_cut;
    let ranking = searched.ranking.iter().map(|one| RankedEffect {
        effect: one.effect.to_owned(),
        statistic: one.statistic,
    });
    Ok(Answer {
        schema_version: SCHEMA_VERSION,
        manifest: Manifest {
            program: "gyrocal".to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            model_hash: plant.hash().to_owned(),
            inputs: Vec::new(),
            seed: options.seed,
            command: String::new(),
        },
        record: summary(record),
        records: Vec::new(),
        subject: Subject::Plant(plant.description.name.clone()),
        later_record: None,
        verdict: Answer::judged(&findings, &remainder, search_complete),
        false_alarm_probability: options.false_alarm_probability,
        false_alarm_shares: None,
        setup: Vec::new(),
        norm: None,
        residuals: None,
        coefficients: Some(parameters(plant, &searched.nominal, fitted, has_findings)),
        findings,
        open_loop: errors(plant, record, (&nominal, &extended), 0..record.len()),
        horizon_s: Some(horizon_s(plant, record)),
        gain: None,
        remainder,
        set_ups: None,
        still_inputs: record.still_inputs(&plant.description),
        undetermined: Vec::new(),
        starts: Some(searched.nominal.starts()),
        ranking: ranking.collect(),
        threshold: (!searched.ranking.is_empty()).then_some(searched.threshold),
        power: Vec::new(),
        noise: noise(plant, fitted)?,
        undeclared_noise: fitted.undeclared_noise()?,
        only_in_white_noise: Vec::new(),
        path: Vec::new(),
        model_noise: None,
        noise_audit: None,
        allan: None,
        not_searched: not_searched(searched, selection),
        search_complete,
        filter: None,
        next_runs: Vec::new(),
    })
}

/// Size of a record.
pub(crate) fn summary(record: &PlantRecord) -> RecordSummary {
    RecordSummary {
        averaged: None,
        rows: record.len(),
        duration_s: record.duration_s(),
        gaps: Gaps::default(),
    }
}

/// Effects that the record cannot show.
fn not_searched(searched: &Searched<FittedPlant>, selection: &Selection) -> Vec<NotTested> {
    let not_tested = |effect: &str, why: &str| NotTested {
        effect: effect.to_owned(),
        reason: NotTestedReason::Unobservable,
        why: why.to_owned(),
    };
    let unavailable = selection.unavailable.iter();
    let unavailable = unavailable.map(|one| not_tested(one.effect, &one.why));
    let is_ranked = |id: &str| searched.ranking.iter().any(|one| one.effect == id);
    let selected = selection.effects.iter();
    let without_score = selected.filter(|effect| !is_ranked(effect.id));
    let why = "parameters and initial states take up all of it";
    let without_score = without_score.map(|effect| not_tested(effect.id, why));
    unavailable.chain(without_score).collect()
}

fn finding(
    fitted: &FittedPlant,
    found: &gyrocal_hypothesis::Finding,
) -> Result<Finding, PlantError> {
    let plant = fitted.loaded();
    let mut effects = plant.description.effects.iter();
    let own = effects.find(|effect| effect.id == found.effect);
    let scale = fitted.record().search_scale();
    let all = found.parameters.iter();
    let mut parameters: Vec<Parameter> = all
        .map(|one| parameter(plant, found.effect, one, scale))
        .collect();
    profile(fitted, own, &mut parameters)?;
    let in_record = in_its_record(fitted.record(), &mut parameters);
    let alternative = |effect: &str, kind, deficit| Alternative {
        effect: effect.to_owned(),
        kind,
        log_likelihood_deficit: Some(deficit),
        parameters: Vec::new(),
    };
    let equivalents = found.exact_equivalents.iter();
    let equivalents =
        equivalents.map(|other| alternative(other.effect, AlternativeKind::ExactEquivalent, 0.0));
    let rivals = found.alternatives.iter().map(|other| {
        let deficit = other.log_likelihood_deficit;
        alternative(other.effect, AlternativeKind::NotExcluded, deficit)
    });
    let none = found.none_of_these;
    Ok(Finding {
        effect: found.effect.to_owned(),
        name: own.map_or_else(String::new, |own| own.name.clone()),
        kind: FindingKind::Cause,
        parameters,
        z: found.z,
        p_value: found.p_value,
        coverage: None,
        alternatives: equivalents.chain(rivals).collect(),
        separations: Vec::new(),
        none_of_these: none.map(|none| none.probability()),
        none_of_these_log_likelihood_ratio: none.map(|none| none.log_likelihood_ratio),
        by_record: None,
        in_record,
        formula: own.map(|own| own.formula.clone()),
        gain_nats: None,
        accepted: Some(true),
    })
}

/// Puts an onset on the clock of the record that it lies in; gives the number of that record, from one, if
/// there are several.
fn in_its_record(record: &PlantRecord, parameters: &mut [Parameter]) -> Option<usize> {
    let onset = parameters.iter_mut().find(|one| one.name == ONSET)?;
    let first_s = record.time_s.first()?;
    let of_row = |row: &usize| record.time_s[*row] - first_s;
    let before = record.starts.iter();
    let begun = before.take_while(|row| of_row(row) <= onset.estimate);
    let before = begun.count();
    let start_s = before
        .checked_sub(1)
        .map_or(0.0, |last| of_row(&record.starts[last]));
    onset.estimate -= start_s;
    for end in onset.interval.iter_mut().flatten().flatten() {
        *end -= start_s;
    }
    (!record.starts.is_empty()).then_some(before + 1)
}

/// A size, or an onset, in units of the plant: the search has another unit of time.
fn parameter(plant: &LoadedPlant, effect: &str, one: &EffectEstimate, scale: f64) -> Parameter {
    let mut effects = plant.description.effects.iter();
    let entry = effects.find(|entry| entry.id == effect);
    let is_ramp = entry.is_some_and(|entry| entry.kind == Kind::Ramp);
    let factor = if one.name == ONSET {
        scale.recip()
    } else if is_ramp {
        scale
    } else {
        1.0
    };
    // The unknown is the difference from where the search takes the knee to be.
    let knee = entry.filter(|_| one.name == KNEE);
    let knee = knee.and_then(|entry| plant.description.knee_of(entry));
    let declared = knee.map_or(0.0, |knee| knee.value);
    let interval = one.interval.as_ref().map(|pieces| {
        pieces
            .iter()
            .map(|[low, high]| [declared + factor * low, declared + factor * high])
            .collect()
    });
    Parameter {
        name: one.name.to_owned(),
        estimate: declared + factor * one.estimate,
        sigma: one.sigma.map(|sigma| factor * sigma),
        interval,
        unit: one.unit.to_owned(),
    }
}

/// Estimates of both models with their standard deviations, by name, unit and declared value.
pub(crate) fn coefficients(
    all: impl Iterator<Item = (String, String, f64, [[f64; 2]; 2])>,
    has_findings: bool,
) -> Coefficients {
    let (mut declared, mut nominal, mut extended) = (Vec::new(), Vec::new(), Vec::new());
    for (name, unit, value, models) in all {
        let [before, after] = models.map(|[estimate, sigma]| CoefficientEstimate {
            name: name.clone(),
            estimate,
            sigma,
            unit: unit.clone(),
        });
        declared.push(value);
        nominal.push(before);
        extended.push(after);
    }
    Coefficients {
        declared,
        nominal,
        extended: has_findings.then_some(extended),
        over_set: None,
        members: Vec::new(),
        covariance: Vec::new(),
    }
}

/// Parameters, and initial states of a record that is alone: several have initial states of their own.
pub(crate) fn parameters(
    plant: &LoadedPlant,
    nominal: &FittedPlant,
    fitted: &FittedPlant,
    has_findings: bool,
) -> Coefficients {
    let states = plant.description.states.len();
    let only = fitted.record().starts.is_empty();
    let own = plant.description.states.iter().filter(|_| only);
    let initial = own.map(|state| {
        let name = format!("initial {}", state.id);
        (name, state.unit.clone(), state.initial)
    });
    let parameters = plant.description.parameters.iter();
    let parameters = parameters.map(|one| (one.id.clone(), one.unit.clone(), one.value));
    let all = parameters.zip(states..).chain(initial.zip(0..));
    let all = all.map(|((name, unit, declared), place)| {
        let of = |fit: &FittedPlant| {
            let sigma = fit.covariance()[(place, place)].sqrt();
            [declared + fit.values()[place], sigma]
        };
        (name, unit, declared, [of(nominal), of(fitted)])
    });
    coefficients(all, has_findings)
}

/// Noise that the plant declares, as it is in a fit.
pub(crate) fn noise(
    plant: &LoadedPlant,
    fitted: &FittedPlant,
) -> Result<Vec<NoiseLevel>, PlantError> {
    let levels = fitted.noise_levels()?;
    let description = &plant.description;
    let outputs = description.outputs.iter().map(|one| one.id.clone());
    let driven = description.noises.iter();
    let driven = driven.map(|one| format!("rate of {}", description.states[one.state].id));
    let channels = outputs.chain(driven).zip(levels);
    Ok(channels
        .map(|(channel, [ratio, low, high])| NoiseLevel {
            channel,
            ratio,
            interval: [low, high],
        })
        .collect())
}

/// What the extended model leaves: Ljung and Box's test of the innovations of each output, and terms outside of
/// the catalogue.
pub(crate) fn remainder(
    plant: &LoadedPlant,
    searched: &Searched<FittedPlant>,
) -> Result<ResidualTest, PlantError> {
    let scale = searched.fitted.record().search_scale();
    let terms = searched.unmodelled.iter();
    let terms: Vec<UnmodelledTerm> = terms.map(|one| term(one, scale)).collect();
    let outputs = output_tests(&searched.fitted)?;
    let least = outputs.iter().map(|one| one.p_value).reduce(f64::min);
    let verdict = if !terms.is_empty() || outputs.iter().any(is_coloured) {
        ResidualVerdict::Unexplained
    } else if outputs.len() < plant.description.outputs.len() {
        ResidualVerdict::NotTested
    } else {
        ResidualVerdict::White
    };
    let rare = outputs.iter().filter(|one| is_coloured(one));
    let words = terms.iter().map(unmodelled).chain(rare.map(coloured));
    let description = match verdict {
        ResidualVerdict::NotTested => "Too short a record for a test of each output.".to_owned(),
        _ => words.collect::<Vec<_>>().join(" "),
    };
    Ok(ResidualTest {
        verdict,
        p_value: least.map(|least| p_of_least(least, outputs.len() as f64)),
        description,
        line: None,
        correlation: None,
        outputs,
        unmodelled: terms,
    })
}

/// Ljung and Box's test of the innovations of each output; none of one with too few.
pub(crate) fn output_tests(fitted: &FittedPlant) -> Result<Vec<OutputTest>, PlantError> {
    let whitened = fitted.whitened()?;
    let all = fitted.loaded().description.outputs.iter().enumerate();
    let tests = all.filter_map(|(index, output)| {
        Some(OutputTest {
            output: output.id.clone(),
            p_value: white(&of_output(&whitened, index))?,
        })
    });
    Ok(tests.collect())
}

/// Probability of as much correlation in white innovations; `None` of too few.
fn white(innovations: &[f64]) -> Option<f64> {
    let rows = innovations.len() as f64;
    let correlations = correlations(innovations, LAGS);
    let terms = correlations.iter().zip(1..);
    let statistic: f64 = terms
        .map(|(correlation, lag)| correlation * correlation / (rows - f64::from(lag)))
        .sum();
    let p_value = chi_square_tail(rows * (rows + 2.0) * statistic, correlations.len() as f64);
    // Not a number where all innovations are zero.
    p_value.filter(|p| p.is_finite())
}

fn term(one: &Unmodelled, scale: f64) -> UnmodelledTerm {
    let (pattern, period_h, depends_on) = match one.pattern {
        Pattern::Line { period_h } => (UnmodelledPattern::Line, Some(period_h / scale), None),
        Pattern::Curve { name, .. } => (UnmodelledPattern::Curve, None, Some(name.to_owned())),
    };
    UnmodelledTerm {
        channel: one.describes.name.to_owned(),
        pattern,
        period_h,
        depends_on,
        size: one.size,
        unit: one.describes.unit.to_owned(),
        p_value: exp(one.ln_probability),
    }
}
