//! Logs of three gyros, most with three accelerometers.

mod slower;
mod stamps;
mod stuck;
mod wild;

use std::path::Path;

use gyrocal_record::SourceText;
use gyrocal_statistics::median_interval_s;

use crate::cell::Wanted;
use crate::clock::{Clock, resampled, steady_clock};
use crate::columns::FileColumns;
use crate::covariates::{Saturated, refuse_saturated, saturated, temperatures_c};
use crate::description::{Description, Direction, Gyro, Jitter, Time, no_accelerometers};
use crate::error::{InstrumentError, Unfit};
use crate::row_time::RowTime;
use crate::scale::{accel_scale, gyro_scale};

use self::slower::fill_slower;
use self::stamps::refuse_backwards;
use self::stuck::refuse_stuck;

pub(crate) use stuck::{refuse_still, refuse_still_at_stops};
pub use wild::BadSamples;
pub(crate) use wild::of_logs;

/// Samples of gyros and accelerometers; all vectors have the same length.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    /// End of the interval of each sample.
    pub time_s: Vec<f64>,
    /// Rate about body x, y, z: rad/s, or counts above zero if the scale is not known.
    pub gyro: Vec<[f64; 3]>,
    /// Specific force along body x, y, z: g, or counts above zero if the scale is not known; `None` of gyros alone.
    pub accel: Option<Vec<[f64; 3]>>,
    /// Temperature \[degrees Celsius\], if the log has it.
    pub temperature_c: Option<Vec<f64>>,
    /// Rate of the turntable about its axis \[rad/s\], if the log has it.
    pub table_rate: Option<Vec<f64>>,
    /// `true` if the scale of the gyros is not known.
    pub gyro_in_counts: bool,
    /// `true` if the scale of the accelerometers is not known.
    pub accel_in_counts: bool,
    /// Stretches of gyros at the end of their range; only a log that is read for its stops has any.
    pub saturated: Vec<Saturated>,
    /// Samples that no noise explains, where [`Self::without_bad_samples`] has left them out.
    pub bad_samples: Vec<BadSamples>,
    /// Median interval between samples.
    pub interval_s: f64,
    /// Origin of the times.
    pub clock: Clock,
}

/// What is done with gyros at the end of their range.
#[derive(Clone, Copy, PartialEq, Eq)]
enum AtEndOfRange {
    Refused,
    Told,
}

/// Intervals longer than this many median ones are gaps.
const GAP: f64 = 1.5;

/// Largest relative scatter of the intervals of a log whose stamps are taken as they are: integration of a
/// changing rate errs by this fraction of its change over an interval.
const JITTER: f64 = 0.05;

/// Intervals longer than this many median ones are no jitter.
const LONGEST_JITTER: f64 = 10.0;

impl Log {
    /// Reads a log. One whose description has no accelerometers is of gyros alone.
    ///
    /// # Errors
    ///
    /// [`InstrumentError::File`] at its place in a text; [`Unfit::Gap`], [`Unfit::Jitter`], [`Unfit::NoScale`],
    /// [`Unfit::Stuck`] and [`Unfit::Saturated`].
    pub fn read(path: &Path, description: &Description) -> Result<Self, InstrumentError> {
        Self::read_with(path, description, AtEndOfRange::Refused)
    }

    /// Reads a log for its stops: gyros may be at the end of their range while they turn, [`Self::saturated`] has where;
    /// samples that no noise explains are left out, as by [`Self::without_bad_samples`].
    ///
    /// # Errors
    ///
    /// As for [`Self::read`], but for [`Unfit::Saturated`].
    pub fn read_for_stops(path: &Path, description: &Description) -> Result<Self, InstrumentError> {
        Ok(Self::read_with(path, description, AtEndOfRange::Told)?.without_bad_samples(true))
    }

    fn read_with(
        path: &Path,
        description: &Description,
        at_end: AtEndOfRange,
    ) -> Result<Self, InstrumentError> {
        let (names, time) = (names(description)?, RowTime::new(description));
        let file = FileColumns::read(path, &description.file, &wanted(&names, description), time)?;
        Self::from_columns(file, description, at_end)
    }

    /// Parses the text of a log; errors call it `name`.
    ///
    /// # Errors
    ///
    /// As for [`Self::read`].
    pub fn parse(
        text: &str,
        name: &str,
        description: &Description,
    ) -> Result<Self, InstrumentError> {
        let source = SourceText::new(text, name)?;
        let (names, time) = (names(description)?, RowTime::new(description));
        let wanted = wanted(&names, description);
        let file = FileColumns::of_text(source, &description.file, &wanted, time)?;
        Self::from_columns(file, description, AtEndOfRange::Refused)
    }

