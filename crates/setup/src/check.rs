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
    /// The record with what can be mended left out or corrected, also if an error stops; `None` if
    /// nothing was mended.
    pub mended: Option<Record>,
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
            mended: None,
            unconfirmed: None,
        };
    }
    let mut samples = Samples::new(record, bench);
    let mut findings: Vec<SetupFinding> = Vec::new();
    let tests = TESTS.iter().filter(|(of, ..)| of.contains(&kind));
    for (_, judged, test) in tests {
        // What follows would judge values that are known to be wrong.
        let mut stopping = findings.iter().filter(|finding| finding.stops);
        if stopping.any(|finding| !judged.stands_beside(finding)) {
            continue;
        }
        findings.extend(test(&mut samples));
    }
    let stops = findings.iter().any(|finding| finding.stops);
    let is_mended = findings.iter().any(|finding| !finding.stops);
    let usable = match (stops, findings.is_empty()) {
        (true, _) => None,
        (false, true) => Some(record.clone()),
        (false, false) => Some(samples.to_record()),
    };
    SetupCheck {
        findings,
        usable,
        mended: is_mended.then(|| samples.to_record()),
        unconfirmed: samples.unconfirmed.filter(|_| !stops),
    }
}

/// A test: takes out of the samples what it explains.
type Test = fn(&mut Samples<'_>) -> Vec<SetupFinding>;

/// What a test judges.
#[derive(Clone, Copy)]
enum Judged {
    /// Magnitudes of specific force and nothing else.
    Magnitudes,
    /// More than that.
    Rows,
}

impl Judged {
    /// Whether an error that stops leaves it as it is: wrong axes or a wrong latitude change no magnitude.
    fn stands_beside(self, error: &SetupFinding) -> bool {
        matches!(self, Self::Magnitudes) && error.kind.is_of_directions()
    }
}

/// All kinds of platforms; those whose attitude in space gyros hold.
const ANY: &[PlatformKind] = &PlatformKind::ALL;
const HELD: &[PlatformKind] = &[PlatformKind::Stabilised];

/// All tests but the first, with the platforms that they are valid of; each may rely on what those
/// before it took out. Magnitudes say the same of every platform. Those that follow the direction of
/// gravity take the drift to be that of gyros that the priors describe, and the fine errors of
/// accelerometers to be those of a laboratory.
const TESTS: [(&[PlatformKind], Judged, Test); 13] = [
    (ANY, Judged::Rows, missing::find),
    (ANY, Judged::Rows, coded::find),
    (ANY, Judged::Rows, temperature::find),
    (ANY, Judged::Rows, unit::find),
    (ANY, Judged::Rows, clipped::find),
    (ANY, Judged::Rows, stuck::find),
    (ANY, Judged::Rows, repeated::find),
    (ANY, Judged::Rows, duplicated::find),
    (HELD, Judged::Rows, motion::find),
    (ANY, Judged::Rows, scale::find),
    (HELD, Judged::Rows, jump::find),
    (HELD, Judged::Rows, rotation::find),
    (HELD, Judged::Magnitudes, gravity::find),
];
