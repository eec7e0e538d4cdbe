use gyrocal::watch::{Courses, EFFECTS_BY_DEFAULT, Grid, WatchSettings, WatchedEffect, columns};
use gyrocal_statistics::deviates::Draw;
use gyrocal_watch::{Observed, Step, Watch};

use super::noise::{Noise, Source};
use super::platform::Platform;
use super::{ACCEL_NOISE_G, COLUMNS, DAY, DRIFT_NOISE, EFFECTS, INTERVAL_S, STATES};
use crate::harness::Error;

/// Onsets of effects and of jumps that live at a time, as in the watch of the filter.
const ONSETS: usize = 10;
const JUMPS: usize = 12;
const HALF: usize = STATES * (STATES + 1) / 2;

/// Noise of a gyro beyond this many sigma in one sample turns the platform as a knock does.
const OUTLIER: f64 = 30.0;

/// An effect in a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Effect {
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

/// A watch over some effects, with its first alarm. That of a single effect alone has no jumps.
struct Test<const E: usize> {
    effects: [WatchedEffect; E],
    settings: WatchSettings<f64>,
    watch: Box<Watch<f64, 3, 3, STATES, COLUMNS, E, ONSETS, JUMPS, HALF>>,
    alarm: Option<Alarm>,
}

/// An alarm.
#[derive(Clone, Debug)]
pub(super) struct Alarm {
    pub(super) row: usize,
    pub(super) grid: Grid,
    /// Effects that cannot be told apart then; jumps follow the effects.
    pub(super) set: Vec<usize>,
}

impl<const E: usize> Test<E> {
    fn start(effects: [WatchedEffect; E], platform: &Platform) -> Result<Self, Error> {
        let entries = effects.map(|effect| effect.entry(COLUMNS));
        let information = effects.map(|effect| effect.information_of_a_day(&platform.settings));
        let mut test = Self {
            effects,
            settings: platform.watch,
            watch: Box::new(Watch::unset(columns(), entries)),
            alarm: None,
        };
        let courses = test.courses(platform);
        let settings = test.settings.of_test(information);
        match test.watch.start(&settings, &courses.0) {
            true => Ok(test),
            false => Err("settings that no watch starts with".into()),
        }
    }

    fn courses(&self, platform: &Platform) -> Courses<f64, E> {
        let filter = platform.filter.filter();
        let (inputs, drift) = (filter.kernel().inputs(), filter.drift().to_array());
        Courses::ahead(&self.effects, inputs, &drift, self.settings.block_s)
    }

    fn step(&mut self, row: usize, step: &Step<'_, f64, 3, 3, STATES>, innovation: &[f64; 3]) {
        let alarm = self.watch.step(step, innovation);
        let alarm = alarm.filter(|grid| E > 1 || *grid == Grid::Effects);
        if let (Some(grid), None) = (alarm, &self.alarm) {
            let mut set = Vec::new();
            let (watch, width) = (&self.watch, self.settings.set_width);
            watch.candidates(width, |candidate| set.push(candidate.effect));
            self.alarm = Some(Alarm { row, grid, set });
        }
    }
}

/// One realisation of a platform: errors of its filter, and its watch.
pub(super) struct Lane {
    error: [f64; STATES],
    source: Option<Source>,
    /// Walks of the gyros, deg/h/√h.
    walk: f64,
    /// The effect, its size and its onset.
    injected: Option<(Effect, f64, usize)>,
    watch: Option<Test<EFFECTS>>,
    /// An effect that a watch of its own is beside for.
    sought: Option<usize>,
    alone: Option<Test<1>>,
    /// The last step at which the noise of a gyro was beyond thirty sigma.
    pub(super) outlier: Option<usize>,
    /// Sum of squares of the innovations since the onset.
    pub(super) information: f64,
}

impl Lane {
    /// Standard deviation of the attitude at the start.
    pub(super) const START_RAD: f64 = 0.01 * core::f64::consts::PI / 180.0;

    /// A platform of a population and number with noise and walks of its own.
    pub(super) fn noisy(
        [population, number]: [u64; 2],
        stream: usize,
        noise: Noise,
        walk_deg_per_h_per_sqrt_h: f64,
    ) -> Self {
        let seed = population.wrapping_mul(1_000_003).wrapping_add(number);
        Self {
            source: Some(Source::new(Draw::new(seed, stream as u64), noise)),
            walk: walk_deg_per_h_per_sqrt_h,
            ..Self::silent()
        }
    }

    /// The same with an effect of a size from a step on.
    pub(super) fn with(self, effect: Effect, size: f64, onset: usize) -> Self {
        let injected = Some((effect, size, onset));
        Self { injected, ..self }
    }

    /// The same with a watch for one effect alone beside it.
    pub(super) fn beside(self, effect: usize) -> Self {
        let sought = Some(effect);
        Self { sought, ..self }
    }

    /// A platform without noise and without a watch.
    pub(super) fn silent() -> Self {
        Self {
            error: [0.0; STATES],
            source: None,
            walk: 0.0,
            injected: None,
            watch: None,
            sought: None,
            alone: None,
            outlier: None,
            information: 0.0,
        }
    }

    /// The first alarm, and the step of that of the effect alone.
    pub(super) fn alarms(&self) -> (Option<&Alarm>, Option<usize>) {
        let alone = self.alone.as_ref().and_then(|test| test.alarm.as_ref());
        let alarm = self.watch.as_ref().and_then(|test| test.alarm.as_ref());
        (alarm, alone.map(|alarm| alarm.row))
    }

