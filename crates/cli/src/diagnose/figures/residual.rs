//! Open-loop residuals, one-step innovations and the specific-force magnitude.

use gyrocal_calibration::CalibrationError;
use gyrocal_diagnosis::{DiagnosisError, magnitude_channel};
use gyrocal_report::{
    Bin, Correlation, CorrelationChannel, CovariatePanel, MarkedFrequency, OpenLoop,
    OpenLoopChannel, Picture, PowerThreshold, ResidualChannel, ResidualVsCovariate, Residuals,
    Spectrum, SpectrumChannel,
};
use gyrocal_statistics::{
    Autocorrelation, BinnedMeans, NORMAL_97_5, Periodogram, autocorrelation, periodogram,
    rms_of_present,
};

use super::{DiagnosisRun, causes, subtitle};

const AXES: [&str; 3] = ["x", "y", "z"];

/// Bins of a covariate.
const BINS: usize = 24;

/// Lags of the autocorrelation.
const LAGS: usize = 40;

/// Cycles a sidereal day, a day.
const SIDEREAL_PER_DAY: f64 = 1.002_737_9;

const SECONDS_PER_DAY: f64 = 86_400.0;

/// Open-loop simulations of the models, from the first row on without measurement updates.
pub(super) struct OpenLoopRuns {
    nominal_g: Vec<[f64; 3]>,
    extended_g: Option<Vec<[f64; 3]>>,
}

impl OpenLoopRuns {
    pub(super) fn of(found: &DiagnosisRun<'_>) -> Result<Self, CalibrationError> {
        let diagnosis = &found.diagnosis;
        Ok(Self {
            nominal_g: diagnosis.nominal.free_run_g()?,
            extended_g: diagnosis
                .extended
                .as_ref()
                .map(|extended| extended.free_run_g())
                .transpose()?,
        })
    }

    /// Measured minus simulated specific force of both models.
    pub(super) fn residuals(&self, found: &DiagnosisRun<'_>) -> Residuals {
        let before = differences(found, &self.nominal_g);
        let after = self.extended_g.as_deref().map(|g| differences(found, g));
        let miss = amount(rms(&before));
        let noise = amount(found.bench.accel_noise_g);
        let title = match (&after, causes(found)) {
            (Some(after), Some(causes)) => format!(
                "Open-loop residual: {miss} rms for the nominal model, {} with {causes}",
                amount(rms(after))
            ),
            _ => format!("Open-loop residual of the nominal model: {miss} rms, noise {noise}"),
        };
        Residuals {
            title,
            subtitle: format!(
                "measured minus simulated specific force, no measurement updates; {}",
                subtitle(found)
            ),
            time_s: found.record.time_s.clone(),
            channels: channels(before, after, found.bench.accel_noise_g),
            before_label: "nominal model".to_owned(),
            after_label: format!("with {}", causes(found).unwrap_or_default()),
            quantity: "residual".to_owned(),
            unit: "g".to_owned(),
        }
    }

    /// Open-loop simulation of the nominal model and the record.
    pub(super) fn open_loop(&self, found: &DiagnosisRun<'_>) -> OpenLoop {
        let miss = amount(rms(&differences(found, &self.nominal_g)));
        let days = found.record.duration_s() / SECONDS_PER_DAY;
        let (measured, simulated) = (columns(&found.record.accel_g), columns(&self.nominal_g));
        let channels = AXES.iter().zip(measured.into_iter().zip(simulated));
        OpenLoop {
            title: format!(
                "Open-loop simulation of the nominal model over {days:.1} days: residual {miss} rms"
            ),
            subtitle: subtitle(found),
            time_s: found.record.time_s.clone(),
            channels: channels
                .map(|(name, (measured, simulated))| OpenLoopChannel {
                    name: (*name).to_owned(),
                    measured,
                    simulated,
                    sigma: found.bench.accel_noise_g,
                })
                .collect(),
            quantity: "specific force".to_owned(),
            unit: "g".to_owned(),
        }
    }

    /// Open-loop residuals against each component of specific force, and temperature.
    pub(super) fn against_force(&self, found: &DiagnosisRun<'_>) -> ResidualVsCovariate {
        let residuals = differences(found, &self.nominal_g);
        let forces = columns(&self.nominal_g);
        let mut panels = Vec::new();
        let mut steepest = (0.0, 0, String::new());
        for (axis, residual) in residuals.iter().enumerate() {
            let mut add = |name: String, unit: &str, abscissa: &[f64]| {
                let share = explained(abscissa, residual);
                if share > steepest.0 {
                    steepest = (share, axis, name.clone());
                }
                panels.push(CovariatePanel {
                    name: AXES[axis].to_owned(),
                    covariate: name,
                    covariate_unit: unit.to_owned(),
                    bins: Bin::of(abscissa, residual, BINS),
                });
            };
            for (other, force) in forces.iter().enumerate() {
                add(format!("specific force {}", AXES[other]), "g", force);
            }
            if let Some(temperature) = &found.record.temperature_c {
                add("temperature".to_owned(), "°C", temperature);
            }
        }
        let (share, axis, name) = steepest;
        ResidualVsCovariate {
            title: format!(
                "{:.0} % of the mean-square open-loop residual of {} depends on {name}",
                100.0 * share,
                AXES[axis]
            ),
            subtitle: format!(
                "open-loop residuals of the nominal model, means in {BINS} bins; {}",
                subtitle(found)
            ),
            quantity: "mean residual".to_owned(),
            unit: "g".to_owned(),
            columns: panels.len() / 3,
            panels,
        }
    }
}

