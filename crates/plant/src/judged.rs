//! A search in white noise, and one in all noise where that is in doubt.
//!
//! What a search in white noise finds is proposed to a second one, in which the levels and correlation times of all
//! noise are estimated anew in each fit: a name stands if it is detected there. The first is kept where both agree and
//! its residuals need no more than white noise, or where it has the larger likelihood less a penalty for each term.
//!
//! Where what is left is not white, no likelihood is a fair judge of a name: parts that are left out of the fit are, and
//! the search begins anew without the effects that they refuse.

use std::sync::Arc;

use gyrocal_answer::{PathStep, Refusal};
use gyrocal_hypothesis::{
    FittedModel as _, SearchOptions, Searched, Selection, search, search_from,
};

use crate::error::{PlantError, or_none};
use crate::fitted::FittedPlant;
use crate::left_out::{UNLISTED, by_parts};
use crate::record::PlantRecord;

/// Penalties of a term in the comparison of both models, log-likelihood: of an effect what the search of a catalogue of
/// a hundred makes of nothing in one of a hundred records, and twice that of an unlisted line or curve, which has two
/// sizes and a period or a shape.
const OF_EFFECT: f64 = 9.0;
const OF_UNLISTED: f64 = 18.0;

/// Logarithm of the likelihood of what was found, less the penalties of its terms.
fn penalised(of: &Searched<FittedPlant>) -> f64 {
    let (effects, unlisted) = (of.findings.len() as f64, of.unmodelled.len() as f64);
    of.noise.log_likelihood - OF_EFFECT * effects - OF_UNLISTED * unlisted
}

/// Searches for names among the effects that left-out parts have not refused. If the last still names some that they
/// refuse, those that stood go on alone.
const NAMES: usize = 6;

/// What was found, and what left-out parts say of it.
pub(crate) struct Standing {
    pub(crate) judged: Judged,
    /// The effects of the last search.
    pub(crate) selection: Selection,
    /// See [`gyrocal_answer::Answer::path`].
    pub(crate) path: Vec<PathStep>,
}

/// Searches a record for effects that stand in parts that are left out of the fit, if what they leave is not white.
///
/// # Errors
/// As [`searched`].
pub(crate) fn standing(
    nominal: &FittedPlant,
    mut selection: Selection,
    options: &SearchOptions,
    later: Option<&Arc<PlantRecord>>,
    is_white: impl Fn(&Searched<FittedPlant>) -> Result<bool, PlantError>,
) -> Result<Standing, PlantError> {
    let effects = &nominal.loaded().description.effects;
    let is_of_time = |id: &str| {
        let mut own = effects.iter();
        own.any(|own| own.id == id && own.kind.is_of_time())
    };
    let mut options = options.clone();
    let mut nominal_step: Option<PathStep> = None;
    let mut refused: Vec<PathStep> = Vec::new();
    let mut refused_gains = Vec::new();
    let mut searches = 0;
    loop {
        // Sets take most of the time: between the first search and the last, names are enough.
        options.names_alone = (1..=NAMES).contains(&searches);
        let judged = match options.names_alone {
            true => search(nominal.clone(), nominal.rows(), &selection, &options)?.into(),
            false => searched(nominal.clone(), &selection, &options, &is_white)?,
        };
        let found = &judged.searched;
        let is_fair = found.fitted.noise.is_declared() && is_white(found)?;
        let has_found = !(found.findings.is_empty() && found.unmodelled.is_empty());
        let path = match is_fair || !has_found {
            true => Vec::new(),
            false => by_parts(found, later, &mut refused_gains)?,
        };
        let (stand, no_longer): (Vec<PathStep>, Vec<PathStep>) =
            path.into_iter().partition(|step| step.refused.is_none());
        let stand = match stand.split_first() {
            Some((first, effects)) => {
                nominal_step = Some(first.clone());
                effects.to_vec()
            }
            None => Vec::new(),
        };
        if no_longer.is_empty() && options.names_alone {
            searches = NAMES + 1;
            continue;
        }
        if no_longer.is_empty() {
            let path = nominal_step.into_iter().chain(stand).chain(refused);
            return Ok(Standing {
                path: path.collect(),
                judged,
                selection,
            });
        }
        let names = |steps: &[PathStep], id: &str| {
            let mut own = steps.iter();
            own.any(|step| step.effect.as_deref() == Some(id))
        };
        if names(&no_longer, UNLISTED) {
            options.unmodelled_probability = 0.0;
        }
        let no_time = no_longer
            .iter()
            .any(|step| step.refused == Some(Refusal::FunctionsOfTime));
        let (go_on, rest): (Vec<_>, Vec<_>) = selection.effects.into_iter().partition(|effect| {
            let is_open = searches < NAMES || names(&stand, effect.id);
            is_open && !names(&no_longer, effect.id) && !(no_time && is_of_time(effect.id))
        });
        selection.effects = go_on;
        // What no left-out part speaks for beside a name may still be what the name stands for.
        let rest = rest.into_iter().filter(|effect| !is_of_time(effect.id));
        selection.rivals.extend(rest);
        refused.extend(no_longer);
        searches += 1;
    }
}

