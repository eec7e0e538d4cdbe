//! Names of the effects that a scenario can hide, and the parameters of each.

use gyrocal_record::{AXES, Bound};

use crate::temperature::OfTemperature;

/// Drifts in deg/h, and such by g, K or gauss: up to three degrees a second; more are a mistake in a unit.
pub(crate) const DRIFT: Bound = Bound::Within(-MAX_DRIFT, MAX_DRIFT);

/// Noise and random walks in deg/h: up to the largest drift.
pub(crate) const DRIFT_SPREAD: Bound = Bound::Within(0.0, MAX_DRIFT);

const MAX_DRIFT: f64 = 1e4;

/// An effect; gyros, accelerometers and axes are 0, 1, 2 for x, y, z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Effect {
    /// Drift proportional to a product of specific forces, with how often each axis enters.
    GyroProduct {
        gyro: usize,
        powers: [u8; 3],
    },
    GyroRamp(usize),
    GyroStep(usize),
    GyroWarmup(usize),
    GyroDiurnal(usize),
    GyroTemperature {
        gyro: usize,
        of: OfTemperature,
    },
    GyroMagnetic(usize),
    GyroTone(usize),
    GyroSign {
        gyro: usize,
        axis: usize,
    },
    GyroDeadZone(usize),
    GyroRandomWalk(usize),
    GyroNoise(usize),
    AxisMisalignment {
        gyro: usize,
        towards: usize,
    },
    AccelBias(usize),
    AccelScale(usize),
    AccelQuadratic(usize),
    AccelTemperature {
        axis: usize,
        of: OfTemperature,
    },
    AccelRamp(usize),
    AccelTone(usize),
    AccelSign(usize),
    AccelDeadZone(usize),
    AccelNoise(usize),
    AccelQuantisation(usize),
    Nonorthogonality([usize; 2]),
    Outliers,
    ColouredNoise,
    Latitude,
    EarthRate,
    Gravity,
    ClockRate,
    InitialAttitude,
    Knock,
}

/// A parameter of an effect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Parameter {
    pub(crate) name: &'static str,
    pub(crate) unit: &'static str,
    pub(crate) bound: Bound,
    /// Default value; `None` if the parameter must be given.
    pub(crate) default: Option<f64>,
    /// True if the effect is proportional to it.
    pub(crate) is_size: bool,
}

const fn size(unit: &'static str) -> Parameter {
    Parameter {
        name: "size",
        unit,
        bound: Bound::Finite,
        default: None,
        is_size: true,
    }
}

const fn shape(name: &'static str, unit: &'static str, bound: Bound) -> Parameter {
    Parameter {
        name,
        unit,
        bound,
        default: None,
        is_size: false,
    }
}

/// A parameter that is zero if it is not given.
const fn part(name: &'static str, unit: &'static str) -> Parameter {
    Parameter {
        name,
        unit,
        bound: Bound::Finite,
        default: Some(0.0),
        is_size: true,
    }
}

const ONSET: Parameter = shape("onset_s", "s", Bound::NotNegative);
const TIME_CONSTANT: Parameter = shape("time_constant_h", "h", Bound::Positive);
const PERIOD: Parameter = shape("period_h", "h", Bound::Positive);
const PHASE: Parameter = Parameter {
    default: Some(0.0),
    ..shape("phase_deg", "deg", Bound::Finite)
};
const RATIO: Parameter = shape("ratio", "1", Bound::NotNegative);
const ANGLES: [Parameter; 3] = [
    part("x_deg", "deg"),
    part("y_deg", "deg"),
    part("z_deg", "deg"),
];

impl Effect {
    /// The parameters, in the order in which their values are kept.
    pub(crate) fn parameters(self) -> Vec<Parameter> {
        let mut all = self.unbounded();
        for parameter in &mut all {
            parameter.bound = match parameter.bound {
                Bound::Finite if parameter.unit.starts_with("deg/h") => DRIFT,
                Bound::NotNegative if parameter.unit == "deg/h/sqrt(h)" => DRIFT_SPREAD,
                bound => bound,
            };
        }
        all
    }

