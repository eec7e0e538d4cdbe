//! One small picture of each kind.

#![allow(
    dead_code,
    unreachable_pub,
    reason = "a module of test binaries that use a part of it each"
)]

use gyrocal_report::{
    Against, AgainstPanel, Bin, Comparison, Convergence, ConvergingCoefficient, Correlation,
    CorrelationPanel, DriftPrediction, Estimate, FreeRun, Gain, MarkedLine, Omitted, Picture,
    Quantity, RankedEffect, Ranking, RankingGroup, Residuals, Role, Spectrum, SpectrumPanel,
    Threshold,
};

/// A name, the picture, and words that it must show.
pub type Sample = (&'static str, Box<dyn Picture>, Vec<&'static str>);

const BAND: &str = "2 sigma (95%)";
const DAYS: &str = "time from the first sample [days]";

fn wave(count: usize, size: f64, phase: f64) -> Vec<f64> {
    (0..count)
        .map(|n| size * (0.37 * n as f64 + phase).sin())
        .collect()
}

fn times(count: usize) -> Vec<f64> {
    (0..count).map(|n| 1e9 + 600.0 * n as f64).collect()
}

/// Residuals every ten minutes.
pub fn residuals(count: usize) -> Residuals {
    Residuals {
        title: "Residuals stay in the band".to_owned(),
        subtitle: String::new(),
        time_s: times(count),
        before: [0.0, 1.0, 2.0].map(|phase| wave(count, 1e-5, phase)),
        before_label: "innovation".to_owned(),
        after: None,
        sigma: [1e-5; 3],
        quantity: "residual".to_owned(),
        unit: "g".to_owned(),
    }
}

/// All nine.
pub fn all() -> Vec<Sample> {
    let n = 400;
    let text = str::to_owned;
    vec![
        (
            "residuals",
            Box::new(residuals(n)),
            vec!["Residuals stay", BAND, DAYS, "µg", "n = 400"],
        ),
        (
            "convergence",
            Box::new(convergence(n)),
            vec![BAND, DAYS, "gyro_x.bias", "deg/h", "truth"],
        ),
        (
            "free run",
            Box::new(FreeRun {
                title: text("Free run"),
                subtitle: String::new(),
                time_s: times(n),
                measured_g: [0.0, 1.0, 2.0].map(|phase| wave(n, 0.9, phase)),
                simulated_g: [0.01, 1.0, 2.0].map(|phase| wave(n, 0.9, phase)),
                sigma_g: [1e-5; 3],
            }),
            vec!["measured less simulated", BAND, "specific force [g]", DAYS],
        ),
        (
            "spectrum",
            Box::new(spectrum(n)),
            vec!["cycles a day", "probability 1%", "solar day"],
        ),
        (
            "correlation",
            Box::new(Correlation {
                title: text("Correlation"),
                subtitle: String::new(),
                channels: vec![CorrelationPanel {
                    name: text("x"),
                    correlation: wave(60, 0.1, 0.0),
                    band: 0.03,
                    samples: 4320,
                }],
                confidence: 0.95,
            }),
            vec![
                "white noise at one lag, 95%",
                "lag [samples]",
                "of 60 lags outside",
            ],
        ),
        (
            "against",
            Box::new(Against {
                title: text("Against"),
                subtitle: String::new(),
                quantity: text("mean residual"),
                unit: text("g"),
                panels: vec![AgainstPanel {
                    name: text("x"),
                    abscissa: text("temperature"),
                    abscissa_unit: text("°C"),
                    bins: Bin::of(&wave(n, 3.0, 0.0), &wave(n, 1e-5, 0.4), 10),
                }],
                columns: 1,
            }),
            vec!["2 standard errors (95%)", "temperature [°C]", "n = 400"],
        ),
        (
            "ranking",
            Box::new(ranking()),
            vec!["|z|", "gyro_y.g_z", "3.9", "not tested", "12 more"],
        ),
        (
            "gain",
            Box::new(Gain {
                title: text("Gain"),
                subtitle: String::new(),
                block_gain_nats: vec![3.0, -1.0, f64::NAN, 5.0],
                drift: Some(DriftPrediction {
                    time_s: times(n),
                    nominal_arcmin: wave(n, 5.0, 0.0),
                    extended_arcmin: wave(n, 0.5, 0.0),
                    expected_arcmin: Some(vec![0.2; n]),
                }),
            }),
            vec![
                "[nats]",
                "[arc minutes]",
                "sum 7.00 nats, 3 blocks",
                "to be expected of the extended model",
            ],
        ),
        (
            "comparison",
            Box::new(comparison()),
            vec![BAND, "smoother", "gyro_x.bias", "deg/h"],
        ),
    ]
}

