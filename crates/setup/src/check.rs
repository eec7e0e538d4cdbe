//! The tests in their order.

use gyrocal_record::{Bench, Record};

use crate::finding::SetupFinding;
use crate::platform_kind::PlatformKind;
use crate::samples::Samples;
use crate::{
    clipped, clock_order, coded, duplicated, gravity, jump, missing, motion, repeated, rotation,
    scale, stuck, temperature, unit,
};

/// What a record shows of its set-up.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupCheck {
    /// Gross errors, in the order of the tests.
    pub findings: Vec<SetupFinding>,
    /// The record with what can be mended left out or corrected; `None` if an error leaves nothing
    /// sound. The same as was given if there is no finding.
    pub usable: Option<Record>,
    /// An error that stops, which the rows alone do not decide: it is one if the record fits its
    /// correction much better than what was given. Only where nothing else stops.
    pub unconfirmed: Option<SetupFinding>,
}

impl SetupCheck {
    /// The errors that leave nothing sound.
    pub fn stopping(&self) -> impl Iterator<Item = &SetupFinding> {
        self.findings.iter().filter(|finding| finding.stops)
    }
}

/// Fewest rows of which anything can be said: the medians of both sides of a jump.
const LEAST_ROWS: usize = 12;

/// Looks for gross errors of the set-up of a record of a platform that gyros hold. Of a record of
/// fewer than twelve rows only the order of its times is judged. The cost is linear in the rows but
/// for one sort.
#[must_use]
pub fn check_setup(record: &Record, bench: &Bench) -> SetupCheck {
    check_setup_of(PlatformKind::Stabilised, record, bench)
}

/// The same of a record of some kind of platform.
#[must_use]
pub fn check_setup_of(kind: PlatformKind, record: &Record, bench: &Bench) -> SetupCheck {
    let disorder = clock_order::find(record);
    if !disorder.is_empty() || record.measured_rows() < LEAST_ROWS {
        let usable = disorder.is_empty().then(|| record.clone());
        return SetupCheck {
            findings: disorder,
            usable,
            unconfirmed: None,
        };
    }
    let mut samples = Samples::new(record, bench);
    let mut findings = Vec::new();
    let tests = TESTS.iter().filter(|(of, _)| of.contains(&kind));
    for (_, test) in tests {
        findings.extend(test(&mut samples));
        // What follows would judge values that are known to be wrong.
        if findings.iter().any(|finding| finding.stops) {
            break;
        }
    }
    let stops = findings.iter().any(|finding| finding.stops);
    let usable = match (stops, findings.is_empty()) {
        (true, _) => None,
        (false, true) => Some(record.clone()),
        (false, false) => Some(samples.to_record()),
    };
    SetupCheck {
        findings,
        usable,
        unconfirmed: samples.unconfirmed.filter(|_| !stops),
    }
}

/// A test: takes out of the samples what it explains.
type Test = fn(&mut Samples<'_>) -> Vec<SetupFinding>;

/// All kinds of platforms; those whose attitude in space gyros hold.
const ANY: &[PlatformKind] = &PlatformKind::ALL;
const HELD: &[PlatformKind] = &[PlatformKind::Stabilised];

/// All tests but the first, with the platforms that they are valid of; each may rely on what those
/// before it took out. Magnitudes say the same of every platform. Those that follow the direction of
/// gravity take the drift to be that of gyros that the priors describe, and the fine errors of
/// accelerometers to be those of a laboratory.
const TESTS: [(&[PlatformKind], Test); 13] = [
    (ANY, missing::find),
    (ANY, coded::find),
    (ANY, temperature::find),
    (ANY, unit::find),
    (ANY, clipped::find),
    (ANY, stuck::find),
    (ANY, repeated::find),
    (ANY, duplicated::find),
    (HELD, motion::find),
    (ANY, scale::find),
    (HELD, jump::find),
    (HELD, rotation::find),
    (HELD, gravity::find),
];
