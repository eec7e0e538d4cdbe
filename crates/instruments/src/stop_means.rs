//! Means over stops, with standard errors for coloured noise.

use core::ops::Range;

use crate::error::InstrumentError;
use crate::fast_noise::{fast_parts_of, mean_variance_of, part_length};
use crate::log::Log;

/// Means of one stop.
#[derive(Debug, Clone, PartialEq)]
pub struct StopMeans {
    /// Range of samples in the log.
    pub samples: Range<usize>,
    /// Time of the first sample.
    pub from_s: f64,
    /// Time of the last sample.
    pub to_s: f64,
    /// Middle of the stop.
    pub time_s: f64,
    /// Mean output of the gyros, in the unit of the log.
    pub gyro: [f64; 3],
    /// Standard errors of the means of the gyros.
    pub gyro_sigma: [f64; 3],
    /// The part of them that comes from angles in steps: zero of gyros whose samples do not show any.
    pub gyro_quantisation: [f64; 3],
    /// Means of the gyros over equal parts of the stop, less that of the stop; empty for one too short. Their number is a
    /// power of two.
    pub gyro_parts: Vec<[f64; 3]>,
    /// Mean output of the accelerometers, in the unit of the log.
    pub accel: [f64; 3],
    /// Standard errors of the means of the accelerometers.
    pub accel_sigma: [f64; 3],
}

/// Compared block lengths, s.
const BLOCKS_S: [f64; 3] = [0.25, 0.5, 1.0];

/// Least degrees of freedom for the variance of block means.
const FEWEST_BLOCKS: f64 = 30.0;

/// Least and largest number of parts of a stop, and the fewest samples of each.
const PARTS: [usize; 2] = [4, 32];
const FEWEST_SAMPLES: usize = 8;

/// Blocks of a stop within which the fast noise is told.
const BLOCKS: f64 = 8.0;

/// Averages each stop.
///
/// The standard error of a mean is that of white noise, from the scatter within the stop (which
/// depends on the attitude if something vibrates), times an inflation for coloured noise that is
/// pooled over all stops: the largest ratio of the variance of block means, times the length of the
/// blocks, to the variance of samples, over blocks of a quarter of a second to one second. Slower
/// noise shows in the residuals of the fit. Outputs whose samples make up for each other, as steps of an angle do, have
/// the standard errors of angle random walk and quantisation instead, pooled over all stops.
///
/// # Errors
///
/// [`crate::Unfit::NoAccelerometers`].
pub fn stop_means(log: &Log, stops: &[Range<usize>]) -> Result<Vec<StopMeans>, InstrumentError> {
    let force = log.force()?;
    let (gyro_inflation, makes_up) = inflation(&log.gyro, log.interval_s, stops);
    let (accel_inflation, _) = inflation(force, log.interval_s, stops);
    let fast: [Option<[f64; 2]>; 3] = core::array::from_fn(|gyro| {
        makes_up[gyro]
            .then(|| fast_parts(log, stops, gyro))
            .flatten()
    });
    let means = stops.iter().map(|samples| {
        let times = &log.time_s[samples.clone()];
        let (gyro, mut gyro_sigma) = moments(&log.gyro[samples.clone()], gyro_inflation);
        let mut gyro_quantisation = [0.0; 3];
        for (axis, parts) in fast.iter().enumerate() {
            if let Some(parts) = parts {
                let duration_s = log.interval_s * samples.len() as f64;
                let [white, quantised] = mean_variance_of(*parts, duration_s);
                gyro_sigma[axis] = (white + quantised).sqrt();
                gyro_quantisation[axis] = quantised.sqrt();
            }
        }
        let (accel, accel_sigma) = moments(&force[samples.clone()], accel_inflation);
        StopMeans {
            samples: samples.clone(),
            from_s: times[0],
            to_s: times[times.len() - 1],
            time_s: 0.5 * (times[0] + times[times.len() - 1]),
            gyro,
            gyro_sigma,
            gyro_quantisation,
            gyro_parts: parts(&log.gyro[samples.clone()], gyro),
            accel,
            accel_sigma,
        }
    });
    Ok(means.collect())
}

