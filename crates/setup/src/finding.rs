//! What the check of a set-up finds.

use core::ops::Range;

use gyrocal_record::{Bench, Record, SetupProblem};

use crate::kind::SetupKind;
use crate::signed_axes::SignedAxes;

/// A gross error of the set-up.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupFinding {
    /// Its kind.
    pub kind: SetupKind,
    /// The error in one or two sentences, with what to do.
    pub description: String,
    /// The numbers that show it.
    pub evidence: String,
    /// Rows from the first to the last one that it concerns, counted from 0; `None` if it concerns
    /// all.
    pub rows: Option<Range<usize>>,
    /// Whether nothing sound is left, so that no coefficient may be estimated.
    pub stops: bool,
    /// Other errors that the same record could have, in words.
    pub equivalents: Vec<String>,
    /// Their kinds.
    pub equivalent_kinds: Vec<SetupKind>,
    /// What would make the record fit, for errors of axes and of the latitude.
    pub correction: Option<Correction>,
}

impl SetupFinding {
    /// A finding that leaves something sound and concerns all rows.
    pub(crate) fn new(kind: SetupKind, description: String, evidence: String) -> Self {
        Self {
            kind,
            description,
            evidence,
            rows: None,
            stops: false,
            equivalents: Vec::new(),
            equivalent_kinds: Vec::new(),
            correction: None,
        }
    }

    /// The same, which leaves nothing sound.
    pub(crate) fn stopping(mut self) -> Self {
        self.stops = true;
        self
    }

    /// The same of some rows.
    pub(crate) fn at(mut self, rows: Range<usize>) -> Self {
        self.rows = Some(rows);
        self
    }

    /// The same with another error that the record could have as well.
    pub(crate) fn or(mut self, kind: SetupKind, text: impl Into<String>) -> Self {
        if kind != self.kind && !self.equivalent_kinds.contains(&kind) {
            self.equivalent_kinds.push(kind);
        }
        self.equivalents.push(text.into());
        self
    }

    /// The finding as results tell it.
    #[must_use]
    pub fn problem(&self) -> SetupProblem {
        SetupProblem {
            kind: self.kind.as_str().to_owned(),
            description: self.description.clone(),
            evidence: self.evidence.clone(),
            rows: self.rows.clone().map(|rows| [rows.start + 1, rows.end]),
            stops: self.stops,
            equivalents: self.equivalents.clone(),
            file: None,
            lines: None,
        }
    }
}

/// A change of axes and latitude that makes a record fit its bench description.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Correction {
    /// The axes that were meant, in terms of the columns of the record.
    pub axes: SignedAxes,
    /// The latitude that fits, north positive.
    pub latitude_deg: f64,
}

impl Correction {
    /// The record with its columns exchanged and negated, and the bench description with the other
    /// latitude.
    #[must_use]
    pub fn apply(&self, record: &Record, bench: &Bench) -> (Record, Bench) {
        let mut corrected = record.clone();
        for row in &mut corrected.accel_g {
            *row = self.axes.apply(*row);
        }
        let bench = Bench {
            latitude_deg: self.latitude_deg,
            ..bench.clone()
        };
        (corrected, bench)
    }
}