/// Periodograms of the innovations of the nominal and of the extended model.
pub(super) fn periodograms(found: &DiagnosisRun<'_>) -> Result<Box<dyn Picture>, DiagnosisError> {
    let probability = found.diagnosis.result.false_alarm_probability;
    let time_s = &found.record.time_s;
    let mut channels = Vec::new();
    let mut frequency = Vec::new();
    // Of each channel the power of its strongest line over the threshold, and its frequency.
    let mut lines: Vec<(f64, f64)> = Vec::new();
    for (label, innovations) in whitened(found) {
        for (axis, series) in columns(innovations).iter().enumerate() {
            let Periodogram {
                frequency_hz,
                power,
                level,
                line,
            } = periodogram(time_s, series, probability)?;
            lines.push((line.power / level, line.frequency_hz * SECONDS_PER_DAY));
            frequency = frequency_hz.iter().map(|hz| hz * SECONDS_PER_DAY).collect();
            channels.push(SpectrumChannel {
                name: format!("{}, {label}", AXES[axis]),
                power,
                samples: series.iter().filter(|value| !value.is_nan()).count(),
                threshold: Some(PowerThreshold {
                    power: level,
                    false_alarm_probability: probability,
                }),
            });
        }
    }
    let mut marks = vec![MarkedFrequency {
        frequency: SIDEREAL_PER_DAY,
        label: "sidereal day".to_owned(),
    }];
    let strongest = (0..lines.len())
        .filter(|channel| lines[*channel].0 > 1.0)
        .max_by(|a, b| lines[*a].0.total_cmp(&lines[*b].0));
    let title = match strongest {
        None => "No spectral line of the innovations exceeds the detection threshold".to_owned(),
        Some(channel) => {
            let (beyond, per_day) = lines[channel];
            let period = format!("{:.2} h", 24.0 / per_day);
            let mut title = format!(
                "Strongest spectral line: period {period} ({}), {beyond:.1} times the threshold",
                channels[channel].name
            );
            // Those of the extended model follow the first three.
            if lines.len() > 3 && lines[3..].iter().all(|(beyond, _)| *beyond <= 1.0) {
                title.push_str("; none in the extended model");
            }
            marks.push(MarkedFrequency {
                frequency: per_day,
                label: period,
            });
            title
        }
    };
    Ok(Box::new(Spectrum {
        title,
        subtitle: format!("one-step innovations; {}", subtitle(found)),
        frequency,
        frequency_unit: "cycles/day".to_owned(),
        channels,
        quantity: "power".to_owned(),
        unit: String::new(),
        marks,
    }))
}

/// Autocorrelations of the same innovations.
pub(super) fn autocorrelations(
    found: &DiagnosisRun<'_>,
) -> Result<Box<dyn Picture>, DiagnosisError> {
    let mut channels = Vec::new();
    let mut worst: Option<(f64, String)> = None;
    let mut beyond = 0;
    for (label, innovations) in whitened(found) {
        let Autocorrelation {
            correlation, sigma, ..
        } = autocorrelation(
            innovations,
            LAGS,
            found.diagnosis.result.false_alarm_probability,
        )?;
        for (axis, name) in AXES.iter().enumerate() {
            let values: Vec<f64> = correlation.iter().map(|lag| lag[axis]).collect();
            let band = sigma
                .first()
                .map_or(f64::NAN, |lag| NORMAL_97_5 * lag[axis]);
            let name = format!("{name}, {label}");
            beyond += values.iter().filter(|value| value.abs() > band).count();
            let largest = values.iter().fold(0.0_f64, |most, value| {
                if value.abs() > most.abs() {
                    *value
                } else {
                    most
                }
            });
            if worst
                .as_ref()
                .is_none_or(|(most, _)| largest.abs() > most.abs())
            {
                worst = Some((largest, name.clone()));
            }
            channels.push(CorrelationChannel {
                name,
                correlation: values,
                band,
                samples: innovations.iter().filter(|row| !row[axis].is_nan()).count(),
            });
        }
    }
    let total = LAGS * channels.len();
    let (largest, name) = worst.unwrap_or_default();
    Ok(Box::new(Correlation {
        title: format!(
            "{beyond} of {total} autocorrelations of the innovations outside the 95 % band, the \
             largest {largest:.3} ({name})"
        ),
        subtitle: format!("one-step innovations; {}", subtitle(found)),
        channels,
        confidence: 0.95,
    }))
}

