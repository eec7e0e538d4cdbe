//! Kinds of records of the servo of the examples, which a user's plant may be like.

use gyrocal_answer::Answer;
use gyrocal_plant::{LoadedPlant, PlantError, PlantRecord, SearchOptions, diagnose};
use gyrocal_statistics::deviates::Draw;
use gyrocal_statistics::root_mean_square;
use gyrocal_truth::plant::{Kind, Setting, simulate};

use super::records::EDITS;

/// A kind of records of the servo `examples/servo`: a voltage turns an axis under feedback, and its angle is
/// read.
pub(super) struct PlantKind {
    /// What the records are, in words.
    pub(super) name: &'static str,
    /// Name of the right answer.
    pub(super) right: &'static str,
    /// What the simulator hides, and its size.
    hidden: (&'static str, f64),
}

const ROWS: usize = 600;

/// Noise of the logged input over its root mean square, which is no matter of the simulator.
const LOGGED: &str = "logged input";

impl PlantKind {
    /// All kinds. New ones come last: places are the seeds of the records.
    #[rustfmt::skip]
    pub(super) const ALL: &[Self] = &[
        kind("servo: as declared", "none", ("", 0.0)),
        kind("servo: noise of correlation 0.5", "noisy", ("noise.correlation", 0.5)),
        kind("servo: noise of correlation 0.9", "noisy", ("noise.correlation", 0.9)),
        kind("servo: noise of the rate", "noisy", ("rate.noise", 0.005)),
        kind("servo: noise of a tenth on the logged input", "noisy", (LOGGED, 0.1)),
        kind("servo: feedback of a row's own reading", "none", ("feedback.same_row", 0.8)),
        kind("servo: a dead time of 0.04 s", "delay", ("drive.late_rows", 2.0)),
        kind("servo: a gain that fades by a fifth", "fade", ("a.fade", 0.2)),
        kind("servo: a gain with waves of a tenth", "wave", ("a.wave", 0.1)),
    ];

    /// The diagnosis of the record of a seed.
    pub(super) fn diagnosed(&self, plant: &LoadedPlant, seed: u64) -> Result<Answer, PlantError> {
        let record = self.record(seed).prepared(plant.description(), self.name)?;
        Ok(diagnose(plant, record, None, &SearchOptions::default())?.answer)
    }

    pub(super) fn record(&self, seed: u64) -> PlantRecord {
        let mut setting = Setting::random(Kind::Servo, seed, ROWS);
        setting.hidden = self.hidden;
        let run = simulate(&setting, None);
        let mut inputs = run.inputs.concat();
        if self.hidden.0 == LOGGED {
            let random = &mut Draw::new(seed, EDITS);
            let sigma = self.hidden.1 * root_mean_square(&inputs);
            let inputs = inputs.iter_mut();
            inputs.for_each(|input| *input += sigma * random.normal());
        }
        PlantRecord {
            time_s: run.time_s,
            inputs,
            outputs: run.outputs.concat(),
            ..PlantRecord::default()
        }
    }
}

const fn kind(name: &'static str, right: &'static str, hidden: (&'static str, f64)) -> PlantKind {
    PlantKind {
        name,
        right,
        hidden,
    }
}
