//! The page of Allan deviations.

mod screen;

use gyrocal_document::{Band, Chart, Item, Panel, Part, Table, Tint};
use gyrocal_instruments::{AllanColumn, AllanReport};
use gyrocal_record::Manifest;
use gyrocal_statistics::allan::NoiseFit;
use gyrocal_statistics::format;

use crate::origin::{file_name, part};
use crate::panels::line;
use crate::words::{listed, section};

/// The page of Allan deviations; `clock` is what there is to tell of the clock of the log.
#[must_use]
pub fn of_allan(manifest: &Manifest, report: &AllanReport, clock: Option<&str>) -> Part {
    let estimator = format!(
        "{}, intervals at a confidence of {}",
        gyrocal_words::capitalised(report.estimator),
        format::percent(report.confidence)
    );
    let lead = format!(
        "{estimator}. A slope of −1/2 is white noise of the rate (angle random walk), a flat part bias \
             instability, a slope of +1/2 a random walk of the rate."
    );
    let items = vec![Item::Chart(chart(report))];
    let deviations = section("deviation", "Deviations", &lead, items);
    let unit = &report.unit;
    let parts = report.columns.iter().flat_map(|column| {
        let mut items = parts(&column.name, column.noise.as_ref(), unit);
        items.extend(column.left_out.as_ref().map(|left_out| {
            let words = screen::bad_samples(left_out, unit);
            Item::text(format!(
                "{}: left out, as no noise explains it, {words}.",
                column.name
            ))
        }));
        items
    });
    let lead = "Fitted by the likelihood of the cosine transform of the samples. The flat part of a bias instability B \
                is 0.664 B.";
    let parts = section("parts", "Parts of the noise", lead, parts.collect());
    let points = report
        .columns
        .iter()
        .map(|column| points(column, report).into());
    let lead = format!("{estimator}, at each averaging time.");
    let points = section("points", "Tables", &lead, points.collect());
    let names: Vec<&str> = report.columns.iter().map(|column| &*column.name).collect();
    let (name, size) = (file_name(manifest, 0, "log"), listed(&names));
    let (first, sections) = (
        screen::first(report, clock),
        vec![deviations, parts, points],
    );
    part(manifest, name, size, first, sections)
}

fn chart(report: &AllanReport) -> Chart {
    let confidence = format::percent(report.confidence);
    let interval = format!("interval, confidence {confidence}");
    let panels = report.columns.iter().map(|column| {
        let of = |value: fn(&gyrocal_instruments::AllanColumnPoint) -> f64| -> Vec<f64> {
            column.points.iter().map(value).collect()
        };
        Panel {
            name: column.name.clone(),
            abscissa: of(|point| point.tau_s),
            bands: vec![Band::new(
                &interval,
                Tint::Measured,
                [of(|point| point.low), of(|point| point.high)],
            )],
            lines: vec![line(
                "deviation",
                Tint::Extended,
                of(|point| point.deviation),
            )],
            no_gaps: true,
            ..Panel::default()
        }
    });
    Chart {
        title: "Deviation against averaging time".to_owned(),
        caption: report.estimator.to_owned(),
        abscissa: "averaging time".to_owned(),
        abscissa_unit: "s".to_owned(),
        logarithmic_abscissa: true,
        quantity: "deviation".to_owned(),
        unit: report.unit.to_owned(),
        logarithmic: true,
        same_scale: true,
        panels: panels.collect(),
        columns: report.columns.len().clamp(1, 3),
        height_px: 300,
        ..Chart::default()
    }
}

/// The coefficients of a column with their intervals, and the test of fit.
fn parts(name: &str, noise: Option<&NoiseFit>, unit: &str) -> Vec<Item> {
    let Some(noise) = noise else {
        return vec![Item::text(format!("{name}: too few samples for a fit."))];
    };
    let rows = noise.coefficients.iter().map(|one| {
        let (estimate, interval) = match (one.estimate, one.interval) {
            (Some(estimate), Some([low, high])) if low > 0.0 => (
                format!("{estimate:.3e}"),
                format!("{low:.3e} to {high:.3e}"),
            ),
            (Some(_), Some([_, high])) => ("not visible".to_owned(), format!("below {high:.3e}")),
            _ => ("not determined".to_owned(), String::new()),
        };
        let unit = format!("{unit}{}", one.part.unit_suffix());
        [one.part.description().to_owned(), estimate, interval, unit]
    });
    let heads = "part | > coefficient | > 95 % interval | unit";
    let remark = match noise.is_described() {
        true => "",
        false => {
            " The noise is no sum of these parts, tones and a filter: no coefficient is determined. Look for \
             vibration, jumps, or a change of temperature."
        }
    };
    let p = format::p_value(noise.p_value);
    let besides = screen::besides(Some(noise), unit).into_iter();
    let besides =
        besides.map(|(label, words)| format!(" {}: {words}.", gyrocal_words::capitalised(label)));
    let besides: String = besides.collect();
    vec![
        Table::of(name, heads, rows).into(),
        Item::text(format!("{name}: test of fit: {p}.{besides}{remark}")),
    ]
}

fn points(column: &AllanColumn, report: &AllanReport) -> Table {
    let rows = column.points.iter().map(|point| {
        [
            format::short(point.tau_s, 4),
            format!("{:.4e}", point.deviation),
            format!("{:.4e}", point.low),
            format!("{:.4e}", point.high),
            format!("{:.1}", point.degrees_of_freedom),
            point.noise.to_owned(),
        ]
    });
    let heads = format!(
        "> averaging time, s | > deviation, {} | > low | > high | > degrees of freedom | noise",
        report.unit.replace('|', " ")
    );
    Table::of(&column.name, &heads, rows)
}
