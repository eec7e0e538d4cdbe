//! What a run says of columns.

use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::{CalibrationError, Extended, Options, PlannedRun};
use gyrocal_record::Record;
use nalgebra::{DMatrix, DVector};

use super::piece::{Columns, Piece};

/// Information on the amplitudes of pieces, and the score where all of them, and all that the fit
/// has beyond, are zero.
#[derive(Clone, Debug)]
pub(crate) struct Said {
    pub(crate) information: DMatrix<f64>,
    pub(crate) score: DVector<f64>,
}

impl Said {
    /// By a record, linearised about a fit.
    pub(crate) fn of(
        fitted: &Extended<'_>,
        record: &Record,
        pieces: &[Piece],
    ) -> Result<Self, CalibrationError> {
        let further: Vec<_> = pieces
            .iter()
            .filter_map(|piece| piece.column(record))
            .collect();
        let gram = fitted.signatures(&further, |_| ())?.gram;
        let own = fitted.extension().further.columns().len();
        let mut next = 1 + PARAMETERS.len() + own;
        let places: Vec<usize> = pieces
            .iter()
            .map(|piece| match piece {
                Piece::Parameter(parameter) => 1 + parameter,
                Piece::Own(index) => 1 + PARAMETERS.len() + index,
                _ => {
                    next += 1;
                    next - 1
                }
            })
            .collect();
        // What the fit has: its score was taken there and is wanted at zero.
        let mut values = fitted.parameters();
        let amplitudes = fitted.values().len() - own;
        values.extend_from_slice(&fitted.values()[amplitudes..]);
        let score_at = |place: usize| {
            let shift: f64 = values
                .iter()
                .enumerate()
                .map(|(index, value)| gram[(index + 1, place)] * value)
                .sum();
            // Columns are derivatives of the innovations, hence the sign.
            shift - gram[(0, place)]
        };
        let count = pieces.len();
        Ok(Self {
            information: DMatrix::from_fn(count, count, |i, j| gram[(places[i], places[j])]),
            score: DVector::from_fn(count, |i, _| score_at(places[i])),
        })
    }
}

/// Information of a run that has not been made on the amplitudes of pieces, from a row on.
pub(crate) fn foreseen(
    run: &PlannedRun<'_>,
    pieces: &[Piece],
    first: usize,
    points: Vec<gyrocal::trajectory::Orientation>,
    options: &Options,
) -> Result<DMatrix<f64>, CalibrationError> {
    let columns = Columns::new(pieces, run.run.record);
    let all =
        run.predicted_information(points, &columns.active, &columns.further, first, options)?;
    let count = pieces.len();
    let value = |i: usize, j: usize| {
        let (a, b) = (columns.places[i], columns.places[j]);
        // One of a fit's own says nothing of a run that it is not of.
        if a == usize::MAX || b == usize::MAX {
            0.0
        } else {
            all.information[(a, b)]
        }
    };
    Ok(DMatrix::from_fn(count, count, value))
}