/// What was found.
pub(crate) struct Judged {
    pub(crate) searched: Searched<FittedPlant>,
    /// Effects that the search in white noise named, and that are not detected in all noise.
    pub(crate) refused: Vec<&'static str>,
}

impl From<Searched<FittedPlant>> for Judged {
    fn from(searched: Searched<FittedPlant>) -> Self {
        Self {
            searched,
            refused: Vec::new(),
        }
    }
}

/// Searches a record for the effects of a selection.
///
/// # Errors
/// Those of a search in white noise. Where the noise cannot be estimated beyond that, its result stands as it is, and
/// the tests of what it leaves say so.
pub(crate) fn searched(
    nominal: FittedPlant,
    selection: &Selection,
    options: &SearchOptions,
    is_white: impl Fn(&Searched<FittedPlant>) -> Result<bool, PlantError>,
) -> Result<Judged, PlantError> {
    let rows = nominal.rows();
    let first = search(nominal, rows, selection, options)?;
    let has_found = !first.findings.is_empty() || !first.unmodelled.is_empty();
    if !has_found && is_white(&first)? {
        return Ok(first.into());
    }
    let Some(noisy) = in_all_noise(&first.nominal)? else {
        return Ok(first.into());
    };
    if is_one_beside_white(&first, &noisy)? {
        return Ok(first.into());
    }
    let Some(second) = searched_again(noisy, &first, selection, options)? else {
        return Ok(first.into());
    };
    let names = |of: &Searched<FittedPlant>| {
        let mut names: Vec<&str> = of.findings.iter().map(|one| one.effect).collect();
        names.sort_unstable();
        (names, of.unmodelled.len())
    };
    if names(&first) == names(&second) && !second.fitted.needs_further_noise().unwrap_or(true) {
        return Ok(first.into());
    }
    if penalised(&first) > penalised(&second) {
        return Ok(first.into());
    }
    // What stands in a set is told there.
    let is_told = |effect: &str| {
        let mut found = second.findings.iter();
        found.any(|one| {
            let mut set = one.alternatives.iter();
            one.effect == effect || set.any(|other| other.effect == effect)
        })
    };
    let named = first.findings.iter().map(|one| one.effect);
    Ok(Judged {
        refused: named.filter(|effect| !is_told(effect)).collect(),
        searched: second,
    })
}

/// Whether the first search has one term, which leaves white noise and explains more than all noise without it does: a
/// second search could name nothing with a larger likelihood less its penalties.
fn is_one_beside_white(
    first: &Searched<FittedPlant>,
    noisy: &FittedPlant,
) -> Result<bool, PlantError> {
    if first.findings.len() + first.unmodelled.len() != 1 || in_all_noise(&first.fitted)?.is_some()
    {
        return Ok(false);
    }
    Ok(penalised(first) > noisy.fit_rate_noise(&[], &[])?.log_likelihood)
}

/// A model in all noise; `None` where it needs no more than white noise, or has no fit with it.
fn in_all_noise(fitted: &FittedPlant) -> Result<Option<FittedPlant>, PlantError> {
    or_none(fitted.in_all_noise()).map(Option::flatten)
}

/// The search in all noise, from the nominal model in it; `None` where it has no fit.
fn searched_again(
    noisy: FittedPlant,
    first: &Searched<FittedPlant>,
    selection: &Selection,
    options: &SearchOptions,
) -> Result<Option<Searched<FittedPlant>>, PlantError> {
    let rows = noisy.rows();
    or_none(search_from(
        noisy,
        rows,
        selection,
        options,
        first.proposals(),
    ))
}
