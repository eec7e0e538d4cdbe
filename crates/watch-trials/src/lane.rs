use gyrocal::watch::{Grid, Linearised};
use gyrocal_watch::{JumpScores, Scores};

use crate::noise::{Noise, Source};
use crate::sizes::{COLUMNS, EFFECTS, JUMPS, ONSETS, STATES};

/// Noise of a gyro beyond this many sigma in one sample turns the platform as a knock does.
const OUTLIER: f64 = 30.0;

/// An effect in a simulation, from a step on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Injected {
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
#[derive(Debug)]
pub struct Lane {
    pub(crate) scores: Scores<f64, STATES, COLUMNS, EFFECTS, ONSETS>,
    pub(crate) jump_scores: JumpScores<f64, 3, JUMPS>,
    pub(crate) error: [f64; STATES],
    pub(crate) source: Option<Source>,
    pub(crate) walk: [f64; 3],
    pub(crate) clip: f64,
    /// The effect, its size and its onset.
    pub injected: Option<(Injected, f64, usize)>,
    /// The alarm: step and grid.
    pub alarm: Option<(usize, Grid)>,
    /// First step at which the effect at this index alone passes the threshold.
    pub alone: Option<(usize, Option<usize>)>,
    /// Effects that could not be told apart at the alarm, the most likely one first.
    pub set: Vec<usize>,
    /// The last step at which the noise of a gyro was beyond thirty sigma before the alarm, with its size.
    pub outlier: Option<(usize, f64)>,
    /// Sum of squares of the innovations since the onset, and the same over its first day.
    pub information: [f64; 2],
    pub(crate) sums: [f64; 2],
    pub(crate) alone_sum: f64,
}

/// Noise of a step, declared.
pub(crate) struct Sigmas {
    pub(crate) drift: f64,
    pub(crate) accel: f64,
    /// Of a walk over a step, per unit of deg/h/√h.
    pub(crate) walk: f64,
}

impl Lane {
    /// A platform with noise and walks of its own.
    #[must_use]
    pub fn noisy(seed: u64, stream: u64, noise: Noise, walk_deg_per_h_per_sqrt_h: f64) -> Self {
        let mut lane = Self::silent();
        lane.source = Some(Source::new(seed, stream, noise));
        lane.walk = [walk_deg_per_h_per_sqrt_h; 3];
        lane.clip = 3.0;
        lane
    }

    /// A platform without noise.
    #[must_use]
    pub fn silent() -> Self {
        Self {
            scores: Scores::new(),
            jump_scores: JumpScores::new(),
            error: [0.0; STATES],
            source: None,
            walk: [0.0; 3],
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
    pub(crate) fn start(&mut self, prior: &[f64; STATES]) {
        if let Some(source) = &mut self.source {
            let normals: [f64; STATES] = source.normals();
            self.error = core::array::from_fn(|i| normals[i] * prior[i]);
        }
    }

    /// A step of the filter; gives the whitened innovation, clipped.
    pub(crate) fn step(
        &mut self,
        row: usize,
        at: &Linearised<f64>,
        force: &[f64; 3],
        sigmas: &Sigmas,
    ) -> [f64; 3] {
        let noise = match &mut self.source {
            Some(source) => source.sample(),
            None => [0.0; 6],
        };
        let [x, y, z, ..] = noise.map(f64::abs);
        let largest = x.max(y).max(z);
        if largest > OUTLIER && self.alarm.is_none() {
            self.outlier = Some((row, largest));
        }
        let mut drift: [f64; 3] = core::array::from_fn(|gyro| sigmas.drift * noise[gyro]);
        let mut accel: [f64; 3] = core::array::from_fn(|axis| sigmas.accel * noise[3 + axis]);
        let mut knock = [0.0; 3];
        if let Some((effect, size, onset)) = self.injected
            && row > onset
        {
            let since = (row - onset) as f64;
            match effect {
                Injected::Step(gyro) => drift[gyro] += size,
                Injected::Ramp(gyro) => drift[gyro] += size * (since - 0.5) / 1440.0,
                Injected::Cross(gyro, axis) => drift[gyro] += size * force[axis],
                Injected::Bias(axis) => accel[axis] += size,
                Injected::Knock(axis) if row == onset + 1 => knock[axis] = size,
                Injected::Knock(_) => {}
            }
        }
        let mut moving = knock;
        for (i, row) in at.transition.iter().enumerate() {
            for (element, error) in row.iter().zip(&self.error) {
                moving[i] += element * error;
            }
            for (gyro, drift) in drift.iter().enumerate() {
                moving[i] += row[3 + 3 * gyro] * drift;
            }
        }
        self.error[..3].copy_from_slice(&moving);
        // What follows in the order of the filter: walk, then the sample.
        if self.walk[0] > 0.0
            && let Some(source) = &mut self.source
        {
            let normals: [f64; 3] = source.normals();
            for gyro in 0..3 {
                self.error[3 + 3 * gyro] += self.walk[gyro] * sigmas.walk * normals[gyro];
            }
        }
        let innovation = self.innovation(at, &accel);
        if let Some((_, _, onset)) = self.injected
            && row > onset
        {
            let square: f64 = innovation.iter().map(|value| value * value).sum();
            self.information[0] += square;
            if row - onset <= 1440 {
                self.information[1] += square;
            }
        }
        let clipped = core::array::from_fn(|k| {
            // As in the filter: only where the state is as certain as the sample.
            let variance = at.observed.whitening[k][k].powi(-2);
            if variance > 2.0 * sigmas.accel * sigmas.accel {
                innovation[k]
            } else {
                innovation[k].clamp(-self.clip, self.clip)
            }
        });
        self.take(at, clipped)
    }

    /// The first sample, which is taken as it is.
    pub(crate) fn correct(&mut self, at: &Linearised<f64>, sigmas: &Sigmas) {
        let noise = match &mut self.source {
            Some(source) => source.sample(),
            None => [0.0; 6],
        };
        let accel = core::array::from_fn(|axis| sigmas.accel * noise[3 + axis]);
        let innovation = self.innovation(at, &accel);
        self.take(at, innovation);
    }

    fn innovation(&self, at: &Linearised<f64>, accel: &[f64; 3]) -> [f64; 3] {
        let mut innovation = [0.0; 3];
        for (k, value) in innovation.iter_mut().enumerate() {
            for i in 0..3 {
                *value += at.observed.output[k][i] * self.error[i];
                *value += at.observed.whitening[k][i] * accel[i];
            }
        }
        innovation
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
