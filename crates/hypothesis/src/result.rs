//! The result for one detected effect: estimates, significance, alternatives.

use gyrocal_scalar::effect::{Effect, EffectKind};
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::accepted::Accepted;
use crate::bank::{NominalEstimate, ScoreBank};
use crate::by_fits::{Compared, fit_rivals};
use crate::context::SearchContext;
use crate::finding::{
    Alternative, CONFIDENCE_SET_DEVIANCE, EffectEstimate, ExactEquivalent, Finding,
};
use crate::fitted_stage::{EffectPlaces, FittedStage};
use crate::hypothesis::{Hypothesis, HypothesisSet, Variant};
use crate::model::FittedModel;
use crate::null_distribution::{GaussianDraws, NullDistribution};
use crate::reach::{keep_likely, reaches};
use crate::score::{Best, NESTED_MODEL_CHI2, Scores};
use crate::state::terms;

/// Twice the log-likelihood by which two effects may differ and count as equally likely: another name is
/// not worth a fit.
const SAME_LIKELIHOOD: f64 = 0.5;

/// Conditional result for one accepted effect, the others being in the model.
pub(crate) struct ConditionalResult {
    pub(crate) finding: Finding,
    /// Logarithm of the sum of its likelihood and those of all that could be in its place over its own.
    pub(crate) ln_others: f64,
    /// Its statistic in the detection test.
    pub(crate) tested: f64,
    /// A hypothesis that would be named in its place, and its advantage.
    pub(crate) better: Option<(Best, f64)>,
}

/// Evaluates one accepted effect, the others being in the model.
pub(crate) fn evaluate<F: FittedModel>(
    compared: &Compared<'_, F>,
    context: &SearchContext<'_>,
    draws: &mut GaussianDraws,
) -> Result<ConditionalResult, F::Error> {
    let by_fits = compared.stage.fitted.sets_need_fits();
    evaluate_with(compared, context, draws, by_fits)
}

/// What could be in the place of an accepted effect by the scores of this fit alone, without further ones.
pub(crate) fn set_by_scores<F: FittedModel>(
    compared: &Compared<'_, F>,
    context: &SearchContext<'_>,
    draws: &mut GaussianDraws,
) -> Result<Vec<Alternative>, F::Error> {
    let result = evaluate_with(compared, context, draws, false)?;
    Ok(result.finding.alternatives)
}

