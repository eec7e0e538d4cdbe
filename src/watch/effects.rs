use gyrocal_estimation::Precision;
use gyrocal_scalar::effect::{Effect, EffectKind, Enters, Role};
use gyrocal_watch::{Driven, Entry, Value};

use crate::generated::catalogue::{EFFECTS, OUTPUTS, RATES};
use crate::generated::platform::Platform;
use crate::settings::FilterSettings;

/// An effect of the catalogue as a watch sees it: the channel that it enters and its course in time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WatchedEffect {
    /// Its id in the catalogue.
    pub id: &'static str,
    /// Unit of its size.
    pub unit: &'static str,
    pub(crate) channel: Channel,
    pub(crate) course: EffectCourse,
}

/// The channel that an effect enters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Channel {
    /// Drift of a gyro.
    Rate(usize),
    /// Reading of an accelerometer.
    Output(usize),
}

/// Course of an effect in its channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EffectCourse {
    /// One from its onset on.
    Constant,
    /// Days since its onset.
    SinceOnset,
    /// The derivative of the channel by this parameter of the catalogue's model.
    Parameter(usize),
}

impl WatchedEffect {
    /// The effect of the catalogue with an id, found when the program is compiled: `const` items made
    /// of it are the choice of a controller.
    ///
    /// An effect that the nominal model has, such as `gyro_x.g_x`, is watched for a change of it.
    ///
    /// # Panics
    /// If the catalogue has no such effect, or none that one size, one channel and the state of the
    /// filter describe. In a `const` item that is an error of compilation.
    #[must_use]
    pub const fn of(id: &str) -> Self {
        let mut i = 0;
        while i < EFFECTS.len() {
            if same(EFFECTS[i].id, id) {
                match Self::from_effect(&EFFECTS[i]) {
                    Some(effect) => return effect,
                    None => panic!("a watch needs more than it has for this effect"),
                }
            }
            i += 1;
        }
        panic!("no such effect in the catalogue")
    }

    /// An effect of the catalogue; `None` for what a watch cannot describe: functions of logged
    /// quantities and of unknown time constants, noise, and jumps, which it always watches for.
    #[must_use]
    pub const fn from_effect(effect: &Effect) -> Option<Self> {
        let [parameter, ..] = effect.parameters else {
            return None;
        };
        if !effect.needs.is_empty() {
            return None;
        }
        let (channel, constant) = match effect.enters {
            Enters::Rates(&[rate]) => (Channel::Rate(rate), RATES[rate].constant),
            Enters::Outputs(&[output]) => (Channel::Output(output), OUTPUTS[output].constant),
            _ => return None,
        };
        let course = match (effect.kind, parameter.role) {
            (EffectKind::Step, _) => EffectCourse::Constant,
            (EffectKind::Ramp, _) => EffectCourse::SinceOnset,
            (EffectKind::Constant, Role::Parameter(index)) if index == constant => {
                EffectCourse::Constant
            }
            (EffectKind::Constant, Role::Parameter(index)) => EffectCourse::Parameter(index),
            _ => return None,
        };
        Some(Self {
            id: effect.id,
            unit: parameter.unit,
            channel,
            course,
        })
    }

    /// The coefficient of the filter that it is a change of, as an index among its states; `None`
    /// for what the filter has no state of.
    #[must_use]
    pub fn coefficient(&self) -> Option<usize> {
        let parameter = match (self.channel, self.course) {
            (Channel::Rate(rate), EffectCourse::Constant) => RATES.get(rate)?.constant,
            (Channel::Rate(_), EffectCourse::Parameter(index)) => index,
            _ => return None,
        };
        (parameter < Platform::PARAMETERS).then_some(Platform::MOVING + parameter)
    }

    /// The gyro whose random walk, larger than declared, cannot be told apart from it at an alarm: a walk
    /// has drifted away from the filter since some time, which is a step of the drift or a ramp. `None` for
    /// effects of another course, and of accelerometers.
    #[must_use]
    pub const fn walking_gyro(&self) -> Option<usize> {
        match (self.channel, self.course) {
            (Channel::Rate(rate), EffectCourse::Constant | EffectCourse::SinceOnset) => Some(rate),
            _ => None,
        }
    }

