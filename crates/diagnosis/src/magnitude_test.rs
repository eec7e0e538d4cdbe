//! Specific-force magnitude test: separates errors of the accelerometers from errors of gyros,
//! attitude and site (docs/method.md, equation 20).

use gyrocal_record::{AXES, Bench, Record};
use gyrocal_statistics::{BinnedMeans, p_of_least};

use crate::error::DiagnosisError;
use crate::magnitude::{MagnitudeChannel, magnitude_channel};

/// Largest number of bins, and number of complete rows per bin.
const MOST_BINS: usize = 24;
const ROWS_A_BIN: usize = 20;

/// Smallest range of a component, in standard deviations of its noise, over which binned means are
/// tested. In a smaller range the noise sorts the values into bins, and correlates with the
/// magnitude.
const LEAST_RANGE_SIGMAS: f64 = 3000.0;

/// Result of the magnitude test.
#[derive(Debug, Clone, PartialEq)]
pub struct MagnitudeTest {
    /// Whether the accelerometers, or gravity, differ from what is declared.
    pub accelerometers: bool,
    /// p-value of the least of all its tests: exact of independent ones, else an upper bound.
    pub p_value: f64,
    /// Mean of |E| less gravity \[g\]; zero if gravity is declared uncertain.
    pub mean_g: f64,
    /// Standard deviation of that mean \[g\].
    pub mean_sigma_g: f64,
    /// The most significant deviation; empty if none is significant.
    pub description: String,
    /// The tested channel.
    pub channel: MagnitudeChannel,
}

/// Tests the magnitude in a record without outliers: its mean, and whether binned means over each
/// component, time and temperature are equal, at the family-wise false-alarm probability `false_alarm`.
///
/// `accel_noise_g` is the standard deviation of white noise with the long-term power of the
/// accelerometer noise. If the bench declares gravity uncertain, the mean of the magnitude is used
/// for it.
///
/// # Errors
///
/// [`DiagnosisError::TooShort`] with too few complete rows.
pub fn magnitude_test(
    record: &Record,
    bench: &Bench,
    accel_noise_g: &[f64; 3],
    false_alarm: f64,
) -> Result<MagnitudeTest, DiagnosisError> {
    let complete = |row: &&[f64; 3]| row.iter().all(|value| !value.is_nan());
    let rows: Vec<&[f64; 3]> = record.accel_g.iter().filter(complete).collect();
    let bins = (rows.len() / ROWS_A_BIN).clamp(1, MOST_BINS);
    let uncertain = bench.uncertainty.gravity_relative_sigma.is_some();
    let gravity_g = if uncertain && !rows.is_empty() {
        let squares = rows
            .iter()
            .map(|row| row.iter().map(|a| a * a).sum::<f64>());
        let variance: f64 = accel_noise_g.iter().map(|sigma| sigma * sigma).sum();
        (squares.sum::<f64>() / rows.len() as f64 - variance)
            .max(0.0)
            .sqrt()
    } else {
        bench.specific_force_at_rest()
    };
    let channel = magnitude_channel(record, accel_noise_g, gravity_g, bins)?;
    // d|E|² = 2 |E| d|E|.
    let mean_g = channel.mean_g2 / (2.0 * gravity_g);
    let mean_sigma_g = channel.mean_sigma_g2 / (2.0 * gravity_g);
    let mut tests: Vec<(f64, f64, String)> = Vec::new();
    if !uncertain {
        let z = mean_g / mean_sigma_g;
        let words = format!(
            "it is {} gravity by {:.1e} g on average ({:.1} sigma)",
            if mean_g > 0.0 { "above" } else { "below" },
            mean_g.abs(),
            z.abs()
        );
        tests.push((channel.mean_p_value, z * z, words));
    }
    let mut depends = |on: &str, found: &BinnedMeans| {
        let Some(test) = found.equal_means() else {
            return;
        };
        let words = format!(
            "it varies with {on} (chi-square {:.0} for {} degrees of freedom)",
            test.chi_square, test.degrees_of_freedom
        );
        let share = test.chi_square / test.degrees_of_freedom;
        tests.push((test.p_value, share, words));
    };
    for (axis, found) in channel.on_component.iter().enumerate() {
        let values = rows.iter().map(|row| row[axis]);
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        if high - low < LEAST_RANGE_SIGMAS * accel_noise_g[axis] {
            continue;
        }
        let axis = AXES[axis];
        depends(&format!("specific force along {axis}"), found);
    }
    depends("time", &channel.on_time);
    if let Some(found) = &channel.on_temperature {
        depends("temperature", found);
    }
    let count = tests.len() as f64;
    // Where probabilities underflow, the largest statistic over its degrees of freedom decides.
    let strongest = tests
        .into_iter()
        .min_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)));
    let (least, words) = strongest.map_or((1.0, String::new()), |(p, _, words)| (p, words));
    let p_value = p_of_least(least, count);
    let accelerometers = p_value < false_alarm;
    Ok(MagnitudeTest {
        accelerometers,
        p_value,
        mean_g,
        mean_sigma_g,
        description: if accelerometers { words } else { String::new() },
        channel,
    })
}
