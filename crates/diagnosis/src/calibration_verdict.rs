//! The verdict on a calibration, in the scale of a diagnosis.

use gyrocal_calibration::{Consistency, FitStatistics};
use gyrocal_hypothesis::Screened;
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

/// The outcome of the detection test as a result tells it; `file` is the record.
#[must_use]
pub fn effect_test(file: &str, screened: &Screened) -> EffectTest {
    EffectTest {
        record: file.to_owned(),
        effect: screened.effect.map(str::to_owned),
        z: screened.z,
        p_value: screened.p_value,
        significant: screened.is_significant,
    }
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
    let shown: Vec<&EffectTest> = effects.iter().filter(|test| test.significant).collect();
    if shown.is_empty() || fit.is_gross() {
        let none = match fit.is_gross() {
            true => several_platforms(records),
            false if effects.is_empty() => String::new(),
            false => " No effect of the catalogue is significant.".to_owned(),
        };
        return CalibrationVerdict {
            verdict: of_size,
            text: format!("{}{none}", fit.consistency_text()),
        };
    }
    let several = records.len() > 1;
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
