//! Which other terms explain the stops as well as one that was found.

use nalgebra::DVector;
use rand_chacha::ChaCha12Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::Serialize;

use super::basis::Term;
use super::regression::{Fit, Whitened};
use super::search::shuffle;

/// Another term in place of one that was found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rival {
    /// Its name.
    pub effect: String,
    /// By how much the log likelihood is lower with it.
    pub log_likelihood_deficit: f64,
}

/// The rivals of a finding, and how well the set holds the truth.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Rivals {
    /// Terms that cannot be ruled out, by deficit.
    pub(crate) members: Vec<Rival>,
    /// The nearest term that is ruled out.
    pub(crate) nearest: Option<Rival>,
    /// Largest deficit of a member.
    pub(crate) limit: f64,
}

/// Half of the 95 % quantile of chi-square with one degree of freedom: a set is never narrower
/// than that of two terms that are nothing alike.
const LEAST_LIMIT: f64 = 1.92;

/// Draws of the bootstrap.
const DRAWS: usize = 999;

/// Terms in place of `term` in a law, whose deficit is within what chance gives the true term in
/// `coverage` of the draws of a bootstrap: the law with its residuals in another order.
pub(crate) fn rivals(
    data: &Whitened,
    law: &[Term],
    term: Term,
    coverage: f64,
    seed: u64,
) -> Option<Rivals> {
    let without: Vec<Term> = law.iter().copied().filter(|other| *other != term).collect();
    let with = |other: Term| {
        let mut terms = without.clone();
        terms.push(other);
        terms
    };
    // The law itself first; terms that the stops do not determine are no rivals.
    let mut others = vec![(term, data.columns(law))];
    let free = Term::catalogue(data.gyro);
    for other in free.into_iter().filter(|other| !law.contains(other)) {
        let columns = data.columns(&with(other));
        if Fit::of(&columns, &data.rates).is_some() {
            others.push((other, columns));
        }
    }
    let half = 0.5 * data.len() as f64;
    // Residual sums of squares need no more than an orthonormal span.
    let spans: Vec<_> = others
        .iter()
        .map(|(_, columns)| columns.clone().qr().q())
        .collect();
    let log_likelihoods = |rates: &DVector<f64>| -> Vec<f64> {
        let rest = |span: &nalgebra::DMatrix<f64>| {
            rates.norm_squared() - (span.transpose() * rates).norm_squared()
        };
        spans.iter().map(|span| -half * rest(span).ln()).collect()
    };
    let fit = data.fit(law)?;
    let fitted = &data.rates - &fit.residuals;
    let mut generator = ChaCha12Rng::seed_from_u64(seed);
    let mut order: Vec<usize> = (0..data.len()).collect();
    let mut deficits_of_truth: Vec<f64> = (0..DRAWS)
        .map(|_| {
            shuffle(&mut order, &mut generator);
            let noise = order.iter().map(|i| fit.residuals[*i]);
            let rates = &fitted + DVector::from_iterator(order.len(), noise);
            let found = log_likelihoods(&rates);
            found.iter().copied().fold(f64::NEG_INFINITY, f64::max) - found[0]
        })
        .collect();
    deficits_of_truth.sort_by(f64::total_cmp);
    let place = (coverage * DRAWS as f64) as usize;
    let quantile = deficits_of_truth.get(place.min(DRAWS - 1)).copied()?;
    let limit = quantile.max(LEAST_LIMIT);
    let found = log_likelihoods(&data.rates);
    let mut all: Vec<Rival> = others
        .iter()
        .zip(&found)
        .skip(1)
        .map(|((other, _), log_likelihood)| Rival {
            effect: other.id(data.gyro),
            log_likelihood_deficit: found[0] - log_likelihood,
        })
        .collect();
    all.sort_by(|a, b| {
        a.log_likelihood_deficit
            .total_cmp(&b.log_likelihood_deficit)
    });
    let members: Vec<Rival> = all
        .iter()
        .filter(|rival| rival.log_likelihood_deficit <= limit)
        .cloned()
        .collect();
    let nearest = all.get(members.len()).cloned();
    Some(Rivals {
        members,
        nearest,
        limit,
    })
}