    /// The same without the bounds of drifts.
    fn unbounded(self) -> Vec<Parameter> {
        match self {
            Self::GyroProduct { powers, .. } => vec![size(match powers.iter().sum::<u8>() {
                0 => "deg/h",
                1 => "deg/h/g",
                2 => "deg/h/g^2",
                _ => "deg/h/g^3",
            })],
            Self::GyroRamp(_) => vec![size("deg/h/day")],
            Self::GyroStep(_) => vec![size("deg/h"), ONSET],
            Self::GyroWarmup(_) => vec![size("deg/h"), TIME_CONSTANT],
            Self::GyroDiurnal(_) => vec![part("sine", "deg/h"), part("cosine", "deg/h")],
            Self::GyroTemperature { of, .. } => vec![size(match of {
                OfTemperature::Itself | OfTemperature::Hysteresis => "deg/h/K",
                OfTemperature::Square => "deg/h/K^2",
                OfTemperature::Rate => "deg/h/(K/h)",
            })],
            Self::GyroMagnetic(_) => vec![size("deg/h/gauss")],
            Self::GyroTone(_) => vec![size("deg/h"), PERIOD, PHASE],
            Self::GyroSign { .. } => vec![size("deg/h")],
            Self::GyroDeadZone(_) => vec![not_negative("deg/h")],
            Self::GyroRandomWalk(_) => vec![not_negative("deg/h/sqrt(h)")],
            Self::GyroNoise(_) | Self::AccelNoise(_) => vec![RATIO],
            Self::AxisMisalignment { .. } | Self::Nonorthogonality(_) => vec![small("rad")],
            Self::AccelBias(_) | Self::AccelSign(_) => vec![size("g")],
            Self::AccelScale(_) | Self::EarthRate | Self::Gravity | Self::ClockRate => {
                vec![small("1")]
            }
            Self::AccelQuadratic(_) => vec![size("g/g^2")],
            Self::AccelTemperature { of, .. } => vec![size(match of {
                OfTemperature::Itself | OfTemperature::Hysteresis => "g/K",
                OfTemperature::Square => "g/K^2",
                OfTemperature::Rate => "g/(K/h)",
            })],
            Self::AccelRamp(_) => vec![size("g/day")],
            Self::AccelTone(_) => vec![size("g"), PERIOD, PHASE],
            Self::AccelDeadZone(_) => vec![not_negative("g")],
            Self::AccelQuantisation(_) => vec![Parameter {
                is_size: true,
                ..shape("lsb", "g", Bound::Positive)
            }],
            Self::Outliers => vec![
                shape("fraction", "1", Bound::Within(0.0, 1.0)),
                size("sigma"),
            ],
            Self::ColouredNoise => {
                vec![shape("correlation", "1", Bound::Within(-0.999, 0.999))]
            }
            Self::Latitude => vec![size("deg")],
            Self::InitialAttitude => ANGLES.to_vec(),
            Self::Knock => vec![ANGLES[0], ANGLES[1], ANGLES[2], ONSET],
        }
    }

    /// True if a record can have it more than once, with different onsets or periods.
    pub(crate) fn can_repeat(self) -> bool {
        matches!(
            self,
            Self::GyroStep(_)
                | Self::GyroWarmup(_)
                | Self::GyroTone(_)
                | Self::AccelTone(_)
                | Self::Knock
        )
    }

    /// The effect of an id.
    pub(crate) fn of(id: &str) -> Option<Self> {
        let mut all = Self::all().into_iter();
        all.find_map(|(name, effect)| (name == id).then_some(effect))
    }

