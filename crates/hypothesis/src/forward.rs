//! Forward selection: one effect after the other, with a full fit after each.

use gyrocal_statistics::math::ln;

use crate::accepted::{Accepted, Detection};
use crate::by_fits::best_by_fits;
use crate::context::{MOST_EFFECTS, SearchContext};
use crate::curve::share_beside_effects;
use crate::hypothesis::Hypothesis;
use crate::jump::best_jump;
use crate::model::FittedModel;
use crate::null_distribution::{GaussianDraws, NullDistribution};
use crate::pattern::{Pattern, Unmodelled};
use crate::rate_noise::degrees_of_freedom;
use crate::score::{Best, NESTED_MODEL_CHI2, Ranked, Scores};
use crate::state::{SearchState, stage};
use crate::unmodelled;
use crate::walk_candidates::BESIDE_WALKS;

/// Result of the first detection test.
#[derive(Clone, Default)]
pub(crate) struct FirstRound {
    /// All hypotheses, largest statistic first.
    pub(crate) ranking: Vec<Ranked>,
    /// Detection threshold.
    pub(crate) threshold: f64,
}

/// Shares of the threshold above which an effect is fitted: its score test has the noise of the model
/// without it, which an effect raises. Beside random walks more so: they take up most of a slow effect
/// until both are fitted together.
pub(crate) const WORTH_FITTING: f64 = 0.7;
const WORTH_FITTING_BESIDE_WALKS: f64 = 0.5;

/// Share of what a curve and the effects beside it explain together that must be left to the curve, for it to
/// go into the model before an effect. Of two large effects in one model scores leave it up to 0.006, what
/// curves of all kinds leave was 0.009 to 0.6.
const LEAST_SHARE: f64 = 0.02;

/// Model that effects are added to.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Beside<'r> {
    /// White noise, and `most` effects at most.
    WhiteNoise {
        walks: Option<Walking<'r>>,
        most: usize,
    },
    /// Random walks: an effect must gain so much more than the threshold, with the walks estimated with
    /// and without it.
    Walks { margin: f64 },
}

impl Beside<'_> {
    /// Takes walks beside these effects into account, if the selection pauses for walks.
    fn add_walks_beside<F: FittedModel>(&mut self, state: &SearchState<F>, threshold: f64) {
        let Beside::WhiteNoise {
            walks: Some(Walking::Alone { best, rates }),
            ..
        } = self
        else {
            return;
        };
        // Walks that cannot be fitted are no better.
        let Ok(walking) = state.stage.fitted.fit_rate_noise(rates, &[]) else {
            return;
        };
        let penalties = state.penalties(threshold, BESIDE_WALKS, 0);
        *best = best.max(walking.log_likelihood - 0.5 * penalties);
    }
}

/// Log-likelihood of a model with walks, less half the penalties of its effects, that effects in white noise
/// are held against.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Walking<'r> {
    /// Of walks without effects. The selection pauses where these, or walks beside its first effects, are
    /// better than its effects.
    Alone { best: f64, rates: &'r [usize] },
    /// Of the model with walks that is compared in the end. Effects are given up where it is so much better
    /// that they would lose even if gains went on to fall only as fast as the last two have.
    Best(f64),
}

/// Why a forward selection ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Ended {
    /// No further effect is to be added.
    Complete,
    /// Walks, alone or beside some of the effects, are better than the effects so far.
    BehindWalks,
}

/// Result of a forward selection.
pub(crate) struct Selected<F> {
    pub(crate) state: SearchState<F>,
    pub(crate) first: FirstRound,
    pub(crate) ended: Ended,
}

impl<F> Selected<F> {
    fn new(state: SearchState<F>, first: Option<FirstRound>, ended: Ended) -> Self {
        Self {
            state,
            first: first.unwrap_or_default(),
            ended,
        }
    }
}

