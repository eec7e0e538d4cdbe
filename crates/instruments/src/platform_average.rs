//! Means of a record that may be larger than memory, made while its file is read.

use std::io::{BufRead, Read};
use std::path::Path;

use gyrocal_record::{Error, Record, SourceText, open_text};

use crate::description::Description;
use crate::error::{InstrumentError, Unfit};
use crate::platform_record::{RowReader, finished};
use crate::platform_row::Row;
use crate::typed_file::TypedFile;

/// Longest interval of such means, s. The mean of a platform that turns with the Earth exceeds the value at
/// its middle by T² a''/24, which is 2e-8 g at 10 s; over longer intervals `average_record` corrects it,
/// which needs the neighbours of each mean.
pub const LONGEST_STREAMED_S: f64 = 10.0;

/// Tolerance of the interval boundaries for sampling times, as a share of an interval.
const ON_BOUNDARY: f64 = 1e-6;

/// Bytes that are read at a time, before the rest of the last line.
const BLOCK: u64 = 1 << 20;

/// A record of means.
#[derive(Debug, Clone)]
pub struct AveragedRecordFile {
    /// The means at the mean times of their rows. An interval without rows has no mean.
    pub record: Record,
    /// Number of rows read.
    pub rows: usize,
}

/// Averages the record of a described text file over intervals, the first of which starts at the first row.
/// A text is never in memory as a whole, unless it comes through a pipe.
///
/// # Errors
///
/// As of [`read_record`](crate::read_record); [`Unfit::Setting`] for an interval that is not from 0 to
/// [`LONGEST_STREAMED_S`]; times that go back.
pub fn average_file(
    path: &Path,
    description: &Description,
    interval_s: f64,
) -> Result<AveragedRecordFile, InstrumentError> {
    if !(interval_s > 0.0 && interval_s <= LONGEST_STREAMED_S) {
        return Err(InstrumentError::unfit(
            Unfit::Setting,
            format!("an interval of {interval_s} s"),
            format!("more than 0 and at most {LONGEST_STREAMED_S} s"),
            "average over longer intervals by `calibrate --average`, which corrects the curvature",
        ));
    }
    let name = path.display().to_string();
    if let Some(typed) = TypedFile::of(path)? {
        let mut means = Means::new(interval_s);
        typed.for_each_row(path, description, |row| {
            means.add(row).map_err(|last_s| {
                let found = format!("{name}: time {} s after {last_s} s", row.time_s);
                let advice = "sort the rows by time";
                InstrumentError::unfit(Unfit::Jitter, found, "times that rise", advice)
            })
        })?;
        return means.file(&name, description);
    }
    let mut content = open_text(path, description.file.encoding.as_deref())?;
    let mut reader = RowReader::new(description)?;
    let mut means = Means::new(interval_s);
    let mut lines = 0;
    while let Some(bytes) = next_block(&mut *content).map_err(|reason| Error::Unreadable {
        path: path.to_owned(),
        reason,
    })? {
        let here = bytes.iter().filter(|byte| **byte == b'\n').count();
        let block = SourceText::of_block(bytes, &name, lines)?;
        lines += here;
        reader.read(&block, |row, line| {
            means.add(row).map_err(|last_s| {
                block
                    .error(
                        gyrocal_record::InputErrorKind::Time,
                        line.span,
                        format!("time {} s after {last_s} s", row.time_s),
                        "times that rise",
                        "sort the rows by time; of a clock that was set back `--split` in place of `--average` writes each part, and `calibrate --average` takes them",
                    )
                    .into()
            })
        })?;
    }
    means.file(&name, description)
}

/// The next whole lines; `None` after the last.
fn next_block(content: &mut dyn BufRead) -> std::io::Result<Option<Vec<u8>>> {
    let mut bytes = Vec::new();
    content.take(BLOCK).read_to_end(&mut bytes)?;
    if bytes.last().is_some_and(|byte| *byte != b'\n') {
        content.read_until(b'\n', &mut bytes)?;
    }
    Ok((!bytes.is_empty()).then_some(bytes))
}

/// Means over intervals.
struct Means {
    interval_s: f64,
    record: Record,
    rows: usize,
    first_s: f64,
    last_s: f64,
    group: Group,
}

/// Sums over one interval; of times since its first row.
#[derive(Default)]
struct Group {
    interval: f64,
    first_s: f64,
    rows: usize,
    since_s: f64,
    accel_g: [f64; 3],
    values: [usize; 3],
    temperature_c: Option<(f64, usize)>,
}

impl Means {
    fn new(interval_s: f64) -> Self {
        Self {
            interval_s,
            record: Record::default(),
            rows: 0,
            first_s: 0.0,
            last_s: f64::NEG_INFINITY,
            group: Group::default(),
        }
    }

    /// Adds a row; the time of the row before it if time goes back.
    fn add(&mut self, row: Row) -> Result<(), f64> {
        if row.time_s < self.last_s {
            return Err(self.last_s);
        }
        if self.rows == 0 {
            self.first_s = row.time_s;
        }
        self.last_s = row.time_s;
        self.rows += 1;
        let since = (row.time_s - self.first_s) / self.interval_s;
        let interval = (since + ON_BOUNDARY).floor();
        if interval > self.group.interval {
            self.group.push_to(&mut self.record);
            self.group = Group {
                interval,
                ..Group::default()
            };
        }
        self.group.add(row);
        Ok(())
    }

    fn file(
        mut self,
        name: &str,
        description: &Description,
    ) -> Result<AveragedRecordFile, InstrumentError> {
        self.group.push_to(&mut self.record);
        if self.rows == 0 {
            return Err(InstrumentError::unfit(
                Unfit::TooShort,
                format!("{name}: no rows"),
                "samples",
                "check that the program that wrote the log had finished",
            ));
        }
        Ok(AveragedRecordFile {
            record: finished(self.record, description),
            rows: self.rows,
        })
    }
}

impl Group {
    fn add(&mut self, row: Row) {
        if self.rows == 0 {
            self.first_s = row.time_s;
        }
        self.rows += 1;
        self.since_s += row.time_s - self.first_s;
        for (axis, value) in row.accel_g.into_iter().enumerate() {
            if !value.is_nan() {
                self.accel_g[axis] += value;
                self.values[axis] += 1;
            }
        }
        if let Some(temperature_c) = row.temperature_c {
            let (sum, values) = self.temperature_c.get_or_insert_default();
            if !temperature_c.is_nan() {
                *sum += temperature_c;
                *values += 1;
            }
        }
    }

    fn push_to(&self, record: &mut Record) {
        if self.rows == 0 {
            return;
        }
        let mean = |sum: f64, values: usize| sum / values as f64;
        Row {
            time_s: self.first_s + mean(self.since_s, self.rows),
            // Zero over zero is a missing value.
            accel_g: core::array::from_fn(|axis| mean(self.accel_g[axis], self.values[axis])),
            temperature_c: self.temperature_c.map(|(sum, values)| mean(sum, values)),
        }
        .push_to(record);
    }
}
