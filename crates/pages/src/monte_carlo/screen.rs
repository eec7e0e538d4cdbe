//! The first screen of a calibration over many simulated records.

use gyrocal_document::{Screen, Standing, Table};
use gyrocal_evaluation::{BandedMean, CalibrationSummary, MonteCarloReport};
use gyrocal_statistics::format;

use super::{measured, seeds};
use crate::origin::named;

/// Whether errors are as large as the sigmas say, and by how much they are not.
pub(super) fn first(report: &MonteCarloReport) -> Screen {
    let summary = &report.summary;
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
    if let Some(errors) = &summary.nees_determined {
        screen.fact("errors (NEES)", band(errors));
    }
    if let Some(innovations) = &summary.nis {
        screen.fact("innovations (NIS)", band(innovations));
    }
    if let Some(share) = summary.consistent {
        let share = measured(share, 100.0, 1);
        screen.fact("runs in their band", format!("{share} %"));
    }
    if let Some(failure) = summary.failures.first() {
        let words = format!("seed {}: {}", failure.seed, failure.message);
        screen.fact("first failure", words);
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
        [
            one.name.clone(),
            bias,
            ratio.map_or_else(String::new, |found| measured(found, 1.0, 2)),
            one.coverage
                .map_or_else(String::new, |found| format!("{:.0} %", 100.0 * found.value)),
        ]
    });
    Table::of("", "coefficient | bias | RMSE / sigma | in 95 % CI", rows)
}
