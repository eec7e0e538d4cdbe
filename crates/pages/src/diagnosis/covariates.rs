//! Means of what a model leaves, in bins of what it may depend on: specific force, temperature, time.

use gyrocal_diagnosis::{Diagnosis, OpenLoopSimulation, magnitude_channel};
use gyrocal_document::{Chart, Item, Level, Line, LineKind, Panel, Section, Tint};
use gyrocal_record::{AXES, Record};
use gyrocal_statistics::{BinMean, BinnedMeans, binned_means};

use crate::panels::two_sigmas;
use crate::words::section;

/// Bins of a covariate.
const BINS: usize = 24;
const SECONDS_PER_DAY: f64 = 86_400.0;

/// Residual of the open-loop simulation against each component of specific force and temperature; `None` of a
/// record with too few rows for the bins.
pub(super) fn against_force(record: &Record, nominal: &OpenLoopSimulation) -> Option<Chart> {
    let forces = (0..3).map(|axis| {
        let force = nominal.simulated_g.iter().map(|row| row[axis]);
        let name = format!("specific force {}", AXES[axis]);
        (name, "g", force.collect())
    });
    let temperature = record.temperature_c.iter();
    let temperature = temperature.map(|all| ("temperature".to_owned(), "°C", all.clone()));
    let covariates: Vec<(String, &str, Vec<f64>)> = forces.chain(temperature).collect();
    let mut panels = Vec::new();
    let mut steepest = (0.0, String::new());
    for (residual, axis) in nominal.residuals_g.iter().zip(AXES) {
        for (name, unit, values) in &covariates {
            let Some((bins, share)) = scattered_means(values, residual) else {
                continue;
            };
            if share > steepest.0 {
                steepest = (share, format!("{axis} depends on {name}"));
            }
            panels.push(panel(axis, (name, unit), &bins));
        }
    }
    let (share, which) = steepest;
    (!panels.is_empty()).then(|| Chart {
        title: match share {
            0.0 => "Open-loop residual of the nominal model against specific force".to_owned(),
            _ => format!(
                "{:.0} % of the mean-square open-loop residual of {which}",
                100.0 * share
            ),
        },
        caption: format!(
            "Residual of the nominal model, means in {BINS} bins of as many rows each. What depends on specific \
             force or temperature is not noise."
        ),
        quantity: "mean residual".to_owned(),
        unit: "g".to_owned(),
        columns: covariates.len(),
        ..chart(panels)
    })
}

/// Means in bins with their standard errors from the scatter in each bin, and the share of the mean square that
/// they hold; `None` with too few values.
fn scattered_means(covariate: &[f64], residual: &[f64]) -> Option<(Vec<BinMean>, f64)> {
    let squares: Vec<f64> = residual.iter().map(|value| value * value).collect();
    let means = binned_means(covariate, residual, 1.0, BINS).ok()?;
    let squares = binned_means(covariate, &squares, 1.0, BINS).ok()?;
    let (mut between, mut total) = (0.0, 0.0);
    let bins = means.bins.into_iter().zip(&squares.bins);
    let bins = bins.map(|(bin, square)| {
        let count = bin.values as f64;
        between += count * bin.mean * bin.mean;
        total += count * square.mean;
        let scatter = (square.mean - bin.mean * bin.mean).max(0.0);
        BinMean {
            sigma: (scatter / (count - 1.0)).sqrt(),
            ..bin
        }
    });
    let bins: Vec<BinMean> = bins.collect();
    let share = if total > 0.0 { between / total } else { 0.0 };
    Some((bins, share))
}

/// The magnitude of specific force against its components, time and temperature; `None` of a record with too few
/// complete rows for the bins.
pub(super) fn magnitude(diagnosis: &Diagnosis<'_>) -> Option<Section> {
    let (record, bench) = (&diagnosis.record, &diagnosis.bench);
    let (noise_g, gravity_g) = ([bench.accel_noise_g; 3], bench.specific_force_at_rest());
    let found = magnitude_channel(record, &noise_g, gravity_g, BINS).ok()?;
    let against =
        |name: &str, unit: &str, means: &BinnedMeans| panel("|f|² − g²", (name, unit), &means.bins);
    let components = found.on_component.iter().zip(AXES);
    let components =
        components.map(|(means, axis)| against(&format!("specific force {axis}"), "g", means));
    let first = record.time_s.first().copied().unwrap_or(0.0);
    let mut in_days = found.on_time.clone();
    for bin in &mut in_days.bins {
        bin.at = (bin.at - first) / SECONDS_PER_DAY;
    }
    let mut panels: Vec<Panel> = components.collect();
    panels.push(against("time from the first row", "days", &in_days));
    let temperature = found.on_temperature.iter();
    panels.extend(temperature.map(|means| against("temperature", "°C", means)));
    let title = match found.least_p_value() < diagnosis.result.false_alarm_probability {
        true => "Magnitude of specific force is not that of gravity: accelerometer error",
        false => "Magnitude of specific force is that of gravity",
    };
    let chart = Chart {
        title: title.to_owned(),
        caption: format!(
            "Squared specific force less squared gravity, in standard deviations of one row; means in {BINS} bins \
             of as many rows each."
        ),
        quantity: "mean".to_owned(),
        unit: "σ".to_owned(),
        columns: 3,
        ..chart(panels)
    };
    Some(section(
        "magnitude",
        "Magnitude of specific force",
        "At rest it is that of gravity in every attitude. It depends on the accelerometers alone, and not on gyros, \
         attitude or model.",
        vec![Item::Chart(chart)],
    ))
}

fn chart(panels: Vec<Panel>) -> Chart {
    Chart {
        same_scale: true,
        unlinked: true,
        height_px: 190,
        panels,
        ..Chart::default()
    }
}

/// Means of bins over what they are binned by.
fn panel(name: &str, (covariate, unit): (&str, &str), bins: &[BinMean]) -> Panel {
    let values: usize = bins.iter().map(|bin| bin.values).sum();
    Panel {
        name: name.to_owned(),
        note: format!("{values} rows"),
        own_abscissa: Some((covariate.to_owned(), unit.to_owned())),
        abscissa: bins.iter().map(|bin| bin.at).collect(),
        bands: vec![two_sigmas(
            "±2 standard errors",
            Tint::Nominal,
            bins.iter().map(|bin| (bin.mean, bin.sigma)),
        )],
        lines: vec![Line::new(
            "mean of a bin",
            Tint::Nominal,
            LineKind::Points,
            bins.iter().map(|bin| bin.mean).collect(),
        )],
        levels: vec![Level::zero()],
        no_gaps: true,
        ..Panel::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_have_the_error_of_their_scatter_and_hold_what_depends() {
        let covariate: Vec<f64> = (0..4 * BINS).map(|row| row as f64).collect();
        let alternating = |row: usize| if row.is_multiple_of(2) { 1.0 } else { -1.0 };
        let noise: Vec<f64> = (0..4 * BINS).map(alternating).collect();
        let (bins, share) = scattered_means(&covariate, &noise).unwrap();
        assert_eq!((bins.len(), bins[0].values, share), (BINS, 4, 0.0));
        // Mean square 1 about the mean 0 of four values.
        assert!((bins[0].sigma - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12);
        let (bins, share) = scattered_means(&covariate, &vec![2.0; 4 * BINS]).unwrap();
        assert_eq!((bins[3].mean, bins[3].sigma, share), (2.0, 0.0, 1.0));
        assert!(scattered_means(&covariate[..BINS], &noise[..BINS]).is_none());
    }
}
