//! The page of a calibration over many simulated records.

use gyrocal_document::{
    Bar, BarGroup, Bars, Cell, Column, Item, List, Part, Screen, Section, Table, Tint,
};
use gyrocal_evaluation::{CalibrationSummary, MeasuredValue, MonteCarloReport};
use gyrocal_statistics::format;

use crate::diagnosis::section;
use crate::origin::{file_name, origin};

/// Failed runs that are listed; the result for programs has all.
const FAILURES_SHOWN: usize = 20;

/// Share of runs whose 95 % interval has to cover the truth.
const COVERED: f64 = 0.95;

/// The page of a calibration over many simulated records.
#[must_use]
pub fn of_monte_carlo(report: &MonteCarloReport, first: Screen) -> Part {
    let summary = &report.summary;
    let mut sections = vec![section(
        "coefficients",
        "Coefficients",
        "Statistics of a coefficient are over the runs that determine it: sigma below a tenth of the prior's. \
         In parentheses: 95 % confidence intervals.",
        vec![
            Item::Bars(errors(summary)),
            Item::Bars(coverage(summary)),
            Item::from(coefficients(summary)),
        ],
    )];
    sections.extend(failures(summary));
    let [lowest, after] = report.seeds;
    let what = match report.population {
        true => "scenarios of a population",
        false => "seeds",
    };
    Part {
        name: file_name(&report.manifest, 0, "scenario"),
        size: format!("{what} {lowest} to {}", after.saturating_sub(1)),
        first,
        sections,
        origin: origin(&report.manifest),
    }
}

fn errors(summary: &CalibrationSummary) -> Bars {
    bars(
        summary,
        ("Errors over sigmas", "RMSE / sigma"),
        (1.0, "as large as the sigmas say"),
        |one| one.rmse_over_sigma,
    )
}

fn coverage(summary: &CalibrationSummary) -> Bars {
    bars(
        summary,
        ("Truth within the 95 % interval", "share of runs"),
        (COVERED, "95 %"),
        |one| one.coverage,
    )
}

fn bars(
    summary: &CalibrationSummary,
    (title, quantity): (&str, &str),
    (threshold, meaning): (f64, &str),
    of: impl Fn(&gyrocal_evaluation::CoefficientSummary) -> Option<MeasuredValue>,
) -> Bars {
    let bars = summary.coefficients.iter().map(|one| Bar {
        label: one.name.clone(),
        value: of(one).map_or(f64::NAN, |found| found.value),
        tint: Tint::Nominal,
        note: of(one).map_or_else(String::new, |found| interval(found, 1.0, 3)),
    });
    Bars {
        title: title.to_owned(),
        quantity: quantity.to_owned(),
        threshold: Some((threshold, meaning.to_owned())),
        groups: vec![BarGroup {
            label: "coefficients".to_owned(),
            bars: bars.collect(),
        }],
        omitted: String::new(),
    }
}

fn coefficients(summary: &CalibrationSummary) -> Table {
    let heads = [
        ("coefficient", false),
        ("unit", false),
        ("runs that determine it", true),
        ("bias", true),
        ("standard error", true),
        ("RMSE", true),
        ("median sigma", true),
        ("RMSE / sigma", true),
        ("RMSE / Cramér-Rao bound", true),
        ("in the 95 % interval", true),
    ];
    let columns = heads.map(|(head, is_number)| Column {
        head: head.to_owned(),
        is_number,
    });
    let number =
        |value: Option<f64>| value.map_or_else(String::new, |value| format::short(value, 3));
    let measured = |found: Option<MeasuredValue>| {
        found.map_or_else(String::new, |found| {
            format!("{:.3} ({})", found.value, interval(found, 1.0, 3))
        })
    };
    let rows = summary.coefficients.iter().map(|one| {
        [
            one.name.clone(),
            one.unit.clone(),
            one.determined.to_string(),
            number(one.bias),
            number(one.bias_standard_error),
            number(one.rmse),
            number(one.sigma_median),
            measured(one.rmse_over_sigma),
            measured(one.rmse_over_bound),
            measured(one.coverage),
        ]
        .map(Cell::from)
        .into()
    });
    Table {
        title: "All coefficients".to_owned(),
        columns: columns.into(),
        rows: rows.collect(),
    }
}

fn interval(found: MeasuredValue, scale: f64, decimals: usize) -> String {
    let [low, high] = found.interval.map(|end| scale * end);
    format!("{low:.decimals$} to {high:.decimals$}")
}

fn failures(summary: &CalibrationSummary) -> Option<Section> {
    let entries: Vec<String> = summary
        .failures
        .iter()
        .take(FAILURES_SHOWN)
        .map(|failure| format!("seed {}: {}", failure.seed, failure.message))
        .collect();
    let title = format!(
        "The first of {} runs without a calibration",
        summary.failures.len()
    );
    (!entries.is_empty()).then(|| {
        section(
            "failures",
            "Failed runs",
            "Each seed can be simulated by itself: simulate --seed.",
            vec![Item::from(List { title, entries })],
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_evaluation::{BandedMean, CoefficientSummary, Failure};
    use gyrocal_record::{Input, Manifest};

    #[test]
    fn a_page_says_the_verdict_and_all_coefficients() {
        let found = MeasuredValue {
            value: 0.93,
            interval: [0.9, 0.96],
        };
        let report = MonteCarloReport {
            schema_version: 1,
            manifest: Manifest {
                program: "gyrocal".to_owned(),
                version: "0".to_owned(),
                model_hash: String::new(),
                inputs: vec![Input {
                    path: "folder/s.toml".to_owned(),
                    sha256: String::new(),
                    role: None,
                }],
                seed: 0,
                command: "gyrocal monte-carlo".to_owned(),
            },
            seeds: [0, 12],
            population: false,
            summary: CalibrationSummary {
                runs: 11,
                failures: vec![Failure {
                    seed: 7,
                    message: "lost".to_owned(),
                }],
                nees_determined: None,
                nees: None,
                nis: Some(BandedMean {
                    mean: 3.2,
                    expected: 3.0,
                    band: [2.9, 3.1],
                    median: 3.0,
                }),
                consistent: Some(found),
                coefficients: vec![CoefficientSummary {
                    name: "gyro_x.bias".to_owned(),
                    unit: "deg/h".to_owned(),
                    determined: 11,
                    bias: Some(1e-3),
                    bias_standard_error: Some(1e-4),
                    rmse: Some(0.02),
                    sigma_median: None,
                    rmse_over_sigma: Some(found),
                    rmse_over_bound: None,
                    coverage: None,
                }],
            },
        };
        let first = Screen::new(gyrocal_document::Standing::Bad, "INCONSISTENT", "too large");
        let html = gyrocal_report::to_html(&crate::page(vec![of_monte_carlo(&report, first)]));
        let html = html.unwrap_or_default();
        for words in [
            "s.toml",
            "seeds 0 to 11",
            "INCONSISTENT",
            "seed 7: lost",
            "gyro_x.bias",
            "0.930 (0.900 to 0.960)",
        ] {
            assert!(html.contains(words), "{words}");
        }
    }
}
