//! Information of a run on the amplitudes of design columns, and their scores.

use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal::trajectory::Orientation;
use gyrocal_calibration::{CalibrationError, FittedPlatform, Options, PlannedRun, rows};
use gyrocal_record::Record;
use nalgebra::{DMatrix, DVector};

use crate::design_column::{DesignColumn, RunColumns};

/// Information on the amplitudes of design columns, and the score where all of them, and all further
/// values of the fit, are zero.
#[derive(Clone, Debug)]
pub(crate) struct RunInformation {
    pub(crate) information: DMatrix<f64>,
    pub(crate) score: DVector<f64>,
}

impl RunInformation {
    /// Of the records of a fit, linearised about it; `record` is theirs, or
    /// [`gyrocal_calibration::joined_record`].
    pub(crate) fn of_record(
        fitted: &FittedPlatform<'_>,
        record: &Record,
        columns: &[DesignColumn],
    ) -> Result<Self, CalibrationError> {
        let rows = fitted.rows(record);
        let further: Vec<_> = columns
            .iter()
            .filter_map(|column| column.column(&rows))
            .collect();
        let [earlier, last] = fitted.earlier_and_last(&further)?;
        let own = fitted.extension().columns.columns().len();
        let places = places(columns, own);
        // What the fit has: its score was taken there and is wanted at zero.
        let further = &fitted.values()[fitted.values().len() - own..];
        let score_of = |gram: &DMatrix<f64>, mut values: Vec<f64>, place: usize| {
            values.extend_from_slice(further);
            let shift: f64 = values
                .iter()
                .enumerate()
                .map(|(index, value)| gram[(index + 1, place)] * value)
                .sum();
            // Columns are derivatives of the innovations, hence the sign.
            shift - gram[(0, place)]
        };
        let score = |i: usize| {
            let of_last = fitted.parameters_in(fitted.records() - 1);
            let of_last = score_of(&last, of_last, places[i]);
            if columns[i].is_of_last() || fitted.records() == 1 {
                return of_last;
            }
            of_last + score_of(&earlier, fitted.shared_parameters(), places[i])
        };
        let information = |i: usize, j: usize| {
            let at = (places[i], places[j]);
            if columns[i].is_of_last() || columns[j].is_of_last() {
                return last[at];
            }
            earlier[at] + last[at]
        };
        let count = columns.len();
        Ok(Self {
            information: DMatrix::from_fn(count, count, information),
            score: DVector::from_fn(count, |i, _| score(i)),
        })
    }
}

/// Places of design columns among those of a pass over the records of a fit, which has `own` further columns.
fn places(columns: &[DesignColumn], own: usize) -> Vec<usize> {
    let mut next = 1 + PARAMETERS.len() + own;
    let place = |column: &DesignColumn| match column {
        DesignColumn::Parameter(parameter) | DesignColumn::OfLast(parameter) => 1 + parameter,
        DesignColumn::Fitted(index) => 1 + PARAMETERS.len() + index,
        _ => {
            next += 1;
            next - 1
        }
    };
    columns.iter().map(place).collect()
}

/// Predicted information of a run on the amplitudes of design columns, from a row on.
pub(crate) fn predicted_information(
    run: &PlannedRun<'_>,
    columns: &[DesignColumn],
    first: usize,
    points: Vec<Orientation>,
    options: &Options,
) -> Result<DMatrix<f64>, CalibrationError> {
    let covariates = run.covariates(&points, options)?;
    let made = RunColumns::new(columns, &rows(run.run.record, covariates));
    let all = run.predicted_information(points, &made.active, &made.further, first, options)?;
    let count = columns.len();
    let value = |i: usize, j: usize| match (made.places[i], made.places[j]) {
        (Some(a), Some(b)) => all.information[(a, b)],
        // A column of the first record's rows is zero in this run.
        _ => 0.0,
    };
    Ok(DMatrix::from_fn(count, count, value))
}
