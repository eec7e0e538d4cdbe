//! Draws every picture from made-up data: `cargo run -p gyrocal-report --example gallery DIR`.

use std::error::Error;
use std::path::{Path, PathBuf};

use gyrocal_record::AXES;
use gyrocal_report::page::Tint;
use gyrocal_report::{
    Bin, ComparedEstimate, ComparedQuantity, Comparison, Convergence, Correlation,
    CorrelationChannel, CovariatePanel, CrossValidation, EstimateHistory, MarkedFrequency, Omitted,
    OpenLoop, OpenLoopChannel, ParameterHistory, Picture, PowerThreshold, PredictionError,
    RankedEffect, Ranking, RankingGroup, ResidualChannel, ResidualVsCovariate, Residuals, Role,
    Spectrum, SpectrumChannel, write_png, write_svg,
};
use gyrocal_statistics::deviates::Draw;

const STEP_S: f64 = 60.0;
const DAY_S: f64 = 86_400.0;
const SIDEREAL_DAY_S: f64 = 86_164.1;
const COEFFICIENTS: [(&str, &str); 3] = [("bias", "deg/h"), ("g", "deg/h/g"), ("gg", "deg/h/g²")];

fn main() -> Result<(), Box<dyn Error>> {
    let directory = std::env::args().nth(1).map(PathBuf::from);
    let directory = directory.ok_or("name a directory for the pictures")?;
    std::fs::create_dir_all(&directory)?;
    let mut noise = Draw::new(1, 0);
    let pictures: [(&str, Box<dyn Picture>); 9] = [
        ("convergence", Box::new(convergence(&mut noise))),
        ("residuals", Box::new(residuals(&mut noise))),
        ("open-loop", Box::new(open_loop(&mut noise))),
        ("spectrum", Box::new(spectrum(&mut noise))),
        ("correlation", Box::new(correlation(&mut noise))),
        (
            "residual-vs-covariate",
            Box::new(residual_vs_covariate(&mut noise)),
        ),
        ("ranking", Box::new(ranking())),
        ("cross-validation", Box::new(cross_validation(&mut noise))),
        ("comparison", Box::new(comparison(&mut noise))),
    ];
    for (name, picture) in &pictures {
        draw(picture.as_ref(), &directory.join(name))?;
    }
    Ok(())
}

fn draw(picture: &dyn Picture, stem: &Path) -> Result<(), gyrocal_report::Error> {
    write_svg(picture, &stem.with_extension("svg"))?;
    write_png(picture, &stem.with_extension("png"), 1920)
}

/// Times of three days without a few hours of the second.
fn times() -> Vec<f64> {
    let all = (0..4320).map(|row| f64::from(row) * STEP_S);
    all.filter(|time| !(1.55 * DAY_S..1.7 * DAY_S).contains(time))
        .collect()
}

fn sidereal(time_s: f64) -> f64 {
    std::f64::consts::TAU * time_s / SIDEREAL_DAY_S
}

fn convergence(noise: &mut Draw) -> Convergence {
    let time_s = times();
    let mut parameters = Vec::new();
    for (power, (kind, unit)) in COEFFICIENTS.into_iter().enumerate() {
        for axis in AXES {
            let size = 10f64.powi(-(power as i32));
            let truth = 0.1 * size * noise.normal();
            let start = noise.normal();
            let sigma = |time: f64| size / (1.0 + (time / 9000.0).powf(1.8) * 3.0);
            let estimate =
                |t: f64| truth + sigma(t) * (start + 0.5 * (sidereal(t) * 2.0).sin()) / 1.5;
            parameters.push(ParameterHistory {
                name: format!("gyro_{axis}.{kind}"),
                unit: unit.to_owned(),
                estimates: EstimateHistory {
                    estimate: time_s.iter().map(|&time| estimate(time)).collect(),
                    sigma: time_s.iter().map(|&time| sigma(time)).collect(),
                },
                reference: Some(truth),
                second: None,
            });
        }
    }
    Convergence {
        title: "All nine coefficients settle within a day".to_owned(),
        subtitle: "Streaming filter, three days at 60 s, latitude 39.1°".to_owned(),
        time_s,
        parameters,
        columns: 3,
        reference_label: "true value".to_owned(),
        estimate_label: String::new(),
        second_label: String::new(),
    }
}