    /// Every effect with its id.
    pub(crate) fn all() -> Vec<(String, Self)> {
        let mut all = Vec::new();
        for (gyro, letter) in AXES.into_iter().enumerate() {
            for powers in products() {
                let name = format!("gyro_{letter}.{}", product_name(powers));
                all.push((name, Self::GyroProduct { gyro, powers }));
            }
            for of in OfTemperature::ALL {
                let effect = Self::GyroTemperature { gyro, of };
                all.push((format!("gyro_{letter}.{}", of.name()), effect));
            }
            let single: [(&str, Self); 9] = [
                ("ramp", Self::GyroRamp(gyro)),
                ("step", Self::GyroStep(gyro)),
                ("warmup", Self::GyroWarmup(gyro)),
                ("diurnal", Self::GyroDiurnal(gyro)),
                ("random_walk", Self::GyroRandomWalk(gyro)),
                ("noise", Self::GyroNoise(gyro)),
                ("magnetic", Self::GyroMagnetic(gyro)),
                ("tone", Self::GyroTone(gyro)),
                ("dead_zone", Self::GyroDeadZone(gyro)),
            ];
            all.extend(single.map(|(name, effect)| (format!("gyro_{letter}.{name}"), effect)));
            for (axis, other) in AXES.into_iter().enumerate() {
                let effect = Self::GyroSign { gyro, axis };
                all.push((format!("gyro_{letter}.sign_{other}"), effect));
                if axis != gyro {
                    let towards = axis;
                    let name = format!("gyro_{letter}{other}.axis_misalignment");
                    all.push((name, Self::AxisMisalignment { gyro, towards }));
                }
            }
        }
        for (axis, letter) in AXES.into_iter().enumerate() {
            for of in OfTemperature::ALL {
                let effect = Self::AccelTemperature { axis, of };
                all.push((format!("accel_{letter}.{}", of.name()), effect));
            }
            let single: [(&str, Self); 9] = [
                ("bias", Self::AccelBias(axis)),
                ("scale", Self::AccelScale(axis)),
                ("quadratic", Self::AccelQuadratic(axis)),
                ("noise", Self::AccelNoise(axis)),
                ("quantisation", Self::AccelQuantisation(axis)),
                ("ramp", Self::AccelRamp(axis)),
                ("tone", Self::AccelTone(axis)),
                ("sign", Self::AccelSign(axis)),
                ("dead_zone", Self::AccelDeadZone(axis)),
            ];
            all.extend(single.map(|(name, effect)| (format!("accel_{letter}.{name}"), effect)));
        }
        for axes in [[0, 1], [0, 2], [1, 2]] {
            let [i, j] = axes.map(|axis| AXES[axis]);
            let name = format!("accel_{i}{j}.nonorthogonality");
            all.push((name, Self::Nonorthogonality(axes)));
        }
        let common: [(&str, Self); 8] = [
            ("accel.outliers", Self::Outliers),
            ("accel.coloured_noise", Self::ColouredNoise),
            ("site.latitude", Self::Latitude),
            ("site.earth_rate", Self::EarthRate),
            ("site.gravity", Self::Gravity),
            ("clock.rate", Self::ClockRate),
            ("platform.initial_attitude", Self::InitialAttitude),
            ("platform.knock", Self::Knock),
        ];
        all.extend(common.map(|(name, effect)| (name.to_owned(), effect)));
        all
    }
}

const fn not_negative(unit: &'static str) -> Parameter {
    Parameter {
        bound: Bound::NotNegative,
        ..size(unit)
    }
}

/// A size within the limits of a small error.
const fn small(unit: &'static str) -> Parameter {
    Parameter {
        bound: Bound::Within(-0.3, 0.3),
        ..size(unit)
    }
}

/// Powers of all products of up to three specific forces.
fn products() -> Vec<[u8; 3]> {
    let mut all = Vec::new();
    for degree in 0..=3 {
        for x in (0..=degree).rev() {
            for y in (0..=degree - x).rev() {
                all.push([x, y, degree - x - y]);
            }
        }
    }
    all
}

/// `bias`, `g_x`, `g_xy`, …: letters in alphabetical order.
fn product_name(powers: [u8; 3]) -> String {
    if powers == [0; 3] {
        return "bias".to_owned();
    }
    let letters = AXES.into_iter().zip(powers);
    let letters = letters.map(|(letter, power)| letter.repeat(power.into()));
    format!("g_{}", letters.collect::<String>())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    #[test]
    fn ids_are_unique_and_products_are_named_by_their_letters() {
        let all = Effect::all();
        let names: BTreeSet<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names.len(), all.len());
        for (id, gyro, powers) in [
            ("gyro_x.bias", 0, [0, 0, 0]),
            ("gyro_y.g_z", 1, [0, 0, 1]),
            ("gyro_z.g_xy", 2, [1, 1, 0]),
            ("gyro_x.g_yy", 0, [0, 2, 0]),
            ("gyro_y.g_yyy", 1, [0, 3, 0]),
            ("gyro_y.g_xyz", 1, [1, 1, 1]),
        ] {
            assert_eq!(Effect::of(id), Some(Effect::GyroProduct { gyro, powers }));
        }
        // Letters out of order are no name.
        assert_eq!(Effect::of("gyro_x.g_zy"), None);
    }

    #[test]
    fn no_effect_has_a_parameter_twice() {
        for (id, effect) in Effect::all() {
            let parameters = effect.parameters();
            let names: BTreeSet<&str> = parameters.iter().map(|p| p.name).collect();
            assert_eq!(names.len(), parameters.len(), "{id}");
            assert!(!names.is_empty(), "{id}");
        }
    }
}
