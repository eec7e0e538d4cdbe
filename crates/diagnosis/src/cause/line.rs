//! A line in the drift of a gyro: a cause that the catalogue does not hold and that a random walk
//! would swallow.

use core::f64::consts::TAU;

use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::{BIASES, CalibrationError, Column, Extended};
use gyrocal_record::Record;

use super::bank::Bank;

/// The shortest period that is looked for here, h; shorter ones show in the innovations.
const SHORTEST_PERIOD_H: f64 = 1.0;

/// At most so many frequencies.
const MOST_FREQUENCIES: usize = 240;

/// Frequencies per resolution of the record: between two of them a line loses a tenth.
const PER_RESOLUTION: f64 = 2.0;

/// Its frequency is refined on so many points.
const REFINED: usize = 21;

/// A line in the drift of a gyro.
#[derive(Clone, Debug, PartialEq)]
pub struct DriftLine {
    /// 0, 1, 2 of gyro x, y, z.
    pub gyro: usize,
    /// Its period, h.
    pub period_h: f64,
    /// Its amplitude, deg/h.
    pub amplitude_deg_per_h: f64,
    /// Chi-square with two degrees of freedom if it is absent.
    pub statistic: f64,
    /// What searching over frequencies reaches by itself.
    pub searched: f64,
}

/// The strongest line of a gyro beside what a fit holds.
pub(crate) fn strongest(
    fitted: &Extended<'_>,
    record: &Record,
    gyro: usize,
) -> Result<Option<DriftLine>, CalibrationError> {
    let (Some(first_s), Some(last_s)) = (record.time_s.first(), record.time_s.last()) else {
        return Ok(None);
    };
    let duration_h = (last_s - first_s) / 3600.0;
    let count = ((PER_RESOLUTION * duration_h / SHORTEST_PERIOD_H) as usize).min(MOST_FREQUENCIES);
    let periods_h: Vec<f64> = (2..=count)
        .map(|index| PER_RESOLUTION * duration_h / index as f64)
        .collect();
    let searched = 2.0 * (periods_h.len().max(1) as f64).ln();
    let Some(coarse) = best_of(fitted, record, gyro, &periods_h, searched)? else {
        return Ok(None);
    };
    // Frequencies between the neighbours of the best.
    let step_per_h = 1.0 / (PER_RESOLUTION * duration_h);
    let finer: Vec<f64> = (0..REFINED)
        .map(|index| {
            let offset = 2.0 * index as f64 / (REFINED - 1) as f64 - 1.0;
            1.0 / (1.0 / coarse.period_h + offset * step_per_h)
        })
        .collect();
    best_of(fitted, record, gyro, &finer, searched)
}

/// The strongest line among some periods.
fn best_of(
    fitted: &Extended<'_>,
    record: &Record,
    gyro: usize,
    periods_h: &[f64],
    searched: f64,
) -> Result<Option<DriftLine>, CalibrationError> {
    let columns: Vec<Column> = periods_h
        .iter()
        .flat_map(|period_h| courses(record, gyro, *period_h))
        .collect();
    let bank = Bank::new(fitted, &columns, &[])?;
    Ok(periods_h
        .iter()
        .enumerate()
        .filter_map(|(index, period_h)| {
            let first = PARAMETERS.len() + 2 * index;
            let joint = bank.joint(&[first, first + 1])?;
            Some(DriftLine {
                gyro,
                period_h: *period_h,
                amplitude_deg_per_h: joint.estimate.norm(),
                statistic: joint.statistic,
                searched,
            })
        })
        .max_by(|a, b| a.statistic.total_cmp(&b.statistic)))
}

/// Sine and cosine of a period, taken in the middle of each step.
pub(crate) fn courses(record: &Record, gyro: usize, period_h: f64) -> [Column; 2] {
    let first_s = record.time_s.first().copied().unwrap_or(0.0);
    let course = |of: fn(f64) -> f64| Column::Course {
        parameter: BIASES[gyro],
        steps: record
            .time_s
            .windows(2)
            .map(|pair| {
                let middle_s = 0.5 * (pair[0] + pair[1]) - first_s;
                of(TAU * middle_s / (3600.0 * period_h))
            })
            .collect(),
    };
    [course(f64::sin), course(f64::cos)]
}
