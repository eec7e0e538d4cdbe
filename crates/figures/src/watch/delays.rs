//! Delays beside the watch of one effect alone, and the sets at the alarms; and jumps of the attitude.

use std::sync::Arc;

use gyrocal::watch::{EFFECTS_BY_DEFAULT, Grid};
use gyrocal::{FilterSettings, Site};
use gyrocal_evaluation::{Statistic, Target};
use gyrocal_statistics::Proportion;
use serde::{Deserialize, Serialize};

use super::lane::{Effect, Lane};
use super::noise::Noise;
use super::platform::{Platform, information};
use super::{DAY, LANES, lanes, platforms};
use crate::harness::{Context, Error, Figure, Records, Row};

/// Populations that no constant was tuned on, and the one that constants of the watch are tuned on.
const DELAYS: u64 = 20_261_232;
const KNOCKS: u64 = 20_261_233;
const TUNED_ON: u64 = 20_261_121;

/// Days before an effect begins, at least: a filter that has settled. And before a knock.
const SETTLED: usize = 10;
const SETTLED_FOR_KNOCKS: usize = 5;
/// Days that an alarm is waited for, and in the small version; and steps after a knock.
const DAYS: usize = 30;
const FEW_DAYS: usize = 3;
const KNOCK_STEPS: usize = 240;
/// A cell with fewer alarms among its runs has no share of its own: they are those that noise helped.
const ALARMED: f64 = 0.5;

/// Effects on gyro or accelerometer x, and their ids.
const EFFECTS: [(&str, Effect, &str); 4] = [
    ("step", Effect::Step(0), "gyro_x.step"),
    ("ramp", Effect::Ramp(0), "gyro_x.ramp"),
    ("cross-axis term", Effect::Cross(0, 1), "gyro_x.g_y"),
    ("bias", Effect::Bias(0), "accel_x.bias"),
];
/// Roots of the information in the first day, with platforms of the small version.
const SIZES: [(f64, u64); 3] = [(2.0, 0), (4.0, 0), (8.0, 2)];
/// Walks that are declared and there, deg/h/√h.
const WALKS: [f64; 2] = [0.0, 1e-5];

/// Size of a knock as the root of its whole information, steps within which 95 % are found, and largest median: four
/// spans, in the last of which the cells of the ones before are taken.
const JUMPS: [(f64, usize, Option<f64>); 2] = [(10.0, 96, Some(16.0)), (12.0, 19, None)];

/// Why a watch over all effects may be slower than one of an effect alone.
const SHARED: &str = "18 effects share the evidence: ln 18 beside the 14 nats that one alone needs is a fifth, the \
                      steps in which cells are taken another";

/// A run with an effect.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Delay {
    /// Days from the onset to the alarm; `None` if there was none. Negative: before the onset.
    days: Option<f64>,
    /// The same of the watch for that effect alone.
    alone_days: Option<f64>,
    /// Whether the set at the alarm holds the effect.
    held: bool,
    /// Effects in that set.
    set: usize,
}

/// Runs of one platform.
type Runs = Vec<Delay>;

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = of_information(context)?;
    let mut cells = Vec::new();
    for walk in WALKS {
        for (kind, effect, id) in EFFECTS {
            for (size, small) in SIZES {
                let name = format!("{kind} of {size} sigma a day, walk {walk:.0e}");
                let trial = Trial {
                    cell: cells.len(),
                    walk,
                    effect,
                    index: index(id),
                    size,
                    lanes: lanes(context),
                    days: if context.is_small() { FEW_DAYS } else { DAYS },
                };
                let population = platforms(&name, [40, small], move |number| trial.runs(number));
                let ratio = format!("median delay over the one of this effect alone: {name}");
                let ratio = Row::new(ratio, over_alone).at_most(1.4, SHARED).told(told);
                figures.extend(context.measure(&population, &[ratio])?);
                cells.push((name, context.records(&population)?));
            }
        }
    }
    figures.extend(of_sets(&cells));
    figures.extend(of_jumps(context)?);
    Ok(figures)
}

