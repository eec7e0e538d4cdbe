//! The search and its result.

use gyrocal_inference::stop;
use gyrocal_scalar::effect::Effect;

use crate::accepted::{Accepted, value_places};
use crate::context::{MOST_EFFECTS, Proposed, SearchContext, SearchOptions, extension};
use crate::finding::Finding;
use crate::fitted_stage::FittedStage;
use crate::forward::{Beside, Ended, FirstRound, Selected, Walking, forward, open_hypotheses};
use crate::hypothesis::{HypothesisSet, Selection, Unavailable};
use crate::model::{FittedModel, ModelExtension};
use crate::null_distribution::GaussianDraws;
use crate::outside::add_none_of_these;
use crate::pattern::Unmodelled;
use crate::plant::Plant;
use crate::rate_noise::RateNoiseFit;
use crate::reassess::reassess;
use crate::result::parameters_of;
use crate::rows::Rows;
use crate::score::Ranked;
use crate::score_table::ScoreTable;
use crate::state::{SearchState, with_noise};
use crate::walk_candidates::{BESIDE_WALKS, Candidates};
use crate::walks::{Compared, compare, walking};

/// Result of a search.
pub struct Searched<F> {
    /// The model with all that was found, at its best fit.
    pub fitted: F,
    /// The nominal model, fitted with the noise that it leaves.
    pub nominal: F,
    /// Noise of the rates, estimated with all that was found.
    pub noise: RateNoiseFit,
    /// Detected effects, in the order of detection, then random walks.
    pub findings: Vec<Finding>,
    /// Detected terms that no effect of the catalogue explains; they are in the model.
    pub unmodelled: Vec<Unmodelled>,
    /// All hypotheses in the first round, largest statistic first.
    pub ranking: Vec<Ranked>,
    /// Detection threshold of the first round.
    pub threshold: f64,
    /// Effects that the record cannot show.
    pub unavailable: Vec<Unavailable>,
    /// Whether the search ended at its budget of work: there may be more to be found.
    pub is_cut: bool,
    /// Work of one pass over the record with all signatures, in the unit of [`FittedModel::work`].
    pub pass_work: u64,
    /// Scores on what the model does not hold.
    pub scores: ScoreTable,
    base: ModelExtension,
    plant: &'static Plant,
    rows: Rows,
    set: HypothesisSet,
    accepted: Vec<Accepted>,
}

impl<F: FittedModel> Searched<F> {
    /// Each finding but random walks, as an effect with the places of its sizes among the values of
    /// [`Self::fitted`].
    #[must_use]
    pub fn sizes(&self) -> Vec<(&'static Effect, Vec<usize>)> {
        let accepted = self.accepted.iter();
        accepted
            .map(|accepted| {
                let hypothesis = &self.set.hypotheses()[accepted.hypothesis];
                (hypothesis.effect(), value_places(&self.fitted, hypothesis))
            })
            .collect()
    }
}

impl<F> Searched<F> {
    /// What was found but random walks and unmodelled terms, for a search of the same record and selection in other
    /// noise.
    #[must_use]
    pub fn proposals(&self) -> Vec<Proposed> {
        let accepted = self.accepted.iter();
        accepted
            .map(|own| Proposed {
                hypothesis: own.hypothesis,
                shape: own.shape,
            })
            .collect()
    }

    /// The extension with all unmodelled terms and those findings that are `kept`; random walks are
    /// noise and no part of it.
    #[must_use]
    pub fn extension_with(&self, kept: &[bool]) -> ModelExtension {
        self.extension_of(kept, &self.unmodelled)
    }

    /// The same without unmodelled terms.
    #[must_use]
    pub fn effects_alone(&self, kept: &[bool]) -> ModelExtension {
        self.extension_of(kept, &[])
    }

    fn extension_of(&self, kept: &[bool], unmodelled: &[Unmodelled]) -> ModelExtension {
        let accepted = self.accepted.iter().zip(kept);
        let accepted: Vec<Accepted> = accepted
            .filter(|(_, kept)| **kept)
            .map(|(accepted, _)| accepted.clone())
            .collect();
        let context = (self.plant, &self.set, &self.rows);
        extension(&self.base, context, &accepted, unmodelled)
    }
}

/// Searches a record for the effects of a selection, from the nominal model at its best fit.
///
/// # Errors
/// Those of [`FittedModel::refitted`] and of passes over the record; [`Stopped`](crate::Stopped).
pub fn search<F: FittedModel>(
    nominal: F,
    rows: Rows,
    selection: &Selection,
    options: &SearchOptions,
) -> Result<Searched<F>, F::Error> {
    search_from(nominal, rows, selection, options, Vec::new())
}

