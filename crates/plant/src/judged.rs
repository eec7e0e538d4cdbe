//! A search in white noise, and one in all noise where that is in doubt.
//!
//! What a search in white noise finds is proposed to a second one, in which the levels and correlation times of all
//! noise are estimated anew in each fit: a name stands if it is detected there. The first is kept where both agree and
//! its residuals need no more than white noise, or where it has the larger likelihood less a penalty for each term.

use gyrocal_hypothesis::{SearchOptions, Searched, Selection, search, search_from};

use crate::error::PlantError;
use crate::fitted::FittedPlant;

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
    let Some(second) = in_all_noise(&first, selection, options)? else {
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

/// The search in all noise; `None` where the nominal model needs no more than white noise, or has no fit with it.
fn in_all_noise(
    first: &Searched<FittedPlant>,
    selection: &Selection,
    options: &SearchOptions,
) -> Result<Option<Searched<FittedPlant>>, PlantError> {
    let nominal = match first.nominal.in_all_noise() {
        Ok(Some(nominal)) => nominal,
        Ok(None) | Err(PlantError::NoFit { .. } | PlantError::Singular) => return Ok(None),
        Err(PlantError::NotFinite { .. }) => return Ok(None),
        Err(other) => return Err(other),
    };
    let rows = nominal.rows();
    match search_from(nominal, rows, selection, options, first.proposals()) {
        Ok(second) => Ok(Some(second)),
        Err(PlantError::NoFit { .. } | PlantError::Singular | PlantError::NotFinite { .. }) => {
            Ok(None)
        }
        Err(other) => Err(other),
    }
}
