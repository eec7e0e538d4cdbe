//! Whether several records are of one platform.
//!
//! Two records of platforms that differ by little look like one platform with causes: a latitude, steps between the
//! records, walks. Their coefficients tell. Records with coefficients of their own are held against one platform with
//! all that was found, by the densities of both, all unknowns integrated out. Before the record the coefficients of
//! another platform differ from those of the first by as much as the estimates do: the declared prior, which is a
//! thousand times as wide as an estimate, would make any walk likelier.

use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::FittedPlatform;
use gyrocal_statistics::math::{ln, ln_1p};
use nalgebra::{Cholesky, DMatrix};

use super::noise_audited_fit::AuditedFit;
use crate::error_budget::{OTHER_PLATFORM, OTHER_PLATFORM_NATS};

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
    /// The largest difference that shows another platform.
    pub(super) difference: Option<Difference>,
    /// Logarithm of the density of the records with coefficients of their own; `None` where it cannot be told.
    apart: Option<f64>,
}

impl OnePlatform {
    pub(super) fn new(audits: &[AuditedFit<'_>]) -> Self {
        let fits: Vec<&FittedPlatform<'_>> = audits.iter().map(|one| &one.nominal).collect();
        let difference = largest_difference(&fits);
        Self {
            difference: difference.filter(|other| other.sigmas > OTHER_PLATFORM),
            apart: apart(&fits),
        }
    }

    /// A difference that explains the records better than one platform with all that was found does.
    pub(super) fn refuted_by(&self, together: &FittedPlatform<'_>) -> Option<Difference> {
        let gained = self.apart? - density(together)?;
        self.difference.filter(|_| gained > OTHER_PLATFORM_NATS)
    }
}

fn density(fit: &FittedPlatform<'_>) -> Option<f64> {
    fit.log_evidence_without(0..0).ok()
}

fn apart(fits: &[&FittedPlatform<'_>]) -> Option<f64> {
    let (first, others) = fits.split_first()?;
    let others = others
        .iter()
        .map(|other| Some(density(other)? + narrowed(first, other)?));
    Some(density(first)? + others.sum::<Option<f64>>()?)
}

/// What the density of a record gains if its coefficients are, before it, as near to those of the first as they are
/// in it: volume of the declared prior over that of the estimates, less (n/2) ln (1 + D²/n) with D² the chi-square of
/// the n differences.
fn narrowed(first: &FittedPlatform<'_>, other: &FittedPlatform<'_>) -> Option<f64> {
    let count = DRIFT.len();
    let covariance = |fit: &FittedPlatform<'_>| -> DMatrix<f64> {
        fit.covariance().view((0, 0), (count, count)).into_owned()
    };
    let prior = (0..count).map(|place| ln(other.evidence_sigma(place)));
    let posterior = Cholesky::new(covariance(other))?;
    let posterior = posterior.l_dirty().diagonal().map(ln).sum();
    let differences = DMatrix::from_fn(count, 1, |place, _| {
        other.values()[place] - first.values()[place]
    });
    let both = Cholesky::new(covariance(first) + covariance(other))?;
    let chi_square = both.solve(&differences).dot(&differences);
    let n = count as f64;
    Some(prior.sum::<f64>() - posterior - 0.5 * n * ln_1p(chi_square / n))
}

fn largest_difference(fits: &[&FittedPlatform<'_>]) -> Option<Difference> {
    let (first, others) = fits.split_first()?;
    let of = |(index, other): (usize, &&FittedPlatform<'_>), place: usize| {
        let variance = first.covariance()[(place, place)] + other.covariance()[(place, place)];
        Difference {
            sigmas: (other.values()[place] - first.values()[place]).abs() / variance.sqrt(),
            record: index + 1,
            place,
        }
    };
    let others = others.iter().enumerate();
    let all = others.flat_map(|other| (0..DRIFT.len()).map(move |place| of(other, place)));
    all.max_by(|a, b| a.sigmas.total_cmp(&b.sigmas))
}