fn convergence(n: usize) -> Convergence {
    let coefficient = |name: &str, reference| ConvergingCoefficient {
        name: name.to_owned(),
        unit: "deg/h".to_owned(),
        estimate: (0..n).map(|k| 0.1 + (1.0 / (k as f64 + 1.0))).collect(),
        sigma: (0..n).map(|k| 1.0 / (k as f64 + 1.0)).collect(),
        reference,
        rival: reference.map(|value| [vec![value; n], vec![0.1; n]]),
    };
    Convergence {
        title: "Convergence".to_owned(),
        subtitle: String::new(),
        time_s: times(n),
        coefficients: vec![
            coefficient("gyro_x.bias", Some(0.1)),
            coefficient("gyro_y.bias", None),
        ],
        columns: 3,
        reference_label: "truth".to_owned(),
        estimate_label: "extended".to_owned(),
        rival_label: "nominal".to_owned(),
    }
}

fn spectrum(n: usize) -> Spectrum {
    Spectrum {
        title: "Spectrum".to_owned(),
        subtitle: String::new(),
        frequency_per_day: (0..n).map(|k| k as f64 / 14.0).collect(),
        channels: vec![SpectrumPanel {
            name: "x".to_owned(),
            power: wave(n, 1.0, 0.0).into_iter().map(f64::abs).collect(),
            samples: n,
            threshold: Some(Threshold {
                power: 12.0,
                false_alarm_probability: 0.01,
            }),
        }],
        quantity: "power".to_owned(),
        unit: "g²".to_owned(),
        marks: vec![MarkedLine {
            frequency_per_day: 1.0,
            label: "solar day".to_owned(),
        }],
    }
}

fn ranking() -> Ranking {
    let effect = |effect: &str, statistic, role| RankedEffect {
        effect: effect.to_owned(),
        statistic,
        role,
        note: String::new(),
    };
    Ranking {
        title: "Ranking".to_owned(),
        subtitle: String::new(),
        statistic: "|z|".to_owned(),
        threshold: 3.9,
        false_alarm_probability: 0.01,
        tested: 15,
        groups: vec![RankingGroup {
            label: "finding 1".to_owned(),
            effects: vec![
                effect("gyro_y.g_z", 18.9, Role::Named),
                effect("gyro_y.g_yz", 18.7, Role::Rival),
                effect("gyro_x.temperature", f64::NAN, Role::Other),
            ],
        }],
        omitted: Some(Omitted {
            effects: 12,
            largest: 1.7,
        }),
    }
}

fn comparison() -> Comparison {
    let estimate = |value| Estimate { value, sigma: 1e-3 };
    Comparison {
        title: "Comparison".to_owned(),
        subtitle: String::new(),
        estimators: ["filter", "smoother"].map(str::to_owned).into(),
        quantities: vec![Quantity {
            name: "gyro_x.bias".to_owned(),
            unit: "deg/h".to_owned(),
            reference: Some(0.031),
            estimates: [0.030, 0.0312].map(estimate).into(),
        }],
        columns: 3,
        reference_label: "truth".to_owned(),
    }
}
