//! Whether an effect has one size in all records, or one for each turn-on.
//!
//! With â the sizes that each record tells and C the covariance of their errors, a shared size of unknown
//! scale W makes â normal with the covariance C + W² 1 1ᵀ, sizes of their own C + W² I. The scale of each is
//! that of the largest marginal likelihood, so that neither pays for a prior that is too wide.

use gyrocal::effect::Role;
use gyrocal_calibration::{CalibrationError, FittedPlatform, RecordSizes};
use gyrocal_hypothesis::{Searched, scale};
use nalgebra::{Cholesky, DMatrix};

use gyrocal_answer::{Estimated, RecordSize, SizeChoice, SizesByRecord};

/// Log-odds from which on a choice is told, nats: three to one.
const DECIDED_NATS: f64 = 1.1;

/// Scales that are tried, in ratios of two about the largest estimate.
const SCALES: core::ops::RangeInclusive<i32> = -6..=3;

/// The sizes of each finding of the search; `None` of noise, of an effect that lies in one record by its
/// nature, and where the records do not tell.
pub(super) fn sizes_by_record(
    searched: &Searched<FittedPlatform<'_>>,
) -> Result<Vec<Option<SizesByRecord>>, CalibrationError> {
    let mut all = Vec::with_capacity(searched.findings.len());
    if searched.fitted.records() == 1 {
        all.resize(searched.findings.len(), None);
        return Ok(all);
    }
    for (effect, places) in searched.sizes() {
        let is_of_one = matches!(effect.shape().map(|shape| shape.role), Some(Role::Onset(_)))
            || !effect.has_term();
        if is_of_one || places.is_empty() {
            all.push(None);
            continue;
        }
        all.push(match searched.fitted.sizes_by_record(&places) {
            Ok(sizes) => compared(&sizes, places.len(), scale(effect)),
            // No two of the records tell.
            Err(CalibrationError::NotPositiveDefinite) => None,
            Err(error) => return Err(error),
        });
    }
    all.resize(searched.findings.len(), None);
    Ok(all)
}

/// The choice from the sizes; `scale` is the unit of the columns over that of the sizes.
fn compared(sizes: &RecordSizes, each: usize, scale: f64) -> Option<SizesByRecord> {
    let count = sizes.records.len();
    if count < 2 {
        return None;
    }
    let shared = log_likelihood(sizes, |i, j| i % each == j % each)?;
    let own = log_likelihood(sizes, |i, j| i == j)?;
    let log_odds_nats = shared - own;
    let records = sizes.records.iter().enumerate();
    Some(SizesByRecord {
        choice: if log_odds_nats > DECIDED_NATS {
            SizeChoice::Shared
        } else if log_odds_nats < -DECIDED_NATS {
            SizeChoice::PerTurnOn
        } else {
            SizeChoice::Undecided
        },
        log_odds_nats,
        sizes: records
            .map(|(slot, record)| RecordSize {
                record: *record,
                estimates: (each * slot..each * (slot + 1))
                    .map(|i| Estimated {
                        estimate: sizes.estimates[i] / scale,
                        sigma: sizes.covariance[(i, i)].sqrt() / scale,
                    })
                    .collect(),
            })
            .collect(),
    })
}

/// Logarithm of the marginal likelihood of the estimates at the best scale, where sizes are `common` or
/// independent.
fn log_likelihood(sizes: &RecordSizes, common: impl Fn(usize, usize) -> bool) -> Option<f64> {
    let count = sizes.estimates.len();
    let largest = sizes.estimates.amax();
    let of_scale = |power: i32| {
        let variance = (largest * f64::from(power).exp2()).powi(2);
        let total = DMatrix::from_fn(count, count, |i, j| {
            sizes.covariance[(i, j)] + variance * f64::from(u8::from(common(i, j)))
        });
        let cholesky = Cholesky::new(total)?;
        let squares = cholesky.solve(&sizes.estimates).dot(&sizes.estimates);
        let determinant = cholesky
            .l()
            .diagonal()
            .iter()
            .map(|x| 2.0 * x.ln())
            .sum::<f64>();
        Some(-0.5 * (squares + determinant))
    };
    SCALES.filter_map(of_scale).max_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::*;

    fn choice(estimates: &[f64]) -> Option<SizeChoice> {
        let count = estimates.len();
        let sizes = RecordSizes {
            records: (0..count).collect(),
            estimates: DVector::from_row_slice(estimates),
            covariance: DMatrix::identity(count, count),
        };
        compared(&sizes, 1, 1.0).map(|found| found.choice)
    }

    #[test]
    fn sizes_that_agree_are_shared_and_sizes_that_differ_are_not() {
        assert_eq!(choice(&[20.0, 20.5, 19.3]), Some(SizeChoice::Shared));
        assert_eq!(choice(&[20.0, -14.0, 3.0]), Some(SizeChoice::PerTurnOn));
        // One sigma each: nothing is told.
        assert_eq!(choice(&[1.0, 0.2]), Some(SizeChoice::Undecided));
        assert_eq!(choice(&[20.0]), None);
    }
}
