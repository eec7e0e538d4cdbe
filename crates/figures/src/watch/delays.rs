//! Delays beside the watch of one effect alone, and the sets at the alarms; and jumps of the attitude.

use gyrocal::watch::{EFFECTS_BY_DEFAULT, Grid};
use gyrocal::{FilterSettings, Site};
use gyrocal_evaluation::Statistic;
use gyrocal_statistics::Proportion;
use serde::{Deserialize, Serialize};

use super::lane::{Effect, Lane};
use super::noise::Noise;
use super::platform::{Platform, information};
use super::{DAY, lanes, platforms};
use crate::error::Error;
use crate::figure::Figure;
use crate::harness::{Context, Row};

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
/// Roots of the information in the first day; the small version has the last.
const SIZES: [f64; 3] = [2.0, 4.0, 8.0];
/// Walks that are declared and there, deg/h/√h.
const WALKS: [f64; 2] = [0.0, 1e-5];

/// Size of a knock as the root of its whole information, steps within which 95 % are found, and largest median.
const JUMPS: [(f64, usize, Option<f64>); 2] = [(10.0, 96, Some(12.0)), (12.0, 15, None)];

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

/// Runs of a platform, by walk, effect and size.
type Runs = Vec<Vec<Delay>>;

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let mut figures = of_information(context)?;
    let small = context.is_small();
    let lanes = lanes(context);
    let (sizes, days) = if small {
        (&SIZES[2..], FEW_DAYS)
    } else {
        (&SIZES[..], DAYS)
    };
    let population = platforms("delays", [40, 2], |number| {
        delays(number, sizes, lanes, days)
    });
    let mut names = Vec::new();
    for walk in WALKS {
        for (kind, ..) in EFFECTS {
            names.extend(
                sizes
                    .iter()
                    .map(|size| format!("{kind} of {size} sigma a day, walk {walk:.0e}")),
            );
        }
    }
    let ratios = names.iter().enumerate().map(|(place, name)| {
        let name = format!("median delay over the one of this effect alone: {name}");
        Row::new(name, move |all: &[Runs]| {
            Statistic::Median(over_alone(all, place))
        })
        .at_most(1.4, SHARED)
        .told(move |all| told(all, place))
    });
    let rows: Vec<Row<'_, Runs>> = ratios.chain(of_sets(&names)).collect();
    figures.extend(context.measure(&population, &rows)?);
    figures.extend(of_jumps(context)?);
    Ok(figures)
}

