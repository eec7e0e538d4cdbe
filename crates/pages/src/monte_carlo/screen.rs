//! The first screen of a calibration over many simulated records.

use gyrocal_document::{Column, Screen, Standing, Table};
use gyrocal_evaluation::{BandedMean, CalibrationSummary, MonteCarloReport};
use gyrocal_statistics::format;

use super::{measured, seeds};
use crate::origin::named;

/// Whether errors are as large as the sigmas say, and by how much they are not.
pub(super) fn first(report: &MonteCarloReport) -> Screen {
    let summary = &report.summary;
    let bands = [summary.nees_determined, summary.nis];
    let said = format!(
        "{} runs, {} failed: {}",
        summary.runs,
        summary.failures.len(),
        summary.verdict()
    );
    let mut screen = match summary.is_consistent() {
        true => Screen::new(Standing::Good, "CONSISTENT", said),
        false => Screen::new(Standing::Bad, "INCONSISTENT", said),
    };
    for (name, banded) in ["errors (NEES)", "innovations (NIS)"]
        .into_iter()
        .zip(bands)
    {
        screen.fact(
            name,
            banded.map_or_else(String::new, |banded| band(&banded)),
        );
    }
    if let Some(share) = summary.consistent {
        screen.fact(
            "runs in their band",
            format!("{} %", measured(share, 100.0, 1)),
        );
    }
    for failure in summary.failures.iter().take(1) {
        screen.fact(
            "first failure",
            format!("seed {}: {}", failure.seed, failure.message),
        );
    }
    let scenario = named(&report.manifest.inputs);
    screen.fact("scenario", format!("{scenario}: {}", seeds(report)));
    screen.table = Some(table(summary));
    screen
}

fn band(banded: &BandedMean) -> String {
    let [low, high] = banded.band;
    format!(
        "mean {:.3}, expected {:.3} ({low:.3} to {high:.3}, 99.9 %): {}",
        banded.mean,
        banded.expected,
        if banded.holds() { "inside" } else { "outside" }
    )
}

fn table(summary: &CalibrationSummary) -> Table {
    let rows = summary.coefficients.iter().map(|one| {
        let bias = match (one.bias, one.bias_standard_error) {
            (Some(bias), Some(error)) => {
                format!("{} {}", format::with_sigma(bias, error), one.unit)
            }
            _ => String::new(),
        };
        let ratio = one.rmse_over_sigma;
        vec![
            one.name.clone(),
            bias,
            ratio.map_or_else(String::new, |found| measured(found, 1.0, 2)),
            one.coverage
                .map_or_else(String::new, |found| format!("{:.0} %", 100.0 * found.value)),
        ]
    });
    Table::new(
        "",
        Column::heads("coefficient | bias | RMSE / sigma | in 95 % CI"),
        rows,
    )
}
