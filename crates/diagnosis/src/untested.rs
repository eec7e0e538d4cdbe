//! Effects of the catalogue that were not tested, and the reasons.

use gyrocal::effect::{EffectKind, Enters, NoiseProperty};
use gyrocal::{EFFECTS, Effect};
use gyrocal_hypothesis::{Ranked, Unavailable};

use crate::noise::NoiseAudit;
use gyrocal_answer::{NotTested, NotTestedReason};

/// State of the tests that were made.
pub(crate) struct Tests<'t> {
    pub(crate) ranking: &'t [Ranked],
    pub(crate) unavailable: &'t [Unavailable],
    pub(crate) audit: &'t NoiseAudit,
    /// Whether a filter was tested.
    pub(crate) filter: bool,
}

/// Effects that neither the search nor the audit tested, in the order of the catalogue.
pub(crate) fn untested(tests: &Tests<'_>) -> impl Iterator<Item = NotTested> {
    EFFECTS.iter().filter_map(move |effect| {
        let unavailable = tests.unavailable.iter();
        let missing = unavailable.clone().find(|u| u.effect == effect.id);
        let reason = match missing {
            Some(_) => NotTestedReason::MissingInput,
            None => reason(effect, tests)?,
        };
        let missing = missing.map(|unavailable| unavailable.why.as_str());
        Some(not_tested(effect.id, reason, missing))
    })
}

/// An effect with the reason why it was not tested, or is not detectable.
pub(crate) fn not_tested(
    effect: &str,
    reason: NotTestedReason,
    missing: Option<&str>,
) -> NotTested {
    NotTested {
        effect: effect.to_owned(),
        reason,
        why: gyrocal_words::not_tested(reason, missing),
    }
}

/// The reason; `None` of an effect that was tested.
fn reason(effect: &Effect, tests: &Tests<'_>) -> Option<NotTestedReason> {
    let spectrum = tests.audit.accel_ratio.is_some();
    let correlated = tests.audit.cleaned.correlation != 0.0;
    let enters_rates = matches!(effect.enters, Enters::Rates(_));
    let is_level = effect.kind == EffectKind::Noise(NoiseProperty::Level);
    let mut ranking = tests.ranking.iter();
    if ranking.any(|ranked| ranked.effect == effect.id) || effect.is_nominal {
        None
    } else if effect.kind == EffectKind::Integration {
        (!tests.filter).then_some(NotTestedReason::FilterNotAsked)
    } else if correlated && enters_rates && is_level {
        Some(NotTestedReason::HiddenByCorrelation)
    } else if effect.is_noise() {
        let tested = spectrum || enters_rates || needs_no_spectrum(effect);
        (!tested).then_some(NotTestedReason::NoSpectrum)
    } else if !effect.default_search {
        Some(NotTestedReason::NotDefault)
    } else {
        Some(NotTestedReason::Unobservable)
    }
}

/// Outliers and quantisation are tested value by value.
fn needs_no_spectrum(effect: &Effect) -> bool {
    use NoiseProperty::{Outliers, Quantisation};

    matches!(
        effect.kind,
        EffectKind::Noise(Outliers) | EffectKind::Noise(Quantisation)
    )
}
