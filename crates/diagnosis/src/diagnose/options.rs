//! Settings of a diagnosis.

use gyrocal_calibration::Options;

use crate::filter_test::TestedFilter;

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
