//! Jumps of the attitude.

use gyrocal::ControllerError;
use gyrocal::watch::Grid;
use gyrocal_statistics::Proportion;

use super::lane::{Injected, Lane};
use super::noise::Noise;
use super::platform::Platform;
use super::{DAY, LANES};
use crate::error::Error;
use crate::figure::Figure;
use crate::resumable;
use crate::truth::Extent;

/// A population that no constant was tuned on.
const KNOCKS: u64 = 20_261_233;

/// Steps before the knock, at least.
const SETTLED: usize = 5 * DAY;

pub(super) fn figures(extent: Extent) -> Result<Vec<Figure>, Error> {
    let small = extent.small;
    let (platforms, lanes) = (extent.records(40, 2), if small { 5 } else { LANES });
    let mut figures = Vec::new();
    for (z, within, share, median) in [(10.0, 96, 0.95, Some(12.0)), (12.0, 15, 0.95, None)] {
        let seeds = 0..platforms;
        let campaign = resumable::campaign("watch", &format!("jumps {z}"), seeds.clone(), small)?;
        let outcome = campaign.run(|number| knocks(number, z, lanes), |_| ())?;
        let steps = outcome
            .successes()
            .flat_map(|(_, runs): (_, &Vec<Option<usize>>)| runs);
        let mut steps: Vec<usize> = steps.map(|own| own.unwrap_or(usize::MAX)).collect();
        steps.sort_unstable();
        let seeds = format!("{KNOCKS}, {seeds:?}");
        let found = Proportion::of(steps.iter().map(|own| *own <= within));
        let name = format!("attitude jumps of z = {z}: found within {within} steps");
        let mut figure =
            Figure::within(&name, [share, f64::INFINITY], found.share()).of_share(found);
        if small {
            figure = figure.judged(found.at_least(share));
        }
        figures.push(figure.over(steps.len(), seeds.as_str()));
        if let Some(limit) = median {
            let middle = steps
                .get(steps.len() / 2)
                .map_or(f64::NAN, |steps| *steps as f64);
            let name = format!("attitude jumps of z = {z}: median steps to the alarm");
            figures.push(Figure::within(&name, [0.0, limit], middle).over(steps.len(), seeds));
        }
    }
    Ok(figures)
}

/// Steps from a knock to an alarm of the jumps, of `lanes` platforms of one number whose knock has the
/// root `z` of its whole information.
fn knocks(number: u64, z: f64, lanes: usize) -> Result<Vec<Option<usize>>, ControllerError> {
    let onset = SETTLED + (number as usize * 17) % 120;
    let (walk, effect) = (1e-5, Injected::Knock(number as usize % 3));
    let mut unit = [Lane::silent().with(effect, 1.0, onset)];
    Platform::new(KNOCKS, number, onset + DAY, walk)?.run(&mut unit, |_, _| false)?;
    let size = z / unit[0].information[0].sqrt();
    let mut all: Vec<Lane> = (0..lanes)
        .map(|stream| Lane::noisy([KNOCKS, number], stream, Noise::Declared, walk))
        .map(|lane| lane.with(effect, size, onset))
        .collect();
    Platform::new(KNOCKS, number, onset + 240, walk)?.run(&mut all, |_, _| false)?;
    let alarm = |lane: &Lane| match lane.alarm {
        Some((row, Grid::Jumps)) if row > onset => Some(row - onset),
        _ => None,
    };
    Ok(all.iter().map(alarm).collect())
}