/// Information of a day on sizes of effects over what the watch takes for it.
fn of_information(context: &Context) -> Result<Vec<Figure>, Error> {
    let settings = FilterSettings::<f64>::at_site(Site::at_latitude_deg(0.0));
    let mut figures = Vec::new();
    for (kind, effect, id) in EFFECTS {
        let name = format!("{kind}: information of a day over the constant of the watch, median");
        let population = platforms(&name, [24, 6], |number| {
            information([TUNED_ON, number], effect, onset(number), 1e-5)
        });
        let taken = EFFECTS_BY_DEFAULT[index(id)].information_of_a_day(&settings);
        let row = Row::median(name, |found: &f64| Some(found / taken));
        let row = row.between([0.5, 2.0], "a factor of two costs a tenth of the delay");
        figures.extend(context.measure(&population, &[row])?);
    }
    Ok(figures)
}

/// Index of an effect among those that are watched.
fn index(id: &str) -> usize {
    let place = EFFECTS_BY_DEFAULT.iter().position(|effect| effect.id == id);
    place.unwrap_or_default()
}

/// The step at which the effects of a platform begin.
fn onset(number: u64) -> usize {
    SETTLED * DAY + (number * 37 % 120) as usize
}

/// An effect of a size that begins on platforms with a declared walk.
#[derive(Clone, Copy, Debug)]
struct Trial {
    /// Its number; noise is drawn anew for each.
    cell: usize,
    walk: f64,
    effect: Effect,
    index: usize,
    /// Root of the information in the first day.
    size: f64,
    lanes: usize,
    /// Days that an alarm is waited for.
    days: usize,
}

impl Trial {
    fn runs(&self, number: u64) -> Result<Runs, Error> {
        let (platform, onset) = ([DELAYS, number], onset(number));
        let unit = information(platform, self.effect, onset, self.walk)?;
        let lane = |stream| {
            let stream = LANES * self.cell + stream;
            Lane::noisy(platform, stream, Noise::Declared, self.walk)
                .with(self.effect, self.size / unit.sqrt(), onset)
                .beside(self.index)
        };
        let mut lanes: Vec<Lane> = (0..self.lanes).map(lane).collect();
        Platform::new(platform, onset + self.days * DAY, self.walk)?.run(&mut lanes)?;
        let delay = |lane: &Lane| Delay::of(lane, onset, self.index);
        Ok(lanes.iter().map(delay).collect())
    }
}

impl Delay {
    fn of(lane: &Lane, onset: usize, index: usize) -> Self {
        let since = |row: usize| (row as f64 - onset as f64) / DAY as f64;
        let (alarm, alone) = lane.alarms();
        let set = alarm.map_or(&[][..], |alarm| &alarm.set);
        Self {
            days: alarm.map(|alarm| since(alarm.row)),
            alone_days: alone.map(since),
            held: set.contains(&index),
            set: set.len(),
        }
    }
}

/// Delay over that of the effect alone, run by run; a run without an alarm is counted to the last day.
fn over_alone(all: &[Runs]) -> Statistic {
    let ratio = |run: &Delay| {
        let alone = run.alone_days.filter(|days| *days > 0.0)?;
        Some(run.days.unwrap_or(DAYS as f64) / alone)
    };
    Statistic::Median(all.iter().flatten().filter_map(ratio).collect())
}

/// Median delays; runs without an alarm come last.
fn told(all: &[Runs]) -> String {
    let median = |of: fn(&Delay) -> Option<f64>| {
        let runs = all.iter().flatten();
        let mut days: Vec<f64> = runs.map(|run| of(run).unwrap_or(f64::INFINITY)).collect();
        days.sort_by(f64::total_cmp);
        match days.get(days.len() / 2) {
            Some(days) if days.is_finite() => format!("{days:.2} days"),
            _ => "not in the time".to_owned(),
        }
    };
    let [days, alone] = [median(|run| run.days), median(|run| run.alone_days)];
    format!("{days}, alone {alone}")
}

