//! A record as it stands in its file.

use std::ops::Range;
use std::path::Path;

use crate::clock::{ClockFault, UNNAMED, leave_out_repeated};
use crate::error::{Error, InputErrorKind};
use crate::plausible::{Codes, check_intervals, check_norms, check_stuck, refuse_too_few};
use crate::printable::printable_line;
use crate::record::Record;
use crate::rows::{Form, parse};
use crate::setup::SetupProblem;
use crate::source::SourceText;
use crate::words::counted;

/// A record as it stands in its file, with the places of its rows: in the format of a record, with
/// values that may be those of no platform. Times may not rise, specific force may be in any unit, and
/// an empty field of an accelerometer is a missing value.
///
/// A check of the set-up tells what is wrong with it, and leaves what is sound; [`Self::check`] refuses
/// what no reader accepts of the rest, with its place.
#[derive(Debug, Clone)]
pub struct RecordFile {
    record: Record,
    source: SourceText,
    places: Vec<Range<usize>>,
    header: Range<usize>,
    notes: Vec<String>,
}

impl RecordFile {
    /// Reads a record as it stands.
    ///
    /// # Errors
    ///
    /// [`Error::Unreadable`], or [`Error::Input`] if the text is not in the format of a record.
    pub fn read(path: &Path) -> Result<Self, Error> {
        Self::of(SourceText::read(path)?)
    }

    /// Takes the text of a record; errors call it `name`.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if the text is not in the format of a record.
    pub fn parse(text: &str, name: &str) -> Result<Self, Error> {
        Self::of(SourceText::new(text, name)?)
    }

    /// Takes the text of a record.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] if it is not in the format of a record.
    pub fn of(source: SourceText) -> Result<Self, Error> {
        let (record, places, header) = parse(&source, Form::Lenient)?;
        Ok(Self::of_rows(record, source, places, header))
    }

    /// Takes a record that was read from a text of another format, with the places of its rows and of its
    /// header.
    #[must_use]
    pub fn of_rows(
        mut record: Record,
        source: SourceText,
        mut places: Vec<Range<usize>>,
        header: Range<usize>,
    ) -> Self {
        let repeated = leave_out_repeated(&mut record, &mut places);
        let notes = repeated.first().map(|first| {
            let (line, _) = source.line_and_column(first.start);
            format!(
                "{}:{line}: this row repeats the row before it in every value, as {} of the record do. They are left out",
                printable_line(source.name()),
                counted(repeated.len(), "row")
            )
        });
        Self {
            record,
            source,
            places,
            header,
            notes: notes.into_iter().collect(),
        }
    }

    /// It with something more to tell the user.
    #[must_use]
    pub fn with_note(mut self, note: Option<String>) -> Self {
        self.notes.extend(note);
        self
    }

    /// Takes a record in memory as if it stood in a file; errors call it `name`. Its rows have no lines;
    /// those of errors are the lines that its rows would have after a header.
    #[must_use]
    pub fn of_record(record: Record, name: &str) -> Self {
        Self {
            record,
            source: SourceText::of_memory(name),
            places: Vec::new(),
            header: 0..0,
            notes: Vec::new(),
        }
    }

    /// The record as it stands.
    #[must_use]
    pub fn record(&self) -> &Record {
        &self.record
    }

    /// The name of the file as it was given.
    #[must_use]
    pub fn name(&self) -> &str {
        self.source.name()
    }

