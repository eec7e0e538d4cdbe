//! The watch: false alarms in platform-years, delays beside the e-process of one effect, jumps, sets, and
//! records of the nonlinear simulator.

mod delays;
mod nonlinear;

use gyrocal_statistics::Proportion;
use gyrocal_watch_trials::{Knocked, Noise, Sound, knocks, sound};

use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use crate::truth::Extent;

/// Populations that no constant was tuned on.
const SOUND: u64 = 20_261_231;
const KNOCKS: u64 = 20_261_233;
const WALKS: u64 = 20_261_235;
/// Realisations of the noise of each platform.
const LANES: usize = 25;

/// Realisations where the noise is not as declared.
const OTHER_LANES: usize = 10;

/// All figures. The small version has a few platforms over weeks.
pub(crate) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let mut figures = false_alarms(extent)?;
    figures.extend(undeclared_walks(extent)?);
    figures.extend(delays::figures(extent)?);
    figures.extend(of_jumps(extent)?);
    figures.extend(nonlinear::figures(extent)?);
    Ok(figures)
}

/// A noise of clean platforms: words, the true one, realisations of each platform, largest share of
/// alarms.
type Row = (&'static str, Noise, usize, f64);

/// Platforms without an effect, by the walk that is declared and there.
fn false_alarms(extent: Extent) -> Result<Vec<Figure>, Error> {
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
fn undeclared_walks(extent: Extent) -> Result<Vec<Figure>, Error> {
    let lanes = if extent.small { 4 } else { OTHER_LANES };
    let years = if extent.small { 0.1 } else { 1.0 };
    let mut figures = Vec::new();
    for (declared, walk) in [(0.0, 1e-5), (0.0, 1e-4), (5e-6, 1e-5), (5e-5, 1e-4)] {
        let seeds = 0..extent.records(40, 2);
        let cell = format!("undeclared {declared:e} {walk:e}");
        let campaign = resumable::campaign("watch", &cell, seeds.clone(), extent.small)?;
        let noises = [(Noise::Declared, walk)];
        let job = |number| sound(WALKS, number, years, declared, &noises, lanes);
        let outcome = campaign.run(job, |_| ())?;
        let all: Vec<&Sound> = outcome.successes().flat_map(|(_, all)| all).collect();
        let platforms: usize = all.iter().map(|sound| sound.platforms).sum();
        let alarms: usize = all.iter().map(|sound| sound.alarms).sum();
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
    let noises = [(noise, walk)];
    let job = |number| sound(SOUND, number, years, walk, &noises, lanes);
    let outcome = campaign.run(job, |_| ())?;
    let all = || {
        outcome
            .successes()
            .flat_map(|(_, all): (_, &Vec<Sound>)| all)
    };
    let share = Proportion {
        hits: all().map(|sound| sound.alarms as u64).sum(),
        trials: all().map(|sound| sound.platforms as u64).sum(),
    };
    let outliers = all().flat_map(|sound| sound.outliers.clone()).collect();
    Ok((share, outliers, format!("{SOUND}, {seeds:?}")))
}

fn of_jumps(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let (platforms, lanes) = (extent.records(40, 2), if small { 5 } else { LANES });
    let mut figures = Vec::new();
    for (z, within, share, median) in [(10.0, 96, 0.95, Some(12.0)), (12.0, 15, 0.95, None)] {
        let seeds = 0..platforms;
        let campaign = resumable::campaign("watch", &format!("jumps {z}"), seeds.clone(), small)?;
        let outcome = campaign.run(|number| knocks(KNOCKS, number, z, lanes), |_| ())?;
        let runs: Vec<Knocked> = outcome
            .successes()
            .flat_map(|(_, runs): (_, &Vec<Knocked>)| runs.clone())
            .collect();
        let seeds = format!("{KNOCKS}, {seeds:?}");
        let found = Proportion::of(
            runs.iter()
                .map(|run| run.steps.is_some_and(|n| n <= within)),
        );
        let name = format!("attitude jumps of z = {z}: found within {within} steps");
        let mut figure =
            Figure::within(&name, [share, f64::INFINITY], found.share()).of_share(found);
        if small {
            figure = figure.judged(found.at_least(share));
        }
        figures.push(figure.over(runs.len(), seeds.as_str()));
        if let Some(limit) = median {
            let mut steps: Vec<usize> = runs
                .iter()
                .map(|run| run.steps.unwrap_or(usize::MAX))
                .collect();
            steps.sort_unstable();
            let middle = steps
                .get(steps.len() / 2)
                .map_or(f64::NAN, |steps| *steps as f64);
            let name = format!("attitude jumps of z = {z}: median steps to the alarm");
            figures.push(Figure::within(&name, [0.0, limit], middle).over(runs.len(), seeds));
        }
    }
    Ok(figures)
}