fn residuals(noise: &mut Draw) -> Residuals {
    let time_s = times();
    let sigma = 1e-5;
    let mut white = || -> Vec<f64> {
        let values: Vec<f64> = time_s.iter().map(|_| noise.normal()).collect();
        values.into_iter().map(|value| sigma * value).collect()
    };
    let after: [Vec<f64>; 3] = std::array::from_fn(|_| white());
    let sizes = [2.0e-5, 6.0e-5, 0.0];
    let mut before: [Vec<f64>; 3] = std::array::from_fn(|axis| {
        let pairs = time_s.iter().zip(&after[axis]);
        pairs
            .map(|(&time, value)| value + sizes[axis] * (sidereal(time) + axis as f64).sin())
            .collect()
    });
    before[2][1000] = 9e-4;
    before[2][3000] = -7e-4;
    Residuals {
        title: "The residual of y follows the sidereal day until gyro_y.g_z is in the model"
            .to_owned(),
        subtitle: "One-step innovations".to_owned(),
        time_s,
        channels: AXES
            .iter()
            .zip(before.into_iter().zip(after))
            .map(|(name, (before, after))| ResidualChannel {
                name: (*name).to_owned(),
                before,
                after: Some(after),
                sigma,
            })
            .collect(),
        before_label: "nominal model".to_owned(),
        after_label: "with gyro_y.g_z".to_owned(),
        quantity: "residual".to_owned(),
        unit: "g".to_owned(),
    }
}

fn open_loop(noise: &mut Draw) -> OpenLoop {
    let time_s = times();
    let channels = AXES.iter().enumerate().map(|(axis, name)| {
        let phase = 2.1 * axis as f64;
        let simulated = time_s
            .iter()
            .map(|&time| 0.8 * (sidereal(time) + phase).cos());
        let simulated: Vec<f64> = simulated.collect();
        let measured = time_s.iter().zip(&simulated).map(|(&time, value)| {
            let error = 1.5e-3 * time / DAY_S * (sidereal(time) + phase).sin();
            value + error + 1e-5 * noise.normal()
        });
        OpenLoopChannel {
            name: (*name).to_owned(),
            measured: measured.collect(),
            simulated,
            sigma: 1e-5,
        }
    });
    OpenLoop {
        title: "The open-loop simulation diverges by 5 mg in three days".to_owned(),
        subtitle: "Nominal model from the first sample on, without measurement updates".to_owned(),
        channels: channels.collect(),
        time_s,
        quantity: "specific force".to_owned(),
        unit: "g".to_owned(),
    }
}

fn spectrum(noise: &mut Draw) -> Spectrum {
    let days = 14.0;
    let frequency: Vec<f64> = (0..10_080).map(|bin| f64::from(bin) / days).collect();
    let mut power = |line: f64| -> Vec<f64> {
        let powers = frequency.iter().map(|frequency| {
            let distance = (frequency - 24.0 / 5.3) * days;
            let peak = line / (1.0 + 4.0 * distance * distance);
            let (a, b) = (noise.normal(), noise.normal());
            0.5 * (a * a + b * b) + peak
        });
        powers.collect()
    };
    let threshold = Some(PowerThreshold {
        power: 13.8,
        false_alarm_probability: 0.01,
    });
    let channels = [("x", 0.0), ("y", 90.0), ("z", 0.0)];
    let channels = channels.map(|(name, line)| SpectrumChannel {
        name: name.to_owned(),
        power: power(line),
        samples: 20_160,
        tint: Tint::Nominal,
        threshold,
    });
    let mark = |frequency: f64, label: &str| MarkedFrequency {
        frequency,
        label: label.to_owned(),
    };
    Spectrum {
        title: "One spectral line: 5.3 h in y".to_owned(),
        subtitle: "Normalised innovations of fourteen days".to_owned(),
        frequency: frequency.clone(),
        frequency_unit: "cycles/day".to_owned(),
        channels: channels.into(),
        quantity: "power".to_owned(),
        unit: String::new(),
        marks: vec![
            mark(1.0, "solar day"),
            mark(DAY_S / SIDEREAL_DAY_S, "sidereal day"),
            mark(2.0 * DAY_S / SIDEREAL_DAY_S, "half of it"),
            mark(24.0 / 5.3, "5.3 h"),
        ],
    }
}

fn correlation(noise: &mut Draw) -> Correlation {
    let band = 1.96 / 4320f64.sqrt();
    let mut channel = |name: &str, first: f64| CorrelationChannel {
        name: name.to_owned(),
        correlation: (1..=100)
            .map(|lag| first.powi(lag) + 0.5 * band * noise.normal())
            .collect(),
        band,
        samples: 4320,
        tint: Tint::Nominal,
    };
    Correlation {
        title: "The noise of z is autocorrelated".to_owned(),
        subtitle: String::new(),
        channels: vec![channel("x", 0.0), channel("y", 0.0), channel("z", 0.3)],
        confidence: 0.95,
    }
}

