//! Forward selection by the Bayesian information criterion (Schwarz, Annals of Statistics 6, 1978).
//!
//! Each round adds the entry that lowers the criterion most, until none does. The decrease is the score
//! statistic given the entries added before, less ln(number of values) for each size and for an onset
//! or a time constant.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::{LibraryEntry, Term};
use crate::projection::ProjectedScores;

/// Largest number of selected effects, the same as in the diagnosis.
const MOST_EFFECTS: usize = 6;

/// A column is skipped if the selected ones leave less than this fraction of its information.
const LEAST_LEFT: f64 = 1e-6;

/// The terms of the selected entries, in the order of selection.
pub(super) fn select(scores: &ProjectedScores, library: &[LibraryEntry]) -> Vec<Term> {
    let mut information = scores.information.clone();
    let mut score = scores.score.clone();
    let penalty = (scores.values as f64).ln();
    let mut selected: Vec<usize> = Vec::new();
    while selected.len() < MOST_EFFECTS {
        let best = library
            .iter()
            .enumerate()
            .filter(|(_, entry)| scores.observes(&entry.signature))
            .filter_map(|(index, entry)| {
                let columns = &entry.signature.columns;
                let left = columns
                    .iter()
                    .map(|column| (*column, *column))
                    .all(|place| information[place] > LEAST_LEFT * scores.information[place]);
                let (own, scores) = part(&information, &score, columns);
                let statistic = Cholesky::new(own)?.solve(&scores).dot(&scores);
                let free = columns.len() + usize::from(entry.has_shape);
                left.then_some((index, statistic - free as f64 * penalty))
            })
            .max_by(|one, other| one.1.total_cmp(&other.1));
        let Some((index, gain)) = best else { break };
        if gain <= 0.0 {
            break;
        }
        selected.push(index);
        let columns = &library[index].signature.columns;
        project_out(&mut information, &mut score, columns);
    }
    let terms = |entry: usize| library[entry].terms(entry);
    selected.into_iter().flat_map(terms).collect()
}

fn part(
    information: &DMatrix<f64>,
    score: &DVector<f64>,
    columns: &[usize],
) -> (DMatrix<f64>, DVector<f64>) {
    let own = information.select_rows(columns).select_columns(columns);
    (own, score.select_rows(columns))
}

/// Projects columns out of scores and information.
fn project_out(information: &mut DMatrix<f64>, score: &mut DVector<f64>, columns: &[usize]) {
    let (own, scores) = part(information, score, columns);
    let Some(cholesky) = Cholesky::new(own) else {
        return;
    };
    let cross = information.select_rows(columns);
    let taken = cholesky.solve(&cross);
    *score -= taken.tr_mul(&scores);
    *information -= cross.tr_mul(&taken);
}