fn evaluate_with<F: FittedModel>(
    compared: &Compared<'_, F>,
    context: &SearchContext<'_>,
    draws: &mut GaussianDraws,
    by_fits: bool,
) -> Result<ConditionalResult, F::Error> {
    let Compared {
        stage,
        accepted,
        index,
        ..
    } = *compared;
    let set = &context.set;
    let own = &accepted[index];
    let places = &stage.places[index];
    let bank = stage.products.bank(&places.values)?;
    let hypotheses = unmasked(set, accepted, &[index], &stage.places);
    let null = NullDistribution::draw(&bank, &hypotheses, draws);
    let mut scores = Scores::of(&bank, &hypotheses, &null, None);
    scores.refine(&stage.fitted, context, &hypotheses, &places.values)?;
    // The score of an effect that the others nearly take up tells nothing; its size in the fit does.
    let effect = set.hypotheses[own.hypothesis].effect;
    let own_score = scores.best[own.hypothesis].get_or_insert_with(|| Best {
        hypothesis: own.hypothesis,
        variant: hypotheses[own.hypothesis].variants.len().saturating_sub(1),
        statistic: of_sizes(
            &stage.fitted,
            &places.values[..effect.model_parameters().count().min(places.values.len())],
        ),
        shape: own.shape.unwrap_or_default(),
        refined: own.shape.is_some(),
        searched: own.searched,
    });
    let statistic = own_score.statistic;
    let (mut reach, mut inflation) = (vec![CONFIDENCE_SET_DEVIANCE; hypotheses.len()], 1.0);
    if by_fits {
        inflation = stage.fitted.inflation()?;
        let of = (&bank, hypotheses.as_slice());
        fit_rivals(compared, context, of, &mut scores, (statistic, inflation));
        reach = reaches(&bank, &hypotheses, &scores, context.options.seed);
    }
    // The penalty of a jump is for the test of every step and not for its directions.
    let (penalised, tested) = if set.hypotheses[own.hypothesis].is_jump {
        (statistic - own.searched, statistic - own.searched)
    } else {
        (
            scores.penalised(own.hypothesis),
            scores.tested(own.hypothesis),
        )
    };
    let others = (0..hypotheses.len())
        .filter(|other| *other != own.hypothesis && hypotheses[*other].can_be_named);
    let better = others
        .map(|other| {
            let margin = prior_margin(&hypotheses, own.hypothesis, other);
            (other, scores.penalised(other) - penalised - margin)
        })
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|(_, advantage)| *advantage > SAME_LIKELIHOOD)
        .and_then(|(other, advantage)| Some((scores.best[other]?, advantage)));
    let ln_others = scores.ln_likelihood_of_all(own.hypothesis, penalised);
    let count = context.plant.nominal_parameters;
    let estimates = |columns: &[usize]| stage.products.estimates(&places.values, columns, count);
    let mut alternatives = alternatives(
        &scores,
        &hypotheses,
        (own.hypothesis, penalised),
        (&reach, inflation),
        estimates,
    );
    if by_fits {
        keep_likely(&mut alternatives);
    }
    Ok(ConditionalResult {
        finding: Finding {
            effect: effect.id,
            parameters: parameters_of(stage, set, accepted, index),
            z: statistic.max(0.0).sqrt(),
            p_value: own.p_value_in(&terms(stage, accepted, compared.unmodelled)),
            alternatives,
            exact_equivalents: exact_equivalents(&stage.fitted, effect, &bank, estimates),
            none_of_these: None,
        },
        ln_others,
        tested,
        better,
    })
}

/// The squared size of some estimates over the covariance of their errors; zero where they are not determined.
fn of_sizes<F: FittedModel>(fitted: &F, places: &[usize]) -> f64 {
    let sizes = places.iter().map(|place| fitted.values()[*place]);
    let sizes = DVector::from_iterator(places.len(), sizes);
    let own = fitted
        .covariance()
        .select_rows(places)
        .select_columns(places);
    Cholesky::new(own).map_or(0.0, |own| own.solve(&sizes).dot(&sizes))
}

/// The hypotheses that are compared with some `own` of the accepted ones: all but the other accepted ones
/// and their equivalents. The last variant of each of its own is that of the fit.
pub(crate) fn unmasked(
    set: &HypothesisSet,
    accepted: &[Accepted],
    own: &[usize],
    places: &[EffectPlaces],
) -> Vec<Hypothesis> {
    let others: Vec<usize> = accepted
        .iter()
        .enumerate()
        .filter(|(other, _)| !own.contains(other))
        .map(|(_, accepted)| accepted.hypothesis)
        .collect();
    let all = set.hypotheses.iter().enumerate();
    let mut hypotheses: Vec<Hypothesis> = all
        .map(|(one, content)| {
            content.masked(others.contains(&one) || set.is_equivalent(one, &others))
        })
        .collect();
    for index in own {
        let (accepted, places) = (&accepted[*index], &places[*index]);
        let variants = &mut hypotheses[accepted.hypothesis].variants;
        if let Some(columns) = &places.jump {
            *variants = vec![Variant {
                columns: columns.clone(),
                shape: None,
            }];
        }
        if let Some(columns) = &places.shaped {
            variants.push(Variant {
                columns: columns.clone(),
                shape: accepted.shape,
            });
        }
    }
    hypotheses
}

/// What twice the log-likelihood of another effect must be larger by to be as likely as the named one: an
/// effect that the named one is nested in must be significantly better.
fn prior_margin(hypotheses: &[Hypothesis], named: usize, other: usize) -> f64 {
    if hypotheses[other]
        .effect
        .nested
        .contains(&hypotheses[named].id())
    {
        NESTED_MODEL_CHI2
    } else {
        0.0
    }
}

