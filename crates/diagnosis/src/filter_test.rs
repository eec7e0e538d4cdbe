//! Consistency test of another filter on the same record.

use gyrocal_calibration::{CalibrationError, Options, calibrate};
use gyrocal_record::{Bench, Record};
use gyrocal_statistics::{chi_square_z, two_sided_p};

use crate::error_budget::FILTER_TEST_ALPHA;
use gyrocal_answer::FilterTest;

/// The effect that is reported of a filter whose integration rule is too coarse.
pub const FILTER_EFFECT: &str = "filter.discretisation";

/// Least ratio of the filter's mean NIS to that of this program's filter. Noise and causes enlarge
/// the innovations of both; an integration rule that is too coarse enlarges its own.
const LEAST_RATIO: f64 = 1.5;

/// A filter whose consistency can be tested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TestedFilter {
    /// The filter of the paper: Euler angles as states, one Euler step per sample.
    Euler,
}

/// Outcome of a consistency test.
pub(crate) struct Tested {
    pub(crate) test: FilterTest,
    /// z and p-value, if the filter is inconsistent and its rule the reason.
    pub(crate) inconsistent: Option<[f64; 2]>,
}

/// Runs the filter over the record, and the streaming filter of this program beside it.
pub(crate) fn filter_test(
    record: &Record,
    bench: &Bench,
    filter: TestedFilter,
) -> Result<Tested, CalibrationError> {
    let (name, options) = match filter {
        TestedFilter::Euler => ("euler", Options::paper_baseline()),
    };
    let own = calibrate(record, bench, &Options::streaming(), |_| ())?.fit;
    let mut test = FilterTest {
        name: name.to_owned(),
        nis_mean: None,
        nis_band: own.nis_band(),
        reference_nis_mean: own.nis_mean(),
        stopped: None,
    };
    let tested = match calibrate(record, bench, &options, |_| ()) {
        Ok(calibration) => calibration.fit,
        Err(CalibrationError::Filter {
            row,
            time_s,
            source,
        }) => {
            test.stopped = Some(format!("at row {row} (t = {time_s} s): {source}"));
            return Ok(Tested {
                test,
                inconsistent: None,
            });
        }
        Err(other) => return Err(other),
    };
    test.nis_mean = Some(tested.nis_mean());
    let z = chi_square_z(tested.nis_sum(), tested.values() as f64).unwrap_or(0.0);
    let p_value = two_sided_p(z);
    let coarse =
        z > 0.0 && p_value < FILTER_TEST_ALPHA && tested.nis_mean() > LEAST_RATIO * own.nis_mean();
    Ok(Tested {
        test,
        inconsistent: coarse.then_some([z, p_value]),
    })
}
