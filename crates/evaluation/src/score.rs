//! Comparison of the diagnosis of one record with the effects injected into it.

use gyrocal::effect::Role;
use gyrocal_answer::{AlternativeKind, Answer, Finding, FindingKind, Parameter, RankedEffect};
use gyrocal_calibration::NoiseModel;
use gyrocal_diagnosis::Diagnosis;
use gyrocal_statistics::NORMAL_97_5;
use gyrocal_truth::{Scenario, Simulation};

use crate::baseline::{BaselineMethod, LibraryEntry, library};
use crate::catalogue::{effect_of, same_or_equivalent, set_holds};
use crate::coefficient_score::CoefficientScore;
use crate::error::EvaluationError;
use crate::injection::{InjectedEffect, diagnosed, nominal_fit, testable_effects};
use crate::oracle::{sets_in_noise, sets_without_walks};
use crate::projection::ProjectedScores;
use crate::record_score::{BaselineScore, FindingScore, InjectedScore, RecordScore};
use crate::signature::{Signature, SignatureColumns};

/// Strengths of populations of which not every effect is found: sets are then compared with those of an oracle.
const WEAK: [f64; 2] = [5.0, 6.0];

/// Number of hypotheses next to the best of the first search that are kept.
const NEAREST_KEPT: usize = 10;

/// Half widths, in sigmas, of simultaneous 95 % intervals of one, two and three sizes: two-sided
/// points of the normal distribution at the roots of 0.95 (Sidak 1967; conservative for correlated
/// sizes).
const HALF_WIDTHS: [f64; 3] = [NORMAL_97_5, 2.236_476_644_557_79, 2.387_737_887_070_817];

/// Diagnoses a record and compares the result with the injected effects of the catalogue, each given
/// with its strength.
pub(crate) fn score(
    scenario: &Scenario,
    simulation: &Simulation,
    injected: &[(InjectedEffect, f64)],
    methods: &[BaselineMethod],
) -> Result<RecordScore, EvaluationError> {
    let found = diagnosed(simulation)?;
    let record = &simulation.record;
    let mut columns = SignatureColumns::default();
    let truths: Vec<Truth<'_>> = injected
        .iter()
        .map(|(injected, strength)| Truth {
            injected,
            strength: *strength,
            signature: columns.signature(injected.effect, record, injected.shape),
        })
        .collect();
    let first = found.result.causes().next().map(|finding| {
        let signature = effect_of(&finding.effect)
            .and_then(|effect| columns.signature(effect, record, shape_of(finding)));
        (finding.effect.as_str(), signature)
    });
    let library = match methods.iter().any(|method| method.identifies_effects()) {
        true => library(&testable_effects(scenario), record, &mut columns),
        false => Vec::new(),
    };
    let misnamed = first.as_ref().is_some_and(|(name, _)| {
        let mut truths = truths.iter();
        truths.any(|truth| !same_or_equivalent(truth.injected.effect.id, name))
    });
    // Without another name and without a baseline method no cosine is asked for.
    let scores = (!methods.is_empty() || misnamed)
        .then(|| nominal_scores(simulation, &found, &columns))
        .transpose()?;
    let hidden = |truth: &Truth<'_>| {
        let first_cosine = first.as_ref().map_or(0.0, |(name, signature)| {
            truth.cosine(name, signature.as_ref(), scores.as_ref())
        });
        injected_score(&found.result, truth, first_cosine, scenario.duration_s)
    };
    let hidden = truths.iter().map(hidden).collect();
    let coefficients = simulation.truth.coefficients.named();
    let coefficients = coefficients.map(|(_, value, _)| value);
    let methods = scores.as_ref().map_or_else(Vec::new, |scores| {
        let truth = truths.first();
        let of = |method: &BaselineMethod| {
            baseline_score(*method, scores, &library, truth, coefficients)
        };
        methods.iter().map(of).collect()
    });
    let mut all = injected.iter();
    let weak = all.find(|(_, strength)| WEAK.contains(strength));
    let oracle = weak.map(|(weak, _)| {
        let sets = sets_without_walks(&found, simulation)?;
        let is_it = |effect: &&str| same_or_equivalent(effect, weak.effect.id);
        Ok::<_, EvaluationError>(sets.iter().any(|set| set.iter().any(is_it)))
    });
    Ok(RecordScore {
        hidden,
        oracle_set_size: oracle_set_size(simulation, &found)?,
        oracle_in_set: oracle.transpose()?,
        coefficients: (found.result.coefficients.as_ref())
            .and_then(|found| CoefficientScore::diagnosed(coefficients, found)),
        methods,
        ..findings_score(&found.result)
    })
}

