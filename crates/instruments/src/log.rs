//! Logs of three gyros and three accelerometers.

use core::ops::Range;
use std::path::Path;

use gyrocal_record::{Error, InputErrorKind, SourceText};
use gyrocal_statistics::median_interval_s;

use crate::columns::{Columns, read_columns};
use crate::description::{AccelUnit, CountScale, Description, Direction, GyroUnit};
use crate::error::{InstrumentError, Unfit};

/// Samples of six sensors; all vectors have the same length.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    /// End of the interval of each sample.
    pub time_s: Vec<f64>,
    /// Rate about body x, y, z: rad/s, or counts above zero if the scale is not known.
    pub gyro: Vec<[f64; 3]>,
    /// Specific force along body x, y, z: g, or counts above zero if the scale is not known.
    pub accel: Vec<[f64; 3]>,
    /// `true` if the scale of the gyros is not known.
    pub gyro_in_counts: bool,
    /// `true` if the scale of the accelerometers is not known.
    pub accel_in_counts: bool,
    /// Median interval between samples.
    pub interval_s: f64,
}

/// Intervals longer than this many median ones are gaps.
const GAP: f64 = 1.5;

/// Largest relative scatter of the intervals: integration of a changing rate errs by this fraction of
/// its change over an interval.
const JITTER: f64 = 0.05;

impl Log {
    /// Reads a log.
    ///
    /// # Errors
    ///
    /// [`InstrumentError::File`] at its place in the file; [`Unfit::Gap`], [`Unfit::Jitter`] and
    /// [`Unfit::NoScale`].
    pub fn read(path: &Path, description: &Description) -> Result<Self, InstrumentError> {
        Self::from_source(&SourceText::read(path)?, description)
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
        Self::from_source(&SourceText::new(text, name)?, description)
    }

