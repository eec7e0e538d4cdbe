//! The first screen of Allan deviations.

use gyrocal_document::{Screen, Standing};
use gyrocal_instruments::{AllanReport, LeftOut};
use gyrocal_statistics::allan::NoiseFit;
use gyrocal_statistics::format;
use gyrocal_words::{counted, joined};

use crate::bad_samples::each;

/// Columns that are told one by one.
const COLUMNS_SHOWN: usize = 4;

/// The parts of the noise of each column, and whether they describe it.
pub(super) fn first(report: &AllanReport, clock: Option<&str>) -> Screen {
    let columns = &report.columns;
    let described = |noise: &Option<NoiseFit>| noise.as_ref().is_some_and(NoiseFit::is_described);
    let good = columns.iter().filter(|column| described(&column.noise));
    let good = good.count();
    let all = columns.len();
    let parts_of = "white noise, flicker and random walks";
    let mut screen = if good == all {
        let what = format!("by {parts_of}, in all of {}", counted(all, "column"));
        Screen::new(Standing::Good, "NOISE EXPLAINED", what)
    } else {
        let (few, all) = (all - good, counted(all, "column"));
        let what = format!("by {parts_of}, in {few} of {all}");
        Screen::new(Standing::Doubtful, "NOISE NOT EXPLAINED", what)
    };
    let bad: usize = columns
        .iter()
        .filter_map(|column| Some(column.left_out.as_ref()?.count))
        .sum();
    if bad > 0 {
        let what = format!("{}, beyond any noise, left out", counted(bad, "sample"));
        screen = Screen::new(Standing::Doubtful, "BAD SAMPLES", what);
    }
    for column in columns.iter().take(COLUMNS_SHOWN) {
        screen.fact(&column.name, parts(column.noise.as_ref(), &report.unit));
        if let Some(left_out) = &column.left_out {
            screen.fact("left out", bad_samples(left_out, &report.unit));
        }
    }
    if bad > 0 {
        let words = match good == all {
            true => format!("explained by {parts_of}"),
            false => format!("not explained by {parts_of}, in {} of {all}", all - good),
        };
        screen.fact("what is left", words);
    }
    if all > COLUMNS_SHOWN {
        let more = all - COLUMNS_SHOWN;
        screen.fact("and", format!("{more} more columns"));
    }
    if good < all {
        let words = "vibration, jumps, a change of temperature, or too short a log";
        screen.fact("may be", words);
    }
    let words = "95 %; the flat part of a bias instability B is 0.664 B";
    screen.fact("intervals", words);
    screen.fact("clock", clock.unwrap_or_default());
    screen
}

/// The samples of a column that are left out, and what would be said with them.
pub(super) fn bad_samples(left_out: &LeftOut, unit: &str) -> String {
    let samples = each(&left_out.samples, left_out.count, unit);
    format!(
        "{samples}; with {}: {}",
        if left_out.count == 1 { "it" } else { "them" },
        parts(left_out.noise_with_them.as_ref(), unit)
    )
}

fn parts(noise: Option<&NoiseFit>, unit: &str) -> String {
    let Some(noise) = noise else {
        return "too few averaging times for a fit".to_owned();
    };
    let each = noise.coefficients.iter().filter_map(|coefficient| {
        let part = coefficient.part;
        let unit = format!("{unit}{}", part.unit_suffix());
        let part = part.description();
        let ends = coefficient.interval?;
        let [low, high] = ends.map(|end| format::short(end, 3));
        let estimate = format::short(coefficient.estimate?, 3);
        Some(match ends[0] > 0.0 {
            true => format!("{part} {estimate} ({low} to {high}) {unit}"),
            false => format!("{part} below {high} {unit}"),
        })
    });
    let fit = format::p_value(noise.p_value);
    match &*joined(each, ", ") {
        "" => format!("no part of the noise is determined; fit {fit}"),
        parts => format!("{parts}; fit {fit}"),
    }
}
