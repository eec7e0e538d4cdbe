use gyrocal::watch::{Grid, Linearised};
use gyrocal_watch::{JumpScores, Scores};

use super::noise::{Noise, Source};
use super::{ACCEL_NOISE_G, COLUMNS, DAY, DRIFT_NOISE, EFFECTS, INTERVAL_S, JUMPS, ONSETS, STATES};

/// Noise of a gyro beyond this many sigma in one sample turns the platform as a knock does.
const OUTLIER: f64 = 30.0;

/// An effect in a simulation, from a step on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Injected {
    /// Drift of a gyro, deg/h.
    Step(usize),
    /// Drift of a gyro that rises, deg/h/day.
    Ramp(usize),
    /// Drift of a gyro by the specific force along another axis, deg/h/g.
    Cross(usize, usize),
    /// Bias of an accelerometer, g.
    Bias(usize),
    /// Turn of the platform about an axis, rad.
    Knock(usize),
}

/// One realisation of a platform: errors of its filter, and the scores of its watch.
pub(super) struct Lane {
    pub(super) scores: Scores<f64, STATES, COLUMNS, EFFECTS, ONSETS>,
    pub(super) jump_scores: JumpScores<f64, 3, JUMPS>,
    error: [f64; STATES],
    source: Option<Source>,
    /// Walks of the gyros, deg/h/√h.
    walk: f64,
    /// Limit of the whitened innovations.
    clip: f64,
    /// The effect, its size and its onset.
    injected: Option<(Injected, f64, usize)>,
    /// The alarm: step and grid.
    pub(super) alarm: Option<(usize, Grid)>,
    /// An effect, and the first step at which it alone passes the threshold.
    pub(super) alone: Option<(usize, Option<usize>)>,
    /// Effects that could not be told apart at the alarm, the most likely one first.
    pub(super) set: Vec<usize>,
    /// The last step at which the noise of a gyro was beyond thirty sigma before the alarm, with its size.
    pub(super) outlier: Option<(usize, f64)>,
    /// Sum of squares of the innovations since the onset, and the same over its first day.
    pub(super) information: [f64; 2],
    pub(super) sums: [f64; 2],
    pub(super) alone_sum: f64,
}

impl Lane {
    /// A platform of a population and number with noise and walks of its own.
    pub(super) fn noisy(
        [population, number]: [u64; 2],
        stream: usize,
        noise: Noise,
        walk_deg_per_h_per_sqrt_h: f64,
    ) -> Self {
        let seed = population.wrapping_mul(1_000_003).wrapping_add(number);
        Self {
            source: Some(Source::new(seed, stream as u64, noise)),
            walk: walk_deg_per_h_per_sqrt_h,
            clip: 3.0,
            ..Self::silent()
        }
    }

    /// The same with an effect of a size from a step on.
    pub(super) fn with(self, effect: Injected, size: f64, onset: usize) -> Self {
        Self {
            injected: Some((effect, size, onset)),
            ..self
        }
    }

    /// A platform without noise.
    pub(super) fn silent() -> Self {
        Self {
            scores: Scores::new(),
            jump_scores: JumpScores::new(),
            error: [0.0; STATES],
            source: None,
            walk: 0.0,
            clip: f64::INFINITY,
            injected: None,
            alarm: None,
            alone: None,
            set: Vec::new(),
            outlier: None,
            information: [0.0; 2],
            sums: [0.0; 2],
            alone_sum: 0.0,
        }
    }

    /// Errors of the filter at its start: those of its prior.
    pub(super) fn start(&mut self, prior: &[f64; STATES]) {
        if let Some(source) = &mut self.source {
            let normals: [f64; STATES] = source.normals();
            self.error = core::array::from_fn(|i| normals[i] * prior[i]);
        }
    }

    /// Noise of a sample, in sigmas.
    fn sample(&mut self) -> [f64; 6] {
        self.source.as_mut().map_or([0.0; 6], Source::sample)
    }

