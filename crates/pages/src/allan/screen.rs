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
    let fits = || columns.iter().filter_map(|column| column.noise.as_ref());
    let good = fits().filter(|noise| noise.is_described()).count();
    let all = columns.len();
    let tones: usize = fits().map(|noise| noise.tones.len()).sum();
    let filtered = fits().any(|noise| noise.filter_corner_hz.is_some());
    let mut what = vec!["white noise, flicker and random walks".to_owned()];
    what.extend((tones > 0).then(|| counted(tones, "tone")));
    what.extend(filtered.then(|| "a filter".to_owned()));
    let parts_of = joined(what, ", ");
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
        for (label, words) in besides(column.noise.as_ref(), &report.unit) {
            screen.fact(label, words);
        }
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
        let words = "vibration, jumps, or a change of temperature";
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

/// What else a column holds, and where its noise is not explained; each with a label.
pub(super) fn besides(noise: Option<&NoiseFit>, unit: &str) -> Vec<(&'static str, String)> {
    let Some(noise) = noise else {
        return Vec::new();
    };
    let mut facts = Vec::new();
    if !noise.tones.is_empty() {
        let each = noise.tones.iter().map(|tone| {
            let [low, high] = tone.interval.map(|end| format::short(end, 3));
            let (frequency, amplitude) = (tone.frequency_hz, format::short(tone.amplitude, 3));
            let frequency = format::short(frequency, 4);
            format!("{frequency} Hz, amplitude {amplitude} ({low} to {high}) {unit}")
        });
        facts.push(("tone", joined(each, "; ")));
    }
    facts.extend(noise.filter_corner_hz.map(|corner| {
        let corner = format::short(corner, 3);
        (
            "filter",
            format!("half of the power at {corner} Hz; quantisation is not told behind it"),
        )
    }));
    facts.extend(noise.samples_per_value.map(|each| {
        let each = format::short(each, 3);
        ("held", format!("each value for {each} samples; taken once"))
    }));
    if !noise.is_described() {
        let each = noise.not_explained_s.iter().map(|octave| {
            let [from, to] = octave.map(|end| format::short(end, 2));
            format!("{from} to {to}")
        });
        let words = joined(each, ", ");
        facts.push(("not explained", format!("at averaging times of {words} s")));
    }
    facts
}

fn parts(noise: Option<&NoiseFit>, unit: &str) -> String {
    let Some(noise) = noise else {
        return "too few samples for a fit".to_owned();
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
