//! Likelihoods of rival hypotheses by fits: where nominal parameters move far to take an effect up, a score
//! about one fit misjudges what another effect would gain.

use crate::accepted::Accepted;
use crate::bank::ScoreBank;
use crate::context::SearchContext;
use crate::finding::CONFIDENCE_SET_DEVIANCE;
use crate::fitted_stage::FittedStage;
use crate::hypothesis::Hypothesis;
use crate::model::FittedModel;
use crate::pattern::Unmodelled;
use crate::score::{Best, Scores};
use crate::state::SearchState;

/// Share of the statistic of the named effect by which a score may misjudge that of a rival: rivals that
/// lack more than it are not fitted.
const MISJUDGED: f64 = 0.15;

/// The same of a rival whose knee a fit moves: its score has the knee where it is declared, which may be far from where
/// it is.
const MISJUDGED_KNEE: f64 = 1.0;

/// Most fits for one effect: of the nearest rivals that differ in the record, and of the nearest with a knee.
const MOST_FITS: usize = 6;
const MOST_FITS_OF_KNEES: usize = 4;

/// Statistic from which on a score about a fit says little of what an effect gains: that of a latitude wrong by a
/// tenth of a degree.
pub const FAR_OFF: f64 = 900.0;

/// Effects nearest by their scores that are fitted beside the errors of the set-up.
const NEAREST: usize = 3;

/// Rest of the information of one signature beside another below which both are the same in the record.
const SAME: f64 = 1e-9;

/// The model with its accepted effects, of which one is compared with its rivals.
pub(crate) struct Compared<'a, F> {
    pub(crate) stage: &'a FittedStage<F>,
    pub(crate) accepted: &'a [Accepted],
    pub(crate) unmodelled: &'a [Unmodelled],
    pub(crate) index: usize,
}

/// Replaces the statistics of the nearest rivals of an accepted effect by those of fits with each of them
/// in its place; `own` is the statistic of the effect, `inflation` that of the model. One that cannot be fitted keeps its
/// score.
pub(crate) fn fit_rivals<F: FittedModel>(
    compared: &Compared<'_, F>,
    context: &SearchContext<'_>,
    (bank, hypotheses): (&ScoreBank, &[Hypothesis]),
    scores: &mut Scores<'_>,
    (own, inflation): (f64, f64),
) {
    let named = compared.accepted[compared.index].hypothesis;
    let penalised = scores.penalised(named);
    let has_knee = |other: usize| hypotheses[other].effect.has_knee();
    let widest = |other: usize| {
        let misjudged = match has_knee(other) {
            true => MISJUDGED_KNEE,
            false => MISJUDGED,
        };
        inflation * CONFIDENCE_SET_DEVIANCE + misjudged * own
    };
    let mut near: Vec<(usize, f64)> = (0..hypotheses.len())
        .filter(|other| *other != named && scores.best[*other].is_some())
        .filter(|other| !hypotheses[*other].is_jump)
        .map(|other| (other, penalised - scores.penalised(other)))
        .filter(|(other, deficit)| *deficit < widest(*other))
        .collect();
    near.sort_by(|a, b| a.1.total_cmp(&b.1));
    let is_enough = |fitted: &[(usize, f64)], other: usize| {
        let alike = fitted.iter();
        let alike = alike.filter(|(one, _)| has_knee(*one) == has_knee(other));
        let most = match has_knee(other) {
            true => MOST_FITS_OF_KNEES,
            false => MOST_FITS,
        };
        alike.count() >= most
    };
    let mut fitted: Vec<(usize, f64)> = Vec::new();
    for (other, _) in near {
        if context.budget.is_spent(compared.stage.fitted.work()) {
            return;
        }
        let twin = fitted
            .iter()
            .find(|(one, _)| is_same(bank, scores, hypotheses, *one, other));
        let gained = match twin {
            Some((_, gained)) => *gained,
            None if is_enough(&fitted, other) => continue,
            None => match in_place(compared, context, scores, hypotheses, other) {
                Some(gained) => gained,
                None => continue,
            },
        };
        fitted.push((other, gained));
        if let Some(best) = &mut scores.best[other] {
            // The shape is that of the score, so that its likelihood is no less than that of the fit.
            let statistic = own + gained;
            best.statistic = match best.shape(hypotheses) {
                Some(_) => statistic.max(best.statistic),
                None => statistic,
            };
        }
    }
}

