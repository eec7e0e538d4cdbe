//! What the residuals of the nominal model show, before anything is named: in size, from row to row,
//! in frequency, and against specific force, time and temperature. It makes no finding.

use gyrocal_calibration::Extended;
use gyrocal_record::Record;
use gyrocal_statistics::{
    Autocorrelation, BinnedMeans, Nis, SpectralLine, StatisticsError, autocorrelation,
    binned_means, nis, periodogram, rms_of_present,
};

use crate::series::Innovations;

/// Lags of the autocorrelation.
const LAGS: usize = 20;

/// Bins of each abscissa.
const BINS: usize = 12;

/// An abscissa that residuals may depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Abscissa {
    /// Specific force along platform axis 0, 1, 2 of x, y, z, g.
    Force(usize),
    /// Time since the first row, s.
    Time,
    /// Temperature, °C.
    Temperature,
}

/// Residuals of a model, looked at in every way. What a short record does not show is `None`.
#[derive(Clone, Debug, PartialEq)]
pub struct Residuals {
    /// Normalised innovations squared.
    pub nis: Option<Nis>,
    /// Correlation of innovations over rows.
    pub autocorrelation: Option<Autocorrelation>,
    /// The largest line of each axis.
    pub lines: Option<[SpectralLine; 3]>,
    /// Root mean square of measured less simulated specific force of each axis, the simulation
    /// running by itself from the first attitude, g.
    pub free_run_rms_g: [f64; 3],
    /// Means of normalised innovations of each axis over each abscissa.
    pub against: Vec<(Abscissa, [BinnedMeans; 3])>,
}

/// Looks at the innovations of the nominal model, and at its free run.
///
/// # Errors
/// As [`Extended::free_run_g`].
pub fn residuals(
    nominal: &Extended<'_>,
    innovations: &Innovations,
    record: &Record,
    false_alarm: f64,
) -> Result<Residuals, gyrocal_calibration::CalibrationError> {
    let simulated_g = nominal.free_run_g()?;
    let normalised = &innovations.normalised;
    let channel = |axis: usize| normalised.iter().map(|row| row[axis]).collect::<Vec<f64>>();
    let channels = [0, 1, 2].map(channel);
    let lines = channels
        .each_ref()
        .map(|series| periodogram(&innovations.time_s, series, false_alarm));
    let against = abscissae(innovations, record)
        .into_iter()
        .filter_map(|(abscissa, at)| {
            let [x, y, z] = channels
                .each_ref()
                .map(|series| binned_means(&at, series, 1.0, BINS));
            Some((abscissa, [x.ok()?, y.ok()?, z.ok()?]))
        })
        .collect();
    Ok(Residuals {
        nis: nis(normalised, false_alarm).ok(),
        autocorrelation: autocorrelation(normalised, LAGS, false_alarm).ok(),
        lines: all(lines.map(|found| found.map(|found| found.line))),
        free_run_rms_g: core::array::from_fn(|axis| {
            let misses = record.accel_g.iter().zip(&simulated_g);
            rms_of_present(misses.map(|(measured, simulated)| measured[axis] - simulated[axis])).0
        }),
        against,
    })
}

fn abscissae(innovations: &Innovations, record: &Record) -> Vec<(Abscissa, Vec<f64>)> {
    let forces = innovations.specific_force_g.iter();
    let mut all: Vec<(Abscissa, Vec<f64>)> = (0..3)
        .map(|axis| {
            let along = forces.clone().map(|force_g| force_g[axis]);
            (Abscissa::Force(axis), along.collect())
        })
        .collect();
    let first_s = innovations.time_s.first().copied().unwrap_or(0.0);
    let times = innovations.time_s.iter().map(|time_s| time_s - first_s);
    all.push((Abscissa::Time, times.collect()));
    if let Some(temperature) = &record.temperature_c
        && record.temperature_changes()
    {
        all.push((Abscissa::Temperature, temperature.clone()));
    }
    all
}

fn all(lines: [Result<SpectralLine, StatisticsError>; 3]) -> Option<[SpectralLine; 3]> {
    let [x, y, z] = lines;
    Some([x.ok()?, y.ok()?, z.ok()?])
}
