//! Open-loop residuals, one-step innovations and the specific-force magnitude.

use gyrocal_calibration::CalibrationError;
use gyrocal_diagnosis::{
    ChannelCorrelation, ChannelSpectrum, DiagnosisError, ModelVersion, OpenLoopSimulation,
    magnitude_channel,
};
use gyrocal_record::AXES;
use gyrocal_report::page::Tint;
use gyrocal_report::{
    Bin, Correlation, CorrelationChannel, CovariatePanel, MarkedFrequency, OpenLoop,
    OpenLoopChannel, Picture, PowerThreshold, ResidualChannel, ResidualVsCovariate, Residuals,
    Spectrum, SpectrumChannel,
};
use gyrocal_statistics::BinnedMeans;

use super::{DiagnosisRun, causes, subtitle};

/// Bins of a covariate.
const BINS: usize = 24;

/// Lags of the autocorrelation.
const LAGS: usize = 40;

/// Cycles a sidereal day, a day.
const SIDEREAL_PER_DAY: f64 = 1.002_737_9;

const SECONDS_PER_DAY: f64 = 86_400.0;

/// Open-loop simulations of the models, from the first row on without measurement updates.
pub(super) struct OpenLoopRuns {
    nominal: OpenLoopSimulation,
    extended: Option<OpenLoopSimulation>,
}

impl OpenLoopRuns {
    pub(super) fn of(found: &DiagnosisRun<'_>) -> Result<Self, CalibrationError> {
        let (nominal, extended) = found.diagnosis.open_loop(&found.diagnosis.record)?;
        Ok(Self { nominal, extended })
    }

    /// Measured minus simulated specific force of both models.
    pub(super) fn residuals(&self, found: &DiagnosisRun<'_>) -> Residuals {
        let miss = amount(self.nominal.rms_g);
        let noise = amount(found.bench.accel_noise_g);
        let title = match (&self.extended, causes(found)) {
            (Some(after), Some(causes)) => format!(
                "Open-loop residual: {miss} rms for the nominal model, {} with {causes}",
                amount(after.rms_g)
            ),
            _ => format!("Open-loop residual of the nominal model: {miss} rms, noise {noise}"),
        };
        Residuals {
            title,
            subtitle: format!(
                "measured minus simulated specific force, no measurement updates; {}",
                subtitle(found)
            ),
            time_s: found.diagnosis.record.time_s.clone(),
            channels: self.channels(found.bench.accel_noise_g),
            before_label: "nominal model".to_owned(),
            after_label: format!("with {}", causes(found).unwrap_or_default()),
            quantity: "residual".to_owned(),
            unit: "g".to_owned(),
        }
    }

