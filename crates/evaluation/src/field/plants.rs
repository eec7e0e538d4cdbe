//! Kinds of records of the servo of the examples, which a user's plant may be like.

use gyrocal_plant::{LoadedPlant, PlantRecord, SearchOptions, diagnose};
use gyrocal_statistics::deviates::Draw;
use gyrocal_truth::plant::{Kind, Setting, simulate};

use super::judge::{Told, judge};
use super::records::EDITS;
use super::right::{Right, Silent, UNLISTED};
use super::{APART, FieldOutcome};

/// A kind of records of the servo `examples/servo`: a voltage turns an axis under feedback, and its angle is
/// read.
#[derive(Clone, Copy, Debug)]
pub struct PlantKind {
    /// What the records are, in words.
    pub name: &'static str,
    /// The answer that is right for them.
    pub right: &'static Right,
    /// What the simulator hides, and its size.
    hidden: (&'static str, f64),
}

const NONE: Right = Right::NOTHING;
const NOISY: Right =
    Right::told(&[&["y.noise", "drive.noise", "rate_rate.noise"]]).silent(Silent::Always);
const DELAY: Right = Right::in_set(&[&["drive.delay"]]);
const FADE: Right = Right::in_set(&[&["a.drift", "a.ramp"]]).near(&["a.step"]);
const WAVE: Right = Right::in_set(&[&[UNLISTED]]).near(&["a.step"]);

/// First seed of the kinds.
const FIRST_SEED: u64 = 500_000_000;

const ROWS: usize = 600;

/// Noise of the logged input over its root mean square, which is no matter of the simulator.
const LOGGED: &str = "logged input";

impl PlantKind {
    /// All kinds. New ones come last: places are the seeds of the records.
    #[rustfmt::skip]
    pub const ALL: &[Self] = &[
        kind("servo: as declared", &NONE, ("", 0.0)),
        kind("servo: noise of correlation 0.5", &NOISY, ("noise.correlation", 0.5)),
        kind("servo: noise of correlation 0.9", &NOISY, ("noise.correlation", 0.9)),
        kind("servo: noise of the rate", &NOISY, ("rate.noise", 0.005)),
        kind("servo: noise of a tenth on the logged input", &NOISY, (LOGGED, 0.1)),
        kind("servo: feedback of a row's own reading", &NONE, ("feedback.same_row", 0.8)),
        kind("servo: a dead time of 0.04 s", &DELAY, ("drive.late_rows", 2.0)),
        kind("servo: a gain that fades by a fifth", &FADE, ("a.fade", 0.2)),
        kind("servo: a gain with waves of a tenth", &WAVE, ("a.wave", 0.1)),
    ];

    /// The first seed of a kind, by its place in [`Self::ALL`].
    #[must_use]
    pub fn first_seed(place: u64) -> u64 {
        FIRST_SEED + APART * place
    }

    /// Makes the record of a seed, diagnoses it with the plant of `examples/servo` and judges the answer.
    #[must_use]
    pub fn run(&self, plant: &LoadedPlant, seed: u64) -> FieldOutcome {
        let record = self.record(seed).prepared(plant.description(), self.name);
        let found = record
            .and_then(|record| diagnose(plant, record, None, &SearchOptions::default()))
            .map(|found| found.answer);
        judge(self.right, None, false, &Told::of_plant(found.as_ref()))
    }

    pub(super) fn record(&self, seed: u64) -> PlantRecord {
        let mut setting = Setting::random(Kind::Servo, seed, ROWS);
        setting.hidden = self.hidden;
        let run = simulate(&setting, None);
        let mut inputs = run.inputs.concat();
        if self.hidden.0 == LOGGED {
            let random = &mut Draw::new(seed, EDITS);
            let square: f64 = inputs.iter().map(|input| input * input).sum();
            let sigma = self.hidden.1 * (square / ROWS as f64).sqrt();
            inputs
                .iter_mut()
                .for_each(|input| *input += sigma * random.normal());
        }
        PlantRecord {
            time_s: run.time_s,
            inputs,
            outputs: run.outputs.concat(),
            ..PlantRecord::default()
        }
    }
}

const fn kind(name: &'static str, right: &'static Right, hidden: (&'static str, f64)) -> PlantKind {
    PlantKind {
        name,
        right,
        hidden,
    }
}
