//! Information of a run on the amplitudes of design columns, and their scores.

use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal::trajectory::Orientation;
use gyrocal_calibration::{CalibrationError, FittedPlatform, Options, PlannedRun, rows};
use gyrocal_hypothesis::FittedModel;
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
    /// Of a record, linearised about a fit.
    pub(crate) fn of_record(
        fitted: &FittedPlatform<'_>,
        record: &Record,
        columns: &[DesignColumn],
    ) -> Result<Self, CalibrationError> {
        let rows = rows(record, fitted.covariates());
        let further: Vec<_> = columns
            .iter()
            .filter_map(|column| column.column(&rows))
            .collect();
        let gram = fitted.signatures(&further, |_| ())?.gram;
        let own = fitted.extension().columns.columns().len();
        let mut next = 1 + PARAMETERS.len() + own;
        let places: Vec<usize> = columns
            .iter()
            .map(|column| match column {
                DesignColumn::Parameter(parameter) => 1 + parameter,
                DesignColumn::Fitted(index) => 1 + PARAMETERS.len() + index,
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
        let count = columns.len();
        Ok(Self {
            information: DMatrix::from_fn(count, count, |i, j| gram[(places[i], places[j])]),
            score: DVector::from_fn(count, |i, _| score_at(places[i])),
        })
    }
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
