//! Lines in drifts and readings. The scores of a change in every step and every reading are what a
//! record would gain by any course of them; where their spectrum stands out, a line is tried.

use core::f64::consts::TAU;
use std::sync::Arc;

use gyrocal_calibration::{BIASES, CalibrationError, Column, Extended, Jump};
use gyrocal_record::Record;
use gyrocal_statistics::{FrequencySearch, fourier_powers, median_interval_s};

use super::bank::Bank;
use super::unnamed::{Channel, Pattern, Unnamed};

/// Lines that are tried in each channel.
const TRIED: usize = 4;

/// Cycles in the record below which a line is a trend.
const LEAST_CYCLES: f64 = 1.5;

/// Frequencies between two bands, as a ratio: spectra of scores change little over one.
const BAND: f64 = 1.2;

/// A band has at least so many frequencies of the record.
const LEAST_BAND_CYCLES: f64 = 12.0;

/// Frequencies of the record on each side of a line that its side lobes take.
const SIDE_LOBES: f64 = 2.0;

/// A step of so many usual ones is a gap.
const LONG_STEP: f64 = 3.0;

/// The frequency is refined on so many points, across one frequency of the record.
const REFINED: usize = 17;

/// The most significant line beside what a fit holds.
pub(super) fn strongest(
    fitted: &Extended<'_>,
    record: &Record,
    jumps: &[Option<Jump>],
) -> Result<Option<Unnamed>, CalibrationError> {
    let (Some(first_s), Some(last_s)) = (record.time_s.first(), record.time_s.last()) else {
        return Ok(None);
    };
    let duration_h = (last_s - first_s) / 3600.0;
    let tried: Vec<(Channel, f64)> = Channel::ALL
        .into_iter()
        .flat_map(|channel| {
            standing_out(record, jumps, channel)
                .into_iter()
                .map(move |period_h| (channel, period_h))
        })
        .collect();
    let Some(coarse) = best(fitted, record, &tried)? else {
        return Ok(None);
    };
    let Pattern::Line { period_h } = coarse.pattern else {
        return Ok(None);
    };
    let finer: Vec<(Channel, f64)> = (0..REFINED)
        .map(|index| {
            let offset = index as f64 / (REFINED - 1) as f64 - 0.5;
            (coarse.channel, 1.0 / (1.0 / period_h + offset / duration_h))
        })
        .filter(|(_, period_h)| *period_h > 0.0)
        .collect();
    best(fitted, record, &finer)
}

/// Periods, h, at which the spectrum of a channel's scores stands out.
fn standing_out(record: &Record, jumps: &[Option<Jump>], channel: Channel) -> Vec<f64> {
    let interval_s = median_interval_s(&record.time_s);
    let scores: Vec<(f64, f64)> = jumps
        .iter()
        .enumerate()
        .skip(1)
        .filter_map(|(row, jump)| {
            let jump = (*jump)?;
            let (before_s, here_s) = (record.time_s[row - 1], record.time_s[row]);
            match channel {
                // Over a gap nothing is left of a line.
                Channel::Drift(_) if here_s - before_s > LONG_STEP * interval_s => None,
                // A drift turns the platform by itself times the step.
                Channel::Drift(axis) => Some((
                    0.5 * (before_s + here_s),
                    jump.score[axis] * (here_s - before_s),
                )),
                Channel::Readings(axis) => Some((here_s, jump.readings[axis])),
            }
        })
        .collect();
    let Some((power, step_hz)) = fourier_powers(&record.time_s, &scores) else {
        return Vec::new();
    };
    let duration_s = record.time_s[record.len() - 1] - record.time_s[0];
    // Places of the transform for each frequency of the record.
    let finer = 1.0 / (duration_s * step_hz);
    let mut peaks: Vec<(f64, usize)> = Vec::new();
    let mut from = (LEAST_CYCLES * finer) as usize;
    while from + 1 < power.len() {
        let width = (from as f64 * (BAND - 1.0)).max(LEAST_BAND_CYCLES * finer);
        let to = (from + width as usize + 1).min(power.len());
        let mut sorted = power[from..to].to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        // Low in the distribution, where a line in the band with its side lobes does not reach.
        let level = sorted[sorted.len() / 4].max(f64::MIN_POSITIVE);
        for place in from.max(1)..to.min(power.len() - 1) {
            if power[place] >= power[place - 1] && power[place] > power[place + 1] {
                peaks.push((power[place] / level, place));
            }
        }
        from = to;
    }
    peaks.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    let mut chosen: Vec<usize> = Vec::with_capacity(TRIED);
    for (_, place) in peaks {
        // Not the side lobes of another.
        let apart = |other: &usize| place.abs_diff(*other) as f64 > SIDE_LOBES * finer;
        if chosen.len() < TRIED && chosen.iter().all(apart) {
            chosen.push(place);
        }
    }
    chosen
        .into_iter()
        .map(|place| 1.0 / (3600.0 * (place as f64 + 1.0) * step_hz))
        .collect()
}

/// The most significant of some lines.
fn best(
    fitted: &Extended<'_>,
    record: &Record,
    tried: &[(Channel, f64)],
) -> Result<Option<Unnamed>, CalibrationError> {
    let columns: Vec<Column> = tried
        .iter()
        .flat_map(|(channel, period_h)| pair(record, *channel, *period_h))
        .collect();
    if columns.is_empty() {
        return Ok(None);
    }
    let bank = Bank::beside(fitted, &columns)?;
    let searched = FrequencySearch::of_times(&record.time_s);
    let found = tried.iter().enumerate().filter_map(|(index, place)| {
        let (channel, period_h) = *place;
        let joint = bank.joint(&[2 * index, 2 * index + 1])?;
        // Half of chi-square with two degrees of freedom is a power; its own tail is its negative.
        let power = 0.5 * joint.statistic;
        let ln_chances = searched.ln_probability(power) + power;
        Some(Unnamed::new(
            (channel, Pattern::Line { period_h }),
            joint.estimate.norm(),
            (joint.statistic, 2),
            ln_chances + (Channel::ALL.len() as f64).ln(),
            columns[2 * index..2 * index + 2].to_vec(),
        ))
    });
    Ok(found.min_by(|a, b| a.ln_probability.total_cmp(&b.ln_probability)))
}

/// Sine and cosine of a period: of a drift their means over each step, which in a gap may have many
/// periods.
fn pair(record: &Record, channel: Channel, period_h: f64) -> [Column; 2] {
    let first_s = record.time_s.first().copied().unwrap_or(0.0);
    let rate = TAU / (3600.0 * period_h);
    [f64::sin, f64::cos].map(|of: fn(f64) -> f64| {
        let wave = |time_s: f64| of(rate * time_s);
        match channel {
            Channel::Drift(gyro) => Column::Course {
                parameter: BIASES[gyro],
                steps: steps(record, |middle_s, step_s| {
                    let half_turn = 0.5 * rate * step_s;
                    wave(middle_s) * half_turn.sin() / half_turn
                }),
            },
            Channel::Readings(axis) => Column::Readings {
                axis,
                change_g: record
                    .time_s
                    .iter()
                    .map(|time_s| wave(time_s - first_s))
                    .collect(),
            },
        }
    })
}

/// A number for each step, from its middle since the first row and its length, s.
fn steps(record: &Record, of: impl Fn(f64, f64) -> f64) -> Arc<[f64]> {
    let first_s = record.time_s.first().copied().unwrap_or(0.0);
    let pairs = record.time_s.windows(2);
    pairs
        .map(|pair| of(0.5 * (pair[0] + pair[1]) - first_s, pair[1] - pair[0]))
        .collect()
}
