//! Residuals of the nominal model before the search: size, correlation, spectral lines, regression on
//! specific force, time and temperature, and the error of the open-loop simulation. They make no
//! finding.

use gyrocal_calibration::{FittedPlatform, NIS_FALSE_ALARM};
use gyrocal_record::Record;
use gyrocal_statistics::{
    SpectralLine, StatisticsError, autocorrelation, binned_means, nis, periodogram,
};

use crate::open_loop::OpenLoopSimulation;
use crate::series::Innovations;
use gyrocal_answer::{Against, Autocorrelation, Line, Nis, Residuals};

/// Lags of the autocorrelation.
const LAGS: usize = 20;

/// Bins of each abscissa.
const BINS: usize = 12;

/// Statistics of the innovations of the nominal model, and the error of its open-loop simulation.
///
/// # Errors
/// As [`OpenLoopSimulation::new`].
pub(crate) fn residuals(
    nominal: &FittedPlatform<'_>,
    innovations: &Innovations,
    record: &Record,
    false_alarm: f64,
) -> Result<Residuals, gyrocal_calibration::CalibrationError> {
    let simulated = OpenLoopSimulation::new(nominal, record)?;
    let normalised = &innovations.normalised;
    let channel = |axis: usize| normalised.iter().map(|row| row[axis]).collect::<Vec<f64>>();
    let channels = core::array::from_fn(channel);
    let lines = channels
        .each_ref()
        .map(|series| periodogram(&innovations.time_s, series, false_alarm));
    let against = abscissae(innovations, record)
        .into_iter()
        .filter_map(|(abscissa, at)| {
            let [x, y, z] = channels
                .each_ref()
                .map(|series| binned_means(&at, series, 1.0, BINS));
            let axes = [x.ok()?, y.ok()?, z.ok()?];
            Some(Against {
                abscissa,
                p_value: axes.each_ref().map(|axis| axis.p_value),
                at: axes
                    .each_ref()
                    .map(|axis| axis.bins.iter().map(|bin| bin.at).collect()),
                mean: axes.map(|axis| axis.bins.iter().map(|bin| bin.mean).collect()),
            })
        })
        .collect();
    Ok(Residuals {
        nis: nis_of_rows(normalised),
        autocorrelation: autocorrelation(normalised, LAGS, false_alarm)
            .ok()
            .map(|found| Autocorrelation {
                ljung_box: found.ljung_box,
                degrees_of_freedom: found.degrees_of_freedom,
                p_value: found.p_value,
                correlation: found.correlation,
            }),
        lines: all(lines.map(|found| found.map(|found| found.line))),
        free_run_rms_g: simulated.axis_rms_g,
        against,
    })
}

/// Mean NIS of a row with its band, which is that of a calibration; `None` without a value.
fn nis_of_rows(normalised: &[[f64; 3]]) -> Option<Nis> {
    let found = nis(normalised, NIS_FALSE_ALARM).ok()?;
    let has_value = |row: &&[f64; 3]| row.iter().any(|value| !value.is_nan());
    let rows = normalised.iter().filter(has_value).count();
    let values_of_a_row = found.values as f64 / rows as f64;
    Some(Nis {
        mean: found.mean * values_of_a_row,
        rows,
        values: found.values,
        band: found.band.map(|bound| bound * values_of_a_row),
        p_value: found.p_value,
    })
}

fn abscissae(innovations: &Innovations, record: &Record) -> Vec<(String, Vec<f64>)> {
    let forces = innovations.specific_force_g.iter();
    let mut all: Vec<(String, Vec<f64>)> = ["force_x_g", "force_y_g", "force_z_g"]
        .into_iter()
        .enumerate()
        .map(|(axis, name)| {
            let along = forces.clone().map(|force_g| force_g[axis]);
            (name.to_owned(), along.collect())
        })
        .collect();
    let first_s = innovations.time_s.first().copied().unwrap_or(0.0);
    let times = innovations.time_s.iter().map(|time_s| time_s - first_s);
    all.push(("time_s".to_owned(), times.collect()));
    if let Some(temperature) = &record.temperature_c
        && record.temperature_changes()
    {
        all.push(("temperature_c".to_owned(), temperature.clone()));
    }
    all
}

fn all(lines: [Result<SpectralLine, StatisticsError>; 3]) -> Option<[Line; 3]> {
    let [x, y, z] = lines;
    let line = |line: SpectralLine| Line {
        period_h: 1.0 / (3600.0 * line.frequency_hz),
        amplitude: line.amplitude,
        p_value: line.p_value,
    };
    Some([line(x.ok()?), line(y.ok()?), line(z.ok()?)])
}
