//! What is simulated.

use super::{Run, Stream, cart_pole, duffing, quadrotor, servo, tanks};

/// An example plant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A mass on a spring, driven by a known force.
    Duffing,
    /// Two tanks, one above the other, with a level sensor in the lower one.
    Tanks,
    /// An axis with a motor, under feedback.
    Servo,
    /// A cart with a hanging pole, under feedback.
    CartPole,
    /// Roll, pitch and yaw of a quadrotor, under feedback.
    Quadrotor,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::Duffing,
        Self::Tanks,
        Self::Servo,
        Self::CartPole,
        Self::Quadrotor,
    ];

    /// Facts about it.
    #[must_use]
    pub fn facts(self) -> &'static Facts {
        match self {
            Self::Duffing => &duffing::FACTS,
            Self::Tanks => &tanks::FACTS,
            Self::Servo => &servo::FACTS,
            Self::CartPole => &cart_pole::FACTS,
            Self::Quadrotor => &quadrotor::FACTS,
        }
    }
}

/// Facts about a plant.
#[derive(Debug)]
pub struct Facts {
    /// Directory below `examples`.
    pub name: &'static str,
    /// Nominal parameters, in the order of the plant's script.
    pub parameters: &'static [f64],
    /// Largest factor between a parameter of a population and its nominal value.
    pub spread: f64,
    /// Standard deviations of initial states.
    pub initial: &'static [f64],
    /// Means of initial states.
    pub mean: &'static [f64],
    /// Standard deviations of the noise of the sensors.
    pub sigmas: &'static [f64],
    /// Effects that may be hidden, by the ids that a diagnosis should find, with a size to begin with.
    pub effects: &'static [(&'static str, f64)],
    /// Time between rows, s.
    pub step_s: f64,
    /// Inputs between rows go in a straight line; they are held otherwise.
    pub interpolate: bool,
    pub(super) simulate: fn(&Setting, Option<&[Vec<f64>]>) -> Run,
}

/// One record to be simulated.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// The plant.
    pub kind: Kind,
    /// Its nominal parameters.
    pub parameters: Vec<f64>,
    /// Initial states.
    pub initial: Vec<f64>,
    /// The hidden effect and its size: one of [`Facts::effects`], or what no catalogue has.
    pub hidden: (&'static str, f64),
    /// Share of the record at which a step begins.
    pub onset: f64,
    /// Where a term bends, over the usual size of its variable.
    pub knee: f64,
    /// Noise over the usual one; none at 0.
    pub noise: f64,
    /// Rows.
    pub rows: usize,
    /// Seed of inputs and noise.
    pub seed: u64,
}

/// A knee is here unless a record says otherwise.
const KNEE: f64 = 0.5;

impl Setting {
    /// A plant of a population, without a hidden effect.
    #[must_use]
    pub fn random(kind: Kind, seed: u64, rows: usize) -> Self {
        let facts = kind.facts();
        let mut random = Stream::new(seed, 0);
        let parameters = facts.parameters.iter();
        let initial = facts.mean.iter().zip(facts.initial);
        let spread = facts.spread;
        Self {
            kind,
            parameters: parameters
                .map(|value| value * random.log_between(1.0 / spread, spread))
                .collect(),
            initial: initial
                .map(|(mean, sigma)| mean + sigma * random.normal())
                .collect(),
            hidden: ("", 0.0),
            onset: random.between(0.2, 0.8),
            knee: KNEE,
            noise: 1.0,
            rows,
            seed,
        }
    }

    /// Size of an effect in this record.
    pub(super) fn size(&self, effect: &str) -> f64 {
        match self.hidden {
            (hidden, size) if hidden == effect => size,
            _ => 0.0,
        }
    }

    /// Size of a step at a share of the record.
    pub(super) fn step(&self, effect: &str, share: f64) -> f64 {
        match share >= self.onset {
            true => self.size(effect),
            false => 0.0,
        }
    }
}
