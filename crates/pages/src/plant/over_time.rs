//! Outputs over time, and tests of the innovations.

use gyrocal_answer::{Answer, NoiseLevel, OutputError, OutputTest};
use gyrocal_document::{Chart, Item, Panel, Section, Table, TimeAxis};
use gyrocal_plant::{Diagnosed, OutputCorrelation, OutputSeries, RecordSeries};
use gyrocal_statistics::format::{self, p_cell};
use gyrocal_statistics::{NORMAL_97_5, rms_of_present};

use super::{record_names, rms, with_unit};
use crate::error::PageError;
use crate::panels;
use crate::words::section;

/// Lags of the correlation of the innovations.
const LAGS: usize = 40;

/// The two sections over time: simulation against measurement, and their difference.
pub(super) fn sections(diagnosed: &Diagnosed) -> [Section; 2] {
    let answer = &diagnosed.answer;
    let names = record_names(answer);
    let series = diagnosed.series();
    let simulations = names.iter().zip(&series);
    let simulations = simulations.map(|(name, one)| simulation(name, one));
    let whole = diagnosed.is_simulated_whole();
    let residuals = names
        .iter()
        .zip(&series)
        .map(|(name, one)| residual(of_record(name, &errors(answer)), one, whole));
    let begins = if whole {
        "The plant simulated from the first row of each record on, with its inputs and without updates, and \
         what its sensors measured."
            .to_owned()
    } else {
        format!(
            "The plant simulated over {} s at a time, as its rates have noise, and what its sensors measured.",
            format::short(answer.horizon_s.unwrap_or_default(), 4)
        )
    };
    let residual_lead = if whole {
        "Measured less simulated. A right model stays within the band, which holds the noise of the sensor."
    } else {
        "Measured less simulated. The band holds the noise of the sensor; noise of the rates comes on top of it."
    };
    let charts = [simulations.collect(), residuals.collect()];
    panels::sections([&begins, residual_lead], charts)
}

/// Errors of all outputs in a title.
fn errors(answer: &Answer) -> String {
    let of = |error: &OutputError| {
        let nominal = rms(error.nominal, &error.unit);
        match answer.has_findings() {
            true => format!(
                "{}: {nominal} rms for the nominal model, {} with what was found",
                error.output,
                rms(error.extended, &error.unit)
            ),
            false => format!("{}: {nominal} rms", error.output),
        }
    };
    let all: Vec<String> = answer.open_loop.iter().map(of).collect();
    all.join("; ")
}

/// A title with the name of the record, if there are several.
fn of_record(name: &str, title: &str) -> String {
    match name {
        "" => title.to_owned(),
        name => name.to_owned(),
    }
}

fn simulation(name: &str, series: &RecordSeries) -> Chart {
    let time = TimeAxis::of(&series.time_s);
    let panel = |one: &OutputSeries| Panel {
        unit: Some(one.unit.clone()),
        ..panels::simulation(
            one.output.clone(),
            &time.values,
            one.measured.clone(),
            (one.nominal.clone(), one.extended.clone()),
        )
    };
    Chart {
        caption: "Lines may coincide at this scale.".to_owned(),
        quantity: "output".to_owned(),
        ..panels::over_time(
            of_record(name, "Outputs, measured and simulated"),
            &time,
            series.outputs.iter().map(panel).collect(),
        )
    }
}

/// Measured less simulated, with the band of the sensor's noise.
pub(super) fn residual(title: String, series: &RecordSeries, whole: bool) -> Chart {
    let time = TimeAxis::of(&series.time_s);
    let label = if whole {
        "95 % band of a right model"
    } else {
        "95 % band of the sensor's noise"
    };
    let panel = |one: &OutputSeries| {
        let (before, after) = (one.nominal_residuals(), one.extended_residuals());
        let rms = |values: &[f64]| with_unit(rms_of_present(values).0, &one.unit);
        Panel {
            name: one.output.clone(),
            note: match &after {
                Some(after) => format!("rms {} → {}", rms(&before), rms(after)),
                None => format!("rms {}", rms(&before)),
            },
            unit: Some(one.unit.clone()),
            abscissa: time.values.clone(),
            bands: vec![panels::band(
                label,
                &vec![NORMAL_97_5 * one.sigma; time.values.len()],
            )],
            lines: panels::of_models(before, after),
            ..Panel::default()
        }
    };
    Chart {
        caption: "The band has the estimated noise of the sensor, not the declared one.".to_owned(),
        quantity: "residual".to_owned(),
        cut_extremes: true,
        ..panels::over_time(title, &time, series.outputs.iter().map(panel).collect())
    }
}

/// Tests of the innovations.
pub(super) fn innovations(diagnosed: &Diagnosed) -> Result<Section, PageError> {
    let found = diagnosed.correlations(LAGS)?;
    let found = found.into_iter().filter(|one| !one.nominal.is_empty());
    let found: Vec<Panel> = found.map(correlation).collect();
    let chart = (!found.is_empty()).then(|| panels::correlations(found));
    Ok(tested(&diagnosed.answer, chart))
}

/// Tests of the innovations in a table, with a chart of their correlations if it is there.
pub(super) fn tested(answer: &Answer, chart: Option<Chart>) -> Section {
    let title =
        "Noise, and correlation over rows that the model with all findings leaves (Ljung-Box)";
    let tests = tests(title, &answer.noise, &answer.remainder.outputs);
    let mut items = vec![Item::from(tests)];
    items.extend(chart.map(Item::Chart));
    let lead = "One-step innovations of a right model are white: no correlation over rows.";
    section("residuals", "Innovations", lead, items)
}

fn correlation(one: OutputCorrelation) -> Panel {
    let note = format!("{} innovations", one.values);
    let models = (one.nominal, one.extended);
    panels::correlation(one.output, note, one.band, models)
}

/// Whiteness of what is left, and noise.
pub(super) fn tests(title: &str, noise: &[NoiseLevel], left: &[OutputTest]) -> Table {
    let rows = noise.iter().map(|noise| {
        let [low, high] = noise.interval.map(|end| format::short(end, 3));
        let mut left = left.iter();
        let left = left.find(|one| one.output == noise.channel);
        [
            noise.channel.clone(),
            format::short(noise.ratio, 3),
            format!("{low} to {high}"),
            left.map_or_else(String::new, |left| p_cell(left.p_value)),
        ]
    });
    let heads = "noise of | > over the declared one | > 95 % interval | > p of white innovations";
    Table::of(title, heads, rows)
}
