//! Initial states of the records after the first: unknowns of the fit that the search does not know.

use nalgebra::{Cholesky, DMatrix};

use crate::error::PlantError;

/// Takes the last columns of a Gram matrix as unknowns with these values and standard deviations before
/// the records, and eliminates them.
pub(crate) fn eliminated(
    mut gram: DMatrix<f64>,
    values: &[f64],
    sigmas: &[f64],
) -> Result<DMatrix<f64>, PlantError> {
    let count = values.len();
    if count == 0 {
        return Ok(gram);
    }
    let kept = gram.nrows() - count;
    for (place, (value, sigma)) in values.iter().zip(sigmas).enumerate() {
        // The prior is one more row: of the residual -v/s, of the column -1/s.
        let weight = sigma.powi(-2);
        let column = kept + place;
        gram[(0, 0)] += weight * value * value;
        gram[(0, column)] += weight * value;
        gram[(column, 0)] += weight * value;
        gram[(column, column)] += weight;
    }
    let cross = gram.view((0, kept), (kept, count)).into_owned();
    let own = gram.view((kept, kept), (count, count)).into_owned();
    let solved = Cholesky::new(own)
        .ok_or(PlantError::Singular)?
        .solve(&cross.transpose());
    Ok(gram.view((0, 0), (kept, kept)) - cross * solved)
}
