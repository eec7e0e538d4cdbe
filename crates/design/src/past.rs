//! The records that a run follows.

use std::borrow::Cow;

use gyrocal_answer::RecordSummary;
use gyrocal_calibration::{FittedPlatform, Run, rows};
use gyrocal_diagnosis::{record_summary, records_summary};
use gyrocal_hypothesis::Rows;
use gyrocal_record::{Bench, Record};

/// The records of a fit, and the last of them, which the next run follows.
pub(crate) struct Past<'b> {
    /// The record, or several as one.
    record: &'b Record,
    /// That of the last record.
    bench: &'b Bench,
    /// First row of each record.
    starts: Vec<usize>,
    last: Cow<'b, Record>,
    /// Start of the last record on the clock of all, s.
    pub(crate) start_s: f64,
}

impl<'b> Past<'b> {
    /// Of a fit to a record, or to several, which `run` has as one.
    pub(crate) fn new(fitted: &FittedPlatform<'_>, run: &Run<'b>) -> Self {
        let rows = fitted.record_rows();
        let starts: Vec<usize> = rows.iter().map(|rows| rows.start).collect();
        let first = starts.last().copied().unwrap_or(0);
        let (last, start_s) = match first {
            0 => (Cow::Borrowed(run.record), 0.0),
            _ => (
                Cow::Owned(run.record.part(first..run.record.len())),
                run.record.time_s[first] - run.record.time_s[0],
            ),
        };
        Self {
            record: run.record,
            bench: run.bench,
            starts,
            last,
            start_s,
        }
    }

    /// All records as one, with the bench of the last.
    pub(crate) fn run(&self) -> Run<'_> {
        Run {
            record: self.record,
            bench: self.bench,
        }
    }

    /// The last record.
    pub(crate) fn last(&self) -> Run<'_> {
        Run {
            record: &self.last,
            bench: self.bench,
        }
    }

    /// Number of records.
    pub(crate) fn records(&self) -> usize {
        self.starts.len()
    }

    /// Whether there are several.
    pub(crate) fn is_several(&self) -> bool {
        self.records() > 1
    }

    /// First row of the last record among those of all.
    pub(crate) fn first_row(&self) -> usize {
        self.starts.last().copied().unwrap_or(0)
    }

    /// The rows of all records, without covariates.
    pub(crate) fn rows(&self) -> Rows {
        let mut rows = rows(self.record, Vec::new());
        rows.starts = self.starts.iter().skip(1).copied().collect();
        rows
    }

    /// Size of all records together.
    pub(crate) fn summary(&self) -> RecordSummary {
        match self.is_several() {
            true => records_summary(&self.summaries()),
            false => record_summary(self.record),
        }
    }

    /// Sizes of the records; empty of one.
    pub(crate) fn summaries(&self) -> Vec<RecordSummary> {
        if !self.is_several() {
            return Vec::new();
        }
        let ends = self.starts[1..].iter().copied();
        let ends = ends.chain([self.record.len()]);
        let parts = self.starts.iter().zip(ends);
        parts
            .map(|(start, end)| record_summary(&self.record.part(*start..end)))
            .collect()
    }
}
