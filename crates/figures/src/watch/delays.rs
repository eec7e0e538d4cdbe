//! Delays beside the e-process of one effect alone, and the sets at the alarms.

use gyrocal::watch::EFFECTS_BY_DEFAULT;
use gyrocal::{ControllerError, FilterSettings, Site};
use gyrocal_statistics::{Judgement, Proportion, median};
use serde::{Deserialize, Serialize};

use super::lane::{Injected, Lane};
use super::noise::Noise;
use super::platform::Platform;
use super::{DAY, LANES};
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use crate::truth::Extent;

/// A population that no constant was tuned on.
const DELAYS: u64 = 20_261_232;
/// The population that constants of the watch are tuned on.
const TUNED_ON: u64 = 20_261_121;
/// Steps before the effect begins, at least: a filter that has settled.
const SETTLED: usize = 10 * DAY;
/// Days that an alarm is waited for.
const DAYS: usize = 30;
/// A cell with fewer alarms among its runs has no share of its own: they are those that noise helped.
const ALARMED: f64 = 0.5;

/// Effects on gyro or accelerometer x, and their ids.
const EFFECTS: [(&str, Injected, &str); 4] = [
    ("step", Injected::Step(0), "gyro_x.step"),
    ("ramp", Injected::Ramp(0), "gyro_x.ramp"),
    ("cross-axis term", Injected::Cross(0, 1), "gyro_x.g_y"),
    ("bias", Injected::Bias(0), "accel_x.bias"),
];
const SIZES: [f64; 3] = [2.0, 4.0, 8.0];

/// An effect whose delay is sought.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Trial {
    /// The effect.
    effect: Injected,
    /// Its id in the catalogue.
    id: &'static str,
    /// Root of the information in the first day.
    sigmas_a_day: f64,
}

/// A run with an effect.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Delay {
    /// Days from the onset to the alarm; `None` if there was none. Negative: before the onset.
    days: Option<f64>,
    /// The same of the e-process with that effect alone.
    alone_days: Option<f64>,
    /// Whether the set at the alarm holds the effect.
    held: bool,
    /// Effects in that set.
    set: usize,
}

/// Information of a day on sizes of effects over what the watch takes for it, medians over attitudes.
pub(super) fn information(extent: Extent) -> Result<Vec<Figure>, Error> {
    let settings = FilterSettings::<f64>::at_site(Site::at_latitude_deg(0.0));
    let numbers = 0..extent.records(24, 6);
    let effects = EFFECTS.map(|(_, effect, _)| effect);
    let all = numbers
        .clone()
        .map(|number| units(TUNED_ON, number, &effects, 1e-5));
    let all: Vec<Vec<f64>> = all.collect::<Result<_, _>>()?;
    let of_effect = |(place, (kind, _, id)): (usize, &(&str, Injected, &str))| {
        let taken = EFFECTS_BY_DEFAULT.iter().find(|effect| effect.id == *id);
        let taken = taken.map_or(f64::NAN, |effect| effect.information_of_a_day(&settings));
        let found: Vec<f64> = all.iter().map(|of| of[place]).collect();
        let name = format!("{kind}: information of a day over the constant of the watch, median");
        let figure = Figure::within(&name, [0.5, 2.0], median(&found) / taken);
        figure.over(all.len(), format!("{TUNED_ON}, {numbers:?}"))
    };
    Ok(EFFECTS.iter().enumerate().map(of_effect).collect())
}

pub(super) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let platforms = extent.records(40, 2);
    let (lanes, days) = if small { (3, 3) } else { (LANES, DAYS) };
    let sizes: &[f64] = if small { &SIZES[2..] } else { &SIZES };
    let trials: Vec<Trial> = EFFECTS
        .iter()
        .flat_map(|(_, effect, id)| {
            sizes.iter().map(|sigmas_a_day| Trial {
                effect: *effect,
                id,
                sigmas_a_day: *sigmas_a_day,
            })
        })
        .collect();
    let mut figures = Vec::new();
    let mut at_alarm: Vec<Delay> = Vec::new();
    let mut worst: Option<(Proportion, String)> = None;
    for walk in [0.0, 1e-5] {
        let seeds = 0..platforms;
        let cell = format!("delays {walk:e}");
        let campaign = resumable::campaign("watch", &cell, seeds.clone(), small)?;
        let job = |number| delays(number, &trials, lanes, days, walk);
        let outcome = campaign.run(job, |_| ())?;
        for (place, trial) in trials.iter().enumerate() {
            let runs: Vec<Delay> = outcome
                .successes()
                .filter_map(|(_, all): (_, &Vec<Vec<Delay>>)| all.get(place))
                .flatten()
                .cloned()
                .collect();
            let kind = EFFECTS[place / sizes.len()].0;
            let name = format!(
                "{kind} of {} sigma a day, walk {walk:.0e}",
                trial.sigmas_a_day
            );
            let count = runs.len();
            let figure = delay_figure(&name, &runs, small);
            figures.push(figure.over(count, format!("{DELAYS}, {seeds:?}")));
            let found: Vec<Delay> = runs
                .into_iter()
                .filter(|run| run.days > Some(0.0))
                .collect();
            let held = Proportion::of(found.iter().map(|run| run.held));
            let least = worst
                .as_ref()
                .map_or(f64::INFINITY, |(least, _)| least.share());
            if found.len() as f64 >= ALARMED * count as f64 && held.share() < least {
                worst = Some((held, name));
            }
            at_alarm.extend(found);
        }
    }
    figures.extend(of_sets(&at_alarm, worst, small));
    Ok(figures)
}

