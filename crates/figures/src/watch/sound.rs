//! Platforms without an effect: false alarms, and alarms of walks that are not declared.

use gyrocal::watch::EFFECTS_BY_DEFAULT;
use gyrocal_evaluation::Statistic;
use gyrocal_statistics::Proportion;
use serde::{Deserialize, Serialize};

use super::lane::Lane;
use super::noise::Noise;
use super::platform::Platform;
use super::{DAY, LANES, lanes, platforms};
use crate::harness::{Context, Error, Figure, Population, Row};

/// Populations that no constant was tuned on.
const SOUND: u64 = 20_261_231;
const WALKS: u64 = 20_261_235;

/// Steps that an onset of jumps lives.
const JUMP_LIFE: usize = 48;
/// Days of a year, and the share of it that the small version takes.
const YEAR_DAYS: f64 = 365.25;
const SHORT: f64 = 0.05;

/// The walk that is declared and there, the true noise in words, largest share of alarms, and why.
const CLEAN: [(f64, Noise, &str, f64, &str); 7] = [
    (0.0, Noise::Declared, "as declared", 0.02, DECLARED),
    (1e-5, Noise::Declared, "as declared", 0.02, DECLARED),
    (1e-4, Noise::Declared, "as declared", 0.02, DECLARED),
    (1e-5, Noise::Larger(1.1), "10 % larger", 0.03, MISDECLARED),
    (1e-5, Noise::Larger(0.9), "10 % smaller", 0.03, MISDECLARED),
    (1e-5, Noise::Correlated(0.1), "AR(1) 0.1", 0.03, MISDECLARED),
    (
        1e-5,
        Noise::Student4,
        "Student t, 4 degrees, of accelerometers",
        0.03,
        MISDECLARED,
    ),
];
const DECLARED: &str = "the promise is 1 % a year: six of 600 are within the bound";
const MISDECLARED: &str = "the promise is of declared noise; here it may be missed by half: ten of 600 are within the bound";

/// Walks that are declared and that are there, deg/h/√h.
const UNDECLARED: [[f64; 2]; 4] = [[0.0, 1e-5], [0.0, 1e-4], [5e-6, 1e-5], [5e-5, 1e-4]];

/// One realisation of a platform over a year, until its alarm.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Year {
    /// Days until the alarm.
    days: Option<f64>,
    /// Whether the set at the alarm holds what a random walk of a gyro is.
    walks: bool,
    /// Whether it followed an outlier of a gyro within the life of a jump's onset.
    turned: bool,
}

/// Platforms of a population over a year; filter and watch expect the walk that is declared. Each cell of a
/// population, by its place, has noise of its own.
fn years(
    context: &Context,
    (cell, place): (&str, usize),
    [population, small]: [u64; 2],
    noise: Noise,
    [declared, walk]: [f64; 2],
) -> Population<'static, Vec<Year>> {
    let lanes = lanes(context);
    let years = if context.is_small() { SHORT } else { 1.0 };
    let steps = (years * YEAR_DAYS * DAY as f64) as usize;
    platforms(cell, [60, small], move |number| {
        let platform = [population, number];
        let of = |lane| Lane::noisy(platform, LANES * place + lane, noise, walk);
        let mut all: Vec<Lane> = (0..lanes).map(of).collect();
        Platform::new(platform, steps, declared)?.run(&mut all)?;
        Ok(all.iter().map(Year::of).collect())
    })
}

impl Year {
    fn of(lane: &Lane) -> Self {
        let (alarm, _) = lane.alarms();
        let is_walk = |index: &usize| {
            let effect = EFFECTS_BY_DEFAULT.get(*index);
            effect.is_some_and(|effect| effect.walking_gyro().is_some())
        };
        let after = alarm.zip(lane.outlier);
        Self {
            days: alarm.map(|alarm| alarm.row as f64 / DAY as f64),
            walks: alarm.is_some_and(|alarm| alarm.set.iter().any(is_walk)),
            turned: after.is_some_and(|(alarm, outlier)| alarm.row - outlier <= JUMP_LIFE),
        }
    }
}

type Years = Vec<Year>;

pub(super) fn figures(context: &Context) -> Result<Vec<Figure>, Error> {
    let alarms = |all: &[Years]| Proportion::of(all.iter().flatten().map(|one| one.days.is_some()));
    let mut figures = Vec::new();
    for (place, (walk, noise, words, limit, reason)) in CLEAN.into_iter().enumerate() {
        let cell = format!("sound {walk:e} {words}");
        let population = years(context, (&cell, place), [SOUND, 2], noise, [walk; 2]);
        let name = format!(
            "alarms in a clean platform-year at 1 % a year, walk {walk:.0e}, noise {words}"
        );
        let row = Row::new(name, |all: &[Years]| Statistic::Bound(alarms(all)));
        figures.extend(context.measure(&population, &[row.at_most(limit, reason)])?);
    }
    // Outliers of gyros turn the platform: alarms are true.
    let words = "Student t, 4 degrees, of all sensors";
    let cell = format!("sound 1e-5 {words}");
    let (place, noise) = ((&*cell, CLEAN.len()), Noise::Student4Both);
    let population = years(context, place, [SOUND, 0], noise, [1e-5; 2]);
    let turned = |all: &Years| {
        let alarmed = all.iter().filter(|one| one.days.is_some());
        alarmed.map(|one| one.turned).collect::<Vec<_>>()
    };
    let rows = [
        Row::new(format!("alarms in a platform-year, walk 1e-5, noise {words}"), |all: &[Years]| {
            Statistic::Share(alarms(all))
        }),
        Row::each(
            "of these alarms: a gyro was 30 sigma off, which turned the platform, in the 48 steps before",
            turned,
        )
        .at_least(0.9, "outliers of 20 to 30 sigma turn it too, and some by chance go together"),
    ];
    figures.extend(context.measure(&population, &rows)?);
    for (place, [declared, walk]) in UNDECLARED.into_iter().enumerate() {
        let cell = format!("undeclared {declared:e} {walk:e}");
        let (place, walks) = ((&*cell, place), [declared, walk]);
        let population = years(context, place, [WALKS, 0], Noise::Declared, walks);
        let name = format!(
            "walk {walk:.0e}, declared {declared:.0e}: delay to an alarm whose set holds a walk"
        );
        figures.extend(context.measure(&population, &[Row::words(name, told)])?);
    }
    Ok(figures)
}

/// Median delay to an alarm whose set holds a walk, and numbers of such alarms and of others.
fn told(all: &[Years]) -> String {
    let all: Vec<&Year> = all.iter().flatten().collect();
    let of_walks = all.iter().filter(|one| one.walks);
    let mut days: Vec<f64> = of_walks.filter_map(|one| one.days).collect();
    days.sort_by(f64::total_cmp);
    let median = match days.get(all.len() / 2) {
        Some(days) => format!("median {days:.1} days"),
        None => "no median within a year".to_owned(),
    };
    let alarms = all.iter().filter(|one| one.days.is_some()).count();
    let (told, others, all) = (days.len(), alarms - days.len(), all.len());
    format!("{median}; {told} of {all} within a year, {others} other alarms")
}
