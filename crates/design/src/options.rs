use gyrocal_calibration::Options;
use gyrocal_record::GimbalLimits;

use crate::goal::Goal;
use crate::result::Aim;

/// Settings of the search for the next run.
#[derive(Clone, Debug, PartialEq)]
pub struct PlanOptions {
    /// Durations of the run, s; none stands for that of the last record.
    pub durations_s: Vec<f64>,
    /// Limits of the gimbals over the whole run, or of the angles of a strapdown unit.
    pub limits: GimbalLimits,
    /// Criterion of the ranking; `None`: by confidence sets if one has alternatives.
    pub aim: Option<Aim>,
    /// Goal of which the shortest run is searched.
    pub goal: Goal,
    /// Proposals for each duration.
    pub proposals: usize,
    /// Seed of the draws.
    pub seed: u64,
    /// Integration of the model.
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
