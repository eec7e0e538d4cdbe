use gyrocal_calibration::Options;
use gyrocal_record::GimbalLimits;

use crate::goal::Goal;
use crate::result::Aim;

/// How a next run is looked for.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanOptions {
    /// Durations of the run, s; none stands for that of the record.
    pub durations_s: Vec<f64>,
    /// Where the gimbals may go, in the whole run.
    pub limits: GimbalLimits,
    /// What proposals are ranked by; `None` is by sets if there is one with rivals.
    pub aim: Option<Aim>,
    /// What a run is to reach, if the duration that this takes is asked for.
    pub goal: Goal,
    /// Proposals for each duration.
    pub proposals: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// How the model is integrated.
    pub calibration: Options,
}

impl Default for PlanOptions {
    fn default() -> Self {
        Self {
            durations_s: Vec::new(),
            limits: GimbalLimits::default(),
            aim: None,
            goal: Goal::default(),
            proposals: 3,
            seed: 0,
            calibration: Options::default(),
        }
    }
}