/// Twice the log-likelihood of a rival less that of the named effect.
fn in_place<F: FittedModel>(
    compared: &Compared<'_, F>,
    context: &SearchContext<'_>,
    scores: &Scores<'_>,
    hypotheses: &[Hypothesis],
    other: usize,
) -> Option<f64> {
    let stage = compared.stage;
    let mut accepted = compared.accepted.to_vec();
    accepted[compared.index] = Accepted {
        hypothesis: other,
        shape: scores.best[other]?.shape(hypotheses),
        ..accepted[compared.index].clone()
    };
    gained(context, stage, &accepted, compared.unmodelled)
}

/// Twice the log-likelihood of a model with these effects less that of a stage, which it is fitted from.
fn gained<F: FittedModel>(
    context: &SearchContext<'_>,
    stage: &FittedStage<F>,
    accepted: &[Accepted],
    unmodelled: &[Unmodelled],
) -> Option<f64> {
    let fitted = context.fitted(&stage.fitted, accepted, unmodelled).ok()?;
    let noise = fitted.fit_rate_noise(&stage.noise.noise.walking(), &[]);
    Some(2.0 * (noise.ok()?.log_likelihood - stage.noise.log_likelihood))
}

/// The effect to add to a model that is far off, by fits of the errors of the set-up and of the effects that are best
/// by their scores; `None` of a model that is not, or where none can be fitted.
pub(crate) fn best_by_fits<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &SearchState<F>,
    hypotheses: &[Hypothesis],
    scores: &Scores<'_>,
) -> Option<Best> {
    if scores.largest() < FAR_OFF {
        return None;
    }
    let mut all: Vec<Best> = scores.best.iter().copied().flatten().collect();
    let penalised = |one: &Best| scores.penalised(one.hypothesis);
    all.sort_by(|a, b| penalised(b).total_cmp(&penalised(a)));
    let is_tried = |(place, one): &(usize, Best)| {
        *place < NEAREST || hypotheses[one.hypothesis].effect.is_of_set_up()
    };
    let fitted = all.into_iter().enumerate().filter(is_tried);
    let fitted = fitted.filter_map(|(_, one)| {
        let mut accepted = state.accepted.clone();
        accepted.push(Accepted {
            hypothesis: one.hypothesis,
            shape: one.shape(hypotheses),
            detection: None,
            searched: 0.0,
            penalty: 0.0,
        });
        let gained = gained(context, &state.stage, &accepted, &state.unmodelled)?;
        Some((gained - scores.penalty(one.hypothesis), one))
    });
    let best = fitted.max_by(|(one, _), (other, _)| one.total_cmp(other));
    best.map(|(_, one)| one)
}

/// Whether two hypotheses of one size each are the same in this record.
fn is_same(
    bank: &ScoreBank,
    scores: &Scores<'_>,
    hypotheses: &[Hypothesis],
    one: usize,
    other: usize,
) -> bool {
    let column = |index: usize| {
        let best = scores.best[index]?;
        let variant = hypotheses[index].variants.get(best.variant)?;
        match (best.shape(hypotheses), variant.columns.as_slice()) {
            (None, [column]) => Some(*column),
            _ => None,
        }
    };
    let (Some(a), Some(b)) = (column(one), column(other)) else {
        return false;
    };
    let information = &bank.information;
    let product = information[(a, a)] * information[(b, b)];
    1.0 - information[(a, b)].powi(2) / product < SAME
}