    /// A log of samples at equal intervals \[s\] in rad/s and g.
    #[must_use]
    pub fn from_samples(interval_s: f64, gyro: Vec<[f64; 3]>, accel: Vec<[f64; 3]>) -> Self {
        Self {
            time_s: (1..=gyro.len())
                .map(|sample| sample as f64 * interval_s)
                .collect(),
            gyro,
            accel: Some(accel),
            temperature_c: None,
            table_rate: None,
            gyro_in_counts: false,
            accel_in_counts: false,
            saturated: Vec::new(),
            bad_samples: Vec::new(),
            interval_s,
            clock: Clock::Rate,
        }
    }

    /// Specific force, as [`Self::accel`], for what needs it.
    ///
    /// # Errors
    ///
    /// [`Unfit::NoAccelerometers`].
    pub fn force(&self) -> Result<&[[f64; 3]], InstrumentError> {
        self.accel.as_deref().ok_or_else(no_accelerometers)
    }

    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time_s.len()
    }

    /// `true` without samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time_s.is_empty()
    }

    fn from_columns(
        mut file: FileColumns,
        description: &Description,
        at_end: AtEndOfRange,
    ) -> Result<Self, InstrumentError> {
        let gyro = gyro_of(description)?;
        let gyro_scale = gyro_scale(gyro)?;
        let accel = description.accel.as_ref();
        let accel_scale = accel.map(|accel| accel_scale(accel, &description.site));
        let accel_scale = accel_scale.transpose()?;
        let turns = at_end == AtEndOfRange::Told;
        refuse_stuck(&file, gyro, sensors(description), turns)?;
        let (time_s, clock) = times(&file, &description.time);
        let interval_s = usual_interval_s(&time_s)?;
        refuse_backwards(&file, &time_s, interval_s)?;
        fill_slower(&mut file, &time_s, description)?;
        let columns = &file.values;
        let rows = columns.first().map_or(0, Vec::len);
        let mut others = columns[sensors(description)..].iter();
        let temperature_c = match (&description.temperature, others.len()) {
            (Some(column), 1..) => {
                let values = others.next().map_or(&[][..], Vec::as_slice);
                Some(temperatures_c(&file, values, column)?)
            }
            _ => None,
        };
        let table = description
            .table
            .as_ref()
            .and_then(|column| Some((column, others.next()?)));
        let table_rate = table.map(|(column, values)| column.rates(values, &time_s));
        let gyros = columns.iter().zip(&gyro.columns);
        let saturated: Vec<Saturated> = gyros
            .flat_map(|(values, name)| saturated(values, name))
            .collect();
        if at_end == AtEndOfRange::Refused {
            refuse_saturated(&file, &saturated)?;
        }
        let body = |first: usize, zero: f64, scale: [f64; 3], axes: [Direction; 3]| {
            let sample = |row: usize| {
                let column = |i: usize| (columns[first + i][row] - zero) * scale[i];
                let columns = [column(0), column(1), column(2)];
                axes.map(|direction| direction.of(columns))
            };
            (0..rows).map(sample).collect::<Vec<[f64; 3]>>()
        };
        let force = accel.zip(accel_scale).map(|(accel, scale)| {
            body(3, accel.zero_counts, scale.unwrap_or([1.0; 3]), accel.axes)
        });
        let log = Self {
            interval_s,
            gyro: body(
                0,
                gyro.zero_counts,
                gyro_scale.unwrap_or([1.0; 3]),
                gyro.axes,
            ),
            accel: force,
            temperature_c,
            table_rate,
            saturated,
            bad_samples: Vec::new(),
            gyro_in_counts: gyro_scale.is_none(),
            accel_in_counts: accel_scale.is_some_and(|scale| scale.is_none()),
            time_s,
            clock,
        };
        if log.is_regular() {
            return Ok(log);
        }
        match description.time.jitter {
            Jitter::Steady => log.on_steady_clock(&file),
            Jitter::Use => {
                log.refuse_long_gaps(&file)?;
                Ok(log)
            }
            Jitter::Resample => {
                log.refuse_long_gaps(&file)?;
                Ok(log.at_equal_intervals())
            }
        }
    }

    /// `true` if no interval is a gap and the intervals hardly scatter.
    fn is_regular(&self) -> bool {
        let longest_s = GAP * self.interval_s;
        let mut intervals = self.time_s.windows(2).map(|pair| pair[1] - pair[0]);
        intervals.all(|interval_s| interval_s <= longest_s) && self.scatter() <= JITTER
    }

    /// Rms deviation of the intervals from the usual one, relative to it.
    fn scatter(&self) -> f64 {
        let intervals = self.time_s.windows(2).map(|pair| pair[1] - pair[0]);
        let squares = intervals.map(|interval_s| (interval_s / self.interval_s - 1.0).powi(2));
        (squares.sum::<f64>() / (self.len() - 1) as f64).sqrt()
    }

    /// The samples on the steady clock behind stamps that jitter.
    fn on_steady_clock(self, file: &FileColumns) -> Result<Self, InstrumentError> {
        match steady_clock(&self.time_s) {
            Ok(steady) => Ok(Self {
                interval_s: median_interval_s(&steady.time_s),
                time_s: steady.time_s,
                clock: Clock::Steady {
                    jitter_s: steady.jitter_s,
                },
                ..self
            }),
            Err([from, _]) => Err(self.gap(file, from)),
        }
    }

    /// The samples interpolated at equal intervals.
    fn at_equal_intervals(self) -> Self {
        let [first, last] = [self.time_s[0], self.time_s[self.len() - 1]];
        let count = ((last - first) / self.interval_s) as usize + 1;
        let at_s: Vec<f64> = (0..count)
            .map(|sample| first + sample as f64 * self.interval_s)
            .collect();
        let alone = |values: Vec<f64>| -> Vec<f64> {
            let vectors: Vec<[f64; 3]> = values.into_iter().map(|value| [value; 3]).collect();
            let at_equal = resampled(&self.time_s, &vectors, &at_s);
            at_equal.into_iter().map(|[value, ..]| value).collect()
        };
        let jitter_s = self.scatter() * self.interval_s;
        let place = |sample: usize| at_s.partition_point(|at_s| *at_s < self.time_s[sample]);
        let moved = |one: Saturated| Saturated {
            // What is interpolated with such a sample is no better.
            samples: place(one.samples.start).saturating_sub(1)
                ..(place(one.samples.end - 1) + 1).min(count),
            ..one
        };
        Self {
            saturated: self.saturated.into_iter().map(moved).collect(),
            temperature_c: self.temperature_c.map(alone),
            table_rate: self.table_rate.map(alone),
            gyro: resampled(&self.time_s, &self.gyro, &at_s),
            accel: self
                .accel
                .map(|force| resampled(&self.time_s, &force, &at_s)),
            clock: Clock::Resampled { jitter_s },
            time_s: at_s,
            ..self
        }
    }
}

