//! Whether several records are of one platform.

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::FittedPlatform;

use super::noise_audited_fit::AuditedFit;

/// Difference of a coefficient between two records that no error of a platform makes, in its standard
/// deviations.
const OTHER_PLATFORM: f64 = 200.0;

/// Least difference of a coefficient of another platform, in its standard deviations, and by how much records with
/// coefficients of their own must be likelier than those of one platform with all that was found, nats.
const LEAST_DIFFERENCE: f64 = 5.0;
const LEAST_GAIN: f64 = 5.0;

/// The coefficient that differs most between the first record and another.
#[derive(Clone, Copy)]
pub(super) struct Difference {
    /// Of the two estimates, in standard deviations.
    pub(super) sigmas: f64,
    /// The other record.
    pub(super) record: usize,
    /// Place of the coefficient.
    pub(super) place: usize,
}

/// What the fits of single records say of one platform.
pub(super) struct OnePlatform {
    largest: Option<Difference>,
    /// Of the records with coefficients of their own.
    evidence: Option<f64>,
}

impl OnePlatform {
    pub(super) fn new(audits: &[AuditedFit<'_>]) -> Self {
        let evidence = audits.iter().map(|one| evidence(&one.nominal));
        Self {
            largest: largest_difference(audits),
            evidence: evidence.sum(),
        }
    }

    /// A difference that no cause explains.
    pub(super) fn is_impossible(&self) -> Option<Difference> {
        self.largest.filter(|other| other.sigmas > OTHER_PLATFORM)
    }

    /// A difference that explains the records better than all that was found in them together does.
    pub(super) fn is_less_likely(&self, together: &FittedPlatform<'_>) -> Option<Difference> {
        let apart = self.evidence?;
        let is_less_likely = apart > evidence(together)? + LEAST_GAIN;
        let largest = self.largest.filter(|_| is_less_likely)?;
        (largest.sigmas > LEAST_DIFFERENCE).then_some(largest)
    }
}

/// Logarithm of the density of the records of a fit, all unknowns integrated out; `None` where it cannot be told.
fn evidence(fit: &FittedPlatform<'_>) -> Option<f64> {
    fit.log_evidence_without(0..0).ok()
}

fn largest_difference(audits: &[AuditedFit<'_>]) -> Option<Difference> {
    let (first, others) = audits.split_first()?;
    let of = |(index, other): (usize, &AuditedFit<'_>), place: usize| {
        let fits = [&first.nominal, &other.nominal];
        let variance: f64 = fits
            .map(|fit| fit.covariance()[(place, place)])
            .iter()
            .sum();
        let [first, other] = fits.map(|fit| fit.values()[place]);
        Difference {
            sigmas: (other - first).abs() / variance.sqrt(),
            record: index + 1,
            place,
        }
    };
    let others = others.iter().enumerate();
    let all = others.flat_map(|other| (0..DRIFT.len()).map(move |place| of(other, place)));
    all.max_by(|a, b| a.sigmas.total_cmp(&b.sigmas))
}
