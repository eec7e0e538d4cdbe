//! Text of `gyrocal monte-carlo`, made from its summary alone.

use std::fmt::Write as _;

use comfy_table::{Cell, Table};
use gyrocal_evaluation::{
    BandedMean, CalibrationSummary, CoefficientSummary, Failure, MeasuredValue,
};
use gyrocal_record::printable_path;
use gyrocal_statistics::format;

use super::MonteCarloArguments;
use crate::tables::{right, table};

/// Number of failed runs that are listed; the JSON result has all.
const FAILURES_SHOWN: usize = 5;

pub(super) fn text(arguments: &MonteCarloArguments, summary: &CalibrationSummary) -> String {
    let mut text = format!(
        "{}: {} {} to {}, {} calibrated, {} failed\n",
        printable_path(&arguments.scenario),
        if arguments.population {
            "scenarios of its population"
        } else {
            "seeds"
        },
        arguments.seeds.start,
        arguments.seeds.end - 1,
        summary.runs,
        summary.failures.len()
    );
    for Failure { seed, message } in summary.failures.iter().take(FAILURES_SHOWN) {
        let _ = writeln!(text, "  {seed}: {message}");
    }
    if summary.failures.len() > FAILURES_SHOWN {
        let more = summary.failures.len() - FAILURES_SHOWN;
        let _ = writeln!(text, "  and {more} more");
    }
    let _ = writeln!(text, "\n{}\n", coefficients(summary).trim_fmt());
    text.push_str(
        "Statistics of a coefficient are over the runs that determine it: sigma below a tenth of the\n\
         prior's. CRB: Cramér-Rao bound. In parentheses: 95 % confidence intervals.\n\n",
    );
    let lines = [
        (
            "NEES of the determined coefficients",
            summary.nees_determined,
        ),
        // Equal to the first if all coefficients are determined in all runs.
        (
            "NEES of all nine, for a truth drawn from the prior",
            nine(summary),
        ),
        ("NIS of a row", summary.nis),
    ];
    for (name, banded) in lines {
        if let Some(banded) = banded {
            let _ = writeln!(text, "{name}: {}.", banded_text(&banded));
        }
    }
    if let Some(share) = summary.consistent {
        let _ = writeln!(
            text,
            "Runs that pass the consistency test (NIS within its 99.9 % band): {} %.",
            measured_text(share, 100.0, 1)
        );
    }
    text
}

fn nine(summary: &CalibrationSummary) -> Option<BandedMean> {
    let all = |coefficient: &CoefficientSummary| coefficient.determined == summary.runs;
    summary
        .nees
        .filter(|_| !summary.coefficients.iter().all(all))
}

fn coefficients(summary: &CalibrationSummary) -> Table {
    let bounded = summary
        .coefficients
        .iter()
        .any(|coefficient| coefficient.rmse_over_bound.is_some());
    let mut header = vec![
        "coefficient",
        "unit",
        "determined",
        "bias",
        "std. error",
        "RMSE",
        "RMSE / sigma",
    ];
    if bounded {
        header.push("RMSE / CRB");
    }
    header.push("95 % CI coverage, %");
    let mut table = table(header);
    for coefficient in &summary.coefficients {
        let ratio = |ratio: Option<MeasuredValue>| {
            right(ratio.map_or_else(String::new, |ratio| measured_text(ratio, 1.0, 3)))
        };
        let [bias, bias_error] = match (coefficient.bias, coefficient.bias_standard_error) {
            (Some(bias), Some(error)) => format::estimate(bias, error),
            (Some(bias), None) => [format!("{bias:.1e}"), String::new()],
            (None, _) => [String::new(), String::new()],
        };
        let rmse = coefficient.rmse.map(|rmse| format::estimate(0.0, rmse));
        let mut row = vec![
            Cell::new(&coefficient.name),
            Cell::new(&coefficient.unit),
            right(coefficient.determined.to_string()),
            right(bias),
            right(bias_error),
            right(rmse.map_or_else(String::new, |[_, rmse]| rmse)),
            ratio(coefficient.rmse_over_sigma),
        ];
        if bounded {
            row.push(ratio(coefficient.rmse_over_bound));
        }
        row.push(right(
            coefficient
                .coverage
                .map_or_else(String::new, |coverage| measured_text(coverage, 100.0, 1)),
        ));
        table.add_row(row);
    }
    table
}

fn measured_text(measured: MeasuredValue, scale: f64, decimals: usize) -> String {
    let [low, high] = measured.interval.map(|bound| scale * bound);
    let value = scale * measured.value;
    format!("{value:.decimals$} ({low:.decimals$} to {high:.decimals$})")
}

fn banded_text(banded: &BandedMean) -> String {
    let [low, high] = banded.band;
    format!(
        "mean {:.3}, {:.3} expected, 99.9 % band {low:.3} to {high:.3} ({}); median {:.3}",
        banded.mean,
        banded.expected,
        if banded.holds() { "inside" } else { "outside" },
        banded.median
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::Views;

    fn summary(rmse_over_bound: Option<MeasuredValue>) -> CalibrationSummary {
        let share = MeasuredValue {
            value: 0.95,
            interval: [0.94, 0.959_6],
        };
        let coefficient = CoefficientSummary {
            name: "gyro_x.bias".to_owned(),
            unit: "deg/h".to_owned(),
            determined: 7,
            bias: Some(-0.001_234),
            bias_standard_error: Some(0.000_56),
            rmse: Some(0.017_8),
            sigma_median: Some(0.018),
            rmse_over_sigma: Some(share),
            rmse_over_bound,
            coverage: Some(share),
        };
        CalibrationSummary {
            runs: 9,
            failures: (0..7)
                .map(|seed| Failure {
                    seed,
                    message: "lost".to_owned(),
                })
                .collect(),
            nees_determined: None,
            nees: None,
            nis: Some(BandedMean {
                mean: 3.2,
                expected: 3.0,
                band: [2.9, 3.1],
                median: 3.0,
            }),
            consistent: None,
            coefficients: vec![coefficient],
        }
    }

    fn said(summary: &CalibrationSummary) -> String {
        let arguments = MonteCarloArguments {
            scenario: "s.toml".into(),
            seeds: 0..16,
            results: None,
            threads: None,
            json: None,
            views: Views::default(),
            population: false,
            streaming: false,
        };
        text(&arguments, summary)
    }

    #[test]
    fn the_cramer_rao_bound_has_a_column_if_it_is_known() {
        let without = said(&summary(None));
        assert!(!without.contains("RMSE / CRB"), "{without}");
        let cells = "7   -0.00123      0.00056   0.018   0.950 (0.940 to 0.960)";
        assert!(without.contains(cells), "{without}");
        assert!(without.contains("95.0 (94.0 to 96.0)"), "{without}");
        let with = said(&summary(Some(MeasuredValue {
            value: 1.02,
            interval: [0.99, 1.05],
        })));
        assert!(with.contains("RMSE / CRB"), "{with}");
        assert!(with.contains("1.020 (0.990 to 1.050)"), "{with}");
    }

    #[test]
    fn failures_and_bands_are_printed() {
        let said = said(&summary(None));
        assert!(
            said.starts_with("s.toml: seeds 0 to 15, 9 calibrated, 7 failed\n  0: lost\n"),
            "{said}"
        );
        assert!(said.contains("  4: lost\n  and 2 more\n"), "{said}");
        assert!(
            said.contains(
                "NIS of a row: mean 3.200, 3.000 expected, 99.9 % band 2.900 to 3.100 (outside)"
            ),
            "{said}"
        );
        assert!(!said.contains("NEES"), "{said}");
    }
}