/// Times of the rows, which are the last column, and how they are known.
fn times(file: &FileColumns, time: &Time) -> (Vec<f64>, Clock) {
    if let Some(rate_hz) = time.rate_hz {
        let (interval_s, rows) = (1.0 / rate_hz, file.values.first().map_or(0, Vec::len));
        let time_s = (1..=rows).map(|row| row as f64 * interval_s).collect();
        return (time_s, Clock::Rate);
    }
    (
        file.values.last().cloned().unwrap_or_default(),
        Clock::Stamps,
    )
}

/// Columns of gyros and accelerometers, which come first.
fn sensors(description: &Description) -> usize {
    3 + 3 * usize::from(description.accel.is_some())
}

/// The columns of names, and those of slower sensors among them.
fn wanted<'a>(names: &'a [&'a str], description: &Description) -> Wanted<'a> {
    let with_temperature = sensors(description) + usize::from(description.temperature.is_some());
    Wanted {
        names,
        sparse: 3..with_temperature,
    }
}

/// Columns of the description: gyros, accelerometers, temperature, turntable.
fn names(description: &Description) -> Result<Vec<&str>, InstrumentError> {
    let sensors = gyro_of(description)?.columns.iter();
    let forces = description.accel.iter().flat_map(|accel| &accel.columns);
    let sensors = sensors.chain(forces);
    let mut names: Vec<&str> = sensors.map(String::as_str).collect();
    let temperature = description.temperature.as_ref();
    names.extend(temperature.map(|column| column.column.as_str()));
    let table = description.table.as_ref();
    names.extend(table.map(|table| table.column.as_str()));
    Ok(names)
}

fn gyro_of(description: &Description) -> Result<&Gyro, InstrumentError> {
    description.gyro.as_ref().ok_or_else(|| {
        InstrumentError::unfit(
            Unfit::NoGyros,
            "a description without `[gyro]`",
            "the columns of three gyros",
            "add `[gyro]` with `columns = [\"gx\", \"gy\", \"gz\"]` and `unit = \"deg/s\"` by the \
             names and the unit of the log; only the record of a stable platform has no gyros",
        )
    })
}

fn usual_interval_s(time_s: &[f64]) -> Result<f64, InstrumentError> {
    const FEWEST: usize = 100;
    if time_s.len() < FEWEST {
        return Err(InstrumentError::unfit(
            Unfit::TooShort,
            format!("{} samples", time_s.len()),
            format!("at least {FEWEST}"),
            "record for longer",
        ));
    }
    Ok(median_interval_s(time_s))
}
