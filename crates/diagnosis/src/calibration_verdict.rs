//! The verdict on a calibration, in the scale of a diagnosis.

use gyrocal_calibration::{Consistency, FitStatistics};
use gyrocal_record::{EffectTest, FitVerdict, printable_line};
use gyrocal_statistics::format::p_value;

/// A verdict with its sentences.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CalibrationVerdict {
    /// The verdict in one word.
    pub(crate) verdict: FitVerdict,
    /// The same in a few sentences.
    pub(crate) text: String,
}

/// The verdict on a fit: what the diagnosis of a record names comes before the size of the innovations, since
/// a test of all innovations together does not see a fault of ten sigmas of its own size. `records` are the
/// names of all records, `effects` what the diagnoses of those say that could be diagnosed.
pub(crate) fn calibration_verdict(
    fit: &FitStatistics,
    records: &[String],
    effects: &[EffectTest],
) -> CalibrationVerdict {
    let CalibrationVerdict { verdict, text } = of_diagnosed(fit, records, effects);
    let without = records
        .iter()
        .filter(|name| !effects.iter().any(|one| one.record == **name));
    let without = without.map(|name| {
        let name = printable_line(name);
        format!(" {name} could not be diagnosed: it may show effects that the model lacks.")
    });
    let text = core::iter::once(text).chain(without).collect();
    CalibrationVerdict { verdict, text }
}

/// The same, without what could not be diagnosed.
fn of_diagnosed(
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
    let several = records.len() > 1;
    let shown: Vec<&EffectTest> = effects
        .iter()
        .filter(|one| !one.causes.is_empty())
        .collect();
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
    let (verdict, first) = match effects.iter().all(|one| one.settled) {
        true => (FitVerdict::EffectsFound, "Model mismatch detected"),
        false => (FitVerdict::NotSettled, "Not settled"),
    };
    CalibrationVerdict {
        verdict,
        text: format!(
            "{first}: {} The coefficients may be biased by more than their sigmas. \
             The innovations are {size} the declared noise predicts (mean NIS {:.3}, 99.9 % band \
             {low:.3} to {high:.3}).",
            sentences.join(" "),
            fit.nis_mean(),
        ),
    }
}

/// The verdict where no effect is named: innovations that are not white come before noise that differs,
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
    let open = effects
        .iter()
        .filter(|one| !one.settled || one.white == Some(false));
    let open: Vec<String> = open.map(|one| left_open(one, &of(one))).collect();
    let noisy = effects.iter().filter(|one| !one.noise.is_empty());
    let noisy = noisy.map(|one| {
        let ids = one.noise.join(", ");
        format!("The noise {}differs from the declared: {ids}.", of(one))
    });
    let noisy: Vec<String> = noisy.collect();
    let verdict = match (open.is_empty(), of_size, noisy.is_empty()) {
        (false, ..) if effects.iter().all(|one| one.settled) => FitVerdict::Unexplained,
        (false, ..) => FitVerdict::NotSettled,
        (true, FitVerdict::Consistent, false) => FitVerdict::NoiseDiffers,
        _ => of_size,
    };
    let none = match effects.is_empty() {
        true => "",
        false => " No effect of the catalogue is significant.",
    };
    let size = fit.consistency_text();
    let found = match verdict {
        FitVerdict::Unexplained => "Model mismatch detected",
        _ => "Not settled",
    };
    let first = match verdict {
        FitVerdict::Unexplained | FitVerdict::NotSettled => format!(
            "{found}: {}, and no effect of the catalogue is named. The coefficients may be biased by more than \
             their sigmas. {size}",
            open.join("; "),
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

/// What a diagnosis that names nothing leaves open; `of` names the record.
fn left_open(test: &EffectTest, of: &str) -> String {
    if test.white != Some(false) {
        return format!("the search {of}ended at its budget of work");
    }
    let p = test.residual_p_value;
    let p = p.map_or_else(String::new, |p| format!(" ({})", p_value(p)));
    format!("the innovations {of}are not white{p}")
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
    let of = match several {
        true => format!("{} shows", printable_line(&test.record)),
        false => "the record shows".to_owned(),
    };
    let causes = test.causes.iter().map(|one| {
        let also = match one.alternatives.is_empty() {
            true => String::new(),
            false => format!("; may also be {}", one.alternatives.join(", ")),
        };
        let p = one
            .p_value
            .map_or_else(String::new, |p| format!(", family-wise {}", p_value(p)));
        format!("{} ({:.1} sigma{p}{also})", one.effect, one.z)
    });
    let causes: Vec<String> = causes.collect();
    let open = match test.settled {
        true => "",
        false => ", and the diagnosis is not settled",
    };
    format!("{of} what the model lacks: {}{open}.", causes.join(", "))
}