    /// What there is to tell of its text: rows that were left out, a last line that seems cut off.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        self.notes.iter().cloned().chain(self.cut_note()).collect()
    }

    /// A note on a last line that seems cut off within its last number: the file ends without a line
    /// feed, and the last field is shorter than that of every other row. `None` otherwise.
    fn cut_note(&self) -> Option<String> {
        const FEWEST_ROWS: usize = 20;
        let (last, others) = self.places.split_last()?;
        let text = self.source.text();
        let length = |place: &Range<usize>| {
            let line = &text[place.clone()];
            line.rsplit(',')
                .next()
                .map_or(0, |field| field.trim().len())
        };
        let is_cut = others.len() >= FEWEST_ROWS
            && self.source.ends_within_line(last)
            && others.iter().all(|other| length(other) > length(last));
        is_cut.then(|| {
            let (line, _) = self.source.line_and_column(last.start);
            format!(
                "{}:{line}: the file ends without a line feed, and the last number is shorter than \
                 those above it: it may be cut off. Copy the file again, or delete this line",
                printable_line(self.name())
            )
        })
    }

    /// The line of a row, counted from 1; rows are counted from 0. `None` beyond the last row.
    #[must_use]
    pub fn line(&self, row: usize) -> Option<usize> {
        let place = self.places.get(row)?;
        Some(self.source.line_and_column(place.start).0)
    }

    /// Gives problems of this record their file and lines, unless they have them.
    pub fn locate(&self, problems: &mut [SetupProblem]) {
        for problem in problems.iter_mut().filter(|problem| problem.file.is_none()) {
            problem.file = Some(self.name().to_owned());
            problem.description = problem.description.replace(UNNAMED, self.name());
            problem.lines = problem.rows.and_then(|[first, last]| {
                let line = |row: usize| self.line(row.checked_sub(1)?);
                Some([line(first)?, line(last)?])
            });
        }
    }

    /// The record, if its times rise.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] at the first row that does not.
    pub fn into_rising(self) -> Result<Record, Error> {
        let Some(fault) = ClockFault::of(&self.record.time_s, self.name()) else {
            return Ok(self.record);
        };
        let place = self.places.get(fault.row).cloned().unwrap_or(0..0);
        let kind = InputErrorKind::Time;
        Err(self
            .source
            .error(kind, place, fault.found, "times that rise", fault.advice))
    }

    /// The record, if it is one that [`Record::read`] takes: times rise, and specific force is of gravity's
    /// size wherever it was measured.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] at the first row that is none.
    pub fn into_sound(self) -> Result<Record, Error> {
        let last = self.places.last().unwrap_or(&self.header);
        refuse_too_few(&self.record, &self.source, last, 1)?;
        check_norms(&self.record, &self.source, &self.places, Codes::Refused)?;
        self.into_rising()
    }

    /// Refuses values that are no platform's in what is left of the record: fewer than `least` rows
    /// with a value, rows too far apart, readings that do not change, and magnitudes far from gravity.
    /// The rows of `usable` are the first of this record, with values missing or corrected.
    ///
    /// # Errors
    ///
    /// [`Error::Input`].
    pub fn check(&self, usable: &Record, least: usize) -> Result<(), Error> {
        let checked = self.check_rows(usable, least);
        if checked.is_ok() || self.places.len() == self.record.len() {
            return checked;
        }
        // A record in memory has places only where they are needed: in an error.
        let path = Path::new(self.name());
        Self::parse(&self.record.text(path)?, self.name())?.check_rows(usable, least)
    }

    fn check_rows(&self, usable: &Record, least: usize) -> Result<(), Error> {
        let Self { source, places, .. } = self;
        let last = places.last().unwrap_or(&self.header);
        refuse_too_few(usable, source, last, least)?;
        check_norms(usable, source, places, Codes::Read)?;
        check_intervals(usable, source, places)?;
        check_stuck(usable, source, places)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "time_s,accel_x_g,accel_y_g,accel_z_g";

    fn file(rows: &str) -> RecordFile {
        RecordFile::parse(&format!("\n{HEADER}\n{rows}"), "r.csv").unwrap()
    }

    #[test]
    fn values_of_no_platform_are_read_with_their_lines() {
        let file = file("0,0,0,9.81\n60,,0,9.81\n\n30,-999,0,9.81\n");
        assert_eq!(file.record().time_s, [0.0, 60.0, 30.0]);
        assert!(file.record().accel_g[1][0].is_nan());
        assert_eq!(file.record().accel_g[2], [-999.0, 0.0, 9.81]);
        let lines = [0, 1, 2, 3].map(|row| file.line(row));
        assert_eq!(lines, [Some(3), Some(4), Some(6), None]);
        let refused = RecordFile::parse(&format!("{HEADER}\n0,0,0,up\n"), "r.csv");
        assert!(refused.unwrap_err().to_string().contains("r.csv:2:7"));
    }

    #[test]
    fn a_sound_record_is_one_that_is_read_strictly() {
        for rows in ["0,0,0,1\n60,0,0,9.81\n", "0,0,0,1\n0,0,1,0\n", ""] {
            let strict = Record::parse(&format!("\n{HEADER}\n{rows}"), "r.csv");
            let sound = file(rows).into_sound();
            assert_eq!(
                strict.unwrap_err().to_string(),
                sound.unwrap_err().to_string()
            );
        }
        assert_eq!(file("0,0,0,1\n60,0,0,1\n").into_sound().unwrap().len(), 2);
    }

    #[test]
    fn errors_of_a_record_in_memory_have_the_lines_of_its_text() {
        let read = file("0,0,0,1\n60,0,0,9.81\n30,0,0,1\n180,nan,0,1\n");
        let kept = RecordFile::of_record(read.record().clone(), "frame");
        assert_eq!((kept.name(), kept.line(0)), ("frame", None));
        let error = kept.check(kept.record(), 2).unwrap_err().to_string();
        assert!(error.starts_with("frame:3:1: found a norm"), "{error}");
        let sound = kept.record().without([[1, 2]]);
        assert!(kept.check(&sound, 3).is_ok());
    }

    #[test]
    fn what_is_left_is_checked_at_its_place() {
        let file = file("0,0,0,1\n60,0,0,9.81\n120,0,0,1\n180,0,0,1\n");
        let error = file.check(file.record(), 2).unwrap_err().to_string();
        assert!(error.starts_with("r.csv:4:1: found a norm"), "{error}");
        let mut left = file.record().without([[1, 2]]);
        assert!(file.check(&left, 4).is_ok());
        left.accel_g.truncate(2);
        left.time_s.truncate(2);
        let error = file.check(&left, 3).unwrap_err().to_string();
        assert!(error.contains("found 2 rows after the header"), "{error}");
    }
}
