//! Panels that the pages of all models have: measured and simulated values over time, what the models leave
//! of them, and its correlation over rows.

use gyrocal_document::{Band, Chart, Item, Line, LineKind, Panel, Section, TimeAxis, Tint};

use crate::words::section;

/// Names of the models in legends.
pub(crate) const NOMINAL: &str = "nominal model";
pub(crate) const EXTENDED: &str = "extended model";

/// A line drawn through.
pub(crate) fn line(label: &str, tint: Tint, values: Vec<f64>) -> Line {
    Line::new(label, tint, LineKind::Solid, values)
}

/// Lines of the nominal and of the extended model.
pub(crate) fn of_models(nominal: Vec<f64>, extended: Option<Vec<f64>>) -> Vec<Line> {
    let mut lines = vec![line(NOMINAL, Tint::Nominal, nominal)];
    lines.extend(extended.map(|values| line(EXTENDED, Tint::Extended, values)));
    lines
}

/// The sections over time of charts of simulations and of their residuals, each with what it shows.
pub(crate) fn sections(leads: [&str; 2], [simulated, left]: [Vec<Chart>; 2]) -> [Section; 2] {
    let of = |id: &str, title: &str, lead: &str, charts: Vec<Chart>| {
        section(
            id,
            title,
            lead,
            charts.into_iter().map(Item::Chart).collect(),
        )
    };
    let title = "Simulation against measurement";
    [
        of("simulation", title, leads[0], simulated),
        of("residual", "Open-loop residual", leads[1], left),
    ]
}

/// Panels in a row, at most.
pub(crate) const COLUMNS: usize = 3;

/// A chart over the time of a record.
pub(crate) fn over_time(title: String, time: &TimeAxis, panels: Vec<Panel>) -> Chart {
    Chart {
        title,
        abscissa: "time from the first row".to_owned(),
        abscissa_unit: time.unit.to_owned(),
        columns: panels.len().clamp(1, COLUMNS),
        panels,
        height_px: 240,
        ..Chart::default()
    }
}

/// Measured values with simulations of them.
pub(crate) fn simulation(
    name: String,
    abscissa: &[f64],
    measured: Vec<f64>,
    (nominal, extended): (Vec<f64>, Option<Vec<f64>>),
) -> Panel {
    let mut lines = vec![line("measured", Tint::Measured, measured)];
    lines.extend(of_models(nominal, extended));
    Panel {
        name,
        abscissa: abscissa.to_vec(),
        lines,
        ..Panel::default()
    }
}

/// A symmetric band of what is expected of a right model, from its half width.
pub(crate) fn band(label: &str, half_width: &[f64]) -> Band {
    let lower = half_width.iter().map(|half| -half).collect();
    Band::new(label, Tint::Expected, [lower, half_width.to_vec()])
}

/// The band of two standard deviations about values, each given with its standard deviation.
pub(crate) fn two_sigmas(
    label: &str,
    tint: Tint,
    values: impl Iterator<Item = (f64, f64)> + Clone,
) -> Band {
    let edge = |sign: f64| {
        let values = values.clone();
        values
            .map(|(value, sigma)| value + sign * 2.0 * sigma)
            .collect()
    };
    Band::new(label, tint, [edge(-1.0), edge(1.0)])
}

/// Correlations of both models at the lags from one on.
pub(crate) fn correlation(
    name: String,
    note: String,
    half_width: f64,
    (nominal, extended): (Vec<f64>, Option<Vec<f64>>),
) -> Panel {
    let lags = nominal.len();
    Panel {
        name,
        note: note.replace('-', "−"),
        abscissa: (1..=lags).map(|lag| lag as f64).collect(),
        bands: vec![band(
            "95 % band of white innovations",
            &vec![half_width; lags],
        )],
        lines: of_models(nominal, extended),
        no_gaps: true,
        ..Panel::default()
    }
}

/// Autocorrelations over rows, with the counts of those outside of the band, and of all.
pub(crate) fn correlations(panels: Vec<Panel>) -> Chart {
    let of = |model: &'static str| {
        let lines = panels
            .iter()
            .flat_map(|panel| panel.lines.iter().zip(panel.bands.iter().cycle()));
        let own = lines.filter(move |(line, _)| line.label == model);
        own.flat_map(|(line, band)| line.values.iter().zip(&band.upper))
    };
    let outside = |model| {
        of(model)
            .filter(|(value, half)| value.abs() > **half)
            .count()
    };
    let (nominal, known) = (outside(NOMINAL), of(NOMINAL));
    let total = known.filter(|(value, _)| !value.is_nan()).count();
    let of_models = of(EXTENDED).next().map(|_| {
        let extended = outside(EXTENDED);
        format!(" for the nominal model, {extended} for the extended one")
    });
    let of_models = of_models.unwrap_or_default();
    let by_chance = total / 20;
    Chart {
        title: format!("{nominal} of {total} autocorrelations outside the 95 % band{of_models}"),
        caption: format!("One in twenty is outside by chance: {by_chance} of {total}."),
        abscissa: "lag".to_owned(),
        abscissa_unit: "rows".to_owned(),
        quantity: "correlation".to_owned(),
        same_scale: true,
        columns: panels.len().clamp(1, COLUMNS),
        panels,
        height_px: 190,
        ..Chart::default()
    }
}