fn alternatives(
    scores: &Scores<'_>,
    hypotheses: &[Hypothesis],
    (named, penalised): (usize, f64),
    (reaches, inflation): (&[f64], f64),
    estimates: impl Fn(&[usize]) -> Option<NominalEstimate>,
) -> Vec<Alternative> {
    let equivalents = hypotheses[named].effect.equivalents;
    let mut alternatives: Vec<Alternative> = (0..hypotheses.len())
        .filter(|other| {
            *other != named
                && scores.best[*other].is_some()
                && !equivalents.contains(&hypotheses[*other].id())
        })
        .filter(|other| penalised - scores.penalised(*other) < inflation * reaches[*other])
        .map(|other| Alternative {
            effect: hypotheses[other].id(),
            log_likelihood_deficit: 0.5 / inflation
                * (penalised - scores.penalised(other) + prior_margin(hypotheses, named, other))
                    .max(0.0),
            nominal: variant(&scores.best[other], &hypotheses[other]).and_then(&estimates),
        })
        .collect();
    alternatives.sort_by(|a, b| {
        a.log_likelihood_deficit
            .total_cmp(&b.log_likelihood_deficit)
    });
    alternatives
}

/// Columns of the best variant of a hypothesis.
fn variant<'h>(best: &Option<Best>, hypothesis: &'h Hypothesis) -> Option<&'h [usize]> {
    let variant = hypothesis.variants.get(best.as_ref()?.variant)?;
    Some(&variant.columns)
}

fn exact_equivalents<F: FittedModel>(
    fitted: &F,
    effect: &Effect,
    bank: &ScoreBank,
    estimates: impl Fn(&[usize]) -> Option<NominalEstimate>,
) -> Vec<ExactEquivalent> {
    let equivalents = effect.equivalents.iter();
    equivalents
        .filter_map(|id| {
            let other = fitted.plant().effect(id)?;
            let columns: Vec<usize> = other.model_parameters().collect();
            let joint = bank.joint(&columns)?;
            let sizes = other.sizes().enumerate().map(|(i, size)| EffectEstimate {
                name: size.name,
                estimate: joint.estimate[i],
                sigma: Some(joint.covariance[(i, i)].sqrt()),
                interval: None,
                unit: size.unit,
            });
            Some(ExactEquivalent {
                effect: other.id,
                parameters: sizes.collect(),
                nominal: estimates(&columns),
            })
        })
        .collect()
}

/// Estimates of the parameters of an accepted effect. Of a wrong first attitude of one of several records the
/// start of that record is among them.
pub(crate) fn parameters_of<F: FittedModel>(
    stage: &FittedStage<F>,
    set: &HypothesisSet,
    accepted: &[Accepted],
    index: usize,
) -> Vec<EffectEstimate> {
    let (own, places) = (&accepted[index], &stage.places[index]);
    let hypothesis = &set.hypotheses[own.hypothesis];
    let (values, covariance): (&[f64], &DMatrix<f64>) =
        (stage.fitted.values(), stage.fitted.covariance());
    let all = hypothesis.effect.parameters.iter().enumerate();
    let start_s = own
        .shape
        .filter(|_| hypothesis.effect.kind == EffectKind::InitialState);
    let start = start_s.map(|start_s| EffectEstimate {
        name: "onset_s",
        estimate: start_s,
        sigma: None,
        interval: None,
        unit: "s",
    });
    all.map(|(index, parameter)| {
        let (estimate, sigma) = match places.values.get(index) {
            Some(place) => (
                values[*place] / parameter.scale,
                Some(covariance[(*place, *place)].sqrt() / parameter.scale),
            ),
            None => (own.shape.unwrap_or(f64::NAN), None),
        };
        EffectEstimate {
            name: parameter.name,
            estimate,
            sigma,
            interval: None,
            unit: parameter.unit,
        }
    })
    .chain(start)
    .collect()
}
