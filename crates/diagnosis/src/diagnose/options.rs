//! Settings of a diagnosis.

use gyrocal_answer::FalseAlarmShares;
use gyrocal_calibration::Options;
use gyrocal_hypothesis::{SearchOptions, Selection};
use gyrocal_record::{Bench, Record};

use crate::error_budget::RESIDUAL_TESTS;
use crate::filter_test::TestedFilter;
use crate::request;

/// Settings of a diagnosis.
#[derive(Clone, Debug, PartialEq)]
pub struct DiagnoseOptions {
    /// Family-wise probability that a record of the nominal model with the declared noise shows any
    /// finding.
    pub false_alarm_probability: f64,
    /// Effects to test beside those of the default search.
    pub also: Vec<String>,
    /// A filter to test for consistency on the record.
    pub filter: Option<TestedFilter>,
    /// Seed of the draws that thresholds come from.
    pub seed: u64,
    /// Integration of the model.
    pub calibration: Options,
}

impl Default for DiagnoseOptions {
    fn default() -> Self {
        Self {
            false_alarm_probability: 0.01,
            also: Vec::new(),
            filter: None,
            seed: 0,
            calibration: Options::default(),
        }
    }
}

/// The effects that are searched for.
pub(super) fn selection(record: &Record, bench: &Bench, options: &DiagnoseOptions) -> Selection {
    let also: Vec<&str> = options.also.iter().map(String::as_str).collect();
    request::selection(record, bench, &also)
}

/// Options of a search on a record that so much work was done on before.
pub(super) fn search_options(
    options: &DiagnoseOptions,
    shares: &FalseAlarmShares,
    work_before: u64,
) -> SearchOptions {
    SearchOptions {
        false_alarm_probability: shares.search,
        walk_probability: shares.random_walk,
        unmodelled_probability: shares.residual_test / RESIDUAL_TESTS,
        seed: options.seed,
        work_before,
        names_alone: false,
    }
}