fn residual_vs_covariate(noise: &mut Draw) -> ResidualVsCovariate {
    let time_s = times();
    let mut panels = Vec::new();
    for (row, axis) in AXES.into_iter().enumerate() {
        let residual: Vec<f64> = time_s
            .iter()
            .map(|&t| {
                let slope = if row == 1 { 8e-6 } else { 0.0 };
                1e-5 * noise.normal() + slope * (sidereal(t) + 2.0).cos()
            })
            .collect();
        for (column, name) in ["specific force z", "time", "temperature"]
            .into_iter()
            .enumerate()
        {
            let covariate: Vec<f64> = match column {
                0 => time_s
                    .iter()
                    .map(|&t| 0.8 * (sidereal(t) + 2.0).cos())
                    .collect(),
                1 => time_s.iter().map(|t| t / DAY_S).collect(),
                _ => time_s
                    .iter()
                    .map(|&t| 24.0 + 1.5 * (sidereal(t) + 0.7).sin())
                    .collect(),
            };
            panels.push(CovariatePanel {
                name: format!("residual of {axis}"),
                covariate: name.to_owned(),
                covariate_unit: ["g", "days", "°C"][column].to_owned(),
                bins: Bin::of(&covariate, &residual, 24),
            });
        }
    }
    ResidualVsCovariate {
        title: "The residual of y follows the specific force along z".to_owned(),
        subtitle: String::new(),
        quantity: "mean residual".to_owned(),
        unit: "g".to_owned(),
        panels,
        columns: 3,
    }
}

fn ranking() -> Ranking {
    let effect = |effect: &str, statistic: f64, role: Role, note: &str| RankedEffect {
        effect: effect.to_owned(),
        statistic,
        role,
        note: note.to_owned(),
    };
    let group = |label: &str, effects: Vec<RankedEffect>| RankingGroup {
        label: label.to_owned(),
        effects,
    };
    Ranking {
        title: "gyro_y.g_z is detected; two alternatives are not distinguishable".to_owned(),
        subtitle: "Score tests on fourteen days".to_owned(),
        statistic: "|z|".to_owned(),
        threshold: 3.87,
        false_alarm_probability: 0.01,
        tested: 91,
        groups: vec![
            group(
                "finding 1, 95% confidence set",
                vec![
                    effect("gyro_y.g_z", 18.9, Role::Reported, "0.0035 deg/h/g"),
                    effect(
                        "gyro_y.g_yz",
                        18.7,
                        Role::Alternative,
                        "log likelihood 3.6 nats lower",
                    ),
                    effect(
                        "gyro_xy.axis_misalignment",
                        18.4,
                        Role::Alternative,
                        "log likelihood 9.1 nats lower",
                    ),
                ],
            ),
            group(
                "after finding 1",
                vec![
                    effect("accel_x.scale", 2.61, Role::Other, ""),
                    effect("gyro_z.diurnal", 2.20, Role::Other, ""),
                    effect("platform.knock", 1.74, Role::Other, ""),
                    effect(
                        "gyro_x.temperature",
                        f64::NAN,
                        Role::Other,
                        "no temperature column",
                    ),
                ],
            ),
        ],
        omitted: Some(Omitted {
            effects: 84,
            largest: 1.71,
        }),
    }
}

fn cross_validation(noise: &mut Draw) -> CrossValidation {
    let time_s: Vec<f64> = (0..1440).map(|row| f64::from(row) * STEP_S).collect();
    let part = |size: f64| -> Vec<f64> {
        let values = time_s
            .iter()
            .map(|t| size * t / DAY_S * (1.0 + 0.3 * sidereal(*t).sin()));
        values.collect()
    };
    CrossValidation {
        title: "gyro_y.g_z gains 41 nats on held-out data and reduces drift to a tenth".to_owned(),
        subtitle: "Eight contiguous blocks; drift of a later record".to_owned(),
        block_gain_nats: (0..8).map(|_| 5.0 + 4.0 * noise.normal()).collect(),
        prediction: Some(PredictionError {
            name: "Later record".to_owned(),
            quantity: "drift prediction error".to_owned(),
            unit: "arcmin".to_owned(),
            nominal: part(4.6),
            extended: part(0.4),
            expected: Some(part(0.3)),
            time_s,
        }),
    }
}

fn comparison(noise: &mut Draw) -> Comparison {
    let estimators = [
        "as printed, Euler steps",
        "plain filter",
        "streaming filter",
        "smoother",
    ];
    let mut quantities = Vec::new();
    for (power, (kind, unit)) in COEFFICIENTS.into_iter().enumerate() {
        for axis in AXES {
            let truth = 0.1 * noise.normal() / 10f64.powi(power as i32);
            let sigma = 2e-4;
            let estimates = [30.0, 1.5, 1.0, 1.0].map(|times| ComparedEstimate {
                value: truth + times * sigma * noise.normal(),
                sigma,
            });
            quantities.push(ComparedQuantity {
                name: format!("gyro_{axis}.{kind}"),
                unit: unit.to_owned(),
                reference: Some(truth),
                estimates: estimates.into(),
            });
        }
    }
    Comparison {
        title: "First-order steps are wrong by many sigma; exact ones agree".to_owned(),
        subtitle: "One record of three days".to_owned(),
        estimators: estimators.map(str::to_owned).into(),
        quantities,
        columns: 3,
        tints: Vec::new(),
        reference_label: "true value".to_owned(),
    }
}
