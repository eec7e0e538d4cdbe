//! The fit of a plant in words, and fits beside each other.

use gyrocal_answer::{
    ComparedFit, OutputFit, PlantComparison, PlantFit, RecordSummary, SimulationError,
};
use gyrocal_document::{Screen, Standing};
use gyrocal_statistics::format::significant;

use super::{coloured, direction, is_coloured, rms, undeclared_noise};
use crate::files::{few, joined};
use crate::format::{counted, short, with_sigma};

/// Estimates that a first screen shows, and other things.
const SHOWN: usize = 9;
const FEW: usize = 3;

fn fit_verdict(fit: &PlantFit) -> (Standing, &'static str) {
    match fit.remainder.iter().any(is_coloured) {
        true => (Standing::Doubtful, "FITTED, NOT WHITE"),
        false if !fit.undeclared_noise.is_empty() => (Standing::Doubtful, "FITTED BESIDE NOISE"),
        false if !fit.undetermined.is_empty() => (Standing::Doubtful, "FITTED IN PART"),
        false => (Standing::Good, "FITTED"),
    }
}

/// The first screen of a fit.
#[must_use]
pub fn fit_screen(fit: &PlantFit) -> Screen {
    let (standing, verdict) = fit_verdict(fit);
    let RecordSummary {
        rows, duration_s, ..
    } = fit.record;
    let what = format!("{} to {rows} rows over {} s.", fit.plant, short(duration_s));
    let mut screen = Screen::new(standing, verdict, what);
    let estimates = fit.coefficients.nominal.iter().map(|one| {
        let value = with_sigma(one.estimate, one.sigma);
        format!("{} {value} {}", one.name, one.unit)
    });
    screen.fact("estimates", few(estimates, SHOWN));
    let largest = fit.correlations.iter().take(FEW);
    let largest = largest.map(|one| format!("{} {:.2}", one.of.join(" and "), one.coefficient));
    let (largest, condition) = (joined(largest, ", "), rms(fit.condition));
    let words = format!("{largest}; condition number {condition}");
    screen.fact("correlation", words);
    let noise = fit.noise.iter().map(|one| {
        let [low, high] = one.interval.map(|end| significant(end, 3));
        let (channel, ratio) = (&one.channel, significant(one.ratio, 3));
        format!("{channel} {ratio} times the declared one ({low} to {high})")
    });
    screen.fact("noise", few(noise, FEW));
    for one in &fit.undeclared_noise {
        let words = undeclared_noise(one).replace("effects were judged", "the fit is made");
        screen.fact("noise", words);
    }
    let (nats, values) = (fit.log_likelihood, counted(fit.values, "reading"));
    let (unknowns, aic, bic) = (counted(fit.unknowns, "unknown"), fit.aic, fit.bic);
    let words = format!("{nats:.1} nats of {values}, {unknowns}; AIC {aic:.1}, BIC {bic:.1}");
    screen.fact("likelihood", words);
    screen.fact("record", errors(&fit.outputs));
    let later = fit.later.as_ref().map(|later| errors(&later.outputs));
    screen.fact("later record", later.unwrap_or_default());
    for one in fit.remainder.iter().filter(|one| is_coloured(one)) {
        let words = coloured(one).replace("Significances rest", "Standard deviations rest");
        screen.fact("remainder", words.replace("too good", "too small"));
    }
    screen.each("undetermined", fit.undetermined.iter().map(direction));
    screen.fact("still inputs", fit.still_inputs.join(", "));
    screen
}

/// An error of simulations with its unit and fit percentage.
#[must_use]
pub fn simulation_error(error: &SimulationError, unit: &str) -> String {
    let percent = error.fit_percent;
    let percent = percent.map_or_else(String::new, |percent| format!(" (fit {percent:.1} %)"));
    format!("{} {unit}{percent}", rms(error.rms))
}

fn errors(outputs: &[OutputFit]) -> String {
    let words = outputs.iter().map(|one| {
        let of = |error| simulation_error(error, &one.unit);
        let (open_loop, one_step) = (of(&one.open_loop), of(&one.one_step));
        let output = &one.output;
        format!("{output} off by {open_loop} in open loop, {one_step} one step ahead")
    });
    few(words, FEW)
}

/// The first screen of a comparison.
#[must_use]
pub fn comparison_screen(compared: &PlantComparison) -> Screen {
    let mut by_bic: Vec<_> = compared.models.iter().collect();
    by_bic.sort_by(|a, b| a.fit.bic.total_cmp(&b.fit.bic));
    let mut screen = Screen::new(Standing::Neutral, "COMPARED", String::new());
    if let [best, next, ..] = by_bic.as_slice() {
        // To the digit that is shown, a difference of nothing is a tie.
        let below = |one: &ComparedFit| format!("{:.1}", one.fit.bic - best.fit.bic);
        let least = by_bic.iter().filter(|one| below(one) == "0.0");
        let least = joined(least.map(|one| &one.name), " and ");
        screen.what = match below(next).as_str() {
            "0.0" => format!("{least} have the same BIC, the least."),
            below => format!("{least} has the least BIC, {below} below {}.", next.name),
        };
    }
    for one in &compared.models {
        screen.fact(&one.name, fit_verdict(&one.fit).1);
    }
    screen
}
