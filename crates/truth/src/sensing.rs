//! Outputs of the accelerometers before noise.

use crate::drift::Wave;
use crate::effect::Effect;
use crate::hidden::Hidden;
use crate::temperature::OfTemperature;
use crate::term::{Moment, Term};

/// Errors of the three accelerometers, axes 0, 1, 2.
#[derive(Debug)]
pub(crate) struct Sensing<'a> {
    parts: Vec<(usize, Part)>,
    terms: &'a [Term],
}

/// One error of the output of one accelerometer \[g\], with its size.
#[derive(Debug)]
enum Part {
    /// Proportional to a power of the specific force along the accelerometer.
    Power(f64, i32),
    Temperature(f64, OfTemperature),
    /// Per second.
    Ramp(f64),
    Wave(Wave),
    Sign(f64),
    DeadZone(f64),
    /// Proportional to the specific force along another axis.
    Cross(f64, usize),
}

impl<'a> Sensing<'a> {
    pub(crate) fn new(hidden: &[Hidden], terms: &'a [Term]) -> Self {
        Self {
            parts: hidden.iter().flat_map(Part::of).collect(),
            terms,
        }
    }

    /// The outputs without noise \[g\].
    pub(crate) fn output_g(&self, moment: &Moment) -> [f64; 3] {
        let mut output = moment.accel_g;
        for (axis, part) in &self.parts {
            output[*axis] += part.at(moment.accel_g[*axis], moment);
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
    /// Each with its accelerometer.
    fn of(hidden: &Hidden) -> Vec<(usize, Self)> {
        const DAY_S: f64 = 86_400.0;
        let size = hidden.value(0);
        vec![match hidden.effect() {
            Effect::AccelBias(axis) => (axis, Self::Power(size, 0)),
            Effect::AccelScale(axis) => (axis, Self::Power(size, 1)),
            Effect::AccelQuadratic(axis) => (axis, Self::Power(size, 2)),
            Effect::AccelTemperature { axis, of } => (axis, Self::Temperature(size, of)),
            Effect::AccelRamp(axis) => (axis, Self::Ramp(size / DAY_S)),
            Effect::AccelTone(axis) => (axis, Self::Wave(Wave::tone(hidden))),
            Effect::AccelSign(axis) => (axis, Self::Sign(size)),
            Effect::AccelDeadZone(axis) => (axis, Self::DeadZone(size)),
            Effect::Nonorthogonality([i, j]) => {
                return vec![(i, Self::Cross(size, j)), (j, Self::Cross(size, i))];
            }
            _ => return Vec::new(),
        }]
    }

    /// Given the specific force along the accelerometer.
    fn at(&self, along_g: f64, moment: &Moment) -> f64 {
        match self {
            Self::Power(size, power) => (0..*power).fold(*size, |product, _| product * along_g),
            Self::Temperature(size, of) => size * of.at(moment),
            Self::Ramp(per_s) => per_s * moment.time_s,
            Self::Wave(wave) => wave.at(moment.time_s),
            Self::Sign(size) if along_g < 0.0 => -size,
            Self::Sign(size) => *size,
            Self::DeadZone(size) if along_g.abs() < *size => -along_g,
            Self::DeadZone(_) => 0.0,
            Self::Cross(size, other) => size * moment.accel_g[*other],
        }
    }
}
