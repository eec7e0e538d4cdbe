//! Platforms without an effect: false alarms, and alarms of walks that are not declared.

use gyrocal::ControllerError;
use gyrocal::watch::EFFECTS_BY_DEFAULT;
use gyrocal_statistics::Proportion;
use serde::{Deserialize, Serialize};

use super::lane::Lane;
use super::noise::Noise;
use super::platform::Platform;
use super::{DAY, LANES};
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use crate::truth::Extent;

/// Populations that no constant was tuned on.
const SOUND: u64 = 20_261_231;
const WALKS: u64 = 20_261_235;

/// Realisations where the noise is not as declared.
const OTHER_LANES: usize = 10;

/// Steps that an onset of jumps lives.
const JUMP_LIFE: usize = 48;
/// Days of a year.
const YEAR_DAYS: f64 = 365.25;

/// Alarms among platforms without an effect.
#[derive(Serialize, Deserialize)]
struct Sound {
    /// Platforms, each over the same time.
    platforms: usize,
    /// Sizes of the outliers of gyros, sigma, that alarms followed within the life of a jump's onset;
    /// one for each such alarm.
    outliers: Vec<f64>,
    /// Days until each alarm, and whether its set holds a random walk of a gyro.
    days: Vec<f64>,
    walks: Vec<bool>,
}

