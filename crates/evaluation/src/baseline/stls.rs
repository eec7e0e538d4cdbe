//! Sequentially thresholded least squares, as in SINDy (Brunton, Proctor and Kutz, PNAS 113, 2016).
//!
//! All columns of the library, scaled to unit length, are fitted by ridge regression; columns with
//! coefficients below a threshold are removed; both are repeated until nothing changes. The remaining
//! columns are fitted without the ridge. Ridge and number of rounds are the defaults of PySINDy's
//! `STLSQ` (de Silva et al., JOSS 5, 2020). Of a sweep of thresholds the one with the best Bayesian
//! information criterion is used (Mangan, Kutz, Brunton and Proctor, Proc. R. Soc. A 473, 2017).
//! Innovations are white with unit variance: thresholds are in sigmas of a single column.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::{LibraryEntry, Term};
use crate::projection::ProjectedScores;

const THRESHOLDS: [f64; 8] = [1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0];
const RIDGE: f64 = 0.05;
const MOST_ROUNDS: usize = 20;

/// Added to the diagonal of the last fit: exact equivalents have equal columns, which make it singular.
const JITTER: f64 = 1e-6;

/// The remaining terms, the largest coefficient first.
pub(super) fn select(scores: &ProjectedScores, library: &[LibraryEntry]) -> Vec<Term> {
    // The observable terms.
    let terms: Vec<Term> = library
        .iter()
        .enumerate()
        .filter(|(_, entry)| scores.observes(&entry.signature))
        .flat_map(|(index, entry)| entry.terms(index))
        .collect();
    let length = |term: usize| scores.information[(terms[term].column, terms[term].column)].sqrt();
    let gram = DMatrix::from_fn(terms.len(), terms.len(), |i, j| {
        scores.information[(terms[i].column, terms[j].column)] / (length(i) * length(j))
    });
    let moment = DVector::from_fn(terms.len(), |i, _| {
        scores.score[terms[i].column] / length(i)
    });
    let penalty = (scores.values as f64).ln();
    let best = THRESHOLDS
        .iter()
        .filter_map(|threshold| {
            let support = support(&gram, &moment, *threshold)?;
            let coefficients = solve(&gram, &moment, &support, JITTER)?;
            let explained: f64 = support
                .iter()
                .zip(coefficients.iter())
                .map(|(term, coefficient)| moment[*term] * coefficient)
                .sum();
            let gain = explained - penalty * support.len() as f64;
            Some((gain, support, coefficients))
        })
        .max_by(|one, other| one.0.total_cmp(&other.0));
    let Some((_, support, coefficients)) = best else {
        return Vec::new();
    };
    let mut sized: Vec<(&usize, &f64)> = support.iter().zip(coefficients.iter()).collect();
    sized.sort_by(|(_, one), (_, other)| other.abs().total_cmp(&one.abs()));
    sized.into_iter().map(|(term, _)| terms[*term]).collect()
}

/// Terms that remain at a threshold; `None` if a fit fails.
fn support(gram: &DMatrix<f64>, moment: &DVector<f64>, threshold: f64) -> Option<Vec<usize>> {
    let mut support: Vec<usize> = (0..moment.len()).collect();
    for _ in 0..MOST_ROUNDS {
        let coefficients = solve(gram, moment, &support, RIDGE)?;
        let kept: Vec<usize> = support
            .iter()
            .zip(coefficients.iter())
            .filter(|(_, coefficient)| coefficient.abs() >= threshold)
            .map(|(term, _)| *term)
            .collect();
        if kept.len() == support.len() {
            break;
        }
        support = kept;
    }
    Some(support)
}

fn solve(
    gram: &DMatrix<f64>,
    moment: &DVector<f64>,
    support: &[usize],
    ridge: f64,
) -> Option<DVector<f64>> {
    if support.is_empty() {
        return Some(DVector::zeros(0));
    }
    let mut own = gram.select_rows(support).select_columns(support);
    for i in 0..support.len() {
        own[(i, i)] += ridge;
    }
    Some(Cholesky::new(own)?.solve(&moment.select_rows(support)))
}