/// Adds effects until none is significant.
pub(crate) fn forward<F: FittedModel>(
    context: &SearchContext<'_>,
    mut state: SearchState<F>,
    mut beside: Beside<'_>,
    draws: &mut GaussianDraws,
) -> Result<Selected<F>, F::Error> {
    let mut first: Option<FirstRound> = None;
    let mut gains = Vec::new();
    let mut proposed = context.proposed.iter();
    let (margin, most) = match beside {
        Beside::WhiteNoise { most, .. } => (None, most),
        Beside::Walks { margin } => (Some(margin), MOST_EFFECTS),
    };
    loop {
        let hypotheses = open_hypotheses(context, &state);
        let null = NullDistribution::draw(&state.stage.bank, &hypotheses, draws);
        let jumps = state.stage.fitted.state_jumps()?;
        let jump = best_jump(&jumps, &context.rows);
        let mut scores = Scores::of(&state.stage.bank, &hypotheses, &null, jump);
        if margin.is_none() {
            scores =
                scores.with_estimated_noise(&hypotheses, &degrees_of_freedom(&state.stage.noise));
        }
        let threshold = null.threshold(context.options.false_alarm_probability);
        first.get_or_insert_with(|| FirstRound {
            ranking: scores.ranking(&hypotheses),
            threshold,
        });
        if context.budget.ends_selection(state.stage.fitted.work()) {
            return Ok(Selected::new(state, first, Ended::Complete));
        }
        if state.accepted.len() < most
            && let Some(next) = proposed.next()
        {
            let candidate = scores.best[next.hypothesis].map(|best| (best, next.shape));
            let tried = candidate
                .map(|own| try_effect(context, &mut state, own, (&null, threshold), beside));
            gains.extend(tried.and_then(Outcome::gained));
            continue;
        }
        let share = if margin.is_some() {
            WORTH_FITTING_BESIDE_WALKS
        } else {
            WORTH_FITTING
        };
        let significant = scores.largest() > share * threshold && state.accepted.len() < most;
        if significant {
            scores.refine(&state.stage.fitted, context, &hypotheses, &[])?;
        }
        let by_fits = best_by_fits(context, &state, &hypotheses, &scores);
        let best = by_fits.or_else(|| scores.named(&hypotheses));
        let best = best.filter(|_| significant);
        // An unmodelled term goes into the model if no effect is significant, or if it explains so
        // much more that a name would be false.
        let limit = ln(context.options.unmodelled_probability) - 0.5 * margin.unwrap_or_default();
        let stands = |other: &Unmodelled| {
            let explains_more = |best: Best| {
                // Several effects together look like a line at a natural period.
                !other.has_natural_period(context.plant, &context.rows)
                    && other.equivalent() > scores.penalised(best.hypothesis) + NESTED_MODEL_CHI2
            };
            other.ln_probability < limit && best.is_none_or(explains_more)
        };
        // A polynomial or one jump absorbs most of what bends or switches with a covariate.
        let curves = !state.accepted.is_empty()
            || best.is_none_or(|best| hypotheses[best.hypothesis].is_jump);
        if state.seeks_unmodelled
            && state.unmodelled.len() < MOST_EFFECTS
            && let Some(other) =
                unmodelled::strongest(&state.stage.fitted, &context.rows, &jumps, curves, stands)?
            && (best.is_none() || is_no_sum_of_effects(&state, &hypotheses, &other)?)
            && accept_unmodelled(context, &mut state, other)
        {
            continue;
        }
        let Some(best) = best else {
            return Ok(Selected::new(state, first, Ended::Complete));
        };
        let candidate = (best, best.shape(&hypotheses));
        match try_effect(context, &mut state, candidate, (&null, threshold), beside) {
            Outcome::Inseparable => {}
            Outcome::Gained(gained) => gains.push(gained),
            Outcome::NotDetected => return Ok(Selected::new(state, first, Ended::Complete)),
        }
        // Walks follow what a model that is far off leaves better than its first effect does.
        let ended = against_walks(&state, &gains, threshold, beside);
        if let Some(ended) = ended.filter(|_| by_fits.is_none()) {
            return Ok(Selected::new(state, first, ended));
        }
        beside.add_walks_beside(&state, threshold);
    }
}

/// Whether an unmodelled term is more than several effects together.
fn is_no_sum_of_effects<F: FittedModel>(
    state: &SearchState<F>,
    hypotheses: &[Hypothesis],
    other: &Unmodelled,
) -> Result<bool, F::Error> {
    Ok(match other.pattern {
        Pattern::Line { .. } => true,
        Pattern::Curve { .. } => {
            let share = share_beside_effects(&state.stage.fitted, hypotheses, other)?;
            share > LEAST_SHARE
        }
    })
}

/// What became of an effect.
enum Outcome {
    /// It cannot be told apart from those in the model.
    Inseparable,
    /// It is in the model; twice the log-likelihood that it gained.
    Gained(f64),
    NotDetected,
}

