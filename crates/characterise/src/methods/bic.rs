//! Forward selection by the Bayesian information criterion (Schwarz, Annals of Statistics 6, 1978).
//!
//! In each round the entry that lowers the criterion most is taken, while one does: its statistic
//! beside those that were taken, less ln(number of values) for each of its sizes and, where it was
//! searched for, for its onset or time constant.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::Entry;
use crate::bank::Bank;

/// More causes than this are not looked for; the diagnosis has the same limit.
const MOST: usize = 6;

/// Columns of which those that were taken leave less than this share are no longer looked at.
const VISIBLE: f64 = 1e-6;

/// Numbers of the entries that were taken, in their order.
pub(super) fn select(bank: &Bank, library: &[Entry]) -> Vec<usize> {
    let mut information = bank.information.clone();
    let mut score = bank.score.clone();
    let price = (bank.values as f64).ln();
    let mut taken: Vec<usize> = Vec::new();
    while taken.len() < MOST {
        let best = library
            .iter()
            .enumerate()
            .filter(|(_, entry)| bank.sees(&entry.signature))
            .filter_map(|(index, entry)| {
                let columns = &entry.signature.columns;
                let left = columns.iter().all(|column| {
                    information[(*column, *column)] > VISIBLE * bank.information[(*column, *column)]
                });
                let (own, scores) = part(&information, &score, columns);
                let statistic = Cholesky::new(own)?.solve(&scores).dot(&scores);
                let free = columns.len() + usize::from(entry.searched_shape);
                left.then_some((index, statistic - free as f64 * price))
            })
            .max_by(|one, other| one.1.total_cmp(&other.1));
        let Some((index, gain)) = best else { break };
        if gain <= 0.0 {
            break;
        }
        taken.push(index);
        project_out(
            &mut information,
            &mut score,
            &library[index].signature.columns,
        );
    }
    taken
}

fn part(
    information: &DMatrix<f64>,
    score: &DVector<f64>,
    columns: &[usize],
) -> (DMatrix<f64>, DVector<f64>) {
    let count = columns.len();
    (
        DMatrix::from_fn(count, count, |i, j| information[(columns[i], columns[j])]),
        DVector::from_fn(count, |i, _| score[columns[i]]),
    )
}

/// Scores and information beside columns that are in the model.
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