/// A noise of clean platforms: words, the true one, realisations of each platform, largest share of
/// alarms.
type Row = (&'static str, Noise, usize, f64);

/// Platforms without an effect, by the walk that is declared and there.
pub(super) fn false_alarms(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let (lanes, others, years) = if small {
        (4, 4, 0.1)
    } else {
        (LANES, OTHER_LANES, 1.0)
    };
    let declared: Row = ("as declared", Noise::Declared, lanes, 0.02);
    let row = |name, noise| (name, noise, others, 0.03);
    let misdeclared = [
        row("10 % larger", Noise::Larger(1.1)),
        row("10 % smaller", Noise::Larger(0.9)),
        row("AR(1) 0.1", Noise::Correlated(0.1)),
        row("Student t, 4 degrees, of accelerometers", Noise::Student4),
    ];
    let mut figures = Vec::new();
    for (walk, rows) in [
        (0.0, &[declared][..]),
        (1e-5, &[declared]),
        (1e-4, &[declared]),
        (1e-5, &misdeclared),
    ] {
        for row in rows {
            let (share, _, seeds) = clean(extent, walk, row, years)?;
            let (noise, _, _, limit) = *row;
            let bound = share.upper_bound(0.95);
            let name = format!(
                "alarms in a clean platform-year at 1 % a year, walk {walk:.0e}, noise {noise}"
            );
            let mut figure = Figure::within(&name, [0.0, limit], bound).of_share(share);
            figure.target = format!("<= {limit} (upper 95 % bound)");
            figure.measured = format!("{:.4}, bound {bound:.4}", share.share());
            if small {
                figure = figure.judged(share.at_most(limit));
            }
            figures.push(figure.over(share.trials as usize, seeds));
        }
    }
    // Outliers of gyros turn the platform: alarms are true.
    let row = row("Student t, 4 degrees, of all sensors", Noise::Student4Both);
    let (share, outliers, seeds) = clean(extent, 1e-5, &row, years)?;
    let name = format!("alarms in a platform-year, walk 1e-5, noise {}", row.0);
    let measured = format!("{:.4}", share.share());
    figures.push(Figure::note(&name, measured).over(share.trials as usize, seeds.as_str()));
    let turned = Proportion {
        hits: outliers.len() as u64,
        trials: share.hits,
    };
    let name = "of these alarms: a gyro was 30 sigma off, which turned the platform, in the 48 steps before";
    let figure = if turned.trials == 0 {
        Figure::note(name, "no alarm".to_owned())
    } else {
        Figure::within(name, [0.9, f64::INFINITY], turned.share()).of_share(turned)
    };
    figures.push(figure.over(turned.trials as usize, seeds));
    Ok(figures)
}

/// Walks that are not declared, or half: the time to an alarm whose set holds the walk.
pub(super) fn undeclared_walks(extent: Extent) -> Result<Vec<Figure>, Error> {
    let lanes = if extent.small { 4 } else { OTHER_LANES };
    let years = if extent.small { 0.1 } else { 1.0 };
    let mut figures = Vec::new();
    for (declared, walk) in [(0.0, 1e-5), (0.0, 1e-4), (5e-6, 1e-5), (5e-5, 1e-4)] {
        let seeds = 0..extent.records(40, 2);
        let cell = format!("undeclared {declared:e} {walk:e}");
        let campaign = resumable::campaign("watch", &cell, seeds.clone(), extent.small)?;
        let noise = (Noise::Declared, walk);
        let job = |number| sound(WALKS, number, years, declared, noise, lanes);
        let outcome = campaign.run(job, |_| ())?;
        let all: Vec<&Sound> = outcome.successes().map(|(_, sound)| sound).collect();
        let platforms: usize = all.iter().map(|sound| sound.platforms).sum();
        let alarms: usize = all.iter().map(|sound| sound.days.len()).sum();
        let mut days: Vec<f64> = all
            .iter()
            .flat_map(|sound| sound.days.iter().zip(&sound.walks))
            .filter_map(|(days, walks)| walks.then_some(*days))
            .collect();
        days.sort_by(f64::total_cmp);
        let median = days.get(platforms / 2).map_or_else(
            || "no median within the time".to_owned(),
            |days| format!("median {days:.1} days"),
        );
        let name = format!(
            "walk {walk:.0e}, declared {declared:.0e}: delay to an alarm whose set holds a walk"
        );
        let measured = format!(
            "{median}; {} of {platforms} within {years} years, {} other alarms",
            days.len(),
            alarms - days.len()
        );
        let seeds = format!("{WALKS}, {seeds:?}");
        figures.push(Figure::note(&name, measured).over(platforms, seeds));
    }
    Ok(figures)
}

/// Clean platforms with one noise: those with an alarm, outliers that alarms followed, and seeds.
fn clean(
    extent: Extent,
    walk: f64,
    row: &Row,
    years: f64,
) -> Result<(Proportion, Vec<f64>, String), Error> {
    let (name, noise, lanes, _) = *row;
    let seeds = 0..extent.records(40, 2);
    let cell = format!("sound {walk:e} {name}");
    let campaign = resumable::campaign("watch", &cell, seeds.clone(), extent.small)?;
    let job = |number| sound(SOUND, number, years, walk, (noise, walk), lanes);
    let outcome = campaign.run(job, |_| ())?;
    let all = || outcome.successes().map(|(_, sound): (_, &Sound)| sound);
    let share = Proportion {
        hits: all().map(|sound| sound.days.len() as u64).sum(),
        trials: all().map(|sound| sound.platforms as u64).sum(),
    };
    let outliers = all().flat_map(|sound| sound.outliers.clone()).collect();
    Ok((share, outliers, format!("{SOUND}, {seeds:?}")))
}

/// `lanes` platforms of one number of the population over `years`; `declared` is the walk that filter and
/// watch expect, and the noise comes with the walk that there is, deg/h/√h.
fn sound(
    population: u64,
    number: u64,
    years: f64,
    declared: f64,
    (noise, walk): (Noise, f64),
    lanes: usize,
) -> Result<Sound, ControllerError> {
    let steps = (years * YEAR_DAYS * DAY as f64) as usize;
    let mut all: Vec<Lane> = (0..lanes)
        .map(|stream| Lane::noisy([population, number], stream, noise, walk))
        .collect();
    Platform::new(population, number, steps, declared)?.run(&mut all, |_, lanes| {
        lanes.iter().all(|lane| lane.alarm.is_some())
    })?;
    let alarmed = all.iter().filter(|lane| lane.alarm.is_some());
    let days = all.iter().filter_map(|lane| lane.alarm);
    Ok(Sound {
        platforms: lanes,
        outliers: all.iter().filter_map(followed).collect(),
        days: days.map(|(row, _)| row as f64 / DAY as f64).collect(),
        walks: alarmed.map(may_walk).collect(),
    })
}

/// The outlier of a gyro that an alarm followed, sigma.
fn followed(lane: &Lane) -> Option<f64> {
    let ((alarm, _), (row, size)) = (lane.alarm?, lane.outlier?);
    (row <= alarm && alarm - row <= JUMP_LIFE).then_some(size)
}

/// Whether the alarm may be one of a walk that is larger than declared.
fn may_walk(lane: &Lane) -> bool {
    let mut effects = lane
        .set
        .iter()
        .filter_map(|index| EFFECTS_BY_DEFAULT.get(*index));
    effects.any(|effect| effect.walking_gyro().is_some())
}
