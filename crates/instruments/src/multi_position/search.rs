//! Forward selection of terms with family-wise p-values.

use gyrocal_statistics::p_of_least;

use super::between_stops::BetweenStops;
use super::laws::open_terms;
use super::regression::WeightedStops;
use super::terms::Term;

/// Degrees of freedom of the noise between stops, in all gyros together, below which no term is tested: two of each. The
/// share of false terms was measured from there on.
pub(super) const LEAST_FREEDOM: usize = 6;

/// A term that a search added.
pub(super) struct SearchStep {
    pub(super) gyro: usize,
    pub(super) term: Term,
    /// Probability of as large a term in any of the tests of a law without it.
    pub(super) p_value: f64,
}

/// Adds terms to the laws of the gyros while the most significant one is below the probability of a false alarm and each
/// law leaves degrees of freedom.
pub(super) fn search(
    between: &BetweenStops,
    data: &[WeightedStops],
    laws: &mut [Vec<Term>],
    false_alarm_probability: f64,
) -> Vec<SearchStep> {
    let stops = data.first().map_or(0, WeightedStops::len);
    let mut steps = Vec::new();
    if between.freedom(stops, laws) < LEAST_FREEDOM {
        return steps;
    }
    // Each term takes one.
    while between.freedom(stops, laws) > 0 {
        let best = most_significant(between, data, laws);
        let Some(step) = best.filter(|best| best.p_value <= false_alarm_probability) else {
            break;
        };
        laws[step.gyro].push(step.term);
        steps.push(step);
    }
    steps
}

/// The most significant term beyond the laws.
fn most_significant(
    between: &BetweenStops,
    data: &[WeightedStops],
    laws: &[Vec<Term>],
) -> Option<SearchStep> {
    let tests: usize = (0..3).map(|gyro| Term::catalogue(gyro).len()).sum();
    let of_gyro = |data: &WeightedStops| {
        let gyro = data.gyro;
        let terms = open_terms(data, &laws[gyro], Term::catalogue(gyro));
        let evidence = between.terms(gyro, laws, &terms);
        let pairs = terms.into_iter().zip(evidence);
        pairs.filter_map(move |(term, evidence)| {
            Some(SearchStep {
                gyro,
                term,
                p_value: evidence?.p_value,
            })
        })
    };
    let best = data
        .iter()
        .flat_map(of_gyro)
        .min_by(|a, b| a.p_value.total_cmp(&b.p_value))?;
    Some(SearchStep {
        p_value: p_of_least(best.p_value, tests as f64),
        ..best
    })
}