/// The same, in which the effects of another search of this record and selection are tried first, in their order.
/// Each must be detected beside those before it as any other.
///
/// # Errors
/// As [`search`].
pub fn search_from<F: FittedModel>(
    nominal: F,
    rows: Rows,
    selection: &Selection,
    options: &SearchOptions,
    proposed: Vec<Proposed>,
) -> Result<Searched<F>, F::Error> {
    let plant = nominal.plant();
    let context = SearchContext {
        proposed,
        ..SearchContext::new(&nominal, rows, selection, options)
    };
    let mut draws = GaussianDraws::new(options.seed);
    let (fitted, noise) = with_noise(nominal)?;
    let before = fitted.work();
    let nominal = FittedStage::new(fitted, noise, &context.set, &context.rows, &[])?;
    let on_record = options.work_before;
    context
        .budget
        .start((before, on_record), nominal.fitted.work());
    let candidates = Candidates::new(&context, &nominal)?;
    let InWhiteNoise {
        state,
        first,
        best_walking,
    } = in_white_noise(&context, candidates.as_ref(), &nominal, &mut draws)?;
    let compared = match &candidates {
        Some(candidates) => compare(
            &context,
            candidates,
            &nominal,
            (state, best_walking),
            &first,
            &mut draws,
        )?,
        None => Compared::without_walks(state),
    };
    let Compared {
        mut state,
        mut walks,
        ranking: ranked_walks,
    } = compared;
    let FirstRound {
        mut ranking,
        threshold,
    } = first;
    ranking.extend(ranked_walks);
    ranking.sort_by(|a, b| b.statistic.total_cmp(&a.statistic));
    let findings = if options.names_alone {
        names(&context, &state)
    } else {
        let mut effects = reassess(
            &context,
            &mut state,
            threshold,
            &mut walks.rivals,
            &mut draws,
        )?;
        let model = (&state.stage, state.unmodelled.as_slice());
        add_none_of_these(&context, model, &mut effects, &mut walks.named)?;
        let effects = effects.into_iter().map(|effect| effect.finding);
        effects.chain(walks.named).collect()
    };
    stop::check()?;
    let open = open_hypotheses(&context, &state);
    Ok(Searched {
        scores: ScoreTable::of(&state.stage.bank, &open),
        fitted: state.stage.fitted,
        nominal: nominal.fitted,
        noise: state.stage.noise,
        findings,
        unmodelled: state.unmodelled,
        ranking,
        threshold,
        unavailable: selection.unavailable.clone(),
        is_cut: context.budget.is_cut(),
        pass_work: context.budget.pass(),
        base: context.base,
        plant,
        rows: context.rows,
        set: context.set,
        accepted: state.accepted,
    })
}

/// The effects of a model without what could be in their place.
fn names<F: FittedModel>(context: &SearchContext<'_>, state: &SearchState<F>) -> Vec<Finding> {
    let all = state.accepted.iter().enumerate();
    all.map(|(index, own)| Finding {
        effect: context.set.hypotheses[own.hypothesis].id(),
        parameters: parameters_of(&state.stage, &context.set, &state.accepted, index),
        z: f64::NAN,
        p_value: None,
        alternatives: Vec::new(),
        exact_equivalents: Vec::new(),
        none_of_these: None,
    })
    .collect()
}

/// Result of the forward selection in white noise.
struct InWhiteNoise<F> {
    state: SearchState<F>,
    first: FirstRound,
    /// The model with walks that it was held against.
    best_walking: Option<SearchState<F>>,
}

/// Forward selection in white noise, held against the best model with walks as soon as walks, alone or
/// beside some of its effects, are better.
fn in_white_noise<F: FittedModel>(
    context: &SearchContext<'_>,
    candidates: Option<&Candidates>,
    nominal: &FittedStage<F>,
    draws: &mut GaussianDraws,
) -> Result<InWhiteNoise<F>, F::Error> {
    let alone = candidates.map(Candidates::log_likelihood);
    let beside = |walks| Beside::WhiteNoise {
        walks,
        most: MOST_EFFECTS,
    };
    let at_first = candidates.map(|candidates| Walking::Alone {
        best: candidates.log_likelihood(),
        rates: &candidates.rates,
    });
    let state = SearchState::new(nominal.clone());
    let Selected {
        state,
        first,
        ended,
    } = forward(context, state, beside(at_first), draws)?;
    let is_behind = ended == Ended::BehindWalks;
    let Some(candidates) = candidates.filter(|_| is_behind) else {
        return Ok(InWhiteNoise {
            state,
            first,
            best_walking: None,
        });
    };
    // Where no fit converges with walks, walks alone are what effects are held against.
    let best_walking = walking(context, candidates, nominal, draws).ok();
    let best = best_walking
        .as_ref()
        .map(|found| found.penalised(first.threshold, BESIDE_WALKS, 0));
    let against = best.or(alone).map(Walking::Best);
    let state = forward(context, state, beside(against), draws)?.state;
    Ok(InWhiteNoise {
        state,
        first,
        best_walking,
    })
}

/// Effects of the default search and those with an id in `also`, but for those with a reason against
/// them: `missing` gives it.
#[must_use]
pub fn select(
    plant: &Plant,
    also: &[&str],
    missing: impl Fn(&Effect) -> Option<String>,
) -> Selection {
    let mut selection = Selection::default();
    for effect in plant.effects {
        if !(effect.default_search || also.contains(&effect.id)) {
            continue;
        }
        match missing(effect) {
            Some(why) => selection.unavailable.push(Unavailable {
                effect: effect.id,
                why,
            }),
            None => selection.effects.push(effect),
        }
    }
    selection
}
