//! Spectral lines in rates and outputs. The spectrum of the scores of a change in every step and
//! every output proposes frequencies; a line is fitted at each.

use core::f64::consts::TAU;
use std::sync::Arc;

use gyrocal_statistics::math::{cos, ln, sin};
use gyrocal_statistics::{FrequencySearch, fourier_powers, median_interval_s};

use crate::bank::ScoreBank;
use crate::model::{FittedModel, StateJump};
use crate::pattern::{ChannelIndex, Pattern, Unmodelled};
use crate::plant::Plant;
use crate::rows::Rows;
use gyrocal_inference::Column;

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

/// The most significant line, the unknowns of the fit free.
pub(crate) fn strongest<F: FittedModel>(
    fitted: &F,
    rows: &Rows,
    jumps: &[Option<StateJump>],
) -> Result<Option<Unmodelled>, F::Error> {
    let (Some(first_s), Some(last_s)) = (rows.time_s.first(), rows.time_s.last()) else {
        return Ok(None);
    };
    let plant = fitted.plant();
    let duration_h = (last_s - first_s) / 3600.0;
    let tried: Vec<(ChannelIndex, f64)> = ChannelIndex::all(plant)
        .into_iter()
        .flat_map(|channel| {
            standing_out(plant, rows, jumps, channel)
                .into_iter()
                .map(move |period_h| (channel, period_h))
        })
        .collect();
    let Some(coarse) = best(fitted, rows, &tried)? else {
        return Ok(None);
    };
    let Pattern::Line { period_h } = coarse.pattern else {
        return Ok(None);
    };
    let finer: Vec<(ChannelIndex, f64)> = (0..REFINED)
        .map(|index| {
            let offset = index as f64 / (REFINED - 1) as f64 - 0.5;
            (coarse.channel, 1.0 / (1.0 / period_h + offset / duration_h))
        })
        .filter(|(_, period_h)| *period_h > 0.0)
        .collect();
    best(fitted, rows, &finer)
}

/// Periods, h, at which the spectrum of a channel's scores stands out.
fn standing_out(
    plant: &Plant,
    rows: &Rows,
    jumps: &[Option<StateJump>],
    channel: ChannelIndex,
) -> Vec<f64> {
    let interval_s = median_interval_s(&rows.time_s);
    let scores: Vec<(f64, f64)> = jumps
        .iter()
        .enumerate()
        .skip(1)
        .filter_map(|(row, jump)| {
            let jump = jump.as_ref()?;
            let (before_s, here_s) = (rows.time_s[row - 1], rows.time_s[row]);
            match channel {
                // A line averages out over a gap.
                ChannelIndex::Rate(_) if here_s - before_s > LONG_STEP * interval_s => None,
                // A rate changes its state by itself times the step.
                ChannelIndex::Rate(rate) => Some((
                    0.5 * (before_s + here_s),
                    jump.score[plant.rate_states[rate]] * (here_s - before_s),
                )),
                ChannelIndex::Output(output) => Some((here_s, jump.outputs[output])),
            }
        })
        .collect();
    let Some((power, step_hz)) = fourier_powers(&rows.time_s, &scores) else {
        return Vec::new();
    };
    let duration_s = rows.time_s[rows.len() - 1] - rows.time_s[0];
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
fn best<F: FittedModel>(
    fitted: &F,
    rows: &Rows,
    tried: &[(ChannelIndex, f64)],
) -> Result<Option<Unmodelled>, F::Error> {
    let plant = fitted.plant();
    let columns: Vec<Column> = tried
        .iter()
        .flat_map(|(channel, period_h)| pair(plant, rows, *channel, *period_h))
        .collect();
    if columns.is_empty() {
        return Ok(None);
    }
    let bank = ScoreBank::conditional(fitted, &columns)?;
    let searched = FrequencySearch::of_times(&rows.time_s);
    let found = tried.iter().enumerate().filter_map(|(index, place)| {
        let (channel, period_h) = *place;
        let joint = bank.joint(&[2 * index, 2 * index + 1])?;
        // Half of chi-square with two degrees of freedom is a power; its own tail is its negative.
        let power = 0.5 * joint.statistic;
        let ln_tests = searched.ln_probability(power) + power;
        Some(Unmodelled::new(
            plant,
            (channel, Pattern::Line { period_h }),
            joint.estimate.norm(),
            (joint.statistic, 2),
            ln_tests + ln(ChannelIndex::all(plant).len() as f64),
            columns[2 * index..2 * index + 2].to_vec(),
        ))
    });
    Ok(found.min_by(|a, b| a.ln_probability.total_cmp(&b.ln_probability)))
}

/// Sine and cosine of a period: of a drift their means over each step, which in a gap may have many
/// periods.
fn pair(plant: &Plant, rows: &Rows, channel: ChannelIndex, period_h: f64) -> [Column; 2] {
    let first_s = rows.time_s.first().copied().unwrap_or(0.0);
    let per_s = TAU / (3600.0 * period_h);
    [sin, cos].map(|of: fn(f64) -> f64| {
        let wave = |time_s: f64| of(per_s * time_s);
        match channel {
            ChannelIndex::Rate(rate) => Column::TimeProfile {
                parameter: plant.rates[rate].constant,
                steps: steps(rows, |middle_s, step_s| {
                    let half_turn = 0.5 * per_s * step_s;
                    wave(middle_s) * sin(half_turn) / half_turn
                }),
            },
            ChannelIndex::Output(output) => Column::Output {
                output,
                change: rows
                    .time_s
                    .iter()
                    .map(|time_s| wave(time_s - first_s))
                    .collect(),
            },
        }
    })
}

/// A number for each step, from its middle since the first row and its length, s.
fn steps(rows: &Rows, of: impl Fn(f64, f64) -> f64) -> Arc<[f64]> {
    let first_s = rows.time_s.first().copied().unwrap_or(0.0);
    let pairs = rows.time_s.windows(2);
    pairs
        .map(|pair| of(0.5 * (pair[0] + pair[1]) - first_s, pair[1] - pair[0]))
        .collect()
}
