//! What a record shows and the catalogue has no name for: lines, and curves over specific force.

use gyrocal_calibration::{CalibrationError, Column, Extended, Jump};
use gyrocal_record::Record;
use gyrocal_statistics::{chi_square_equivalent, ln_chi_square_tail};

use super::{curve, line};

/// A gyro or an accelerometer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// The drift of gyro 0, 1, 2 of x, y, z.
    Drift(usize),
    /// The readings of accelerometer 0, 1, 2 of x, y, z.
    Readings(usize),
}

impl Channel {
    /// All of them.
    pub(super) const ALL: [Self; 6] = [
        Self::Drift(0),
        Self::Drift(1),
        Self::Drift(2),
        Self::Readings(0),
        Self::Readings(1),
        Self::Readings(2),
    ];

    /// Unit of what it shows.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Drift(_) => "deg/h",
            Self::Readings(_) => "g",
        }
    }
}

const SIDEREAL_DAY_H: f64 = 23.934_47;

/// How it goes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pattern {
    /// As a sine.
    Line {
        /// Its period, h.
        period_h: f64,
    },
    /// With a component of specific force, and not as a polynomial of the catalogue does.
    Curve {
        /// 0, 1, 2 of the component along x, y, z.
        axis: usize,
    },
}

/// Something that no effect of the catalogue explains.
#[derive(Clone, Debug, PartialEq)]
pub struct Unnamed {
    /// Where it is.
    pub channel: Channel,
    /// How it goes.
    pub pattern: Pattern,
    /// Amplitude of a line, root mean square of a curve, in the channel's unit.
    pub size: f64,
    /// Chi-square if it is absent.
    pub statistic: f64,
    /// Its degrees of freedom.
    pub degrees_of_freedom: usize,
    /// Natural logarithm of the probability that chance shows as much anywhere that was looked at.
    pub ln_probability: f64,
    /// What it adds to a model.
    pub(super) columns: Vec<Column>,
}

impl Unnamed {
    pub(super) fn new(
        (channel, pattern): (Channel, Pattern),
        size: f64,
        (statistic, degrees_of_freedom): (f64, usize),
        ln_chances: f64,
        columns: Vec<Column>,
    ) -> Self {
        let tail = ln_chi_square_tail(statistic, degrees_of_freedom as f64);
        Self {
            channel,
            pattern,
            size,
            statistic,
            degrees_of_freedom,
            ln_probability: (tail + ln_chances).min(0.0),
            columns,
        }
    }

    /// The value of chi-square with one degree of freedom that is as rare.
    pub(super) fn equivalent(&self) -> f64 {
        chi_square_equivalent(self.ln_probability)
    }

    /// Whether it is a line with a period that terms of the catalogue have: a sidereal day, its
    /// half or its third, as far as the record can tell.
    pub(super) fn is_of_the_day(&self, record: &Record) -> bool {
        let (Pattern::Line { period_h }, [first_s, .., last_s]) =
            (self.pattern, record.time_s.as_slice())
        else {
            return false;
        };
        let half_told_per_h = 1800.0 / (last_s - first_s);
        (1..=3).any(|harmonic| {
            (f64::from(harmonic) / SIDEREAL_DAY_H - 1.0 / period_h).abs() < half_told_per_h
        })
    }
}

/// The most significant line or curve beside what a fit holds, if it stands against what else there
/// is. Curves, which cost more, are looked for if they are asked for or a line stands: what goes
/// with specific force has the periods of a day.
pub(super) fn strongest(
    fitted: &Extended<'_>,
    record: &Record,
    jumps: &[Option<Jump>],
    curves: bool,
    stands: impl Fn(&Unnamed) -> bool,
) -> Result<Option<Unnamed>, CalibrationError> {
    let line = line::strongest(fitted, record, jumps)?.filter(&stands);
    let curve = if curves || line.is_some() {
        curve::strongest(fitted, record)?.filter(&stands)
    } else {
        None
    };
    let found = [line, curve].into_iter().flatten();
    Ok(found.min_by(|a, b| a.ln_probability.total_cmp(&b.ln_probability)))
}
