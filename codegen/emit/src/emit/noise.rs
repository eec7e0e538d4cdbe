//! Noise inputs that enter the rates exactly as parameters do.

use crate::ir::{Expressions, NodeId};
use crate::program::Output;

/// For each noise input the first parameter whose column of the Jacobian is the same
/// expressions in the same rows, if there is one for every input.
///
/// Expressions are hash-consed, so equal nodes are equal expressions; an input that does
/// not enter at all is no match.
pub(super) fn parameters(
    jacobian: &Expressions,
    parameters: (usize, &Output),
    noise: (usize, &Output),
) -> Option<Vec<usize>> {
    let column = |(index, output): (usize, &Output), column: usize| {
        let mut entries: Vec<(usize, NodeId)> = output
            .nonzeros
            .iter()
            .zip(&jacobian.outputs[index])
            .filter(|((_, of), _)| *of == column)
            .map(|(&(row, _), &node)| (row, node))
            .collect();
        entries.sort_unstable();
        entries
    };
    let candidates: Vec<_> = (0..parameters.1.columns)
        .map(|index| column(parameters, index))
        .collect();
    (0..noise.1.columns)
        .map(|index| {
            let entries = column(noise, index);
            candidates
                .iter()
                .position(|candidate| !entries.is_empty() && *candidate == entries)
        })
        .collect()
}
