//! The result of a search in which a model with walks is chosen.

use super::{Compared, Walks, uncompared_rivals};
use crate::context::SearchContext;
use crate::finding::Alternative;
use crate::model::FittedModel;
use crate::null_distribution::GaussianDraws;
use crate::rate_noise::RateNoise;
use crate::score::Ranked;
use crate::state::SearchState;
use crate::walk_by_rate::{ByRate, replaced};
use crate::walk_candidates::Candidates;
use crate::walk_findings::named;

/// A search in which a model with walks is chosen.
pub(super) struct Chosen<'c, 'o> {
    pub(super) context: &'c SearchContext<'o>,
    pub(super) candidates: &'c Candidates,
    pub(super) threshold: f64,
    pub(super) ranking: &'c [Ranked],
}

impl Chosen<'_, '_> {
    /// The result of a search whose budget ended before effects were compared with walks: walks stand in the
    /// sets of effects, and beside these in the model if the record needs them there.
    pub(super) fn uncompared<F: FittedModel>(
        &self,
        state: SearchState<F>,
        (p_beside, beside): (f64, &RateNoise),
        draws: &mut GaussianDraws,
    ) -> Result<Compared<F>, F::Error> {
        let mut rivals = uncompared_rivals(self.context, self.candidates, &state);
        let probability = self.context.options.walk_probability;
        let walking = (p_beside < probability).then(|| state.in_noise(self.context, beside));
        let mut compared = match walking {
            Some(Ok(walking)) => self.with_walks(walking, (p_beside, Vec::new()), draws)?,
            // Walks that no fit converges with are not what the record has.
            _ => Compared {
                ranking: self.ranking.to_vec(),
                ..Compared::without_walks(state)
            },
        };
        compared.walks.rivals.append(&mut rivals);
        Ok(compared)
    }

    /// The result, with the rivals of all walks together; each walk is held against effects.
    pub(super) fn with_walks<F: FittedModel>(
        &self,
        state: SearchState<F>,
        (p_value, together): (f64, Vec<Alternative>),
        draws: &mut GaussianDraws,
    ) -> Result<Compared<F>, F::Error> {
        let ByRate {
            state,
            walks,
            rivals,
            in_place_of,
        } = replaced(self.context, self.candidates, state, self.threshold, draws)?;
        let mut named = named(self.candidates, &state, walks, p_value)?;
        for (walk, finding) in &mut named {
            let own = in_place_of.iter().find(|(rate, _)| *rate == walk.rate);
            let own = own.map(|(_, effects)| effects);
            finding.alternatives.clone_from(own.unwrap_or(&together));
        }
        Ok(Compared {
            state,
            walks: Walks {
                named: named.into_iter().map(|(_, finding)| finding).collect(),
                rivals,
            },
            ranking: self.ranking.to_vec(),
        })
    }
}