    /// A step of the filter; gives the whitened innovation, clipped.
    pub(super) fn step(&mut self, row: usize, at: &Linearised<f64>, force: &[f64; 3]) -> [f64; 3] {
        let noise = self.sample();
        let [x, y, z, ..] = noise.map(f64::abs);
        let largest = x.max(y).max(z);
        if largest > OUTLIER && self.alarm.is_none() {
            self.outlier = Some((row, largest));
        }
        let mut drift: [f64; 3] = core::array::from_fn(|gyro| DRIFT_NOISE * noise[gyro]);
        let mut accel: [f64; 3] = core::array::from_fn(|axis| ACCEL_NOISE_G * noise[3 + axis]);
        let mut moving = [0.0; 3];
        let injected = self.injected.filter(|(_, _, onset)| row > *onset);
        if let Some((effect, size, onset)) = injected {
            let since = (row - onset) as f64;
            match effect {
                Injected::Step(gyro) => drift[gyro] += size,
                Injected::Ramp(gyro) => drift[gyro] += size * (since - 0.5) / DAY as f64,
                Injected::Cross(gyro, axis) => drift[gyro] += size * force[axis],
                Injected::Bias(axis) => accel[axis] += size,
                Injected::Knock(axis) if row == onset + 1 => moving[axis] = size,
                Injected::Knock(_) => {}
            }
        }
        for (moving, row) in moving.iter_mut().zip(&at.transition) {
            for (element, error) in row.iter().zip(&self.error) {
                *moving += element * error;
            }
            for (gyro, drift) in drift.iter().enumerate() {
                *moving += row[3 + 3 * gyro] * drift;
            }
        }
        self.error[..3].copy_from_slice(&moving);
        // What follows in the order of the filter: walk, then the sample.
        if let Some(source) = self.source.as_mut().filter(|_| self.walk > 0.0) {
            let normals: [f64; 3] = source.normals();
            for (gyro, normal) in normals.into_iter().enumerate() {
                self.error[3 + 3 * gyro] += self.walk * (INTERVAL_S / 3600.0).sqrt() * normal;
            }
        }
        let innovation = self.innovation(at, &accel);
        if let Some((_, _, onset)) = injected {
            let square: f64 = innovation.iter().map(|value| value * value).sum();
            self.information[0] += square;
            if row - onset <= DAY {
                self.information[1] += square;
            }
        }
        let clipped = core::array::from_fn(|k| {
            // As in the filter: only where the state is as certain as the sample.
            let variance = at.observed.whitening[k][k].powi(-2);
            if variance > 2.0 * ACCEL_NOISE_G * ACCEL_NOISE_G {
                innovation[k]
            } else {
                innovation[k].clamp(-self.clip, self.clip)
            }
        });
        self.take(at, clipped)
    }

    /// The first sample, which is taken as it is.
    pub(super) fn correct(&mut self, at: &Linearised<f64>) {
        let noise = self.sample();
        let accel = core::array::from_fn(|axis| ACCEL_NOISE_G * noise[3 + axis]);
        let innovation = self.innovation(at, &accel);
        self.take(at, innovation);
    }

    fn innovation(&self, at: &Linearised<f64>, accel: &[f64; 3]) -> [f64; 3] {
        core::array::from_fn(|k| {
            let (output, whitening) = (&at.observed.output[k], &at.observed.whitening[k]);
            (0..3).fold(0.0, |value, i| {
                value + output[i] * self.error[i] + whitening[i] * accel[i]
            })
        })
    }

    fn take(&mut self, at: &Linearised<f64>, innovation: [f64; 3]) -> [f64; 3] {
        for (gain, value) in at.observed.gain.iter().zip(innovation) {
            for (error, gain) in self.error.iter_mut().zip(gain) {
                *error -= gain * value;
            }
        }
        innovation
    }
}
