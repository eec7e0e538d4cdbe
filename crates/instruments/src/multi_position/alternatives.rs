//! Confidence set of a finding: terms that explain the stops as well in its place.

use serde::Serialize;

use super::between_stops::BetweenStops;
use super::laws::open_terms;
use super::regression::WeightedStops;
use super::terms::Term;

/// A term in place of a finding.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Alternative {
    /// Name of the term.
    pub effect: String,
    /// Decrease of the log-likelihood with it, integrated over the noise between stops.
    pub log_likelihood_deficit: f64,
}

/// Largest decrease of the log-likelihood of an alternative: 97 of 100 hidden terms are within it.
const LARGEST_DEFICIT: f64 = 3.0;

/// Terms in the place of one of the law of a gyro, those nearest to it first: its alternatives, and the nearest that is
/// none.
pub(super) fn alternatives(
    data: &WeightedStops,
    laws: &[Vec<Term>],
    term: Term,
    between: &BetweenStops,
) -> (Vec<Alternative>, Option<Alternative>) {
    let mut without = laws.to_vec();
    without[data.gyro].retain(|other| *other != term);
    let free = Term::NOMINAL.into_iter().chain(Term::catalogue(data.gyro));
    let mut terms = open_terms(data, &without[data.gyro], free);
    terms.retain(|other| *other != term);
    terms.insert(0, term);
    let evidence = between.terms(data.gyro, &without, &terms);
    let own = match evidence.first() {
        Some(Some(own)) => own.log_likelihood,
        _ => f64::NEG_INFINITY,
    };
    let others = terms.iter().zip(&evidence).skip(1);
    let others = others.filter_map(|(other, evidence)| {
        Some(Alternative {
            effect: other.id(data.gyro).to_owned(),
            log_likelihood_deficit: own - evidence.as_ref()?.log_likelihood,
        })
    });
    let mut members: Vec<Alternative> = others.collect();
    members.sort_by(|a, b| {
        a.log_likelihood_deficit
            .total_cmp(&b.log_likelihood_deficit)
    });
    let inside = members.partition_point(|other| other.log_likelihood_deficit <= LARGEST_DEFICIT);
    let nearest = members.drain(inside..).next();
    (members, nearest)
}
