//! The page of Allan deviations.

use gyrocal_document::{
    Band, Cell, Chart, Column, Item, Line, LineKind, Panel, Part, Screen, Table, Tint,
};
use gyrocal_instruments::AllanColumn;
use gyrocal_record::Manifest;
use gyrocal_statistics::allan::NoiseFit;
use gyrocal_statistics::format;

use crate::diagnosis::section;
use crate::origin::{file_name, origin};

/// Allan deviations of a log.
#[derive(Clone, Copy, Debug)]
pub struct AllanAnswer<'a> {
    /// Origin of the answer.
    pub manifest: &'a Manifest,
    /// The columns.
    pub columns: &'a [AllanColumn],
    /// Unit of the deviations.
    pub unit: &'a str,
    /// The estimator in words.
    pub estimator: &'a str,
    /// Confidence level of the intervals.
    pub confidence: f64,
}

/// The page of Allan deviations.
#[must_use]
pub fn of_allan(answer: &AllanAnswer<'_>, first: Screen) -> Part {
    let mut sections = vec![section(
        "deviation",
        "Deviations",
        &format!(
            "{}, intervals at a confidence of {}. A slope of −1/2 is white noise of the rate (angle random \
             walk), a flat part bias instability, a slope of +1/2 a random walk of the rate.",
            crate::words::capitalised(answer.estimator),
            format::percent(answer.confidence)
        ),
        vec![Item::Chart(chart(answer))],
    )];
    let tables = answer.columns.iter().filter_map(|column| {
        let noise = column.noise.as_ref()?;
        Some(Item::from(parts(&column.name, noise, answer.unit)))
    });
    let tables: Vec<Item> = tables.collect();
    if !tables.is_empty() {
        sections.push(section(
            "parts",
            "Parts of the noise",
            "Fitted with the covariances of the deviations over averaging times.",
            tables,
        ));
    }
    let points = answer
        .columns
        .iter()
        .map(|column| Item::from(points(column, answer)));
    sections.push(section(
        "points",
        "Tables",
        "The deviation at each averaging time with its confidence interval.",
        points.collect(),
    ));
    let names: Vec<&str> = answer.columns.iter().map(|column| &*column.name).collect();
    Part {
        name: file_name(answer.manifest, 0, "log"),
        size: crate::words::listed(&names),
        first,
        sections,
        origin: origin(answer.manifest),
    }
}

fn chart(answer: &AllanAnswer<'_>) -> Chart {
    let panels = answer.columns.iter().map(|column| {
        let of = |value: fn(&gyrocal_instruments::AllanColumnPoint) -> f64| -> Vec<f64> {
            column.points.iter().map(value).collect()
        };
        Panel {
            name: column.name.clone(),
            abscissa: of(|point| point.tau_s),
            bands: vec![Band {
                label: format!(
                    "interval, confidence {}",
                    format::percent(answer.confidence)
                ),
                tint: Tint::Measured,
                lower: of(|point| point.low),
                upper: of(|point| point.high),
            }],
            lines: vec![Line {
                label: "deviation".to_owned(),
                tint: Tint::Extended,
                kind: LineKind::Solid,
                values: of(|point| point.deviation),
            }],
            no_gaps: true,
            ..Panel::default()
        }
    });
    Chart {
        title: "Deviation against averaging time".to_owned(),
        caption: answer.estimator.to_owned(),
        abscissa: "averaging time".to_owned(),
        abscissa_unit: "s".to_owned(),
        logarithmic_abscissa: true,
        quantity: "deviation".to_owned(),
        unit: answer.unit.to_owned(),
        logarithmic: true,
        same_scale: true,
        panels: panels.collect(),
        columns: answer.columns.len().clamp(1, 3),
        height_px: 300,
        ..Chart::default()
    }
}

fn head(head: &str, is_number: bool) -> Column {
    Column {
        head: head.to_owned(),
        is_number,
    }
}

fn parts(name: &str, noise: &NoiseFit, unit: &str) -> Table {
    let rows = noise.coefficients.iter().map(|one| {
        let (estimate, interval) = match (one.estimate, one.interval) {
            (Some(estimate), Some([low, high])) if low > 0.0 => (
                format!("{estimate:.3e}"),
                format!("{low:.3e} to {high:.3e}"),
            ),
            (Some(_), Some([_, high])) => ("not visible".to_owned(), format!("below {high:.3e}")),
            _ => ("not determined".to_owned(), String::new()),
        };
        vec![
            Cell::from(one.part.description().to_owned()),
            Cell::from(estimate),
            Cell::from(interval),
            Cell::from(format!("{unit}{}", one.part.unit_suffix())),
        ]
    });
    Table {
        title: name.to_owned(),
        columns: vec![
            head("part", false),
            head("coefficient", true),
            head("95 % interval", true),
            head("unit", false),
        ],
        rows: rows.collect(),
    }
}

fn points(column: &AllanColumn, answer: &AllanAnswer<'_>) -> Table {
    let rows = column.points.iter().map(|point| {
        vec![
            Cell::from(format::short(point.tau_s, 4)),
            Cell::from(format!("{:.4e}", point.deviation)),
            Cell::from(format!("{:.4e}", point.low)),
            Cell::from(format!("{:.4e}", point.high)),
            Cell::from(format!("{:.1}", point.degrees_of_freedom)),
            Cell::from(point.noise.to_owned()),
        ]
    });
    Table {
        title: column.name.clone(),
        columns: vec![
            head("averaging time, s", true),
            head(&format!("deviation, {}", answer.unit), true),
            head("low", true),
            head("high", true),
            head("degrees of freedom", true),
            head("noise", false),
        ],
        rows: rows.collect(),
    }
}