impl Outcome {
    fn gained(self) -> Option<f64> {
        match self {
            Self::Gained(gained) => Some(gained),
            Self::Inseparable | Self::NotDetected => None,
        }
    }
}

/// Whether the selection ends for walks that are better than its effects.
fn against_walks<F>(
    state: &SearchState<F>,
    gains: &[f64],
    threshold: f64,
    beside: Beside<'_>,
) -> Option<Ended> {
    let Beside::WhiteNoise {
        walks: Some(walks),
        most,
    } = beside
    else {
        return None;
    };
    let (last, before) = gains.split_last()?;
    let own = state.penalised(threshold, 0.0, 1);
    let best = match walks {
        Walking::Alone { best, .. } => return (own < best).then_some(Ended::BehindWalks),
        Walking::Best(best) => best,
    };
    let fall = before.last().map_or(1.0, |before| (last / before).min(1.0));
    let mut further = 0.0;
    let mut gain = *last;
    for _ in state.accepted.len()..most {
        gain *= fall;
        further += (gain - threshold).max(0.0);
    }
    (own + 0.5 * further < best).then_some(Ended::Complete)
}

/// Adds the best effect to the model if it is detected: by the likelihood ratio, the noise estimated
/// with and without it.
fn try_effect<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &mut SearchState<F>,
    (best, shape): (Best, Option<f64>),
    (null, threshold): (&NullDistribution, f64),
    beside: Beside<'_>,
) -> Outcome {
    let penalty = best.searched + null.penalties[best.hypothesis];
    let before = state.clone();
    let accepted = Accepted {
        hypothesis: best.hypothesis,
        shape,
        detection: None,
        searched: best.searched,
        penalty,
    };
    accept(context, state, accepted);
    if state.accepted.len() == before.accepted.len() {
        return Outcome::Inseparable;
    }
    let gained = 2.0 * (state.stage.noise.log_likelihood - before.stage.noise.log_likelihood);
    let tested = gained - best.searched - null.detection_penalties[best.hypothesis];
    let is_detected = match beside {
        Beside::Walks { margin } => gained - penalty > threshold + margin,
        Beside::WhiteNoise { .. } => tested > threshold,
    };
    if !is_detected {
        *state = before;
        return Outcome::NotDetected;
    }
    let model = state.terms();
    if let Some(own) = state.accepted.last_mut() {
        own.detection = Some(Detection {
            p_value: null.probability(tested),
            model,
        });
    }
    Outcome::Gained(gained)
}

/// Hypotheses that are not in the model and can be distinguished from it.
pub(crate) fn open_hypotheses<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &SearchState<F>,
) -> Vec<Hypothesis> {
    let accepted = state.accepted.iter().map(|accepted| accepted.hypothesis);
    let taken: Vec<usize> = accepted.chain(state.inseparable.iter().copied()).collect();
    let all = context.set.hypotheses.iter().enumerate();
    all.map(|(index, hypothesis)| {
        let is_taken = taken.contains(&index) || context.set.is_equivalent(index, &taken);
        hypothesis.masked(is_taken || !hypothesis.can_be_named)
    })
    .collect()
}

/// Adds an effect to the model. One that cannot be fitted beside the others is not separable from
/// them.
fn accept<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &mut SearchState<F>,
    accepted: Accepted,
) {
    let hypothesis = accepted.hypothesis;
    state.accepted.push(accepted);
    match stage(
        context,
        &state.stage.fitted,
        &mut state.accepted,
        &state.unmodelled,
    ) {
        Ok(next) => state.stage = next,
        Err(_) => {
            state.accepted.pop();
            state.inseparable.push(hypothesis);
        }
    }
}

/// Adds an unmodelled term to the model; whether it could be fitted. If not, it is left to the
/// residual tests.
fn accept_unmodelled<F: FittedModel>(
    context: &SearchContext<'_>,
    state: &mut SearchState<F>,
    other: Unmodelled,
) -> bool {
    state.unmodelled.push(other);
    match stage(
        context,
        &state.stage.fitted,
        &mut state.accepted,
        &state.unmodelled,
    ) {
        Ok(next) => {
            state.stage = next;
            true
        }
        Err(_) => {
            state.unmodelled.pop();
            state.seeks_unmodelled = false;
            false
        }
    }
}
