//! The first screen of Allan deviations.

use gyrocal_document::{Screen, Standing};
use gyrocal_instruments::AllanReport;
use gyrocal_statistics::allan::NoiseFit;
use gyrocal_statistics::format;
use gyrocal_words::counted;

/// Columns that are told one by one.
const COLUMNS_SHOWN: usize = 4;

/// The parts of the noise of each column, and whether they describe it.
pub(super) fn first(report: &AllanReport, clock: Option<&str>) -> Screen {
    let columns = &report.columns;
    let described = |noise: &Option<NoiseFit>| noise.as_ref().is_some_and(NoiseFit::is_described);
    let good = columns
        .iter()
        .filter(|column| described(&column.noise))
        .count();
    let all = columns.len();
    let parts_of = "white noise, flicker and random walks";
    let mut screen = if good == all {
        let what = format!("by {parts_of}, in all of {}", counted(all, "column"));
        Screen::new(Standing::Good, "NOISE EXPLAINED", what)
    } else {
        let what = format!(
            "by {parts_of}, in {} of {}",
            all - good,
            counted(all, "column")
        );
        Screen::new(Standing::Doubtful, "NOISE NOT EXPLAINED", what)
    };
    for column in columns.iter().take(COLUMNS_SHOWN) {
        screen.fact(&column.name, parts(column.noise.as_ref(), &report.unit));
    }
    if columns.len() > COLUMNS_SHOWN {
        let more = columns.len() - COLUMNS_SHOWN;
        screen.fact("and", format!("{more} more columns"));
    }
    if good < columns.len() {
        screen.fact(
            "may be",
            "vibration, jumps, a change of temperature, or too short a log",
        );
    }
    screen.fact(
        "intervals",
        "95 %; the flat part of a bias instability B is 0.664 B",
    );
    screen.fact("clock", clock.unwrap_or_default());
    screen
}

fn parts(noise: Option<&NoiseFit>, unit: &str) -> String {
    let Some(noise) = noise else {
        return "too few averaging times for a fit".to_owned();
    };
    let each = noise.coefficients.iter().filter_map(|coefficient| {
        let part = coefficient.part;
        let unit = format!("{unit}{}", part.unit_suffix());
        let short = |value| format::short(value, 3);
        match (coefficient.estimate, coefficient.interval) {
            (Some(estimate), Some([low, high])) if low > 0.0 => Some(format!(
                "{} {} ({} to {}) {unit}",
                part.description(),
                short(estimate),
                short(low),
                short(high)
            )),
            (Some(_), Some([_, high])) => Some(format!(
                "{} below {} {unit}",
                part.description(),
                short(high)
            )),
            _ => None,
        }
    });
    let mut each: Vec<String> = each.collect();
    if each.is_empty() {
        each.push("no part of the noise is determined".to_owned());
    }
    format!(
        "{}; fit {}",
        each.join(", "),
        format::p_value(noise.p_value)
    )
}
