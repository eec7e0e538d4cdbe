//! Small pictures of each kind.

#![allow(
    dead_code,
    unreachable_pub,
    reason = "a module of binaries that use a part of it each"
)]

use gyrocal_document::{
    Band, Bar, BarGroup, Bars, Chart, EstimateRow, Estimates, Level, Line, LineKind, Mark, Panel,
    Tint, ValueWithSigma,
};
use gyrocal_report::Picture;

/// A name, the picture, and words that it must show.
pub type Sample = (&'static str, Box<dyn Picture>, Vec<&'static str>);

const BAND: &str = "±2σ (95%)";
const AXES: [(&str, f64); 3] = [("x", 0.0), ("y", 1.0), ("z", 2.0)];

fn wave(count: usize, size: f64, phase: f64) -> Vec<f64> {
    (0..count)
        .map(|n| size * (0.37 * n as f64 + phase).sin())
        .collect()
}

/// Days of rows every ten minutes.
fn days(count: usize) -> Vec<f64> {
    (0..count).map(|n| n as f64 / 144.0).collect()
}

fn line(label: &str, tint: Tint, kind: LineKind, values: Vec<f64>) -> Line {
    Line {
        label: label.to_owned(),
        tint,
        kind,
        values,
    }
}

fn band(middle: &[f64], half: &[f64]) -> Band {
    let edge = |sign: f64| {
        let pairs = middle.iter().zip(half);
        pairs.map(|(middle, half)| middle + sign * half).collect()
    };
    Band {
        label: BAND.to_owned(),
        tint: Tint::Expected,
        lower: edge(-1.0),
        upper: edge(1.0),
    }
}

/// Residuals every ten minutes.
pub fn residuals(count: usize) -> Chart {
    let panels = AXES.map(|(name, phase)| Panel {
        name: name.to_owned(),
        note: format!("n = {count}"),
        abscissa: days(count),
        bands: vec![band(&vec![0.0; count], &vec![2e-5; count])],
        lines: vec![line(
            "innovation",
            Tint::Nominal,
            LineKind::Solid,
            wave(count, 1e-5, phase),
        )],
        ..Panel::default()
    });
    Chart {
        title: "Residuals stay in the band".to_owned(),
        caption: "How to read it.".to_owned(),
        abscissa: "time from the first row".to_owned(),
        abscissa_unit: "days".to_owned(),
        quantity: "residual".to_owned(),
        unit: "g".to_owned(),
        same_scale: true,
        cut_extremes: true,
        columns: 1,
        height_px: 150,
        panels: panels.into(),
        ..Chart::default()
    }
}

/// One of each kind.
pub fn all() -> Vec<Sample> {
    let n = 400;
    vec![
        (
            "residuals",
            Box::new(residuals(n)),
            vec![
                "Residuals stay",
                "How to read it.",
                BAND,
                "time from the first row [days]",
                "µg",
                "n = 400",
            ],
        ),
        (
            "convergence",
            Box::new(convergence(n)),
            vec![BAND, "length [days]", "gyro_x.bias", "deg/h", "truth"],
        ),
        (
            "spectrum",
            Box::new(spectrum(n)),
            vec![
                "cycles/day",
                "detection threshold",
                "solar day",
                "24.1 h",
                "power [g²]",
            ],
        ),
        (
            "covariates",
            Box::new(covariates()),
            vec!["temperature [°C]", "specific force x [g]", "bin mean"],
        ),
        (
            "blocks",
            Box::new(blocks()),
            vec!["gain [nats]", "extended model predicts better"],
        ),
        (
            "ranking",
            Box::new(ranking()),
            vec!["|z|", "gyro_y.g_z", "3.9", "not determined", "12 more"],
        ),
        (
            "estimates",
            Box::new(estimates()),
            vec![BAND, "smoother", "gyro_x.bias", "deg/h", "truth"],
        ),
    ]
}

fn convergence(n: usize) -> Chart {
    let panel = |name: &str| {
        let sigma: Vec<f64> = (0..n).map(|k| 1.0 / (k as f64 + 1.0)).collect();
        let estimate: Vec<f64> = sigma.iter().map(|sigma| 0.1 + sigma).collect();
        let half: Vec<f64> = sigma.iter().map(|sigma| 2.0 * sigma).collect();
        Panel {
            name: name.to_owned(),
            unit: Some("deg/h".to_owned()),
            abscissa: days(n),
            bands: vec![band(&estimate, &half)],
            lines: vec![line("estimate", Tint::Extended, LineKind::Solid, estimate)],
            levels: vec![Level {
                label: "truth".to_owned(),
                value: 0.1,
            }],
            scale_from: Some(1.0),
            ..Panel::default()
        }
    };
    Chart {
        title: "Convergence".to_owned(),
        abscissa: "length".to_owned(),
        abscissa_unit: "days".to_owned(),
        columns: 3,
        height_px: 170,
        panels: vec![panel("gyro_x.bias"), panel("gyro_y.bias")],
        ..Chart::default()
    }
}

