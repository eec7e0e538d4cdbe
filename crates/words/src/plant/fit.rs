//! The fit of a plant in words, and fits beside each other.

use gyrocal_answer::{OutputFit, PlantComparison, PlantFit, SimulationError};
use gyrocal_document::{Screen, Standing};
use gyrocal_statistics::format::{estimate, significant};

use super::{coloured, direction, is_coloured, rms, undeclared_noise};
use crate::files::few;
use crate::format::{counted, short};

/// Estimates and outputs that a first screen shows.
const SHOWN: usize = 9;
const OUTPUTS: usize = 3;

/// The first screen of a fit.
#[must_use]
pub fn fit_screen(fit: &PlantFit) -> Screen {
    let is_white = !fit.remainder.iter().any(is_coloured);
    let (standing, verdict) = match (is_white, fit.undeclared_noise.is_empty()) {
        (false, _) => (Standing::Doubtful, "FITTED, NOT WHITE"),
        (true, false) => (Standing::Doubtful, "FITTED BESIDE NOISE"),
        _ if !fit.undetermined.is_empty() => (Standing::Doubtful, "FITTED, NOT ALL DETERMINED"),
        _ => (Standing::Good, "FITTED"),
    };
    let what = format!(
        "{} to {} over {} s: {}.",
        fit.plant,
        counted(fit.record.rows, "row"),
        short(fit.record.duration_s),
        counted(fit.unknowns, "unknown"),
    );
    let mut screen = Screen::new(standing, verdict, what);
    let estimates = fit.coefficients.nominal.iter().map(|one| {
        let value = estimate(one.estimate, one.sigma).join(" ± ");
        format!("{} {value} {}", one.name, one.unit)
    });
    screen.fact("estimates", few(estimates, SHOWN));
    screen.fact("correlation", correlation(fit));
    let noise = fit.noise.iter().map(|one| {
        let [low, high] = one.interval.map(|end| significant(end, 3));
        let ratio = significant(one.ratio, 3);
        format!("of {} {ratio} ({low} to {high})", one.channel)
    });
    let noise = format!("over the declared one, 95 %: {}", few(noise, OUTPUTS));
    screen.fact("noise", noise);
    for one in &fit.undeclared_noise {
        let words = undeclared_noise(one).replace("effects were judged", "the fit is made");
        screen.fact("noise", words);
    }
    screen.fact("likelihood", likelihood(fit));
    errors(&mut screen, "record", &fit.outputs);
    if let Some(later) = &fit.later {
        errors(&mut screen, "later record", &later.outputs);
    }
    for one in fit.remainder.iter().filter(|one| is_coloured(one)) {
        let sigmas = "Standard deviations rest on the noise above, take them as too small.";
        let words = coloured(one);
        let what = words.split(" Significances").next().unwrap_or_default();
        screen.fact("remainder", format!("{what} {sigmas}"));
    }
    for one in &fit.undetermined {
        screen.fact("undetermined", direction(one));
    }
    screen.fact("inputs that never move", fit.still_inputs.join(", "));
    screen
}

fn correlation(fit: &PlantFit) -> String {
    let largest = fit.correlations.iter().map(|one| {
        let [first, second] = &one.of;
        format!("{first} and {second} {:.2}", one.coefficient)
    });
    let condition = fit.condition.map_or_else(
        || "infinite".to_owned(),
        |condition| significant(condition, 2),
    );
    let largest: Vec<String> = largest.take(OUTPUTS).collect();
    format!("{}; condition number {condition}", largest.join(", "))
}

fn likelihood(fit: &PlantFit) -> String {
    format!(
        "{:.1} nats of {}; AIC {:.1}, BIC {:.1}",
        fit.log_likelihood,
        counted(fit.values, "value"),
        fit.aic,
        fit.bic
    )
}

/// An error of simulations with its unit and fit percentage.
#[must_use]
pub fn simulation_error(error: &SimulationError, unit: &str) -> String {
    let percent = error.fit_percent;
    let percent = percent.map_or_else(String::new, |percent| format!(", {percent:.1} %"));
    let unit = if unit == "1" { "" } else { unit };
    format!("{} {unit}", rms(error.rms)).trim_end().to_owned() + &percent
}

fn errors(screen: &mut Screen, label: &str, outputs: &[OutputFit]) {
    let words = outputs.iter().map(|one| {
        let [open_loop, one_step] =
            [&one.open_loop, &one.one_step].map(|error| simulation_error(error, &one.unit));
        let output = &one.output;
        format!("{output} off by {open_loop} in open loop, {one_step} one step ahead")
    });
    screen.fact(label, few(words, OUTPUTS));
}

/// The first screen of a comparison.
#[must_use]
pub fn comparison_screen(compared: &PlantComparison) -> Screen {
    let mut by_bic: Vec<_> = compared.models.iter().collect();
    by_bic.sort_by(|a, b| a.fit.bic.total_cmp(&b.fit.bic));
    let what = match by_bic.as_slice() {
        [best, next, ..] => format!(
            "{} has the least BIC, {:.1} below {}.",
            best.name,
            next.fit.bic - best.fit.bic,
            next.name
        ),
        _ => String::new(),
    };
    let mut screen = Screen::new(Standing::Neutral, "COMPARED", what);
    for one in &compared.models {
        let doubts = fit_screen(&one.fit).verdict;
        if doubts != "FITTED" {
            screen.fact(&one.name, doubts.to_lowercase());
        }
    }
    screen
}