    /// Open-loop simulation of the nominal model and the record.
    pub(super) fn open_loop(&self, found: &DiagnosisRun<'_>) -> OpenLoop {
        let miss = amount(self.nominal.rms_g);
        let days = found.diagnosis.record.duration_s() / SECONDS_PER_DAY;
        let (measured, simulated) = (
            columns(&found.diagnosis.record.accel_g),
            columns(&self.nominal.simulated_g),
        );
        let channels = AXES.iter().zip(measured.into_iter().zip(simulated));
        OpenLoop {
            title: format!(
                "Open-loop simulation of the nominal model over {days:.1} days: residual {miss} rms"
            ),
            subtitle: subtitle(found),
            time_s: found.diagnosis.record.time_s.clone(),
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

    fn channels(&self, sigma: f64) -> Vec<ResidualChannel> {
        let channel = |(axis, name): (usize, &&str)| ResidualChannel {
            name: (*name).to_owned(),
            before: self.nominal.residuals_g[axis].clone(),
            after: self
                .extended
                .as_ref()
                .map(|run| run.residuals_g[axis].clone()),
            sigma,
        };
        AXES.iter().enumerate().map(channel).collect()
    }

    /// Open-loop residuals against each component of specific force, and temperature.
    pub(super) fn against_force(&self, found: &DiagnosisRun<'_>) -> ResidualVsCovariate {
        let residuals = &self.nominal.residuals_g;
        let forces = columns(&self.nominal.simulated_g);
        let mut panels = Vec::new();
        let mut steepest = (0.0, 0, String::new());
        for (axis, residual) in residuals.iter().enumerate() {
            let mut add = |name: String, unit: &str, abscissa: &[f64]| {
                let share = Bin::share_of_mean_square(abscissa, residual, BINS);
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
            if let Some(temperature) = &found.diagnosis.record.temperature_c {
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
    let spectra = found.diagnosis.spectra(&found.diagnosis.record)?;
    let name =
        |spectrum: &ChannelSpectrum| format!("{}, {}", AXES[spectrum.axis], label(spectrum.model));
    let per_day = |hz: f64| hz * SECONDS_PER_DAY;
    let mut marks = vec![MarkedFrequency {
        frequency: SIDEREAL_PER_DAY,
        label: "sidereal day".to_owned(),
    }];
    let strongest = spectra
        .iter()
        .filter(|spectrum| spectrum.line_over_threshold > 1.0)
        .max_by(|a, b| a.line_over_threshold.total_cmp(&b.line_over_threshold));
    let title = match strongest {
        None => "No spectral line of the innovations exceeds the detection threshold".to_owned(),
        Some(spectrum) => {
            let frequency = per_day(spectrum.periodogram.line.frequency_hz);
            let period = format!("{:.2} h", 24.0 / frequency);
            let mut title = format!(
                "Strongest spectral line: period {period} ({}), {:.1} times the threshold",
                name(spectrum),
                spectrum.line_over_threshold
            );
            let of_extended = spectra
                .iter()
                .filter(|spectrum| spectrum.model == ModelVersion::Extended);
            let mut lines = of_extended
                .map(|spectrum| spectrum.line_over_threshold)
                .peekable();
            if lines.peek().is_some() && lines.all(|line| line <= 1.0) {
                title.push_str("; none in the extended model");
            }
            marks.push(MarkedFrequency {
                frequency,
                label: period,
            });
            title
        }
    };
    let frequency = spectra.first().map_or_else(Vec::new, |spectrum| {
        let all = spectrum.periodogram.frequency_hz.iter();
        all.map(|hz| per_day(*hz)).collect()
    });
    let channels = spectra.iter().map(|spectrum| SpectrumChannel {
        name: name(spectrum),
        power: spectrum.periodogram.power.clone(),
        samples: spectrum.samples,
        tint: tint(spectrum.model),
        threshold: Some(PowerThreshold {
            power: spectrum.periodogram.level,
            false_alarm_probability: probability,
        }),
    });
    Ok(Box::new(Spectrum {
        title,
        subtitle: format!("one-step innovations; {}", subtitle(found)),
        frequency,
        frequency_unit: "cycles/day".to_owned(),
        channels: channels.collect(),
        quantity: "power".to_owned(),
        unit: String::new(),
        marks,
    }))
}

/// Autocorrelations of the same innovations.
pub(super) fn autocorrelations(
    found: &DiagnosisRun<'_>,
) -> Result<Box<dyn Picture>, DiagnosisError> {
    let channels = found.diagnosis.autocorrelations(LAGS)?;
    let name =
        |channel: &ChannelCorrelation| format!("{}, {}", AXES[channel.axis], label(channel.model));
    let worst = channels
        .iter()
        .max_by(|a, b| a.largest.abs().total_cmp(&b.largest.abs()));
    let worst = worst.map_or_else(String::new, |channel| {
        format!(", the largest {:.3} ({})", channel.largest, name(channel))
    });
    let outside: usize = channels.iter().map(|channel| channel.outside).sum();
    let total = LAGS * channels.len();
    let drawn = channels.iter().map(|channel| CorrelationChannel {
        name: name(channel),
        correlation: channel.correlation.clone(),
        band: channel.band,
        samples: channel.samples,
        tint: tint(channel.model),
    });
    Ok(Box::new(Correlation {
        title: format!(
            "{outside} of {total} autocorrelations of the innovations outside the 95 % band{worst}"
        ),
        subtitle: format!("one-step innovations; {}", subtitle(found)),
        channels: drawn.collect(),
        confidence: 0.95,
    }))
}

/// Label of a model in the pictures.
fn label(model: ModelVersion) -> &'static str {
    match model {
        ModelVersion::Nominal => "nominal model",
        ModelVersion::Extended => "extended model",
    }
}

/// Colour of a model in the pictures.
fn tint(model: ModelVersion) -> Tint {
    match model {
        ModelVersion::Nominal => Tint::Nominal,
        ModelVersion::Extended => Tint::Extended,
    }
}

/// Squared magnitude of specific force against its components and time: accelerometers only.
pub(super) fn norm(found: &DiagnosisRun<'_>) -> Result<Box<dyn Picture>, DiagnosisError> {
    let noise_g = [found.bench.accel_noise_g; 3];
    let gravity_g = found.bench.specific_force_at_rest();
    let norm = magnitude_channel(&found.diagnosis.record, &noise_g, gravity_g, BINS)?;
    let panel = |covariate: String, unit: &str, scale: f64, means: &BinnedMeans| {
        let first = if unit == "days" {
            found
                .diagnosis
                .record
                .time_s
                .first()
                .copied()
                .unwrap_or(0.0)
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
    let title = if norm.least_p_value() < found.diagnosis.result.false_alarm_probability {
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

fn columns(rows: &[[f64; 3]]) -> [Vec<f64>; 3] {
    std::array::from_fn(|axis| rows.iter().map(|row| row[axis]).collect())
}

/// A specific force in µg.
fn amount(force_g: f64) -> String {
    format!("{:.0} µg", 1e6 * force_g)
}
