//! The tests in their order.

use gyrocal_record::{Bench, Record};

use crate::finding::SetupFinding;
use crate::samples::Samples;
use crate::{
    clipped, clock_order, coded, duplicated, gravity, jump, missing, motion, repeated, rotation,
    scale, stuck, unit,
};

/// What a record shows of its set-up.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupCheck {
    /// Gross errors, in the order of the tests.
    pub findings: Vec<SetupFinding>,
    /// The record with what can be mended left out or corrected; `None` if an error leaves nothing
    /// sound. The same as was given if there is no finding.
    pub usable: Option<Record>,
}

impl SetupCheck {
    /// The errors that leave nothing sound.
    pub fn stopping(&self) -> impl Iterator<Item = &SetupFinding> {
        self.findings.iter().filter(|finding| finding.stops)
    }
}

/// Fewest rows of which anything can be said: the medians of both sides of a jump.
const LEAST_ROWS: usize = 12;

/// Looks for gross errors of the set-up of a record. Of a record of fewer than twelve rows only the
/// order of its times is judged. The cost is linear in the rows but for one sort.
#[must_use]
pub fn check_setup(record: &Record, bench: &Bench) -> SetupCheck {
    let disorder = clock_order::find(record);
    if !disorder.is_empty() || record.measured_rows() < LEAST_ROWS {
        let usable = disorder.is_empty().then(|| record.clone());
        return SetupCheck {
            findings: disorder,
            usable,
        };
    }
    let mut samples = Samples::new(record, bench);
    let mut findings = Vec::new();
    for test in TESTS {
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
        (false, false) => Some(samples.to_record(record)),
    };
    SetupCheck { findings, usable }
}

/// A test: takes out of the samples what it explains.
type Test = fn(&mut Samples<'_>) -> Vec<SetupFinding>;

/// All tests but the first, each of which may rely on what those before it took out.
const TESTS: [Test; 12] = [
    missing::find,
    coded::find,
    unit::find,
    clipped::find,
    stuck::find,
    repeated::find,
    duplicated::find,
    motion::find,
    scale::find,
    jump::find,
    rotation::find,
    gravity::find,
];
