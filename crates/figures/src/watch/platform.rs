use gyrocal::watch::{
    Calendar, Courses, EFFECTS_BY_DEFAULT, Evidence, Grid, WatchSettings, WatchedEffect,
    WatchedFilter,
};
use gyrocal::{ControllerError, FilterSettings, InitialAttitude, Limits, Site};
use gyrocal_truth::Population;
use gyrocal_watch::{Jumps, Settings, Signatures, least_of_set};

use super::lane::Lane;
use super::{COLUMNS, EFFECTS, INTERVAL_S, JUMPS, ONSETS, STATES};

const HALF: usize = STATES * (STATES + 1) / 2;
const CALENDAR: Calendar = Calendar::of_slots(ONSETS);

/// A platform with its filter, and the signatures of its watch.
pub(super) struct Platform {
    forces: Vec<[f64; 3]>,
    filter: WatchedFilter<f64, 1, COLUMNS>,
    signatures: Signatures<f64, STATES, COLUMNS, EFFECTS, ONSETS, HALF>,
    jumps: Jumps<f64, 3, JUMPS>,
    settings: Settings<f64, EFFECTS, 3>,
    set_width: f64,
    block_s: f64,
}

static ONE_EFFECT: [WatchedEffect; 1] = [EFFECTS_BY_DEFAULT[0]];

impl Platform {
    /// The platform of a number in the usual population, over some steps of a minute, with a declared
    /// walk of its gyros.
    pub(super) fn new(
        population: u64,
        number: u64,
        steps: usize,
        walk_deg_per_h_per_sqrt_h: f64,
    ) -> Result<Self, ControllerError> {
        let scenario = Population::new(population).scenario(number);
        let truth = scenario.platform();
        let times: Vec<f64> = (0..=steps).map(|row| row as f64 * INTERVAL_S).collect();
        let forces = truth.specific_force_g(&times);
        let settings = FilterSettings::at_site(Site::at_latitude_deg(scenario.latitude_deg));
        // Errors of its prior are those of the simulation: turns about the platform's axes.
        let platform_c_enu = truth.initial_platform_c_enu.matrix();
        let attitude = InitialAttitude::Orientation {
            north_and_up: [1, 2].map(|column| platform_c_enu.map(|row| row[column])),
            sigma_rad: [0.01_f64.to_radians(); 3],
        };
        let watch = WatchSettings {
            walk_deg_per_h_per_sqrt_h: [walk_deg_per_h_per_sqrt_h; 3],
            ..WatchSettings::default()
        };
        let mut filter = WatchedFilter::unset(&ONE_EFFECT);
        filter.start(&settings, &attitude, Limits::default(), &watch)?;
        let entries = EFFECTS_BY_DEFAULT.map(|effect| effect.entry(COLUMNS));
        let information = EFFECTS_BY_DEFAULT.map(|effect| effect.information_of_a_day(&settings));
        Ok(Self {
            forces,
            filter,
            signatures: Signatures::new(gyrocal::watch::columns(), entries),
            jumps: Jumps::new(),
            settings: watch.of_test(information),
            set_width: watch.set_width,
            block_s: watch.block_s,
        })
    }

    fn courses(&self) -> Courses<f64, EFFECTS> {
        let filter = self.filter.filter();
        Courses::ahead(
            &EFFECTS_BY_DEFAULT,
            filter.kernel().inputs(),
            &filter.drift().to_array(),
            self.block_s,
        )
    }

    /// Runs all lanes over the record; `done` ends it early. Lanes keep their first alarm.
    pub(super) fn run(
        mut self,
        lanes: &mut [Lane],
        mut done: impl FnMut(usize, &[Lane]) -> bool,
    ) -> Result<(), ControllerError> {
        let mut prior = [1.0; STATES];
        prior[..3].fill(0.01_f64.to_radians());
        for lane in lanes.iter_mut() {
            lane.start(&prior);
        }
        self.filter.update(&self.forces[0])?;
        let first = *self.filter.linearised();
        for lane in lanes.iter_mut() {
            lane.correct(&first);
        }
        let courses = self.courses();
        self.signatures.reset();
        self.signatures.begin(&courses.0);
        self.jumps.reset();
        let mut block = 0;
        let mut span = 0;
        self.begin_onset(block, lanes);
        self.begin_jump(span, lanes);
        for row in 1..self.forces.len() {
            self.filter.step(INTERVAL_S, &self.forces[row])?;
            let at = *self.filter.linearised();
            let step = gyrocal_watch::Step {
                transition: &at.transition,
                observed: Some(&at.observed),
                part: INTERVAL_S / self.block_s,
            };
            let whitened = self.signatures.advance(&step);
            let shown = self.jumps.advance(&step);
            let force: [f64; 3] = core::array::from_fn(|axis| {
                0.5 * (self.forces[row - 1][axis] + self.forces[row][axis])
            });
            for lane in lanes.iter_mut() {
                let innovation = lane.step(row, &at, &force);
                lane.scores.add(&whitened, &innovation);
                lane.jump_scores.add(&shown, &innovation);
            }
            if row % self.settings.span_steps as usize == 0 {
                span += 1;
                self.end_span(row, span, lanes);
            }
            if row % self.settings.block_steps as usize == 0 {
                block += 1;
                self.end_block(row, block, lanes);
                if done(row, lanes) {
                    break;
                }
            }
        }
        Ok(())
    }