/// Information of a day on sizes of effects over what the watch takes for it.
fn of_information(context: &Context) -> Result<Vec<Figure>, Error> {
    let effects = EFFECTS.map(|(_, effect, _)| effect);
    let population = platforms("information", [24, 6], |number| {
        information([TUNED_ON, number], &effects, onset(number), 1e-5)
    });
    let settings = FilterSettings::<f64>::at_site(Site::at_latitude_deg(0.0));
    let rows = core::array::from_fn::<_, 4, _>(|place| {
        let (kind, _, id) = EFFECTS[place];
        let taken = EFFECTS_BY_DEFAULT[index(id)].information_of_a_day(&settings);
        let name = format!("{kind}: information of a day over the constant of the watch, median");
        Row::median(name, move |all: &Vec<f64>| Some(all.get(place)? / taken))
            .between([0.5, 2.0], "a factor of two costs a tenth of the delay")
    });
    context.measure(&population, &rows)
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

/// Runs of one platform with each effect of each size, for at most `days` from the onset.
fn delays(number: u64, sizes: &[f64], lanes: usize, days: usize) -> Result<Runs, Error> {
    let (platform, onset) = ([DELAYS, number], onset(number));
    let mut runs = Vec::new();
    for walk in WALKS {
        let effects = EFFECTS.map(|(_, effect, _)| effect);
        let units = information(platform, &effects, onset, walk)?;
        let mut all: Vec<Lane> = Vec::new();
        for ((_, effect, id), unit) in EFFECTS.iter().zip(&units) {
            for size in sizes.iter().map(|sigmas| sigmas / unit.sqrt()) {
                let first = all.len();
                all.extend((first..first + lanes).map(|stream| {
                    let lane = Lane::noisy(platform, stream, Noise::Declared, walk);
                    lane.with(*effect, size, onset).beside(index(id))
                }));
            }
        }
        Platform::new(platform, onset + days * DAY, walk)?.run(&mut all)?;
        let ids = EFFECTS
            .iter()
            .flat_map(|(_, _, id)| sizes.iter().map(|_| index(id)));
        let cells = all.chunks(lanes).zip(ids);
        runs.extend(cells.map(|(lanes, index)| {
            let delay = |lane: &Lane| Delay::of(lane, onset, index);
            lanes.iter().map(delay).collect()
        }));
    }
    Ok(runs)
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

/// Runs of one walk, effect and size.
fn cell(all: &[Runs], place: usize) -> impl Iterator<Item = &Delay> {
    all.iter().filter_map(move |runs| runs.get(place)).flatten()
}

/// Those with an alarm after the onset.
fn found(all: &[Runs], place: usize) -> impl Iterator<Item = &Delay> {
    cell(all, place).filter(|run| run.days > Some(0.0))
}

/// Delay over that of the effect alone, run by run; a run without an alarm is counted to the last day.
fn over_alone(all: &[Runs], place: usize) -> Vec<f64> {
    let ratio = |run: &Delay| {
        let alone = run.alone_days.filter(|days| *days > 0.0)?;
        Some(run.days.unwrap_or(DAYS as f64) / alone)
    };
    cell(all, place).filter_map(ratio).collect()
}

/// Median delays; runs without an alarm come last.
fn told(all: &[Runs], place: usize) -> String {
    let median = |of: fn(&Delay) -> Option<f64>| {
        let mut days: Vec<f64> = cell(all, place)
            .map(|run| of(run).unwrap_or(f64::INFINITY))
            .collect();
        days.sort_by(f64::total_cmp);
        match days.get(days.len() / 2) {
            Some(days) if days.is_finite() => format!("{days:.2} days"),
            _ => "not in the time".to_owned(),
        }
    };
    format!(
        "{}, alone {}",
        median(|run| run.days),
        median(|run| run.alone_days)
    )
}

/// The sets at all alarms, and those of the effect and size that they hold most rarely.
fn of_sets(names: &[String]) -> [Row<'_, Runs>; 3] {
    const REASON: &str = "sets of 95 %";
    let count = names.len();
    let held = |all: &[Runs], place| Proportion::of(found(all, place).map(|run| run.held));
    let shares = move |all: &[Runs]| {
        let places = (0..count).filter(|place| {
            found(all, *place).count() as f64 >= ALARMED * cell(all, *place).count() as f64
        });
        places
            .map(|place| (place, held(all, place)))
            .collect::<Vec<_>>()
    };
    let least = move |all: &[Runs]| {
        let shares = shares(all);
        let least = shares
            .iter()
            .min_by(|one, other| one.1.share().total_cmp(&other.1.share()));
        least.map_or_else(String::new, |(place, _)| names[*place].clone())
    };
    let at_alarm = move |all: &[Runs], of: fn(&Delay) -> f64| {
        let runs = (0..count).flat_map(|place| found(all, place));
        runs.map(of).collect::<Vec<f64>>()
    };
    let every = move |all: &[Runs]| {
        let held = at_alarm(all, |run| f64::from(u8::from(run.held)));
        Statistic::Share(Proportion::of(held.into_iter().map(|held| held > 0.0)))
    };
    [
        Row::new("set at the alarm holds the truth", every).at_least(0.95, REASON),
        Row::new(
            "the same of the effect and size with the least share",
            move |all: &[Runs]| {
                Statistic::Least(shares(all).into_iter().map(|(_, share)| share).collect())
            },
        )
        .at_least(0.95, REASON)
        .told(least),
        Row::new("effects in the set, mean", move |all: &[Runs]| {
            Statistic::Mean(at_alarm(all, |run| run.set as f64))
        })
        .at_most(
            3.0,
            "a step, a ramp and a cross-axis term of one gyro are alike for some hours",
        ),
    ]
}

fn of_jumps(context: &Context) -> Result<Vec<Figure>, Error> {
    let lanes = lanes(context);
    let mut figures = Vec::new();
    for (z, within, median) in JUMPS {
        let job = |number| knocks(number, z, lanes);
        let population = platforms(&format!("jumps {z}"), [40, 2], job);
        let name = |what: String| format!("attitude jumps of z = {z}: {what}");
        let found = move |steps: &Vec<Option<usize>>| {
            let all = steps
                .iter()
                .map(|own| own.is_some_and(|steps| steps <= within));
            all.collect::<Vec<_>>()
        };
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
                .at_most(limit, "three onsets of jumps")
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
    let unit = information(platform, &[effect], onset, walk)?;
    let size = z / unit.iter().sum::<f64>().sqrt();
    let lane = |stream| Lane::noisy(platform, stream, Noise::Declared, walk);
    let lanes = (0..lanes).map(|stream| lane(stream).with(effect, size, onset));
    let mut all: Vec<Lane> = lanes.collect();
    Platform::new(platform, onset + KNOCK_STEPS, walk)?.run(&mut all)?;
    let steps = |lane: &Lane| match lane.alarms() {
        (Some(alarm), _) if alarm.grid == Grid::Jumps && alarm.row > onset => {
            Some(alarm.row - onset)
        }
        _ => None,
    };
    Ok(all.iter().map(steps).collect())
}
