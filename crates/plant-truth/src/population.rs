//! Populations of the example plants.

use crate::random::Stream;
use crate::setting::{Facts, Kind, Setting};
use crate::{cart_pole, duffing, quadrotor, servo, tanks};

impl Kind {
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
            noise: 1.0,
            rows,
            seed,
        }
    }
}
