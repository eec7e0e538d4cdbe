//! Confidence set of a finding: terms that explain the stops as well in its place.

use chacha20::ChaCha12Rng;
use chacha20::rand_core::SeedableRng;
use nalgebra::DVector;
use serde::Serialize;

use super::regression::{Fit, WeightedStops};
use super::search::shuffle;
use super::terms::Term;

/// A term in place of a finding.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Alternative {
    /// Name of the term.
    pub effect: String,
    /// Decrease of the log-likelihood with it.
    pub log_likelihood_deficit: f64,
}

/// Alternatives of a finding.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Alternatives {
    /// Terms that cannot be rejected, in the order of their deficits.
    pub(crate) members: Vec<Alternative>,
    /// The nearest rejected term.
    pub(crate) nearest: Option<Alternative>,
    /// Largest deficit of a member.
    pub(crate) limit: f64,
}

/// Least limit of a deficit, that of two unrelated terms: half of the 95 % quantile of chi-square with
/// one degree of freedom.
const LEAST_LIMIT: f64 = 1.92;

/// Number of bootstrap draws.
const DRAWS: usize = 999;

/// Terms in place of `term` in a law. The limit of their deficit is the quantile `coverage` of the
/// deficit of the true term in a bootstrap: the fitted law with its residuals permuted.
pub(crate) fn alternatives(
    data: &WeightedStops,
    law: &[Term],
    term: Term,
    coverage: f64,
    seed: u64,
) -> Option<Alternatives> {
    let without: Vec<Term> = law.iter().copied().filter(|other| *other != term).collect();
    let with = |other: Term| {
        let mut terms = without.clone();
        terms.push(other);
        terms
    };
    // The law itself first; terms that the stops do not determine are left out.
    let mut others = vec![(term, data.columns(law))];
    let free = Term::catalogue(data.gyro);
    for other in free.into_iter().filter(|other| !law.contains(other)) {
        let columns = data.columns(&with(other));
        if Fit::of(&columns, &data.rates).is_some() {
            others.push((other, columns));
        }
    }
    let half = 0.5 * data.len() as f64;
    // An orthonormal span is enough for residual sums of squares.
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
    // ChaCha12: see `gyrocal_statistics::deviates`.
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
    let mut all: Vec<Alternative> = others
        .iter()
        .zip(&found)
        .skip(1)
        .map(|((other, _), log_likelihood)| Alternative {
            effect: other.id(data.gyro).to_owned(),
            log_likelihood_deficit: found[0] - log_likelihood,
        })
        .collect();
    all.sort_by(|a, b| {
        a.log_likelihood_deficit
            .total_cmp(&b.log_likelihood_deficit)
    });
    let members: Vec<Alternative> = all
        .iter()
        .filter(|other| other.log_likelihood_deficit <= limit)
        .cloned()
        .collect();
    let nearest = all.get(members.len()).cloned();
    Some(Alternatives {
        members,
        nearest,
        limit,
    })
}
