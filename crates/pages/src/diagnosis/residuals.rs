//! Tests of the innovations: correlation over rows, and spectrum.

use gyrocal_answer::Answer;
use gyrocal_diagnosis::{ChannelCorrelation, ChannelSpectrum, Diagnosis, ModelVersion};
use gyrocal_document::{Chart, Item, Level, Mark, Panel, Section, Tint};
use gyrocal_record::AXES;
use gyrocal_statistics::format;
use gyrocal_words::{joined, time};

use super::test_table;
use crate::panels::{self, line};
use crate::words::section as titled;

/// Lags of the autocorrelation.
const LAGS: usize = 40;
/// Cycles a sidereal day, a day.
const SIDEREAL_PER_DAY: f64 = 1.002_737_9;
const SECONDS_PER_DAY: f64 = 86_400.0;

pub(super) fn section(result: &Answer, charts: Vec<Chart>) -> Section {
    let mut items = vec![Item::from(test_table::table(result))];
    items.extend(charts.into_iter().map(Item::Chart));
    items.extend(gyrocal_words::residuals(result).map(Item::from));
    let lead = "One-step innovations of a right model are white: no correlation over rows, no line in the spectrum.";
    titled("residuals", "Innovations", lead, items)
}

/// The charts that the record is long enough for.
pub(super) fn charts(diagnosis: &Diagnosis<'_>) -> Vec<Chart> {
    let correlations = diagnosis.autocorrelations(LAGS).map(correlation);
    let spectra = diagnosis.spectra(&diagnosis.record);
    let probability = diagnosis.result.false_alarm_probability;
    let spectra = spectra.map(|found| spectrum(found, probability));
    correlations.into_iter().chain(spectra).collect()
}

fn look(model: ModelVersion) -> (&'static str, Tint) {
    match model {
        ModelVersion::Nominal => (panels::NOMINAL, Tint::Nominal),
        ModelVersion::Extended => (panels::EXTENDED, Tint::Extended),
    }
}

fn correlation(channels: Vec<ChannelCorrelation>) -> Chart {
    let panels = (0..3).map(|axis| {
        let of_axis: Vec<_> = channels.iter().filter(|one| one.axis == axis).collect();
        let of = |model: ModelVersion| {
            let own = of_axis.iter().find(|one| one.model == model);
            own.map(|one| one.correlation.clone())
        };
        let half = of_axis.first().map_or(f64::NAN, |one| one.band);
        let shown = of_axis.iter().filter(|channel| channel.samples > 0);
        let largest = joined(shown.map(|one| format!("{:+.3}", one.largest)), " → ");
        let note = match &*largest {
            "" => String::new(),
            both => format!("largest {both}"),
        };
        let nominal = of(ModelVersion::Nominal).unwrap_or_default();
        let models = (nominal, of(ModelVersion::Extended));
        panels::correlation(AXES[axis].to_owned(), note, half, models)
    });
    panels::correlations(panels.collect())
}

/// The strongest line above the threshold.
fn strongest(spectra: &[ChannelSpectrum]) -> Option<&ChannelSpectrum> {
    spectra
        .iter()
        .filter(|one| one.line_over_threshold > 1.0)
        .max_by(|a, b| a.line_over_threshold.total_cmp(&b.line_over_threshold))
}

/// Period of the largest line.
fn period(spectrum: &ChannelSpectrum) -> String {
    time(1.0 / spectrum.periodogram.line.frequency_hz)
}

/// The strongest line, and whether it remains in the extended model.
fn spectrum_title(spectra: &[ChannelSpectrum]) -> String {
    let over = |model: ModelVersion| {
        let of = spectra.iter().filter(move |one| one.model == model);
        of.map(|one| one.line_over_threshold).fold(0.0, f64::max)
    };
    match strongest(spectra) {
        None => "No spectral line of the innovations exceeds the detection threshold".to_owned(),
        Some(one) => {
            let after = match over(ModelVersion::Extended) {
                0.0 => "",
                line if line <= 1.0 => "; none in the extended model",
                _ => "; one remains in the extended model",
            };
            format!(
                "Strongest spectral line: period {}, axis {}, {}, {:.1} times the threshold{after}",
                period(one),
                AXES[one.axis],
                look(one.model).0,
                one.line_over_threshold
            )
        }
    }
}

fn spectrum(spectra: Vec<ChannelSpectrum>, probability: f64) -> Chart {
    let title = spectrum_title(&spectra);
    let mut marks = vec![Mark {
        label: "sidereal day".to_owned(),
        value: SIDEREAL_PER_DAY,
    }];
    marks.extend(strongest(&spectra).map(|one| Mark {
        label: period(one),
        value: one.periodogram.line.frequency_hz * SECONDS_PER_DAY,
    }));
    let panels = (0..3).map(|axis| {
        let of_axis: Vec<_> = spectra.iter().filter(|one| one.axis == axis).collect();
        let frequency = of_axis.first().map(|one| &one.periodogram.frequency_hz);
        let lines = of_axis.iter().map(|one| {
            let (label, tint) = look(one.model);
            // A logarithmic scale has no place for nothing.
            let power = one.periodogram.power.iter();
            line(label, tint, power.map(|power| power.max(1e-3)).collect())
        });
        let level = of_axis.first().map(|one| Level {
            label: format!(
                "detection threshold ({} of white innovations)",
                format::percent(probability)
            ),
            value: one.periodogram.level,
        });
        let samples = of_axis.first().map(|one| one.samples);
        Panel {
            name: AXES[axis].to_owned(),
            note: samples.map_or_else(String::new, |count| format!("{count} innovations")),
            abscissa: frequency
                .map(|all| all.iter().map(|hz| hz * SECONDS_PER_DAY).collect())
                .unwrap_or_default(),
            lines: lines.collect(),
            levels: level.into_iter().collect(),
            marks: marks.clone(),
            no_gaps: true,
            ..Panel::default()
        }
    });
    Chart {
        title,
        caption: "Power of white innovations is 1 in the mean at every frequency.".to_owned(),
        abscissa: "frequency".to_owned(),
        abscissa_unit: "cycles/day".to_owned(),
        logarithmic_abscissa: true,
        quantity: "power, of white noise 1".to_owned(),
        logarithmic: true,
        same_scale: true,
        panels: panels.collect(),
        columns: 3,
        height_px: 210,
        ..Chart::default()
    }
}