/// Squared magnitude of specific force against its components and time: accelerometers only.
pub(super) fn norm(found: &DiagnosisRun<'_>) -> Result<Box<dyn Picture>, DiagnosisError> {
    let noise_g = [found.bench.accel_noise_g; 3];
    let gravity_g = found.bench.specific_force_at_rest();
    let norm = magnitude_channel(found.record, &noise_g, gravity_g, BINS)?;
    let panel = |covariate: String, unit: &str, scale: f64, means: &BinnedMeans| {
        let first = if unit == "days" {
            found.record.time_s.first().copied().unwrap_or(0.0)
        } else {
            0.0
        };
        CovariatePanel {
            name: "|f|² − g²".to_owned(),
            covariate,
            covariate_unit: unit.to_owned(),
            bins: means
                .bins
                .iter()
                .map(|bin| Bin {
                    centre: (bin.at - first) * scale,
                    mean: bin.mean,
                    standard_error: bin.sigma,
                    samples: bin.values,
                })
                .collect(),
        }
    };
    let mut panels: Vec<CovariatePanel> = norm
        .on_component
        .iter()
        .zip(AXES)
        .map(|(means, axis)| panel(format!("specific force {axis}"), "g", 1.0, means))
        .collect();
    let per_day = 1.0 / SECONDS_PER_DAY;
    panels.push(panel("time".to_owned(), "days", per_day, &norm.on_time));
    if let Some(means) = &norm.on_temperature {
        panels.push(panel("temperature".to_owned(), "°C", 1.0, means));
    }
    let tests = norm
        .on_component
        .iter()
        .chain([&norm.on_time])
        .chain(&norm.on_temperature);
    let least = tests
        .map(|test| test.p_value)
        .fold(norm.mean_p_value, f64::min);
    let count = 1.0 + panels.len() as f64;
    let title = if least * count < found.diagnosis.result.false_alarm_probability {
        "Specific-force magnitude test: not consistent with gravity, accelerometer error"
    } else {
        "Specific-force magnitude test: consistent with gravity"
    };
    Ok(Box::new(ResidualVsCovariate {
        title: title.to_owned(),
        subtitle: format!(
            "squared specific force minus squared gravity, in standard deviations of one sample; \
             independent of gyros and attitude; {}",
            subtitle(found)
        ),
        quantity: "mean".to_owned(),
        unit: String::new(),
        columns: 2,
        panels,
    }))
}

/// Innovations of the nominal model and, if there is one, of the extended model.
fn whitened<'a>(found: &'a DiagnosisRun<'_>) -> Vec<(&'static str, &'a [[f64; 3]])> {
    let diagnosis = &found.diagnosis;
    let mut all = vec![("nominal model", diagnosis.innovations.normalised.as_slice())];
    if diagnosis.extended.is_some() {
        all.push(("extended model", diagnosis.whitened.as_slice()));
    }
    all
}

fn differences(found: &DiagnosisRun<'_>, simulated_g: &[[f64; 3]]) -> [Vec<f64>; 3] {
    std::array::from_fn(|axis| {
        found
            .record
            .accel_g
            .iter()
            .zip(simulated_g)
            .map(|(measured, simulated)| measured[axis] - simulated[axis])
            .collect()
    })
}

/// Residuals of the three axes, before and after.
fn channels(
    before: [Vec<f64>; 3],
    after: Option<[Vec<f64>; 3]>,
    sigma: f64,
) -> Vec<ResidualChannel> {
    let after = after.map_or([None, None, None], |after| after.map(Some));
    AXES.iter()
        .zip(before.into_iter().zip(after))
        .map(|(name, (before, after))| ResidualChannel {
            name: (*name).to_owned(),
            before,
            after,
            sigma,
        })
        .collect()
}

fn columns(rows: &[[f64; 3]]) -> [Vec<f64>; 3] {
    std::array::from_fn(|axis| rows.iter().map(|row| row[axis]).collect())
}

fn rms(columns: &[Vec<f64>; 3]) -> f64 {
    rms_of_present(columns.iter().flatten()).0
}

/// Share of the mean square of a residual that the means of its bins hold.
fn explained(abscissa: &[f64], residual: &[f64]) -> f64 {
    let bins = Bin::of(abscissa, residual, BINS);
    let within: f64 = bins
        .iter()
        .map(|bin| bin.samples as f64 * bin.mean * bin.mean)
        .sum();
    let pairs = abscissa.iter().zip(residual);
    let whole: f64 = pairs
        .filter(|(x, y)| x.is_finite() && y.is_finite())
        .map(|(_, y)| y * y)
        .sum();
    if whole > 0.0 { within / whole } else { 0.0 }
}

/// A specific force in the unit that people read.
fn amount(force_g: f64) -> String {
    format!("{:.0} µg", 1e6 * force_g)
}
