//! Outputs of the accelerometers before noise.

use crate::drift::Wave;
use crate::effect::Effect;
use crate::hidden::Hidden;
use crate::temperature::OfTemperature;
use crate::term::{Moment, Term};

/// Errors of the three accelerometers, axes 0, 1, 2.
#[derive(Debug)]
pub(crate) struct Sensing<'a> {
    parts: Vec<Part>,
    terms: &'a [Term],
}

/// One error of the output \[g\].
#[derive(Debug)]
enum Part {
    /// Proportional to a power of the specific force along the accelerometer.
    Power {
        axis: usize,
        size: f64,
        power: i32,
    },
    Temperature {
        axis: usize,
        size: f64,
        of: OfTemperature,
    },
    Ramp {
        axis: usize,
        per_s: f64,
    },
    Wave {
        axis: usize,
        wave: Wave,
    },
    Sign {
        axis: usize,
        size: f64,
    },
    DeadZone {
        axis: usize,
        size: f64,
    },
    Nonorthogonality {
        axes: [usize; 2],
        size: f64,
    },
}

impl<'a> Sensing<'a> {
    pub(crate) fn new(hidden: &[Hidden], terms: &'a [Term]) -> Self {
        Self {
            parts: hidden.iter().filter_map(Part::of).collect(),
            terms,
        }
    }

    /// The outputs without noise \[g\].
    pub(crate) fn output_g(&self, moment: &Moment) -> [f64; 3] {
        let mut output = moment.accel_g;
        for part in &self.parts {
            part.add_to(&mut output, moment);
        }
        for term in self.terms {
            if let Term::Output(error) = term {
                let error = error(moment);
                output = core::array::from_fn(|axis| output[axis] + error[axis]);
            }
        }
        output
    }
}

impl Part {
    fn of(hidden: &Hidden) -> Option<Self> {
        const DAY_S: f64 = 86_400.0;
        let size = hidden.value(0);
        let power = |axis, power| Self::Power { axis, size, power };
        Some(match hidden.effect() {
            Effect::AccelBias(axis) => power(axis, 0),
            Effect::AccelScale(axis) => power(axis, 1),
            Effect::AccelQuadratic(axis) => power(axis, 2),
            Effect::AccelTemperature { axis, of } => Self::Temperature { axis, size, of },
            Effect::AccelRamp(axis) => Self::Ramp {
                axis,
                per_s: size / DAY_S,
            },
            Effect::AccelTone(axis) => Self::Wave {
                axis,
                wave: Wave::tone(hidden),
            },
            Effect::AccelSign(axis) => Self::Sign { axis, size },
            Effect::AccelDeadZone(axis) => Self::DeadZone { axis, size },
            Effect::Nonorthogonality(axes) => Self::Nonorthogonality { axes, size },
            _ => return None,
        })
    }

    fn add_to(&self, output_g: &mut [f64; 3], moment: &Moment) {
        let accel_g = moment.accel_g;
        match self {
            Self::Power { axis, size, power } => {
                output_g[*axis] += (0..*power).fold(*size, |product, _| product * accel_g[*axis]);
            }
            Self::Temperature { axis, size, of } => output_g[*axis] += size * of.at(moment),
            Self::Ramp { axis, per_s } => output_g[*axis] += per_s * moment.time_s,
            Self::Wave { axis, wave } => output_g[*axis] += wave.at(moment.time_s),
            Self::Sign { axis, size } => {
                output_g[*axis] += if accel_g[*axis] < 0.0 { -size } else { *size };
            }
            Self::DeadZone { axis, size } => {
                if accel_g[*axis].abs() < *size {
                    output_g[*axis] -= accel_g[*axis];
                }
            }
            Self::Nonorthogonality { axes: [i, j], size } => {
                output_g[*i] += size * accel_g[*j];
                output_g[*j] += size * accel_g[*i];
            }
        }
    }
}
