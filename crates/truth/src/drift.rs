//! The drift of the gyros with hidden effects.

use core::f64::consts::TAU;

use libm::{cos, exp, sin};

use crate::coefficients::Coefficients;
use crate::effect::Effect;
use crate::hidden::Hidden;
use crate::temperature::OfTemperature;
use crate::term::{Moment, Term};

/// Drift as a function of the moment.
///
/// It is smooth except where a *mode* changes: a step begins, a specific force changes its sign, a
/// gyro enters or leaves its dead zone. Modes are held until [`DriftLaw::update_modes`], so an
/// integrator sees a smooth function, detects by [`DriftLaw::mode_changed`] where it ends, and
/// restarts there.
#[derive(Debug)]
pub(crate) struct DriftLaw<'a> {
    coefficients: Coefficients,
    parts: Vec<(usize, Part)>,
    dead_zones: Vec<DeadZone>,
    /// Platform rates of the rates about the gyros' input axes, where these are different axes.
    platform_c_input: Option<[[f64; 3]; 3]>,
    terms: &'a [Term],
}

/// One addition to the drift of one gyro.
#[derive(Debug)]
enum Part {
    Product {
        size: f64,
        powers: [u8; 3],
    },
    /// Per second.
    Ramp(f64),
    /// The size and the time constant, s.
    Warmup(f64, f64),
    Wave(Wave),
    Temperature {
        size: f64,
        of: OfTemperature,
    },
    /// Per gauss, along an axis.
    Magnetic(f64, usize),
    Step {
        size: f64,
        onset_s: f64,
        on: bool,
    },
    Sign {
        size: f64,
        axis: usize,
        negative: bool,
    },
}

/// A sine wave that is locked to the first row.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Wave {
    sine: f64,
    cosine: f64,
    rate_rad_per_s: f64,
}

/// Dead zone of a gyro by friction: its drift less a size, 0 below it.
#[derive(Debug)]
struct DeadZone {
    gyro: usize,
    size: f64,
    side: f64,
}

const DAY_S: f64 = 86_400.0;
const HOUR_S: f64 = 3600.0;

impl<'a> DriftLaw<'a> {
    pub(crate) fn new(coefficients: Coefficients, hidden: &[Hidden], terms: &'a [Term]) -> Self {
        let mut law = Self {
            coefficients,
            parts: Vec::new(),
            dead_zones: Vec::new(),
            platform_c_input: None,
            terms,
        };
        let mut input_c_platform = IDENTITY;
        for effect in hidden {
            let size = effect.value(0);
            match effect.effect() {
                Effect::GyroDeadZone(gyro) => law.dead_zones.push(DeadZone {
                    gyro,
                    size,
                    side: 0.0,
                }),
                Effect::AxisMisalignment { gyro, towards } => {
                    input_c_platform[gyro][towards] += size;
                }
                _ => law.parts.extend(Part::of(effect)),
            }
        }
        if input_c_platform != IDENTITY {
            law.platform_c_input = Some(inverse(input_c_platform));
        }
        law
    }

    /// Drift of each gyro \[deg/h\].
    pub(crate) fn drift_deg_per_h(&self, moment: &Moment) -> [f64; 3] {
        let mut drift = self.free_drift_deg_per_h(moment);
        for zone in &self.dead_zones {
            let free = &mut drift[zone.gyro];
            *free = match zone.side == 0.0 {
                true => 0.0,
                false => *free - zone.side * zone.size,
            };
        }
        drift
    }

    /// The platform's rate in its own axes when the gyros drift so about their input axes.
    pub(crate) fn platform_rate(&self, input_rate: [f64; 3]) -> [f64; 3] {
        match &self.platform_c_input {
            Some(matrix) => matrix.map(|row| crate::attitude::dot(row, input_rate)),
            None => input_rate,
        }
    }

    /// True if a mode at this moment differs from the held one. Steps are left out: their onsets are
    /// known times.
    pub(crate) fn mode_changed(&self, moment: &Moment) -> bool {
        let signs = self.parts.iter().any(|(_, part)| match part {
            Part::Sign { axis, negative, .. } => (moment.accel_g[*axis] < 0.0) != *negative,
            _ => false,
        });
        if signs || self.dead_zones.is_empty() {
            return signs;
        }
        let free = self.free_drift_deg_per_h(moment);
        let mut zones = self.dead_zones.iter();
        zones.any(|zone| zone.side_of(free) != zone.side)
    }

    /// Sets the modes to those at this moment.
    pub(crate) fn update_modes(&mut self, moment: &Moment) {
        for (_, part) in &mut self.parts {
            match part {
                Part::Step { onset_s, on, .. } => *on = moment.time_s >= *onset_s,
                Part::Sign { axis, negative, .. } => *negative = moment.accel_g[*axis] < 0.0,
                _ => {}
            }
        }
        let free = self.free_drift_deg_per_h(moment);
        for zone in &mut self.dead_zones {
            zone.side = zone.side_of(free);
        }
    }

    /// True if the motion itself can change a mode.
    pub(crate) fn has_switches(&self) -> bool {
        let mut parts = self.parts.iter();
        !self.dead_zones.is_empty() || parts.any(|(_, part)| matches!(part, Part::Sign { .. }))
    }

