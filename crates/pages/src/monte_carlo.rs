//! The page of a calibration over many simulated records.

mod screen;

use gyrocal_document::{Bar, BarGroup, Bars, Item, List, Part, Section, Table, Tint};
use gyrocal_evaluation::{
    BandedMean, CalibrationSummary, CoefficientSummary, MeasuredValue, MonteCarloReport,
};
use gyrocal_statistics::format;

use crate::origin::{file_name, part};
use crate::words::section;

/// Failed runs that are listed; the result for programs has all.
const FAILURES_SHOWN: usize = 20;

/// Share of runs whose 95 % interval has to cover the truth.
const COVERED: f64 = 0.95;

/// The page of a calibration over many simulated records.
#[must_use]
pub fn of_monte_carlo(report: &MonteCarloReport) -> Part {
    let summary = &report.summary;
    let errors = bars(
        summary,
        ("Errors over sigmas", "RMSE / sigma"),
        (1.0, "as large as the sigmas say"),
        |one| one.rmse_over_sigma,
    );
    let coverage = bars(
        summary,
        ("Truth within the 95 % interval", "share of runs"),
        (COVERED, "95 %"),
        |one| one.coverage,
    );
    let lead = "Statistics of a coefficient are over the runs that determine it: sigma below a tenth of the prior's. \
         In parentheses: 95 % confidence intervals.";
    let items = vec![
        Item::Bars(errors),
        Item::Bars(coverage),
        coefficients(summary).into(),
    ];
    let coefficients = section("coefficients", "Coefficients", lead, items);
    let mut sections = vec![coefficients, consistency(summary)];
    sections.extend(failures(summary));
    let (manifest, first) = (&report.manifest, screen::first(report));
    let name = file_name(manifest, 0, "scenario");
    part(manifest, name, seeds(report), first, sections)
}

fn seeds(report: &MonteCarloReport) -> String {
    let [lowest, after] = report.seeds;
    let what = match report.population {
        true => "scenarios of its population",
        false => "seeds",
    };
    format!("{what} {lowest} to {}", after.saturating_sub(1))
}

fn bars(
    summary: &CalibrationSummary,
    (title, quantity): (&str, &str),
    (threshold, meaning): (f64, &str),
    of: impl Fn(&CoefficientSummary) -> Option<MeasuredValue>,
) -> Bars {
    let bars = summary.coefficients.iter().map(|one| Bar {
        label: one.name.clone(),
        value: of(one).map_or(f64::NAN, |found| found.value),
        tint: Tint::Nominal,
        note: of(one).map_or_else(String::new, |found| {
            let [low, high] = found.interval;
            format!("{low:.3} to {high:.3}")
        }),
    });
    Bars {
        threshold: Some((threshold, meaning.to_owned())),
        ..Bars::new(title, quantity, vec![BarGroup::new("coefficients", bars)])
    }
}

fn coefficients(summary: &CalibrationSummary) -> Table {
    let number = |value: Option<f64>| value.map_or_else(String::new, |one| format::short(one, 3));
    let of = |found: Option<MeasuredValue>| {
        found.map_or_else(String::new, |found| measured(found, 1.0, 3))
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
            of(one.rmse_over_sigma),
            of(one.rmse_over_bound),
            of(one.coverage),
        ]
    });
    let heads = "coefficient | unit | > runs that determine it | > bias | > standard error | > RMSE \
                   | > median sigma | > RMSE / sigma | > RMSE / Cramér-Rao bound | > in the 95 % interval";
    Table::of("All coefficients", heads, rows)
}

/// A value with its interval.
fn measured(found: MeasuredValue, scale: f64, decimals: usize) -> String {
    let [low, high] = found.interval.map(|bound| scale * bound);
    let value = scale * found.value;
    format!("{value:.decimals$} ({low:.decimals$} to {high:.decimals$})")
}

/// Errors and innovations against what is expected of them.
fn consistency(summary: &CalibrationSummary) -> Section {
    let all = |one: &CoefficientSummary| one.determined == summary.runs;
    // Equal to the first if all coefficients are determined in all runs.
    let nine = summary
        .nees
        .filter(|_| !summary.coefficients.iter().all(all));
    let found = [
        (
            "NEES of the determined coefficients",
            summary.nees_determined,
        ),
        ("NEES of all nine, for a truth drawn from the prior", nine),
        ("NIS of a row", summary.nis),
    ];
    let rows = found.into_iter().filter_map(|(name, banded)| {
        let BandedMean {
            mean,
            expected,
            band: [low, high],
            median,
        } = banded?;
        let inside = if banded?.holds() { "inside" } else { "outside" };
        Some([
            name.to_owned(),
            format!("{mean:.3}"),
            format!("{expected:.3}"),
            format!("{low:.3} to {high:.3}"),
            inside.to_owned(),
            format!("{median:.3}"),
        ])
    });
    let heads = "statistic | > mean | > expected | > 99.9 % band | mean is | > median";
    let mut items = vec![Table::of("", heads, rows).into()];
    if let Some(share) = summary.consistent {
        items.push(Item::text(format!(
            "Runs that pass the consistency test (NIS within its 99.9 % band): {} %.",
            measured(share, 100.0, 1)
        )));
    }
    let lead =
        "Squared errors over their covariance (NEES) and squared innovations over theirs (NIS).";
    section("consistency", "Consistency", lead, items)
}

fn failures(summary: &CalibrationSummary) -> Option<Section> {
    let failures = &summary.failures;
    let first = failures.iter().take(FAILURES_SHOWN);
    let entries = first.map(|one| format!("seed {}: {}", one.seed, one.message));
    let title = format!("The first of {} runs without a calibration", failures.len());
    let list = List::of(&title, entries)?.into();
    let lead = "Each seed can be simulated by itself: simulate --seed.";
    Some(section("failures", "Failed runs", lead, vec![list]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyrocal_evaluation::Failure;
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
                    ..Input::default()
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
        let html = gyrocal_report::to_html(&crate::page(vec![of_monte_carlo(&report)]));
        let html = html.unwrap_or_default();
        for words in [
            "s.toml",
            "seeds 0 to 11",
            "INCONSISTENT",
            "seed 7: lost",
            "gyro_x.bias",
            "0.930 (0.900 to 0.960)",
            "2.900 to 3.100",
            "outside",
        ] {
            assert!(html.contains(words), "{words}");
        }
    }
}
