//! The page of a calibration over many simulated records.

use gyrocal_evaluation::{BandedMean, CalibrationSummary, MeasuredValue, MonteCarloReport};
use gyrocal_report::page::{
    Bar, BarGroup, Bars, Card, Cell, Column, Item, List, Part, Section, Summary, Table, Tint, Tone,
};
use gyrocal_statistics::format;

use crate::diagnosis::section;
use crate::origin::{file_name, origin};

/// Failed runs that are listed; the result for programs has all.
const FAILURES_SHOWN: usize = 20;

/// Share of runs whose 95 % interval has to cover the truth.
const COVERED: f64 = 0.95;

/// The page of a calibration over many simulated records.
#[must_use]
pub fn of_monte_carlo(report: &MonteCarloReport) -> Part {
    let summary = &report.summary;
    let mut sections = vec![section(
        "coefficients",
        "Coefficients",
        "Statistics of a coefficient are over the runs that determine it: sigma below a tenth of the prior's. \
         In parentheses: 95 % confidence intervals.",
        vec![
            Item::Bars(errors(summary)),
            Item::Bars(coverage(summary)),
            Item::Table(coefficients(summary)),
        ],
    )];
    sections.extend(failures(summary));
    let [first, after] = report.seeds;
    let what = match report.population {
        true => "scenarios of a population",
        false => "seeds",
    };
    Part {
        name: file_name(&report.manifest, 0, "scenario"),
        size: format!("{what} {first} to {}", after.saturating_sub(1)),
        summary: first_screen(summary),
        sections,
        origin: origin(&report.manifest),
    }
}

fn first_screen(summary: &CalibrationSummary) -> Summary {
    let (tone, headline) = match summary.is_consistent() {
        true => (Tone::Good, "Consistent"),
        false => (Tone::Bad, "Inconsistent"),
    };
    let mut cards = Vec::new();
    let bands = [
        ("Errors (NEES)", summary.nees_determined),
        ("Innovations (NIS)", summary.nis),
    ];
    for (title, banded) in bands {
        cards.extend(banded.map(|banded| band(title, &banded)));
    }
    if let Some(share) = summary.consistent {
        cards.push(Card {
            title: "Runs in their band".to_owned(),
            main: format!("{:.1} %", 100.0 * share.value),
            text: vec![format!(
                "95 % interval {}; NIS of a run within its 99.9 % band",
                interval(share, 100.0, 1)
            )],
            columns: 4,
            ..Card::default()
        });
    }
    Summary {
        tone,
        headline: headline.to_owned(),
        sentence: format!(
            "{} runs were calibrated, {} failed: {}.",
            summary.runs,
            summary.failures.len(),
            summary.verdict()
        ),
        cards,
    }
}

fn band(title: &str, banded: &BandedMean) -> Card {
    let [low, high] = banded.band;
    let holds = match banded.holds() {
        true => "inside",
        false => "outside",
    };
    Card {
        title: title.to_owned(),
        main: format!("{:.3}", banded.mean),
        number: format!("{:.3} expected", banded.expected),
        text: vec![format!(
            "{holds} the 99.9 % band {low:.3} to {high:.3} of the mean; median {:.3}",
            banded.median
        )],
        columns: 4,
        ..Card::default()
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
            vec![Item::List(List { title, entries })],
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_evaluation::{CoefficientSummary, Failure};
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
        let html = crate::page(vec![of_monte_carlo(&report)]).to_html();
        let html = html.unwrap_or_default();
        for words in [
            "s.toml",
            "seeds 0 to 11",
            "Inconsistent",
            "errors are not as large as the sigmas say",
            "outside the 99.9 % band 2.900 to 3.100",
            "seed 7: lost",
            "gyro_x.bias",
            "0.930 (0.900 to 0.960)",
        ] {
            assert!(html.contains(words), "{words}");
        }
    }
}
