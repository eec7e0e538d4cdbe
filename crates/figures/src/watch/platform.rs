use gyrocal::watch::{EFFECTS_BY_DEFAULT, WatchSettings, WatchedEffect, WatchedFilter};
use gyrocal::{FilterSettings, InitialAttitude, Limits, Site};
use gyrocal_truth::Population;
use gyrocal_watch::Step;

use super::lane::{Effect, Lane};
use super::{COLUMNS, DAY, INTERVAL_S};
use crate::harness::Error;

/// A platform without noise, and the filter over it, whose gains are those of all its realisations.
pub(super) struct Platform {
    forces: Vec<[f64; 3]>,
    pub(super) filter: WatchedFilter<f64, 1, COLUMNS>,
    pub(super) settings: FilterSettings<f64>,
    pub(super) watch: WatchSettings<f64>,
}

static ONE_EFFECT: [WatchedEffect; 1] = [EFFECTS_BY_DEFAULT[0]];

impl Platform {
    /// The platform of a number in the usual population, over some steps of a minute, with a declared
    /// walk of its gyros.
    pub(super) fn new(
        [population, number]: [u64; 2],
        steps: usize,
        walk_deg_per_h_per_sqrt_h: f64,
    ) -> Result<Self, Error> {
        let scenario = Population::new(population).scenario(number);
        let truth = scenario.platform();
        let times: Vec<f64> = (0..=steps).map(|row| row as f64 * INTERVAL_S).collect();
        let settings = FilterSettings::at_site(Site::at_latitude_deg(scenario.latitude_deg));
        // Errors of its prior are those of the simulation: turns about the platform's axes.
        let platform_c_enu = truth.initial_platform_c_enu.matrix();
        let attitude = InitialAttitude::Orientation {
            north_and_up: [1, 2].map(|column| platform_c_enu.map(|row| row[column])),
            sigma_rad: [Lane::START_RAD; 3],
        };
        let watch = WatchSettings {
            walk_deg_per_h_per_sqrt_h: [walk_deg_per_h_per_sqrt_h; 3],
            ..WatchSettings::default()
        };
        let mut filter = WatchedFilter::unset(&ONE_EFFECT);
        filter.start(&settings, &attitude, Limits::default(), &watch)?;
        Ok(Self {
            forces: truth.specific_force_g(&times),
            filter,
            settings,
            watch,
        })
    }

    /// Runs lanes over the record until each is done.
    pub(super) fn run(mut self, lanes: &mut [Lane]) -> Result<(), Error> {
        self.filter.update(&self.forces[0])?;
        for lane in lanes.iter_mut() {
            lane.start(&self)?;
        }
        let block = (self.watch.block_s / INTERVAL_S) as usize;
        for row in 1..self.forces.len() {
            let [before, now] = [self.forces[row - 1], self.forces[row]];
            self.filter.step(INTERVAL_S, &now)?;
            let at = self.filter.linearised();
            let step = Step {
                transition: &at.transition,
                observed: Some(&at.observed),
                part: INTERVAL_S / self.watch.block_s,
            };
            let force = core::array::from_fn(|axis| 0.5 * (before[axis] + now[axis]));
            let mut all_done = true;
            for lane in lanes.iter_mut().filter(|lane| !lane.is_done()) {
                lane.step(row, &step, &at.observed, &force);
                if row.is_multiple_of(block) {
                    lane.end_block(&self);
                }
                all_done = false;
            }
            if all_done {
                break;
            }
        }
        Ok(())
    }
}

/// Information that a platform shows on a unit of an effect in the first day after its onset.
pub(super) fn information(
    platform: [u64; 2],
    effect: Effect,
    onset: usize,
    walk: f64,
) -> Result<f64, Error> {
    let mut lane = [Lane::silent().with(effect, 1.0, onset)];
    Platform::new(platform, onset + DAY, walk)?.run(&mut lane)?;
    Ok(lane[0].information)
}
