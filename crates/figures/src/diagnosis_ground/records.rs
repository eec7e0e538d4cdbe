//! Records with noise other than declared, and the expected findings of each kind.

use gyrocal_truth::Population;

use gyrocal_testkit::noise_faults::{Fault, FaultyRecord, faulty_record};

/// Seed of the population.
pub(super) const POPULATION: u64 = 20;

/// A kind of fault in the noise.
#[derive(Clone, Copy)]
pub(super) struct Kind {
    pub(super) name: &'static str,
    pub(super) fault: Fault,
    /// The expected findings; others are errors.
    pub(super) expected: &'static [&'static str],
}

const EACH_NOISE: &[&str] = &["accel_x.noise", "accel_y.noise", "accel_z.noise"];

/// All kinds of faults.
pub(super) const KINDS: [Kind; 5] = [
    Kind {
        name: "LSB of 3 sigma",
        fault: Fault::Quantised(3.0),
        expected: &[
            "accel_x.quantisation",
            "accel_y.quantisation",
            "accel_z.quantisation",
        ],
    },
    Kind {
        name: "0.5 % outliers of 8 sigma",
        fault: Fault::Outliers(0.005, 8.0),
        expected: &["accel.outliers"],
    },
    Kind {
        name: "AR(1) of 0.3",
        fault: Fault::Coloured(0.3),
        expected: &["accel.coloured_noise"],
    },
    Kind {
        name: "sigma 1.2 of declared",
        fault: Fault::Ratio(1.2),
        expected: EACH_NOISE,
    },
    Kind {
        name: "sigma 0.8 of declared",
        fault: Fault::Ratio(0.8),
        expected: EACH_NOISE,
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