    /// Information on its size that a day of samples of a settled filter gives, by the declared noise;
    /// a scale for the sizes that are looked for. The factors are medians over attitudes, measured by
    /// `cargo figures embedded --part watch`: a factor of two in them costs little.
    #[must_use]
    pub fn information_of_a_day<T: Precision>(&self, settings: &FilterSettings<T>) -> T {
        let day = T::from_f64(86_400.0);
        let mean = settings.drift_noise_density() / day;
        let factor = match (self.channel, self.course) {
            (Channel::Rate(_), EffectCourse::Constant) => 0.4,
            (Channel::Rate(_), EffectCourse::Parameter(_)) => 0.16,
            (Channel::Rate(_), EffectCourse::SinceOnset) => 0.13,
            (Channel::Output(_), _) => {
                let noise = settings.accel_noise_g;
                return T::from_f64(450.0) / (noise * noise);
            }
        };
        T::from_f64(factor) / mean
    }

    /// Its entry in the table of a watch whose columns are [`columns`] of as many.
    ///
    /// # Panics
    /// If it needs more columns.
    #[must_use]
    pub const fn entry(&self, columns: usize) -> Entry {
        let value = match self.channel {
            Channel::Rate(rate) => Value::State(Platform::MOVING + RATES[rate].constant),
            Channel::Output(output) => Value::Driven(3 + output),
        };
        let slope = match (self.channel, self.course) {
            (_, EffectCourse::Constant) => columns,
            (Channel::Rate(rate), _) => rate,
            (Channel::Output(output), _) => 6 + output,
        };
        assert!(
            slope <= columns,
            "an effect on accelerometers that changes with attitude needs nine columns"
        );
        Entry {
            value,
            slope,
            from_onset: matches!(self.course, EffectCourse::SinceOnset),
        }
    }
}

/// Columns of a watch: slopes of drifts, offsets of readings, and, with nine, slopes of readings.
///
/// # Panics
/// Unless there are six or nine.
#[must_use]
pub const fn columns<const D: usize>() -> [Driven; D] {
    assert!(D == 6 || D == 9, "a watch has six columns or nine");
    let mut columns = [Driven::Output(0); D];
    let mut i = 0;
    while i < D {
        columns[i] = match i / 3 {
            0 => Driven::Slope(Platform::MOVING + RATES[i].constant),
            1 => Driven::Output(i - 3),
            _ => Driven::OutputSlope(i - 6),
        };
        i += 1;
    }
    columns
}

const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    if a.len() != b.len() {
        return false;
    }
    let mut i = 0;
    while i < a.len() {
        if a[i] != b[i] {
            return false;
        }
        i += 1;
    }
    true
}

/// The effects that are watched unless others are picked: changes of the constant drift and of the
/// drift along the input axis, ramps, cross-axis terms and biases of accelerometers. With the jumps
/// about three axes they are 21.
pub const EFFECTS_BY_DEFAULT: [WatchedEffect; 18] = [
    WatchedEffect::of("gyro_x.step"),
    WatchedEffect::of("gyro_y.step"),
    WatchedEffect::of("gyro_z.step"),
    WatchedEffect::of("gyro_x.g_x"),
    WatchedEffect::of("gyro_y.g_y"),
    WatchedEffect::of("gyro_z.g_z"),
    WatchedEffect::of("gyro_x.ramp"),
    WatchedEffect::of("gyro_y.ramp"),
    WatchedEffect::of("gyro_z.ramp"),
    WatchedEffect::of("gyro_x.g_y"),
    WatchedEffect::of("gyro_x.g_z"),
    WatchedEffect::of("gyro_y.g_x"),
    WatchedEffect::of("gyro_y.g_z"),
    WatchedEffect::of("gyro_z.g_x"),
    WatchedEffect::of("gyro_z.g_y"),
    WatchedEffect::of("accel_x.bias"),
    WatchedEffect::of("accel_y.bias"),
    WatchedEffect::of("accel_z.bias"),
];