    pub(super) fn is_done(&self) -> bool {
        let (alarm, alone) = self.alarms();
        alarm.is_some() && alone.is_some() == self.alone.is_some()
    }

    /// Errors of the prior, and the first sample, which is taken as it is.
    pub(super) fn start(&mut self, platform: &Platform) -> Result<(), Error> {
        let Some(source) = &mut self.source else {
            return Ok(());
        };
        let normals: [f64; STATES] = source.normals();
        let sigma = |state| if state < 3 { Self::START_RAD } else { 1.0 };
        self.error = core::array::from_fn(|state| sigma(state) * normals[state]);
        let [.., x, y, z] = source.sample().map(|noise| ACCEL_NOISE_G * noise);
        let observed = &platform.filter.linearised().observed;
        let innovation = self.innovation(observed, &[x, y, z]);
        self.take(observed, &innovation);
        self.watch = Some(Test::start(EFFECTS_BY_DEFAULT, platform)?);
        if let Some(sought) = self.sought {
            self.alone = Some(Test::start([EFFECTS_BY_DEFAULT[sought]], platform)?);
        }
        Ok(())
    }

    /// A step of filter and watch.
    pub(super) fn step(
        &mut self,
        row: usize,
        step: &Step<'_, f64, 3, 3, STATES>,
        observed: &Observed<f64, 3, 3, STATES>,
        force: &[f64; 3],
    ) {
        let noise = self.source.as_mut().map_or([0.0; 6], Source::sample);
        if noise[..3].iter().any(|one| one.abs() > OUTLIER) {
            self.outlier = Some(row);
        }
        let [mut drift, mut accel] = [[0.0; 3]; 2];
        for axis in 0..3 {
            drift[axis] = DRIFT_NOISE * noise[axis];
            accel[axis] = ACCEL_NOISE_G * noise[3 + axis];
        }
        let mut moving = [0.0; 3];
        let injected = self.injected.filter(|(_, _, onset)| row > *onset);
        if let Some((effect, size, onset)) = injected {
            let since = (row - onset) as f64;
            match effect {
                Effect::Step(gyro) => drift[gyro] += size,
                Effect::Ramp(gyro) => drift[gyro] += size * (since - 0.5) / DAY as f64,
                Effect::Cross(gyro, axis) => drift[gyro] += size * force[axis],
                Effect::Bias(axis) => accel[axis] += size,
                Effect::Knock(axis) if row == onset + 1 => moving[axis] = size,
                Effect::Knock(_) => {}
            }
        }
        for (moving, row) in moving.iter_mut().zip(step.transition) {
            *moving += row.iter().zip(&self.error).map(|(a, b)| a * b).sum::<f64>();
            let by_drift = (0..3).map(|gyro| row[3 + 3 * gyro] * drift[gyro]);
            *moving += by_drift.sum::<f64>();
        }
        self.error[..3].copy_from_slice(&moving);
        // What follows in the order of the filter: walk, then the sample.
        if let Some(source) = self.source.as_mut().filter(|_| self.walk > 0.0) {
            let normals: [f64; 3] = source.normals();
            for (gyro, normal) in normals.into_iter().enumerate() {
                self.error[3 + 3 * gyro] += self.walk * (INTERVAL_S / 3600.0).sqrt() * normal;
            }
        }
        let innovation = self.innovation(observed, &accel);
        if injected.is_some() {
            self.information += innovation.iter().map(|value| value * value).sum::<f64>();
        }
        let taken = match &self.watch {
            Some(test) => clipped(observed, &innovation, test.settings.clip),
            None => innovation,
        };
        self.take(observed, &taken);
        if let Some(watch) = &mut self.watch {
            watch.step(row, step, &taken);
        }
        if let Some(alone) = &mut self.alone {
            alone.step(row, step, &taken);
        }
    }

    pub(super) fn end_block(&mut self, platform: &Platform) {
        if let Some(test) = &mut self.watch {
            test.watch.end_block(&test.courses(platform).0);
        }
        if let Some(test) = &mut self.alone {
            test.watch.end_block(&test.courses(platform).0);
        }
    }

    fn innovation(&self, observed: &Observed<f64, 3, 3, STATES>, accel: &[f64; 3]) -> [f64; 3] {
        core::array::from_fn(|k| {
            let (output, whitening) = (&observed.output[k], &observed.whitening[k]);
            let part = |i: usize| output[i] * self.error[i] + whitening[i] * accel[i];
            (0..3).map(part).sum()
        })
    }

    fn take(&mut self, observed: &Observed<f64, 3, 3, STATES>, innovation: &[f64; 3]) {
        for (gain, value) in observed.gain.iter().zip(innovation) {
            for (error, gain) in self.error.iter_mut().zip(gain) {
                *error -= gain * value;
            }
        }
    }
}

/// As in the filter: clipped only where the state is as certain as the sample.
fn clipped(observed: &Observed<f64, 3, 3, STATES>, innovation: &[f64; 3], clip: f64) -> [f64; 3] {
    core::array::from_fn(|k| {
        let variance = observed.whitening[k][k].powi(-2);
        match variance > 2.0 * ACCEL_NOISE_G * ACCEL_NOISE_G {
            true => innovation[k],
            false => innovation[k].clamp(-clip, clip),
        }
    })
}