    fn begin_onset(&mut self, block: u32, lanes: &mut [Lane]) {
        let slot = CALENDAR.slot(block);
        self.signatures.restart(slot);
        for lane in lanes {
            lane.scores.restart(slot);
        }
    }

    fn begin_jump(&mut self, span: u32, lanes: &mut [Lane]) {
        let slot = span as usize % JUMPS;
        self.jumps.restart(slot);
        for lane in lanes {
            lane.jump_scores.restart(slot);
        }
    }

    fn end_span(&mut self, row: usize, span: u32, lanes: &mut [Lane]) {
        self.jumps.end_span();
        for lane in lanes.iter_mut() {
            lane.jump_scores.end_span();
            lane.sums[1] = 0.0;
        }
        self.begin_jump(span, lanes);
        let begun = (span as usize).min(JUMPS);
        for back in 1..begun {
            let slot = (span as usize - back) % JUMPS;
            self.jumps.update(slot, |jump, before| {
                for lane in lanes.iter_mut() {
                    lane.jump_scores.update(slot, jump, before);
                }
            });
            let Some(cell) = self.jumps.cell(slot) else {
                continue;
            };
            for lane in lanes.iter_mut() {
                let scores = lane
                    .jump_scores
                    .scores(slot)
                    .into_iter()
                    .zip(cell.information);
                for ((score, information), precision) in scores.zip(self.settings.jump_precision) {
                    lane.sums[1] += Evidence { precision }.value(score, information) / 3.0;
                }
            }
        }
        let threshold = self.settings.jump_budget.threshold(1.0);
        for lane in lanes.iter_mut() {
            if lane.alarm.is_none() && lane.sums[1] >= threshold {
                lane.alarm = Some((row, Grid::Jumps));
                lane.set = self.likely(lane);
            }
        }
    }

    fn end_block(&mut self, row: usize, block: u32, lanes: &mut [Lane]) {
        let courses = self.courses();
        self.signatures.end_block(&courses.0);
        for lane in lanes.iter_mut() {
            lane.scores.end_block();
            lane.sums[0] = 0.0;
            lane.alone_sum = 0.0;
        }
        self.begin_onset(block, lanes);
        let mut scores = vec![0.0; lanes.len()];
        for slot in 0..ONSETS {
            let Some(onset) = CALENDAR.latest(slot, block).filter(|onset| *onset < block) else {
                continue;
            };
            let age = block - onset - 1;
            let weight: f64 = CALENDAR.weight(slot);
            for effect in 0..EFFECTS {
                let Some(direction) = self.signatures.direction(slot, effect, age) else {
                    continue;
                };
                for (lane, score) in lanes.iter_mut().zip(&mut scores) {
                    *score = lane.scores.update(slot, effect, &direction);
                }
                self.signatures.update(slot, effect, age, &direction);
                let cell = self.signatures.cell(slot, effect);
                let information = cell.map_or(0.0, |cell| cell.information);
                let precision = self.settings.precision[effect];
                for (lane, score) in lanes.iter_mut().zip(&scores) {
                    let value = Evidence { precision }.value(*score, information);
                    lane.sums[0] += weight * value / EFFECTS as f64;
                    if lane.alone.is_some_and(|(index, _)| index == effect) {
                        lane.alone_sum += weight * value;
                    }
                }
            }
        }
        let threshold = self.settings.budget.threshold(CALENDAR.weight(ONSETS - 1));
        for lane in lanes.iter_mut() {
            if let Some((_, alarm @ None)) = &mut lane.alone
                && lane.alone_sum >= threshold
            {
                *alarm = Some(row);
            }
            if lane.alarm.is_none() && lane.sums[0] >= threshold {
                lane.alarm = Some((row, Grid::Effects));
                lane.set = self.likely(lane);
            }
        }
    }

    /// Effects within the deviance of a set, the most likely one first; jumps follow the effects.
    fn likely(&self, lane: &Lane) -> Vec<usize> {
        let deviance = |score: f64, information: f64| {
            if information > 0.0 {
                score * score / information
            } else {
                0.0
            }
        };
        let mut all: Vec<(usize, f64)> = (0..EFFECTS)
            .map(|effect| {
                let of_slot = |slot: usize| {
                    let cell = self.signatures.cell(slot, effect);
                    let information = cell.map_or(0.0, |cell| cell.information);
                    deviance(lane.scores.score(slot, effect), information)
                };
                (effect, (0..ONSETS).map(of_slot).fold(0.0, f64::max))
            })
            .collect();
        all.extend((0..3).map(|jump| {
            let of_slot = |slot: usize| {
                let cell = self.jumps.cell(slot);
                let information = cell.map_or(0.0, |cell| cell.information[jump]);
                deviance(lane.jump_scores.scores(slot)[jump], information)
            };
            (EFFECTS + jump, (0..JUMPS).map(of_slot).fold(0.0, f64::max))
        }));
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        let most = all.first().map_or(0.0, |(_, deviance)| *deviance);
        let least = least_of_set(most, self.set_width);
        all.retain(|(_, deviance)| *deviance >= least);
        all.into_iter().map(|(effect, _)| effect).collect()
    }
}
