//! One small picture of each kind.

#![allow(
    dead_code,
    unreachable_pub,
    reason = "a module of test binaries that use a part of it each"
)]

use gyrocal_report::page::Tint;
use gyrocal_report::{
    Bin, ComparedEstimate, ComparedQuantity, Comparison, Convergence, Correlation,
    CorrelationChannel, CovariatePanel, CrossValidation, EstimateHistory, MarkedFrequency, Omitted,
    OpenLoop, OpenLoopChannel, ParameterHistory, Picture, PowerThreshold, PredictionError,
    RankedEffect, Ranking, RankingGroup, ResidualChannel, ResidualVsCovariate, Residuals, Role,
    Spectrum, SpectrumChannel,
};

/// A name, the picture, and words that it must show.
pub type Sample = (&'static str, Box<dyn Picture>, Vec<&'static str>);

const BAND: &str = "±2σ (95%)";
const DAYS: &str = "time from the first sample [days]";

fn wave(count: usize, size: f64, phase: f64) -> Vec<f64> {
    (0..count)
        .map(|n| size * (0.37 * n as f64 + phase).sin())
        .collect()
}

fn times(count: usize) -> Vec<f64> {
    (0..count).map(|n| 1e9 + 600.0 * n as f64).collect()
}

const AXES: [(&str, f64); 3] = [("x", 0.0), ("y", 1.0), ("z", 2.0)];

/// Residuals every ten minutes.
pub fn residuals(count: usize) -> Residuals {
    Residuals {
        title: "Residuals stay in the band".to_owned(),
        subtitle: String::new(),
        time_s: times(count),
        channels: AXES
            .map(|(name, phase)| ResidualChannel {
                name: name.to_owned(),
                before: wave(count, 1e-5, phase),
                after: None,
                sigma: 1e-5,
            })
            .into(),
        before_label: "innovation".to_owned(),
        after_label: String::new(),
        quantity: "residual".to_owned(),
        unit: "g".to_owned(),
    }
}

/// One of each kind but one.
#[expect(clippy::too_many_lines, reason = "a table of pictures")]
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
            "open loop",
            Box::new(open_loop(n)),
            vec!["measured minus simulated", BAND, "specific force [g]", DAYS],
        ),
        (
            "spectrum",
            Box::new(spectrum(n)),
            vec!["cycles/day", "probability 1%", "solar day"],
        ),
        (
            "correlation",
            Box::new(Correlation {
                title: text("Correlation"),
                subtitle: String::new(),
                channels: vec![CorrelationChannel {
                    name: text("x"),
                    correlation: wave(60, 0.1, 0.0),
                    band: 0.03,
                    samples: 4320,
                    tint: Tint::Nominal,
                }],
                confidence: 0.95,
            }),
            vec![
                "white noise, 95% at each lag",
                "lag [samples]",
                "of 60 lags outside",
            ],
        ),
        (
            "residual against covariate",
            Box::new(ResidualVsCovariate {
                title: text("Covariate"),
                subtitle: String::new(),
                quantity: text("mean residual"),
                unit: text("g"),
                panels: vec![CovariatePanel {
                    name: text("x"),
                    covariate: text("temperature"),
                    covariate_unit: text("°C"),
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
            "cross-validation",
            Box::new(CrossValidation {
                title: text("Cross-validation"),
                subtitle: String::new(),
                block_gain_nats: vec![3.0, -1.0, f64::NAN, 5.0],
                prediction: Some(PredictionError {
                    name: text("Later record"),
                    quantity: text("drift prediction error"),
                    unit: text("arcmin"),
                    time_s: times(n),
                    nominal: wave(n, 5.0, 0.0),
                    extended: wave(n, 0.5, 0.0),
                    expected: Some(vec![0.2; n]),
                }),
            }),
            vec![
                "[nats]",
                "drift prediction error [arcmin]",
                "sum 7.00 nats, 3 blocks",
                "expected for the extended model",
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
    let parameter = |name: &str, reference: Option<f64>| ParameterHistory {
        name: name.to_owned(),
        unit: "deg/h".to_owned(),
        estimates: EstimateHistory {
            estimate: (0..n).map(|k| 0.1 + (1.0 / (k as f64 + 1.0))).collect(),
            sigma: (0..n).map(|k| 1.0 / (k as f64 + 1.0)).collect(),
        },
        reference,
        second: reference.map(|value| EstimateHistory {
            estimate: vec![value; n],
            sigma: vec![0.1; n],
        }),
    };
    Convergence {
        title: "Convergence".to_owned(),
        subtitle: String::new(),
        time_s: times(n),
        parameters: vec![
            parameter("gyro_x.bias", Some(0.1)),
            parameter("gyro_y.bias", None),
        ],
        columns: 3,
        reference_label: "truth".to_owned(),
        estimate_label: "extended".to_owned(),
        second_label: "nominal".to_owned(),
    }
}

fn open_loop(n: usize) -> OpenLoop {
    OpenLoop {
        title: "Open loop".to_owned(),
        subtitle: String::new(),
        time_s: times(n),
        channels: AXES
            .map(|(name, phase)| OpenLoopChannel {
                name: name.to_owned(),
                measured: wave(n, 0.9, phase),
                simulated: wave(n, 0.9, phase.max(0.01)),
                sigma: 1e-5,
            })
            .into(),
        quantity: "specific force".to_owned(),
        unit: "g".to_owned(),
    }
}

fn spectrum(n: usize) -> Spectrum {
    Spectrum {
        title: "Spectrum".to_owned(),
        subtitle: String::new(),
        frequency: (0..n).map(|k| k as f64 / 14.0).collect(),
        frequency_unit: "cycles/day".to_owned(),
        channels: vec![SpectrumChannel {
            name: "x".to_owned(),
            power: wave(n, 1.0, 0.0).into_iter().map(f64::abs).collect(),
            samples: n,
            tint: Tint::Extended,
            threshold: Some(PowerThreshold {
                power: 12.0,
                false_alarm_probability: 0.01,
            }),
        }],
        quantity: "power".to_owned(),
        unit: "g²".to_owned(),
        marks: vec![MarkedFrequency {
            frequency: 1.0,
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
                effect("gyro_y.g_z", 18.9, Role::Reported),
                effect("gyro_y.g_yz", 18.7, Role::Alternative),
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
    let estimate = |value| ComparedEstimate { value, sigma: 1e-3 };
    Comparison {
        title: "Comparison".to_owned(),
        subtitle: String::new(),
        estimators: ["filter", "smoother"].map(str::to_owned).into(),
        quantities: vec![ComparedQuantity {
            name: "gyro_x.bias".to_owned(),
            unit: "deg/h".to_owned(),
            reference: Some(0.031),
            estimates: [0.030, 0.0312].map(estimate).into(),
        }],
        columns: 3,
        tints: Vec::new(),
        reference_label: "truth".to_owned(),
    }
}
