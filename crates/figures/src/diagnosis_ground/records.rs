//! Records with noise other than declared, and the expected findings of each kind.

use gyrocal::EFFECTS;
use gyrocal::effect::{EffectKind, Enters, NoiseProperty};
use gyrocal_testkit::noise_faults::{Fault, FaultyRecord, faulty_record};
use gyrocal_truth::Population;

/// Seed of the population.
pub(super) const POPULATION: u64 = 20;

/// A kind of fault in the noise.
#[derive(Clone, Copy)]
pub(super) struct Kind {
    pub(super) name: &'static str,
    pub(super) fault: Fault,
    /// Property of the noise of each accelerometer that the audit must find; other findings are errors.
    pub(super) property: NoiseProperty,
}

impl Kind {
    /// Ids of the expected findings, in alphabetical order.
    pub(super) fn expected(&self) -> Vec<&'static str> {
        accelerometer_noise(self.property)
    }
}

/// Ids of the effects that are a property of the noise of accelerometers, in alphabetical order.
pub(super) fn accelerometer_noise(property: NoiseProperty) -> Vec<&'static str> {
    let mut ids: Vec<&str> = EFFECTS
        .iter()
        .filter(|effect| effect.kind == EffectKind::Noise(property))
        .filter(|effect| matches!(effect.enters, Enters::Outputs(_)))
        .map(|effect| effect.id)
        .collect();
    ids.sort_unstable();
    ids
}

/// All kinds of faults.
pub(super) const KINDS: [Kind; 5] = [
    Kind {
        name: "LSB of 3 sigma",
        fault: Fault::Quantised(3.0),
        property: NoiseProperty::Quantisation,
    },
    Kind {
        name: "0.5 % outliers of 8 sigma",
        fault: Fault::Outliers(0.005, 8.0),
        property: NoiseProperty::Outliers,
    },
    Kind {
        name: "AR(1) of 0.3",
        fault: Fault::Coloured(0.3),
        property: NoiseProperty::Correlation,
    },
    Kind {
        name: "sigma 1.2 of declared",
        fault: Fault::Ratio(1.2),
        property: NoiseProperty::Level,
    },
    Kind {
        name: "sigma 0.8 of declared",
        fault: Fault::Ratio(0.8),
        property: NoiseProperty::Level,
    },
];

/// Three days with a row each minute, at any latitude and attitude, with drift.
pub(super) fn three_days() -> Population {
    let mut population = Population::new(POPULATION);
    population.duration_days = [3.0, 3.0];
    population
}

/// Record `number` with a fault.
pub(super) fn record(number: u64, fault: Fault) -> FaultyRecord {
    faulty_record(&three_days(), number, fault, &[])
}