/// An injected effect with its strength and its signature.
struct Truth<'a> {
    injected: &'a InjectedEffect,
    strength: f64,
    signature: Option<Signature>,
}

impl Truth<'_> {
    /// Closeness of a finding: 1 for the same effect or an exact equivalent, else the cosine between
    /// the signatures, 0 if there is none.
    fn cosine(
        &self,
        name: &str,
        signature: Option<&Signature>,
        scores: Option<&ProjectedScores>,
    ) -> f64 {
        match (&self.signature, signature, scores) {
            _ if same_or_equivalent(name, self.injected.effect.id) => 1.0,
            (Some(truth), Some(signature), Some(scores)) => {
                scores.cosine(truth, &self.injected.sizes, signature)
            }
            _ => 0.0,
        }
    }
}

/// Scores and information at the fit of the nominal model with the declared noise.
fn nominal_scores(
    simulation: &Simulation,
    found: &Diagnosis<'_>,
    columns: &SignatureColumns,
) -> Result<ProjectedScores, EvaluationError> {
    let nominal = match found.noise_model == NoiseModel::default() {
        true => found.nominal.clone(),
        false => nominal_fit(simulation)?,
    };
    Ok(ProjectedScores::new(&nominal, &columns.further)?)
}

/// Result of a baseline method, compared with the first injected effect.
fn baseline_score(
    method: BaselineMethod,
    scores: &ProjectedScores,
    library: &[LibraryEntry],
    truth: Option<&Truth<'_>>,
    coefficients: [f64; 9],
) -> BaselineScore {
    let (result, selected) = method.apply(scores, library);
    let first_cosine = match (selected.first(), truth) {
        (Some(term), Some(truth)) => {
            let entry = &library[term.entry];
            truth.cosine(entry.effect.id, Some(&entry.signature), Some(scores))
        }
        _ => 0.0,
    };
    let columns: Vec<usize> = selected.iter().map(|term| term.column).collect();
    BaselineScore {
        method: method.name().to_owned(),
        result,
        first_cosine,
        coefficients: scores
            .coefficients_with(&columns)
            .and_then(|estimates| CoefficientScore::normal(coefficients, estimates)),
    }
}

/// The findings of a diagnosis, without the comparison with injected effects.
pub(crate) fn findings_score(found: &Answer) -> RecordScore {
    RecordScore {
        verdict: found.verdict.name().to_owned(),
        findings: found.causes().map(finding_score).collect(),
        noise: found
            .of_kind(FindingKind::Noise)
            .map(|finding| finding.effect.clone())
            .collect(),
        unexplained: found
            .is_unexplained()
            .then(|| found.remainder.description.clone()),
        nearest: nearest(&found.ranking),
        gain_nats: found
            .gain
            .as_ref()
            .map(|gain| gain.cross_validated_log_score_nats),
        ..RecordScore::default()
    }
}

