//! The first screen of Allan deviations.

use gyrocal_document::{Screen, Standing};
use gyrocal_instruments::{AllanReport, LeftOut};
use gyrocal_statistics::allan::NoiseFit;
use gyrocal_statistics::format;
use gyrocal_words::counted;

/// Columns that are told one by one.
const COLUMNS_SHOWN: usize = 4;

/// Samples of a column that are told one by one.
const SAMPLES_SHOWN: usize = 3;

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
        let words = match good == columns.len() {
            true => format!("explained by {parts_of}"),
            false => format!("not explained by {parts_of}, in {} of {all}", all - good),
        };
        screen.fact("what is left", words);
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

/// The samples of a column that are left out, and what would be said with them.
pub(super) fn bad_samples(left_out: &LeftOut, unit: &str) -> String {
    let each = left_out.samples.iter().take(SAMPLES_SHOWN).map(|one| {
        format!(
            "{} at {} s ({} {unit})",
            one.sample,
            format::short(one.time_s, 6),
            format::short(one.value, 5)
        )
    });
    let each = each.collect::<Vec<_>>().join(", ");
    let more = match left_out.count.saturating_sub(SAMPLES_SHOWN) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    format!(
        "sample {each}{more}; with {}: {}",
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