fn spectrum(n: usize) -> Chart {
    let mark = |label: &str, value| Mark {
        label: label.to_owned(),
        value,
    };
    Chart {
        title: "Spectrum".to_owned(),
        abscissa: "frequency".to_owned(),
        abscissa_unit: "cycles/day".to_owned(),
        logarithmic_abscissa: true,
        quantity: "power".to_owned(),
        unit: "g²".to_owned(),
        logarithmic: true,
        columns: 1,
        height_px: 210,
        panels: vec![Panel {
            name: "x".to_owned(),
            abscissa: (0..n).map(|k| k as f64 / 14.0).collect(),
            lines: vec![line(
                "periodogram",
                Tint::Nominal,
                LineKind::Solid,
                wave(n, 1.0, 0.0).into_iter().map(f64::abs).collect(),
            )],
            levels: vec![Level {
                label: "detection threshold".to_owned(),
                value: 12.0,
            }],
            marks: vec![mark("solar day", 1.0), mark("24.1 h", 0.996)],
            no_gaps: true,
            ..Panel::default()
        }],
        ..Chart::default()
    }
}

fn covariates() -> Chart {
    let panel = |quantity: &str, unit: &str| {
        let means = wave(24, 1e-5, 0.4);
        Panel {
            name: "x".to_owned(),
            own_abscissa: Some((quantity.to_owned(), unit.to_owned())),
            abscissa: (0..24).map(f64::from).collect(),
            bands: vec![band(&means, &[3e-6; 24])],
            lines: vec![line("bin mean", Tint::Nominal, LineKind::Points, means)],
            ..Panel::default()
        }
    };
    Chart {
        title: "Covariates".to_owned(),
        quantity: "mean residual".to_owned(),
        unit: "g".to_owned(),
        same_scale: true,
        unlinked: true,
        columns: 2,
        height_px: 190,
        panels: vec![panel("specific force x", "g"), panel("temperature", "°C")],
        ..Chart::default()
    }
}

fn blocks() -> Chart {
    let bars =
        |label: &str, tint, values: [f64; 10]| line(label, tint, LineKind::Bars, values.to_vec());
    let none = f64::NAN;
    Chart {
        title: "Gain".to_owned(),
        abscissa: "held-out block".to_owned(),
        quantity: "gain".to_owned(),
        unit: "nats".to_owned(),
        columns: 1,
        height_px: 180,
        panels: vec![Panel {
            name: "cross-validation".to_owned(),
            abscissa: (1..=10).map(f64::from).collect(),
            lines: vec![
                bars(
                    "extended model predicts better",
                    Tint::Extended,
                    [3.0, none, 5.0, 4.0, none, 2.0, 6.0, 1.0, 2.0, 3.0],
                ),
                bars(
                    "nominal model predicts better",
                    Tint::Nominal,
                    [none, -1.0, none, none, none, none, none, none, none, none],
                ),
            ],
            no_gaps: true,
            ..Panel::default()
        }],
        ..Chart::default()
    }
}

fn ranking() -> Bars {
    let bar = |label: &str, value, tint| Bar {
        label: label.to_owned(),
        value,
        tint,
        note: String::new(),
    };
    Bars {
        title: "Ranking".to_owned(),
        quantity: "|z|".to_owned(),
        threshold: Some((3.9, "detection threshold 3.9".to_owned())),
        groups: vec![BarGroup {
            label: "finding 1".to_owned(),
            bars: vec![
                bar("gyro_y.g_z", 18.9, Tint::Extended),
                bar("gyro_y.g_yz", 18.7, Tint::Alternative),
                bar("gyro_x.temperature", f64::NAN, Tint::Other),
            ],
        }],
        omitted: "12 more are not shown.".to_owned(),
    }
}

fn estimates() -> Estimates {
    let models = [
        ("truth", Tint::Measured),
        ("filter", Tint::Nominal),
        ("smoother", Tint::Extended),
    ];
    let row = |name: &str| {
        let values = [(0.031, f64::NAN), (0.030, 1e-3), (0.0312, 1e-3)];
        EstimateRow {
            name: name.to_owned(),
            unit: "deg/h".to_owned(),
            values: values
                .map(|(value, sigma)| ValueWithSigma { value, sigma })
                .into(),
            note: String::new(),
            strong: false,
        }
    };
    Estimates {
        title: "Estimates".to_owned(),
        models: models.map(|(name, tint)| (name.to_owned(), tint)).into(),
        rows: vec![row("gyro_x.bias"), row("gyro_y.bias")],
        note_head: String::new(),
    }
}
