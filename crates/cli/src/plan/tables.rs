//! The tables below the text.

use std::fmt::Write as _;

use comfy_table::Cell;
use gyrocal_diagnosis::plan::{Outlook, Proposal};

use super::Found;
use super::words::{hours, percent};
use crate::tables::{right, table};

/// All tables with their headings.
pub(super) fn all(found: &Found<'_>) -> String {
    let planned = &found.planned;
    let mut text = format!(
        "\nRuns for each duration, the best first:\n\n{}\n",
        runs(found)
    );
    let best = planned.proposals.first();
    let longer = best.and_then(|best| {
        let mut all = planned.going_on.iter();
        all.find(|run| run.duration_s == best.duration_s)
    });
    let Some(best) = best else { return text };
    let columns: Vec<(&str, &Outlook)> = std::iter::once(("now", &planned.now))
        .chain(longer.map(|longer| ("present attitude", &longer.outlook)))
        .chain([("best run", &best.outlook)])
        .collect();
    let _ = writeln!(
        text,
        "\nStandard deviations now, and after {} more:\n\n{}",
        hours(best.duration_s),
        sigmas(&columns)
    );
    if planned.now.sets.iter().any(|set| set.members.len() > 1) {
        let _ = writeln!(
            text,
            "\nDiscrimination probability of the named effect and each alternative:\n\n{}",
            members(&columns[1..])
        );
    }
    text
}

fn runs(found: &Found<'_>) -> String {
    let planned = &found.planned;
    let mut header = vec!["duration", "x", "y", "z", "sigmas"];
    let sets: Vec<String> = planned
        .now
        .sets
        .iter()
        .filter(|set| set.members.len() > 1)
        .map(|set| {
            format!(
                "mean size of set {} (now {})",
                set.effect,
                set.members.len()
            )
        })
        .collect();
    header.extend(sets.iter().map(String::as_str));
    let mut table = table(header);
    let row = |run: &Proposal| {
        let angles = match run.angles_deg {
            Some(angles) => angles.map(|angle| right(format!("{angle:.0}°"))),
            None => [Cell::new("present"), Cell::new(""), Cell::new("")],
        };
        let sets = run.outlook.sets.iter().zip(&planned.now.sets);
        let sizes = sets
            .filter(|(_, now)| now.members.len() > 1)
            .map(|(set, _)| right(format!("{:.2}", set.mean_size)));
        std::iter::once(right(hours(run.duration_s)))
            .chain(angles)
            .chain([right(format!("{:.3}", run.outlook.sigma_ratio))])
            .chain(sizes)
            .collect::<Vec<_>>()
    };
    for duration_s in super::words::durations(found) {
        let of_it = |p: &&Proposal| p.duration_s == duration_s;
        for run in planned.proposals.iter().filter(of_it) {
            table.add_row(row(run));
        }
        for run in planned.going_on.iter().filter(of_it) {
            table.add_row(row(run));
        }
    }
    table.trim_fmt()
}

fn sigmas(columns: &[(&str, &Outlook)]) -> String {
    let header = std::iter::once("")
        .chain(columns.iter().map(|(name, _)| *name))
        .chain(["unit"]);
    let mut table = table(header.collect::<Vec<_>>());
    let Some((_, first)) = columns.first() else {
        return String::new();
    };
    let all = |outlook: &Outlook| -> Vec<f64> {
        let sizes = outlook.coefficients.iter().chain(&outlook.sizes);
        sizes.map(|forecast| forecast.sigma).collect()
    };
    let values: Vec<Vec<f64>> = columns.iter().map(|(_, outlook)| all(outlook)).collect();
    for (index, forecast) in first.coefficients.iter().chain(&first.sizes).enumerate() {
        let cells = values
            .iter()
            .filter_map(|sigmas| sigmas.get(index))
            .map(|sigma| right(format!("{sigma:.1e}")));
        table.add_row(
            std::iter::once(Cell::new(&forecast.name))
                .chain(cells)
                .chain([Cell::new(forecast.unit)])
                .collect::<Vec<_>>(),
        );
    }
    table.trim_fmt()
}

fn members(columns: &[(&str, &Outlook)]) -> String {
    let header = ["named", "alternative"]
        .into_iter()
        .chain(columns.iter().map(|(name, _)| *name));
    let mut table = table(header.collect::<Vec<_>>());
    let Some((_, first)) = columns.first() else {
        return String::new();
    };
    for (at, set) in first.sets.iter().enumerate() {
        for (index, member) in set.members.iter().enumerate().skip(1) {
            let cells = columns
                .iter()
                .filter_map(|(_, outlook)| outlook.sets.get(at)?.members.get(index))
                .map(|member| right(percent(member.told_apart)));
            table.add_row(
                [Cell::new(set.effect), Cell::new(member.effect)]
                    .into_iter()
                    .chain(cells)
                    .collect::<Vec<_>>(),
            );
        }
    }
    table.trim_fmt()
}