/// The sets at all alarms, and those of the effect and size that they hold most rarely.
fn of_sets(cells: &[(String, Arc<Records<Runs>>)]) -> [Figure; 3] {
    let (mut sizes, mut all, mut of_cells) = (Vec::new(), Vec::new(), Vec::new());
    for (name, records) in cells {
        let runs: Vec<&Delay> = records.records.iter().flatten().collect();
        let found = runs.iter().filter(|run| run.days > Some(0.0));
        let held: Vec<bool> = found.clone().map(|run| run.held).collect();
        sizes.extend(found.map(|run| run.set as f64));
        if !held.is_empty() && held.len() as f64 >= ALARMED * runs.len() as f64 {
            of_cells.push((Proportion::of(held.iter().copied()), name));
        }
        all.extend(held);
    }
    let cells_by_share = of_cells.iter();
    let least = cells_by_share.min_by(|(one, _), (other, _)| one.share().total_cmp(&other.share()));
    let least = least.map_or("", |(_, name)| name.as_str());
    let of_cells = of_cells.iter().map(|(share, _)| *share).collect();
    let full = cells.iter().all(|(_, records)| records.full);
    let figure = |name: &str, statistic: Statistic, target: Target, reason: &str| Figure {
        reason: reason.to_owned(),
        ..Figure::of_statistic(name, &statistic, Some(target), full)
    };
    let of_share = |name: &str, statistic: Statistic| {
        figure(name, statistic, Target::AtLeast(0.95), "sets of 95 %")
    };
    let rarest = "the same of the effect and size with the least share";
    let mut rarest = of_share(rarest, Statistic::Least(of_cells));
    rarest.measured += &format!("; {least}");
    let (share, mean) = (
        Statistic::Share(Proportion::of(all)),
        Statistic::Mean(sizes),
    );
    let alike = "a step, a ramp and a cross-axis term of one gyro are alike for some hours";
    [
        of_share("set at the alarm holds the truth", share),
        rarest,
        figure("effects in the set, mean", mean, Target::AtMost(3.0), alike),
    ]
}

fn of_jumps(context: &Context) -> Result<Vec<Figure>, Error> {
    let lanes = lanes(context);
    let mut figures = Vec::new();
    for (z, within, median) in JUMPS {
        let job = |number| knocks(number, z, lanes);
        let population = platforms(&format!("jumps {z}"), [40, 2], job);
        let name = |what: String| format!("attitude jumps of z = {z}: {what}");
        let is_found = move |own: &Option<usize>| own.is_some_and(|steps| steps <= within);
        let found = move |all: &Vec<_>| all.iter().map(is_found).collect::<Vec<_>>();
        let steps = |all: &[Vec<Option<usize>>]| {
            let all = all.iter().flatten();
            Statistic::Median(all.map(|own| own.unwrap_or(KNOCK_STEPS) as f64).collect())
        };
        let mut rows = vec![
            Row::each(name(format!("found within {within} steps")), found)
                .at_least(0.95, "one of twenty may come with noise against it"),
        ];
        rows.extend(median.map(|limit| {
            Row::new(name("median steps to the alarm".to_owned()), steps)
                .at_most(limit, "three spans, and one in which the cells are taken")
        }));
        figures.extend(context.measure(&population, &rows)?);
    }
    Ok(figures)
}

/// Steps from a knock to an alarm of the jumps, of `lanes` platforms of one number whose knock has the
/// root `z` of its whole information.
fn knocks(number: u64, z: f64, lanes: usize) -> Result<Vec<Option<usize>>, Error> {
    let onset = SETTLED_FOR_KNOCKS * DAY + (number * 17 % 120) as usize;
    let (platform, walk) = ([KNOCKS, number], 1e-5);
    let effect = Effect::Knock((number % 3) as usize);
    let size = z / information(platform, effect, onset, walk)?.sqrt();
    let lane = |stream| Lane::noisy(platform, stream, Noise::Declared, walk);
    let lanes = (0..lanes).map(|stream| lane(stream).with(effect, size, onset));
    let mut all: Vec<Lane> = lanes.collect();
    Platform::new(platform, onset + KNOCK_STEPS, walk)?.run(&mut all)?;
    let steps = |lane: &Lane| {
        let alarm = lane.alarms().0.filter(|alarm| alarm.grid == Grid::Jumps)?;
        alarm.row.checked_sub(onset).filter(|steps| *steps > 0)
    };
    Ok(all.iter().map(steps).collect())
}