/// Most effects in a set, in the mean.
const MOST_EFFECTS: f64 = 3.0;

/// The sets at all alarms, and those of the effect and size that they hold most rarely.
fn of_sets(at_alarm: &[Delay], worst: Option<(Proportion, String)>, small: bool) -> Vec<Figure> {
    let seeds = format!("{DELAYS}, all above");
    let share = |name: &str, held: Proportion| {
        let figure = Figure::within(name, [0.95, f64::INFINITY], held.share()).of_share(held);
        let figure = match small {
            true => figure.judged(held.at_least(0.95)),
            false => figure,
        };
        figure.over(held.trials as usize, seeds.as_str())
    };
    let held = Proportion::of(at_alarm.iter().map(|run| run.held));
    let mut figures = vec![share("set at the alarm holds the truth", held)];
    if let Some((held, name)) = worst {
        let mut figure = share("the same of the effect and size with the least share", held);
        figure.measured = format!("{} ({name})", figure.measured);
        figures.push(figure);
    }
    let effects: usize = at_alarm.iter().map(|run| run.set).sum();
    let mean = effects as f64 / at_alarm.len().max(1) as f64;
    let mut sizes = Figure::within("effects in the set, mean", [1.0, MOST_EFFECTS], mean);
    // Few runs fail where their mean is above by more than its three standard deviations.
    let squares = at_alarm.iter().map(|run| (run.set as f64 - mean).powi(2));
    let sigma = squares.sum::<f64>().sqrt() / at_alarm.len().max(1) as f64;
    if small && mean > MOST_EFFECTS && mean < MOST_EFFECTS + 3.0 * sigma {
        sizes = sizes.judged(Judgement::TooFew);
    }
    figures.push(sizes.over(at_alarm.len(), seeds));
    figures
}

/// Median delay over that of the e-process with this effect alone; runs without an alarm come last.
fn delay_figure(name: &str, runs: &[Delay], small: bool) -> Figure {
    let median = |of: fn(&Delay) -> Option<f64>| {
        let mut days: Vec<f64> = runs
            .iter()
            .map(|run| of(run).unwrap_or(f64::INFINITY))
            .collect();
        days.sort_by(f64::total_cmp);
        days.get(days.len() / 2).copied().unwrap_or(f64::INFINITY)
    };
    let (days, alone) = (median(|run| run.days), median(|run| run.alone_days));
    let name = format!("median delay over the one of this effect alone: {name}");
    let told = |days: f64| match days {
        days if days.is_finite() => format!("{days:.2} days"),
        _ => format!("not in {DAYS} days"),
    };
    if small || !alone.is_finite() {
        return Figure::note(&name, format!("{}, alone {}", told(days), told(alone)));
    }
    Figure {
        measured: format!(
            "{:.2} ({}, alone {})",
            days / alone,
            told(days),
            told(alone)
        ),
        ..Figure::within(&name, [0.0, 1.4], days / alone)
    }
}

/// Runs of one platform with each trial, `lanes` of each, for at most `days` from the onset. `walk` is
/// declared and there, deg/h/√h.
fn delays(
    number: u64,
    trials: &[Trial],
    lanes: usize,
    days: usize,
    walk: f64,
) -> Result<Vec<Vec<Delay>>, ControllerError> {
    let onset = onset(number);
    let effects: Vec<Injected> = trials.iter().map(|trial| trial.effect).collect();
    let units = units(DELAYS, number, &effects, walk)?;
    let mut all = Vec::new();
    for (trial, unit) in trials.iter().zip(&units) {
        let size = trial.sigmas_a_day / unit.sqrt();
        let mut effects = EFFECTS_BY_DEFAULT.iter();
        let index = effects.position(|effect| effect.id == trial.id);
        let index = index.unwrap_or(usize::MAX);
        for _ in 0..lanes {
            let lane = Lane::noisy([DELAYS, number], all.len(), Noise::Declared, walk);
            let mut lane = lane.with(trial.effect, size, onset);
            lane.alone = Some((index, None));
            all.push(lane);
        }
    }
    let platform = Platform::new(DELAYS, number, onset + days * DAY, walk)?;
    platform.run(&mut all, |_, lanes| {
        lanes.iter().all(|lane| {
            lane.alarm.is_some() && lane.alone.is_some_and(|(_, alarm)| alarm.is_some())
        })
    })?;
    let since = |row: usize| (row as f64 - onset as f64) / DAY as f64;
    let of_lane = |lane: &Lane| {
        let (index, alone) = lane.alone.unwrap_or((usize::MAX, None));
        Delay {
            days: lane.alarm.map(|(row, _)| since(row)),
            alone_days: alone.map(since),
            held: lane.set.contains(&index),
            set: lane.set.len(),
        }
    };
    let of_trial = |lanes: &[Lane]| lanes.iter().map(of_lane).collect();
    Ok(all.chunks(lanes.max(1)).map(of_trial).collect())
}

/// The step at which the effects of a platform begin.
fn onset(number: u64) -> usize {
    SETTLED + (number as usize * 37) % 120
}

/// Information that a platform shows on a unit of each effect in its first day.
fn units(
    population: u64,
    number: u64,
    effects: &[Injected],
    walk: f64,
) -> Result<Vec<f64>, ControllerError> {
    let onset = onset(number);
    let lanes = effects.iter();
    let lanes = lanes.map(|effect| Lane::silent().with(*effect, 1.0, onset));
    let mut lanes: Vec<Lane> = lanes.collect();
    Platform::new(population, number, onset + DAY + 1, walk)?.run(&mut lanes, |_, _| false)?;
    Ok(lanes.iter().map(|lane| lane.information[1]).collect())
}