fn nearest(ranking: &[RankedEffect]) -> Vec<(String, f64)> {
    let Some(best) = ranking.first() else {
        return Vec::new();
    };
    let mut nearest: Vec<(String, f64)> = Vec::with_capacity(NEAREST_KEPT);
    for ranked in &ranking[1..] {
        let same = |other: &String| same_or_equivalent(&ranked.effect, other);
        if !same(&best.effect) && !nearest.iter().any(|(other, _)| same(other)) {
            nearest.push((ranked.effect.clone(), best.statistic - ranked.statistic));
        }
        if nearest.len() == NEAREST_KEPT {
            break;
        }
    }
    nearest
}

fn finding_score(finding: &Finding) -> FindingScore {
    let has_equivalents =
        effect_of(&finding.effect).is_some_and(|effect| !effect.equivalents.is_empty());
    FindingScore {
        effect: finding.effect.clone(),
        alternatives: finding.set().skip(1).map(str::to_owned).collect(),
        lacks_equivalents: has_equivalents && finding.equivalents().next().is_none(),
        none_of_these: finding.none_of_these,
        gain_nats: finding.gain_nats,
        accepted: finding.accepted,
    }
}

fn injected_score(
    found: &Answer,
    truth: &Truth<'_>,
    first_cosine: f64,
    duration_s: f64,
) -> InjectedScore {
    let injected = truth.injected;
    let id = injected.effect.id;
    // Those of the effect, or those of an exact equivalent that a finding lists.
    let parameters: Option<&[Parameter]> = found.causes().find_map(|finding| {
        if finding.effect == id {
            return Some(finding.parameters.as_slice());
        }
        let mut equivalents = finding.of_kind(AlternativeKind::ExactEquivalent);
        let listed = equivalents.find(|other| other.effect == id);
        listed.map(|other| other.parameters.as_slice())
    });
    let in_set = found.causes().any(|finding| set_holds(finding, id));
    let shape = injected.effect.shape();
    let shape = shape.filter(|shape| matches!(shape.role, Role::Onset(_)));
    let onset_s = parameters.zip(shape).and_then(|(parameters, shape)| {
        let mut parameters = parameters.iter();
        let onset = parameters.find(|parameter| parameter.name == shape.name);
        onset.map(|onset| onset.estimate)
    });
    let best = found.ranking.first().map_or(0.0, |best| best.statistic);
    let mut ranking = found.ranking.iter();
    let own = ranking.find(|ranked| same_or_equivalent(&ranked.effect, id));
    InjectedScore {
        effect: id.to_owned(),
        strength: truth.strength,
        in_set,
        first_cosine,
        covered: parameters.map(|parameters| covers(parameters, &injected.sizes)),
        onset_error: onset_s
            .zip(injected.shape)
            .map(|(found_s, true_s)| (found_s - true_s).abs() / duration_s),
        deficit: own.map(|own| best - own.statistic),
    }
}

/// `true` if the simultaneous 95 % intervals of all sizes cover the true ones.
fn covers(parameters: &[Parameter], sizes: &[f64]) -> bool {
    let sigmas = HALF_WIDTHS[sizes.len().clamp(1, HALF_WIDTHS.len()) - 1];
    parameters.iter().zip(sizes).all(|(found, size)| {
        let holds = |sigma| (found.estimate - size).abs() <= sigmas * sigma;
        found.sigma.is_none_or(holds)
    })
}

/// Size of the first confidence set of a search with the true noise, which here is the declared one.
fn oracle_set_size(
    simulation: &Simulation,
    found: &Diagnosis<'_>,
) -> Result<Option<usize>, EvaluationError> {
    let noise = NoiseModel::default();
    if found.noise_model == noise {
        let first = found.result.causes().next();
        return Ok(first.map(|finding| finding.set().count()));
    }
    let sets = sets_in_noise(found, simulation, &noise, |_| true)?;
    Ok(sets.first().map(Vec::len))
}

/// Onset or time constant of a finding.
fn shape_of(finding: &Finding) -> Option<f64> {
    let shape = effect_of(&finding.effect)?.shape()?;
    let found = finding.parameter(shape.name);
    found.map(|parameter| parameter.estimate)
}
