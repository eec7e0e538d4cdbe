//! Expected size of a confidence set after a next run.

use chacha20::ChaCha8Rng;
use chacha20::rand_core::SeedableRng;
use gyrocal_statistics::deviates::polar;
use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};

use crate::joint_unknowns::{ConfidenceSet, Unknown, with_priors};
use crate::result::SetForecast;
use crate::run_information::RunInformation;
use crate::set_comparison::{Comparison, deficits, stays};

/// Posterior of the sizes of each member and of its nuisance unknowns, if that member is the cause.
pub(crate) struct Posteriors {
    of: Vec<Option<Posterior>>,
}

struct Posterior {
    /// The unknowns.
    places: Vec<usize>,
    mean: DVector<f64>,
    covariance: DMatrix<f64>,
    /// Probability of the member before the next run.
    weight: f64,
}

/// Normal deviates, common to all attitudes.
pub(crate) struct Deviates(DMatrix<f64>);

impl Deviates {
    pub(crate) fn new(rows: usize, draws: usize, seed: u64) -> Self {
        // ChaCha8: see `gyrocal_statistics::deviates`.
        let mut generator = ChaCha8Rng::seed_from_u64(seed);
        Self(DMatrix::from_fn(rows.max(1), draws, |_, _| {
            polar(&mut generator)
        }))
    }
}

impl Posteriors {
    pub(crate) fn new(
        case: &ConfidenceSet,
        unknowns: &[Unknown],
        information: &RunInformation,
    ) -> Self {
        let of = case
            .members
            .iter()
            .map(|member| {
                if member.is_walk() && member.candidate.variance <= 0.0 {
                    return None;
                }
                let mut places = case.nuisance.clone();
                places.extend(&member.places);
                let count = places.len();
                let inner = with_priors(&information.information, unknowns, &places);
                let cholesky = Cholesky::new(inner)?;
                let score = DVector::from_fn(count, |i, _| information.score[places[i]]);
                Some(Posterior {
                    mean: cholesky.solve(&score),
                    covariance: cholesky.inverse(),
                    places,
                    weight: (-member.candidate.deficit).exp(),
                })
            })
            .collect();
        Self { of }
    }
}

/// The set after a next run of which only the information is known, drawn from what each member
/// predicts of it.
pub(crate) fn expected(
    case: &ConfidenceSet,
    unknowns: &[Unknown],
    posteriors: &Posteriors,
    now: &RunInformation,
    next: &DMatrix<f64>,
    deviates: &Deviates,
) -> Option<SetForecast> {
    let count = case.members.len();
    let comparison = if count > 1 {
        let total = &now.information + next;
        Some(Comparison::new(case, unknowns, &total)?)
    } else {
        None
    };
    let mut mean_size = 0.0;
    let mut one_left = 0.0;
    let mut weights = 0.0;
    // For each member: probability that it and the first do not both stay, if it is the cause,
    // and if the first is.
    let mut apart = vec![[0.0; 2]; count];
    let mut odds = vec![0.0; count];
    for (truth, posterior) in posteriors.of.iter().enumerate() {
        let (Some(comparison), Some(posterior)) = (&comparison, posterior) else {
            continue;
        };
        let outcome = outcome(case, comparison, posterior, now, next, deviates);
        let weight = posterior.weight;
        mean_size += weight * outcome.size;
        one_left += weight * outcome.one_left;
        weights += weight;
        odds[truth] = weight;
        apart[truth][0] = outcome.apart[truth];
        if truth == 0 {
            for (apart, told) in apart.iter_mut().zip(outcome.apart) {
                apart[1] = told;
            }
        }
    }
    if weights == 0.0 {
        (mean_size, one_left, weights) = (1.0, 1.0, 1.0);
    }
    case.forecast(mean_size / weights, one_left / weights, |index| {
        if index == 0 {
            return 1.0;
        }
        let [own, first] = apart[index];
        let total = odds[index] + odds[0];
        (odds[index] * own + odds[0] * first) / total.max(f64::MIN_POSITIVE)
    })
}

/// The set after the next run if one member is the cause.
struct Outcome {
    size: f64,
    one_left: f64,
    /// Probability that a member and the first do not both stay.
    apart: Vec<f64>,
}

fn outcome(
    case: &ConfidenceSet,
    comparison: &Comparison,
    posterior: &Posterior,
    now: &RunInformation,
    next: &DMatrix<f64>,
    Deviates(deviates): &Deviates,
) -> Outcome {
    let places = &posterior.places;
    let seen = DMatrix::from_fn(next.nrows(), places.len(), |i, j| next[(i, places[j])]);
    let score = &now.score + &seen * &posterior.mean;
    let mean = &comparison.projection * score;
    let spread = &comparison.projection * &seen;
    let covariance = &comparison.projection * next * comparison.projection.transpose()
        + &spread * &posterior.covariance * spread.transpose();
    let root = root(&covariance);
    let rows = mean.len();
    let draws = deviates.ncols();
    let (mut size, mut one_left, mut apart) = (0.0, 0.0, vec![0.0; case.members.len()]);
    let deviates = deviates.view((0, 0), (rows, draws));
    let mut scores = root * deviates;
    for mut column in scores.column_iter_mut() {
        column += &mean;
    }
    for draw in 0..draws {
        let column: Vec<f64> = scores.column(draw).iter().copied().collect();
        let statistics = comparison.statistics(&column);
        let Some((_, deficits)) = deficits(&case.members, &statistics) else {
            continue;
        };
        let kept: Vec<bool> = deficits.iter().map(|deficit| stays(*deficit)).collect();
        let left = kept.iter().filter(|kept| **kept).count();
        size += left as f64;
        one_left += f64::from(u8::from(left == 1));
        for (apart, kept_too) in apart.iter_mut().zip(&kept) {
            *apart += f64::from(u8::from(!(*kept_too && kept[0])));
        }
    }
    let draws = draws as f64;
    Outcome {
        size: size / draws,
        one_left: one_left / draws,
        apart: apart.into_iter().map(|count| count / draws).collect(),
    }
}

/// A root of a covariance that may be singular; rows differ by many powers of ten.
fn root(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let count = covariance.nrows();
    let scale: Vec<f64> = (0..count)
        .map(|i| covariance[(i, i)].max(0.0).sqrt())
        .collect();
    let correlation = DMatrix::from_fn(count, count, |i, j| {
        let product = scale[i] * scale[j];
        if product > 0.0 {
            0.5 * (covariance[(i, j)] + covariance[(j, i)]) / product
        } else {
            0.0
        }
    });
    let eigen = SymmetricEigen::new(correlation);
    let mut root = eigen.eigenvectors;
    for (mut column, value) in root.column_iter_mut().zip(eigen.eigenvalues.iter()) {
        column *= value.max(0.0).sqrt();
    }
    for (mut row, scale) in root.row_iter_mut().zip(scale) {
        row *= scale;
    }
    root
}
