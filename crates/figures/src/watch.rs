//! The watch: false alarms in platform-years, delays beside the e-process of one effect, jumps, sets.

use gyrocal_statistics::Proportion;
use gyrocal_watch_trials::{Delay, Injected, Knocked, Noise, Sound, Trial, delays, knocks, sound};

use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;

/// Populations that no constant was tuned on.
const SOUND: u64 = 20_261_131;
const DELAYS: u64 = 20_261_132;
const KNOCKS: u64 = 20_261_133;
/// Realisations of the noise of each platform.
const LANES: usize = 25;

/// All figures. The small version has a few platforms over weeks.
pub(crate) fn figures(small: bool) -> Result<Vec<Figure>, Error> {
    let mut figures = false_alarms(small)?;
    figures.extend(of_delays(small)?);
    figures.extend(of_jumps(small)?);
    Ok(figures)
}

/// Platforms without an effect, by the walk that is declared.
fn false_alarms(small: bool) -> Result<Vec<Figure>, Error> {
    let (platforms, lanes, years) = if small { (2, 4, 0.1) } else { (40, LANES, 1.0) };
    let mut figures = Vec::new();
    for walk in [0.0, 1e-5, 1e-4] {
        let mut noises = vec![("as declared", Noise::Declared, walk, 0.02)];
        if walk == 1e-5 {
            noises.extend([
                ("10 % larger", Noise::Larger(1.1), walk, 0.03),
                ("10 % smaller", Noise::Larger(0.9), walk, 0.03),
                ("AR(1) 0.1", Noise::Correlated(0.1), walk, 0.03),
                (
                    "Student t, 4 degrees, of accelerometers",
                    Noise::Student4,
                    walk,
                    0.03,
                ),
            ]);
        }
        let list: Vec<(Noise, f64)> = noises.iter().map(|row| (row.1, row.2)).collect();
        let seeds = 0..platforms;
        let cell = format!("sound {walk:e}");
        let campaign = resumable::campaign("watch", &cell, seeds.clone(), small)?;
        let job = |number| sound(SOUND, number, years, walk, &list, lanes);
        let outcome = campaign.run(job, |_| ())?;
        for (place, (name, _, _, limit)) in noises.iter().enumerate() {
            let of_noise = || {
                let runs = outcome.successes();
                runs.filter_map(|(_, all): (_, &Vec<Sound>)| all.get(place))
            };
            let share = Proportion {
                hits: of_noise().map(|sound| sound.alarms as u64).sum(),
                trials: of_noise().map(|sound| sound.platforms as u64).sum(),
            };
            let bound = share.upper_bound(0.95);
            let name = format!(
                "alarms in a clean platform-year at 1 % a year, walk {walk:.0e}, noise {name}"
            );
            let mut figure = Figure::within(&name, [0.0, *limit], bound).of_share(share);
            figure.target = format!("<= {limit} (upper 95 % bound)");
            figure.measured = format!("{:.4}, bound {bound:.4}", share.share());
            if small {
                figure = figure.judged(share.at_most(*limit));
            }
            figures.push(figure.over(share.trials as usize, format!("{SOUND}, {seeds:?}")));
        }
    }
    Ok(figures)
}

/// Effects on gyro or accelerometer x, and their ids.
const EFFECTS: [(&str, Injected, &str); 4] = [
    ("step", Injected::Step(0), "gyro_x.step"),
    ("ramp", Injected::Ramp(0), "gyro_x.ramp"),
    ("cross-axis term", Injected::Cross(0, 1), "gyro_x.g_y"),
    ("bias", Injected::Bias(0), "accel_x.bias"),
];
const SIZES: [f64; 3] = [2.0, 4.0, 8.0];

fn of_delays(small: bool) -> Result<Vec<Figure>, Error> {
    let (platforms, lanes, days) = if small { (2, 3, 3) } else { (40, LANES, 30) };
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
    for walk in [0.0, 1e-5] {
        let seeds = 0..platforms;
        let cell = format!("delays {walk:e}");
        let campaign = resumable::campaign("watch", &cell, seeds.clone(), small)?;
        let job = |number| delays(DELAYS, number, &trials, lanes, days, walk);
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
            figures.push(
                delay_figure(&name, &runs, small).over(runs.len(), format!("{DELAYS}, {seeds:?}")),
            );
            at_alarm.extend(runs.into_iter().filter(|run| run.days > Some(0.0)));
        }
    }
    let seeds = format!("{DELAYS}, all above");
    let held = Proportion::of(at_alarm.iter().map(|run| run.held));
    let mut figure = Figure::within(
        "set at the alarm holds the truth",
        [0.95, f64::INFINITY],
        held.share(),
    )
    .of_share(held);
    if small {
        figure = figure.judged(held.at_least(0.95));
    }
    figures.push(figure.over(at_alarm.len(), seeds.as_str()));
    let effects: usize = at_alarm.iter().map(|run| run.set).sum();
    let mean = effects as f64 / at_alarm.len().max(1) as f64;
    figures.push(
        Figure::within("effects in the set, mean", [1.0, 3.0], mean).over(at_alarm.len(), seeds),
    );
    Ok(figures)
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
        _ => "not in 30 days".to_owned(),
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

fn of_jumps(small: bool) -> Result<Vec<Figure>, Error> {
    let (platforms, lanes) = if small { (2, 5) } else { (40, LANES) };
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