fn moments(samples: &[[f64; 3]], inflation: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let mean: [f64; 3] = core::array::from_fn(|axis| mean(samples, axis));
    let sigma = core::array::from_fn(|axis| {
        let variance = variance(samples, axis);
        (variance * inflation[axis] / samples.len() as f64).sqrt()
    });
    (mean, sigma)
}

/// Means over the parts of a stop, less that of all.
fn parts(samples: &[[f64; 3]], of_all: [f64; 3]) -> Vec<[f64; 3]> {
    let count = samples.len();
    let [least, mut parts] = PARTS;
    while parts > least && count < parts * FEWEST_SAMPLES {
        parts /= 2;
    }
    if count < parts * FEWEST_SAMPLES {
        return Vec::new();
    }
    let chunks = (0..parts).map(|part| &samples[part * count / parts..(part + 1) * count / parts]);
    chunks
        .map(|chunk| core::array::from_fn(|axis| mean(chunk, axis) - of_all[axis]))
        .collect()
}

/// Angle random walk and quantisation of a gyro within all stops.
fn fast_parts(log: &Log, stops: &[Range<usize>], gyro: usize) -> Option<[f64; 2]> {
    let longest = stops.iter().map(Range::len).max()?;
    let block_s = log.interval_s * longest as f64 / BLOCKS;
    let length = part_length(block_s, log.interval_s);
    let of_stop = |stop: &Range<usize>| -> Vec<f64> {
        let parts = log.gyro[stop.clone()].chunks_exact(length);
        parts.map(|part| mean(part, gyro)).collect()
    };
    let stretches: Vec<Vec<f64>> = stops.iter().map(of_stop).collect();
    let stretches: Vec<&[f64]> = stretches.iter().map(Vec::as_slice).collect();
    fast_parts_of(&stretches, log.interval_s * length as f64)
}

/// Variance of a mean over that of white noise, one or more; and whether it is less: samples make up for each other.
fn inflation(
    samples: &[[f64; 3]],
    interval_s: f64,
    stops: &[Range<usize>],
) -> ([f64; 3], [bool; 3]) {
    /// Standard deviations by which a ratio is less than one.
    const SURE: f64 = 3.0;
    let mut makes_up = [false; 3];
    let inflation = core::array::from_fn(|axis| {
        let mut largest = 1.0_f64;
        for block_s in BLOCKS_S {
            let block = (block_s / interval_s).round() as usize;
            let (mut between, mut within, mut freedom) = (0.0, 0.0, 0.0);
            for stop in stops
                .iter()
                .filter(|stop| block > 1 && stop.len() >= 2 * block)
            {
                let stop = &samples[stop.clone()];
                let means: Vec<[f64; 3]> = stop
                    .chunks_exact(block)
                    .map(|chunk| core::array::from_fn(|axis| mean(chunk, axis)))
                    .collect();
                let weight = (means.len() - 1) as f64;
                between += weight * variance(&means, axis) * block as f64;
                within += weight * variance(stop, axis);
                freedom += weight;
            }
            if freedom >= FEWEST_BLOCKS && within > 0.0 {
                let ratio = between / within;
                largest = largest.max(ratio);
                // The longest blocks tell last.
                makes_up[axis] = ratio * (1.0 + SURE * (2.0 / freedom).sqrt()) < 1.0;
            }
        }
        largest
    });
    (inflation, makes_up)
}

fn mean(samples: &[[f64; 3]], axis: usize) -> f64 {
    samples.iter().map(|sample| sample[axis]).sum::<f64>() / samples.len() as f64
}

fn variance(samples: &[[f64; 3]], axis: usize) -> f64 {
    let mean = mean(samples, axis);
    let squares = samples.iter().map(|sample| (sample[axis] - mean).powi(2));
    squares.sum::<f64>() / (samples.len() - 1) as f64
}