    /// Onsets of steps, s.
    pub(crate) fn onsets_s(&self) -> impl Iterator<Item = f64> {
        self.parts.iter().filter_map(|(_, part)| match part {
            Part::Step { onset_s, .. } => Some(*onset_s),
            _ => None,
        })
    }

    /// Longest integration step for the parts that depend on time: a three-hundredth of a period, a
    /// sixtieth of a time constant. The error of 0.1 deg/h integrated so is 1e-13 rad after three
    /// days.
    pub(crate) fn longest_step_s(&self) -> f64 {
        /// Step for terms of the caller, whose rate of change is unknown.
        const UNKNOWN_S: f64 = 10.0;
        let mut terms = self.terms.iter();
        let unknown = terms.any(|term| matches!(term, Term::Drift(_)));
        let unknown = unknown.then_some(UNKNOWN_S);
        let parts = self.parts.iter().filter_map(|(_, part)| match part {
            Part::Wave(wave) => Some(TAU / wave.rate_rad_per_s / 300.0),
            Part::Warmup(_, time_constant_s) => Some(time_constant_s / 60.0),
            _ => None,
        });
        parts.chain(unknown).fold(f64::INFINITY, f64::min)
    }

    /// Drift without dead zones.
    fn free_drift_deg_per_h(&self, moment: &Moment) -> [f64; 3] {
        let mut drift = self.coefficients.drift_deg_per_h(moment.accel_g);
        for (gyro, part) in &self.parts {
            drift[*gyro] += part.at(moment);
        }
        for term in self.terms {
            if let Term::Drift(added) = term {
                let added = added(moment);
                drift = core::array::from_fn(|gyro| drift[gyro] + added[gyro]);
            }
        }
        drift
    }
}

impl Part {
    fn of(hidden: &Hidden) -> Option<(usize, Self)> {
        let size = hidden.value(0);
        let (gyro, part) = match hidden.effect() {
            Effect::GyroProduct { gyro, powers } => (gyro, Self::Product { size, powers }),
            Effect::GyroRamp(gyro) => (gyro, Self::Ramp(size / DAY_S)),
            Effect::GyroWarmup(gyro) => (gyro, Self::Warmup(size, hidden.value(1) * HOUR_S)),
            Effect::GyroDiurnal(gyro) => {
                (gyro, Self::Wave(Wave::new(size, hidden.value(1), DAY_S)))
            }
            Effect::GyroTone(gyro) => (gyro, Self::Wave(Wave::tone(hidden))),
            Effect::GyroTemperature { gyro, of } => (gyro, Self::Temperature { size, of }),
            Effect::GyroMagnetic(gyro) => (gyro, Self::Magnetic(size, gyro)),
            Effect::GyroStep(gyro) => {
                let (onset_s, on) = (hidden.value(1), false);
                (gyro, Self::Step { size, onset_s, on })
            }
            Effect::GyroSign { gyro, axis } => {
                let sign = Self::Sign {
                    size,
                    axis,
                    negative: false,
                };
                (gyro, sign)
            }
            _ => return None,
        };
        Some((gyro, part))
    }

    /// In the part's own gyro \[deg/h\].
    fn at(&self, moment: &Moment) -> f64 {
        match self {
            Self::Product { size, powers } => {
                let axes = moment.accel_g.iter().zip(powers);
                axes.fold(*size, |product, (accel, power)| {
                    (0..*power).fold(product, |product, _| product * accel)
                })
            }
            Self::Ramp(per_s) => per_s * moment.time_s,
            Self::Warmup(size, time_constant_s) => size * exp(-moment.time_s / time_constant_s),
            Self::Wave(wave) => wave.at(moment.time_s),
            Self::Temperature { size, of } => size * of.at(moment),
            Self::Magnetic(per_gauss, axis) => per_gauss * moment.field_gauss[*axis],
            Self::Step { size, on, .. } => f64::from(*on) * size,
            Self::Sign { size, negative, .. } => match negative {
                true => -size,
                false => *size,
            },
        }
    }
}

impl Wave {
    pub(crate) fn new(sine: f64, cosine: f64, period_s: f64) -> Self {
        let rate_rad_per_s = TAU / period_s;
        Self {
            sine,
            cosine,
            rate_rad_per_s,
        }
    }

    /// `size sin(2π t / period + phase)`.
    pub(crate) fn tone(hidden: &Hidden) -> Self {
        let [size, period_h, phase_deg] = hidden.three();
        let [sine, cosine] = [cos, sin].map(|of| size * of(phase_deg.to_radians()));
        Self::new(sine, cosine, period_h * HOUR_S)
    }

    pub(crate) fn at(&self, time_s: f64) -> f64 {
        let angle = self.rate_rad_per_s * time_s;
        self.sine * sin(angle) + self.cosine * cos(angle)
    }
}

impl DeadZone {
    fn side_of(&self, free_drift: [f64; 3]) -> f64 {
        let free = free_drift[self.gyro];
        match free.abs() <= self.size {
            true => 0.0,
            false => free.signum(),
        }
    }
}

const IDENTITY: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The inverse of a matrix near the identity, by its adjugate.
fn inverse(m: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let cofactor = |i: usize, j: usize| {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        m[a][c] * m[b][d] - m[a][d] * m[b][c]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    core::array::from_fn(|i| core::array::from_fn(|j| cofactor(j, i) / determinant))
}
