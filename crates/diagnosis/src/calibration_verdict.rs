//! The verdict on a calibration, in the scale of a diagnosis.

use gyrocal_calibration::{Consistency, FitStatistics};
use gyrocal_record::{EffectTest, FitVerdict, printable_line};
use gyrocal_statistics::format::p_value;

/// A verdict with its sentences.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrationVerdict {
    /// The verdict in one word.
    pub verdict: FitVerdict,
    /// The same in a few sentences.
    pub text: String,
}

/// The verdict on a fit: an effect that a record shows comes before the size of the innovations, since
/// a test of all innovations together does not see a fault of ten sigmas of its own size. `records` are the
/// names of all records, `effects` the tests of those that were tested.
#[must_use]
pub fn calibration_verdict(
    fit: &FitStatistics,
    records: &[String],
    effects: &[EffectTest],
) -> CalibrationVerdict {
    let of_size = match fit.consistency() {
        Consistency::Consistent => FitVerdict::Consistent,
        Consistency::Overconfident => FitVerdict::TooLarge,
        Consistency::Underconfident => FitVerdict::TooSmall,
    };
    if fit.is_gross() {
        return CalibrationVerdict {
            verdict: of_size,
            text: format!("{}{}", fit.consistency_text(), several_platforms(records)),
        };
    }
    let shown: Vec<&EffectTest> = effects.iter().filter(|test| test.significant).collect();
    let several = records.len() > 1;
    if shown.is_empty() {
        return without_effects(fit, of_size, effects, several);
    }
    let sentences: Vec<String> = shown.iter().map(|test| sentence(test, several)).collect();
    let [low, high] = fit.nis_band();
    let size = match of_size {
        FitVerdict::TooLarge => "larger than",
        FitVerdict::TooSmall => "smaller than",
        _ => "as large as",
    };
    CalibrationVerdict {
        verdict: FitVerdict::EffectsFound,
        text: format!(
            "Model mismatch detected: {} The coefficients may be biased by more than their sigmas. \
             The innovations are {size} the declared noise predicts (mean NIS {:.3}, 99.9 % band \
             {low:.3} to {high:.3}).",
            sentences.join(" "),
            fit.nis_mean(),
        ),
    }
}

/// The verdict where no effect is significant: innovations that are not white come before noise that differs,
/// and both before the size of the innovations.
fn without_effects(
    fit: &FitStatistics,
    of_size: FitVerdict,
    effects: &[EffectTest],
    several: bool,
) -> CalibrationVerdict {
    let of = |test: &EffectTest| match several {
        true => format!("of {} ", printable_line(&test.record)),
        false => String::new(),
    };
    let coloured = effects.iter().filter(|test| test.white == Some(false));
    let coloured: Vec<String> = coloured
        .map(|test| {
            let p = test
                .residual_p_value
                .map_or_else(String::new, |p| format!(" ({})", p_value(p)));
            format!("the innovations {}are not white{p}", of(test))
        })
        .collect();
    let noisy = effects.iter().filter(|test| !test.noise.is_empty());
    let noisy: Vec<String> = noisy
        .map(|test| {
            let ids = test.noise.join(", ");
            format!("The noise {}differs from the declared: {ids}.", of(test))
        })
        .collect();
    let verdict = match (coloured.is_empty(), of_size, noisy.is_empty()) {
        (false, ..) => FitVerdict::Unexplained,
        (true, FitVerdict::Consistent, false) => FitVerdict::NoiseDiffers,
        _ => of_size,
    };
    let none = match effects.is_empty() {
        true => "",
        false => " No effect of the catalogue is significant.",
    };
    let size = fit.consistency_text();
    let first = match verdict {
        FitVerdict::Unexplained => format!(
            "Model mismatch detected: {}, and no effect of the catalogue is significant. The coefficients may \
             be biased by more than their sigmas. {size}",
            coloured.join("; "),
        ),
        FitVerdict::NoiseDiffers => format!(
            "The mean NIS of all channels, {:.3}, is as expected, but it does not see all of the noise.{none}",
            fit.nis_mean()
        ),
        _ => format!("{size}{none}"),
    };
    let sentences: Vec<String> = core::iter::once(first).chain(noisy).collect();
    let text = sentences.join(" ");
    CalibrationVerdict { verdict, text }
}

/// What a gross misfit of several records may come from.
fn several_platforms(records: &[String]) -> String {
    if records.len() < 2 {
        return String::new();
    }
    let names = records.iter().map(|name| printable_line(name));
    let names: Vec<_> = names.collect();
    format!(
        " If these are records of several platforms, calibrate {} one by one. If only their turn-ons differ, \
         declare `turn_on_sigma_deg_per_h` in [prior].",
        names.join(", ")
    )
}

fn sentence(test: &EffectTest, several: bool) -> String {
    let of = if several {
        format!("{} shows", printable_line(&test.record))
    } else {
        "the record shows".to_owned()
    };
    let what = test.effect.as_deref().map_or_else(String::new, |effect| {
        format!("; the largest is {effect}, {:.1} sigma", test.z)
    });
    format!(
        "{of} an effect that the model lacks (family-wise {}{what}).",
        p_value(test.p_value)
    )
}
