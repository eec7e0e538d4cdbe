//! Ordinates of a record: its cosine transform, in bins.
//!
//! The squares of the coefficients C(k) of the DCT-II of white noise and of a random walk are
//! independent, whatever the length of the record, with the spectral density at k / 2n as mean: there is no
//! taper, and no power of a walk leaks.

use core::f64::consts::PI;

use rustfft::algorithm::{BluesteinsAlgorithm, Radix4};
use rustfft::num_complex::Complex64;
use rustfft::{Fft as _, FftDirection};

use super::parts::{NoisePart, PARTS};
use crate::math::{cos, sin, sin_cos};

/// Ordinates from the lowest on that have a bin each.
const SINGLE: usize = 16;

/// Ratio of the ends of a bin of higher ordinates: a random walk changes by a sixth over it.
const RATIO: f64 = 1.08;

/// Shapes of what is no noise of one frequency: the errors of the angle at both ends of the record, in even and odd
/// ordinates, and a ramp of the rate.
pub(super) const SHAPES: usize = 3;
pub(super) const RAMP: usize = 2;

/// Ordinates at neighbouring frequencies.
#[derive(Debug, Clone)]
pub(super) struct Bin {
    /// Frequency, in samples.
    pub(super) frequency: f64,
    /// Number of ordinates.
    pub(super) count: f64,
    /// Mean of their squares.
    pub(super) power: f64,
    /// Density of each part for a coefficient of one.
    pub(super) density: [f64; PARTS],
    /// Sums of the squares of each shape, and of its products with the ordinates.
    pub(super) shapes: [[f64; 2]; SHAPES],
}

/// Bins of the ordinates of values, from low to high frequencies.
pub(super) fn bins(values: &[f64]) -> Vec<Bin> {
    let count = values.len();
    let transform = cosine_transform(values);
    let bin = |from: usize, to: usize| {
        let own = &transform[from..to];
        let members = (to - from) as f64;
        let frequency = 0.5 * (from + to - 1) as f64 / (2 * count) as f64;
        let mut shapes = [[0.0; 2]; SHAPES];
        for (k, value) in (from..to).zip(own) {
            for (sums, shape) in shapes.iter_mut().zip(shapes_at(k, count)) {
                sums[0] += shape * shape;
                sums[1] += shape * value;
            }
        }
        Bin {
            frequency,
            count: members,
            power: own.iter().map(|value| value * value).sum::<f64>() / members,
            density: NoisePart::ALL.map(|part| part.density(frequency)),
            shapes,
        }
    };
    let mut bins = Vec::new();
    let mut from = 1;
    while from < count {
        let to = match from {
            ..=SINGLE => from + 1,
            _ => count.min((RATIO * from as f64).ceil() as usize),
        };
        bins.push(bin(from, to));
        from = to;
    }
    bins
}

/// The shapes at an ordinate, each with a unit of its cause.
fn shapes_at(k: usize, count: usize) -> [f64; SHAPES] {
    let (n, angle) = (count as f64, PI * k as f64 / (2 * count) as f64);
    let end = (2.0 / n).sqrt() * cos(angle);
    match k % 2 {
        0 => [end, 0.0, 0.0],
        // A ramp of one over the record.
        _ => [0.0, end, end / (n * sin(angle).powi(2))],
    }
}

/// DCT-II with orthonormal basis, by a transform of the even values followed by the odd ones backward (J. Makhoul,
/// IEEE Transactions on Acoustics, Speech, and Signal Processing 28, 1980).
fn cosine_transform(values: &[f64]) -> Vec<f64> {
    let count = values.len();
    let odd = values.iter().skip(1).step_by(2).rev();
    let mut buffer: Vec<Complex64> = values
        .iter()
        .step_by(2)
        .chain(odd)
        .map(|value| Complex64::from(*value))
        .collect();
    fourier_transform(&mut buffer);
    let scale = (2.0 / count as f64).sqrt();
    let turned = |(k, value): (usize, &Complex64)| {
        let (sin, cos) = sin_cos(PI * k as f64 / (2 * count) as f64);
        scale * (value.re * cos + value.im * sin)
    };
    buffer.iter().enumerate().map(turned).collect()
}

/// Fourier transform of any length. The two algorithms that it needs: a planner instantiates all of them.
pub(super) fn fourier_transform(buffer: &mut [Complex64]) {
    let (count, forward) = (buffer.len(), FftDirection::Forward);
    if count.is_power_of_two() {
        return Radix4::new(count, forward).process(buffer);
    }
    let inner = Radix4::new((2 * count).next_power_of_two(), forward);
    BluesteinsAlgorithm::new(count, std::sync::Arc::new(inner)).process(buffer);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinates_and_shapes_are_those_of_their_sums() {
        for count in [32, 53] {
            let values: Vec<f64> = (0..count).map(|i| ((i * i) as f64).sin()).collect();
            let direct = |values: &dyn Fn(usize) -> f64, k: usize| {
                let at =
                    |i: usize| values(i) * (PI * k as f64 * (i as f64 + 0.5) / count as f64).cos();
                (2.0 / count as f64).sqrt() * (0..count).map(at).sum::<f64>()
            };
            let found = cosine_transform(&values);
            for (k, found) in found.into_iter().enumerate().skip(1) {
                assert!((found - direct(&|i| values[i], k)).abs() < 1e-10);
                let [even, odd, ramp] = shapes_at(k, count);
                let last = |i: usize| f64::from(u8::from(i + 1 == count));
                assert!((even + odd - direct(&last, k).abs()).abs() < 1e-10);
                let rate = |i: usize| -2.0 * i as f64 / count as f64;
                assert!((ramp - direct(&rate, k)).abs() < 1e-10, "{k} {ramp}");
            }
        }
    }
}