    /// A log of samples at equal intervals \[s\] in rad/s and g.
    #[must_use]
    pub fn from_samples(interval_s: f64, gyro: Vec<[f64; 3]>, accel: Vec<[f64; 3]>) -> Self {
        Self {
            time_s: (1..=gyro.len())
                .map(|sample| sample as f64 * interval_s)
                .collect(),
            gyro,
            accel,
            gyro_in_counts: false,
            accel_in_counts: false,
            interval_s,
        }
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

    fn from_source(
        source: &SourceText,
        description: &Description,
    ) -> Result<Self, InstrumentError> {
        let gyro_scale = gyro_scale(description)?;
        let accel_scale = accel_scale(description)?;
        let mut names: Vec<&str> = Vec::new();
        let sensors = description
            .gyro
            .columns
            .iter()
            .chain(&description.accel.columns);
        names.extend(sensors.map(String::as_str));
        names.extend(description.time.column.as_deref());
        let Columns {
            values: columns,
            places,
        } = read_columns(source, &names)?;
        let rows = places.len();
        let time_s = match (&columns[6..], description.time.rate_hz) {
            ([stamps], _) => {
                let unit_s = description.time.unit_s;
                let time_s: Vec<f64> = stamps.iter().map(|stamp| stamp * unit_s).collect();
                refuse_backwards(source, &time_s, &places)?;
                time_s
            }
            (_, rate_hz) => {
                let interval_s = 1.0 / rate_hz.unwrap_or(1.0);
                (1..=rows).map(|row| row as f64 * interval_s).collect()
            }
        };
        let body = |first: usize, zero: f64, scale: [f64; 3], axes: [Direction; 3]| {
            let sample = |row: usize| {
                let column = |i: usize| (columns[first + i][row] - zero) * scale[i];
                let columns = [column(0), column(1), column(2)];
                axes.map(|direction| direction.of(columns))
            };
            (0..rows).map(sample).collect::<Vec<[f64; 3]>>()
        };
        let (gyro, accel) = (&description.gyro, &description.accel);
        let log = Self {
            interval_s: usual_interval_s(&time_s)?,
            gyro: body(
                0,
                gyro.zero_counts,
                gyro_scale.unwrap_or([1.0; 3]),
                gyro.axes,
            ),
            accel: body(
                3,
                accel.zero_counts,
                accel_scale.unwrap_or([1.0; 3]),
                accel.axes,
            ),
            gyro_in_counts: gyro_scale.is_none(),
            accel_in_counts: accel_scale.is_none(),
            time_s,
        };
        log.refuse_gaps()?;
        log.refuse_jitter()?;
        Ok(log)
    }

    fn refuse_gaps(&self) -> Result<(), InstrumentError> {
        let longest_s = GAP * self.interval_s;
        let gaps: Vec<&[f64]> = self
            .time_s
            .windows(2)
            .filter(|pair| pair[1] - pair[0] > longest_s)
            .collect();
        let Some(first) = gaps.first() else {
            return Ok(());
        };
        Err(InstrumentError::unfit(
            Unfit::Gap,
            format!(
                "{} gap(s) in the time stamps, the first of {:.4} s after {} s",
                gaps.len(),
                first[1] - first[0],
                first[0]
            ),
            format!("a sample every {:.4} s", self.interval_s),
            "cut the log at the gap, since rotation that was not recorded cannot be integrated; if \
             the clock is wrong and not the samples, give `rate_hz` in place of the time column",
        ))
    }

    fn refuse_jitter(&self) -> Result<(), InstrumentError> {
        let intervals = self.time_s.windows(2).map(|pair| pair[1] - pair[0]);
        let squares = intervals.map(|interval_s| (interval_s / self.interval_s - 1.0).powi(2));
        let scatter = (squares.sum::<f64>() / (self.len() - 1) as f64).sqrt();
        if scatter <= JITTER {
            return Ok(());
        }
        Err(InstrumentError::unfit(
            Unfit::Jitter,
            format!(
                "intervals that scatter by {:.1} % of the usual {:.4} s",
                100.0 * scatter,
                self.interval_s
            ),
            format!("at most {} %", 100.0 * JITTER),
            "if the sensor samples on its own steady clock and the stamps are those of the \
             computer that received them, give `rate_hz` in place of the time column",
        ))
    }
}

/// Factor from counts above zero to rad/s; `None` if turns are to determine it.
fn gyro_scale(description: &Description) -> Result<Option<[f64; 3]>, InstrumentError> {
    let per_hour = 1.0_f64.to_radians() / 3600.0;
    match (description.gyro.unit, description.gyro.counts_per_rad_per_s) {
        (GyroUnit::RadPerS, _) => Ok(Some([1.0; 3])),
        (GyroUnit::DegPerS, _) => Ok(Some([1.0_f64.to_radians(); 3])),
        (GyroUnit::DegPerH, _) => Ok(Some([per_hour; 3])),
        (GyroUnit::Counts, Some(scale)) => Ok(per_unit(scale)),
        (GyroUnit::Counts, None) => Err(no_scale("gyro", "counts_per_rad_per_s", "from-turns")),
    }
}

/// Factor from counts above zero to g; `None` if stops are to determine it.
fn accel_scale(description: &Description) -> Result<Option<[f64; 3]>, InstrumentError> {
    match (description.accel.unit, description.accel.counts_per_g) {
        (AccelUnit::G, _) => Ok(Some([1.0; 3])),
        (AccelUnit::MetrePerS2, _) => {
            let gravity = description.site.gravity_m_per_s2.unwrap_or(f64::NAN);
            Ok(Some([1.0 / gravity; 3]))
        }
        (AccelUnit::Counts, Some(scale)) => Ok(per_unit(scale)),
        (AccelUnit::Counts, None) => Err(no_scale("accel", "counts_per_g", "from-stops")),
    }
}

fn per_unit(scale: CountScale) -> Option<[f64; 3]> {
    match scale {
        CountScale::Same(counts) => Some([1.0 / counts; 3]),
        CountScale::Each(counts) => Some(counts.map(|counts| 1.0 / counts)),
        CountScale::Estimate(_) => None,
    }
}

fn no_scale(table: &str, key: &str, estimate: &str) -> InstrumentError {
    InstrumentError::unfit(
        Unfit::NoScale,
        format!("`[{table}]` in counts without `{key}`"),
        "what a count is",
        format!(
            "give `{key}`, or `{key} = \"{estimate}\"` for a log with static stops in many \
             attitudes"
        ),
    )
}

fn refuse_backwards(
    source: &SourceText,
    time_s: &[f64],
    places: &[Range<usize>],
) -> Result<(), Error> {
    let Some(row) = time_s.windows(2).position(|pair| pair[1] <= pair[0]) else {
        return Ok(());
    };
    Err(source.error(
        InputErrorKind::Time,
        places[row + 1].clone(),
        format!("time {} s after {} s", time_s[row + 1], time_s[row]),
        "times that rise",
        "cut the log where the clock was set back; if only the stamps are wrong, give `rate_hz` \
         in place of the time column",
    ))
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
