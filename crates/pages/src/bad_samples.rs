//! Words on samples that no noise explains.

use gyrocal_document::{Item, Table};
use gyrocal_instruments::{BadSample, BadSamples};
use gyrocal_statistics::format;
use gyrocal_words::joined;

/// Samples that are told one by one on a first screen.
const SHOWN: usize = 3;

/// The first samples of `count`, each with its time and value.
pub(crate) fn each(samples: &[BadSample], count: usize, unit: &str) -> String {
    let each = samples.iter().take(SHOWN).map(|one| {
        let (time_s, value) = (format::short(one.time_s, 6), format::short(one.value, 5));
        format!("{} at {time_s} s ({value} {unit})", one.sample)
    });
    let each = joined(each, ", ");
    match count.saturating_sub(SHOWN) {
        0 => format!("sample {each}"),
        more => format!("sample {each} and {more} more"),
    }
}

/// What is left out of some logs, for a first screen; empty of nothing.
pub(crate) fn left_out(bad: &[BadSamples], logs: usize) -> String {
    let of_gyro = |one: &BadSamples| {
        let samples = each(&one.samples, one.count, &one.unit);
        format!("{}, {samples}", of(one, logs))
    };
    let sensors = joined(bad.iter().map(of_gyro), "; ");
    match bad {
        [] => String::new(),
        _ => format!("{sensors}: beyond any noise"),
    }
}

/// A table of the samples that are left out; none of nothing.
pub(crate) fn table(bad: &[BadSamples], logs: usize) -> Option<Item> {
    let rows = bad.iter().flat_map(|one| {
        one.samples.iter().map(move |sample| {
            let value = format!("{} {}", format::short(sample.value, 6), one.unit);
            let (place, time_s) = (sample.sample.to_string(), format::short(sample.time_s, 8));
            [of(one, logs), place, time_s, value]
        })
    });
    let title = "Samples left out, as no noise explains them: the median of those about them takes their place";
    let heads = "gyro | > sample | > after the first, s | > value";
    (!bad.is_empty()).then(|| Table::of(title, heads, rows).into())
}

fn of(bad: &BadSamples, logs: usize) -> String {
    match logs {
        1 => bad.gyro.clone(),
        _ => format!("{} of log {}", bad.gyro, bad.log + 1),
    }
}
