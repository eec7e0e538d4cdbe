//! The verdict on a calibration, in the scale of a diagnosis.

use gyrocal_calibration::{Consistency, FitStatistics};
use gyrocal_record::{EffectTest, FitVerdict};

/// The verdict on a fit: what the diagnosis of a record names comes before the size of the innovations, since
/// a test of all innovations together does not see a fault of ten sigmas of its own size. Innovations that are not
/// white come before noise that differs, and both before the size. `effects` is what the diagnoses of those records say
/// that could be diagnosed.
pub(crate) fn calibration_verdict(fit: &FitStatistics, effects: &[EffectTest]) -> FitVerdict {
    let of_size = match fit.consistency() {
        Consistency::Consistent => FitVerdict::Consistent,
        Consistency::Overconfident => FitVerdict::TooLarge,
        Consistency::Underconfident => FitVerdict::TooSmall,
    };
    let any = |is: fn(&EffectTest) -> bool| effects.iter().any(is);
    let names = any(|one| !one.causes.is_empty());
    if fit.is_gross() {
        of_size
    } else if any(|one| !one.settled) {
        FitVerdict::NotSettled
    } else if names {
        FitVerdict::EffectsFound
    } else if any(|one| one.white == Some(false)) {
        FitVerdict::Unexplained
    } else if of_size == FitVerdict::Consistent && any(|one| !one.noise.is_empty()) {
        FitVerdict::NoiseDiffers
    } else {
        of_size
    }
}
