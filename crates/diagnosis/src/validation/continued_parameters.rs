//! Prediction of the parameters of a later record of the same platform from a fit to one record.

use core::f64::consts::SQRT_2;

use gyrocal::generated::catalogue::PARAMETERS;
use gyrocal_calibration::{
    BIASES, CalibrationError, Expectation, FittedPlatform, PLATFORM, REGRESSORS, Run, WalkEnd,
    regressor_means,
};
use gyrocal_hypothesis::{Column, Phase, RecordOffset, continued, continued_shapes};
use gyrocal_record::Record;
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::COEFFICIENTS;

/// Linear map from the values of a fit to the parameters of a later record.
///
/// Terms of specific force, temperature and site stay as they are. A warm-up begins anew with the
/// record. A step and a random walk leave the drift where they brought it, ageing goes on. A knock
/// and an error of the first attitude belong to their record. A wave of 24 h goes on if the clock
/// of the records does.
pub(crate) struct ContinuedParameters {
    /// A row for each parameter of the catalogue, a column for each value of the fit.
    map: DMatrix<f64>,
    /// Constant drifts that walk, with the time until the later record, s.
    walks: Vec<(WalkEnd, f64)>,
    /// Standard deviation that a new turn-on adds to each constant drift, deg/h.
    turn_on: [f64; 3],
    /// Onsets and time constants as the later record has them.
    pub(crate) shapes: Vec<f64>,
}

impl ContinuedParameters {
    /// From a fit to a record to a later record.
    ///
    /// # Errors
    /// [`CalibrationError::Pass`].
    pub(crate) fn new(
        fit: &FittedPlatform<'_>,
        first: &Run<'_>,
        later: &Record,
    ) -> Result<Self, CalibrationError> {
        let extension = fit.extension();
        let further = extension.columns.columns();
        let values = COEFFICIENTS + extension.parameters.len() + further.len();
        let mut map = DMatrix::zeros(PARAMETERS.len(), values);
        for coefficient in 0..COEFFICIENTS {
            map[(coefficient, coefficient)] = 1.0;
        }
        let offset = offset_between(first.record, later);
        for (place, (parameter, _)) in extension.parameters.iter().enumerate() {
            for (target, factor) in continued(&PLATFORM, *parameter, &offset) {
                map[(target, COEFFICIENTS + place)] += factor;
            }
        }
        let base = COEFFICIENTS + extension.parameters.len();
        for (offset, column) in further.iter().enumerate() {
            if let Column::Step { parameter, .. } = column {
                map[(*parameter, base + offset)] = 1.0;
            }
        }
        let until_s = offset.elapsed_s - first.record.duration_s();
        let walks = fit.walk_ends()?.into_iter();
        let walks: Vec<(WalkEnd, f64)> = walks.map(|end| (end, until_s.max(0.0))).collect();
        for (end, _) in &walks {
            for (value, derivative) in end.by_values.iter().enumerate() {
                map[(end.parameter, value)] += derivative;
            }
        }
        Ok(Self {
            map,
            walks,
            turn_on: first.bench.prior.turn_on_sigma_deg_per_h,
            shapes: continued_shapes(&PLATFORM, &extension.all_shapes(&PLATFORM), &offset),
        })
    }

    /// Parameters of the catalogue, beyond the nine, that the later record may show.
    pub(crate) fn parameters(&self) -> impl Iterator<Item = usize> {
        (COEFFICIENTS..PARAMETERS.len())
            .filter(|parameter| self.map.row(*parameter).iter().any(|share| *share != 0.0))
    }

    /// Mean and covariance of the parameters of the later record.
    ///
    /// # Errors
    /// [`CalibrationError::NotPositiveDefinite`].
    pub(crate) fn expectation(
        &self,
        fit: &FittedPlatform<'_>,
    ) -> Result<Expectation, CalibrationError> {
        let values = DVector::from_column_slice(fit.values());
        let cholesky =
            Cholesky::new(fit.covariance().clone()).ok_or(CalibrationError::NotPositiveDefinite)?;
        let known = &self.map * cholesky.l();
        let walks = self.walks.len();
        let mut factor = known.clone().insert_columns(known.ncols(), 3 + walks, 0.0);
        let mut mean = &self.map * &values;
        for (place, (end, until_s)) in self.walks.iter().enumerate() {
            let variance = end.sigma.powi(2) + end.density * until_s;
            factor[(end.parameter, known.ncols() + 3 + place)] = variance.sqrt();
            // The derivatives are of differences from the fit.
            let by_values = DVector::from_column_slice(&end.by_values);
            mean[end.parameter] += end.change - by_values.dot(&values);
        }
        for (axis, bias) in BIASES.into_iter().enumerate() {
            // One turn-on from the mean to this record, one from it to the other.
            factor[(bias, known.ncols() + axis)] = SQRT_2 * self.turn_on[axis];
        }
        Ok(Expectation {
            mean: mean.iter().copied().collect(),
            factor,
        })
    }
}

/// Clocks and thermometers of two records. A clock that began again says nothing: the later record
/// then counts as if it followed the first at once.
fn offset_between(first: &Record, later: &Record) -> RecordOffset {
    let ends = |record: &Record| {
        let first_s = record.time_s.first().copied().unwrap_or(0.0);
        [first_s, record.time_s.last().copied().unwrap_or(first_s)]
    };
    let ([from_s, to_s], [later_s, _]) = (ends(first), ends(later));
    let goes_on = later_s > to_s;
    RecordOffset {
        elapsed_s: if goes_on { later_s } else { to_s } - from_s,
        phase: if goes_on {
            Phase::Elapsed
        } else {
            Phase::Unknown
        },
        regressors: match (regressor_means(first, first), regressor_means(later, first)) {
            (Some(first), Some(later)) => (0..REGRESSORS).map(|i| later[i] - first[i]).collect(),
            _ => vec![0.0; REGRESSORS],
        },
    }
}

/// The factor of what a fit knows of its own parameters: a row for each parameter of the catalogue.
///
/// # Errors
/// [`CalibrationError::NotPositiveDefinite`].
pub(crate) fn factor(fit: &FittedPlatform<'_>) -> Result<DMatrix<f64>, CalibrationError> {
    let cholesky =
        Cholesky::new(fit.covariance().clone()).ok_or(CalibrationError::NotPositiveDefinite)?;
    let own = cholesky.l();
    let further = fit.extension().parameters.iter();
    let places = (0..COEFFICIENTS).chain(further.map(|(parameter, _)| *parameter));
    let mut factor = DMatrix::zeros(PARAMETERS.len(), own.ncols());
    for (value, parameter) in places.enumerate() {
        factor.set_row(parameter, &own.row(value));
    }
    Ok(factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Parameters of a later record that one of a first record becomes, with their factors.
    fn continued_as(id: &str, offset: &RecordOffset) -> Vec<(&'static str, f64)> {
        let index = PARAMETERS.iter().position(|p| p.id == id);
        let mut found = continued(&PLATFORM, index.unwrap_or(usize::MAX), offset);
        found.sort_by_key(|(index, _)| *index);
        let named = found.into_iter();
        named
            .map(|(index, factor)| (PARAMETERS[index].id, factor))
            .collect()
    }

    /// To rounding of the least squares that the factors come from.
    fn assert_continued(id: &str, offset: &RecordOffset, expected: &[(&str, f64)]) {
        let found = continued_as(id, offset);
        let same = found.len() == expected.len()
            && found.iter().zip(expected).all(|(found, expected)| {
                found.0 == expected.0 && (found.1 - expected.1).abs() < 1e-12 * expected.1.abs()
            });
        assert!(same, "{id}: {found:?}, expected {expected:?}");
    }

    /// A record of an hour with this first row.
    fn record(from_s: f64, temperature_c: f64) -> Record {
        Record {
            time_s: vec![from_s, from_s + 3600.0],
            accel_g: vec![[0.0, 0.0, 1.0]; 2],
            temperature_c: Some(vec![temperature_c; 2]),
        }
    }

    #[test]
    fn what_changed_stays_and_what_ages_goes_on() {
        // Two days and six hours later, three kelvin warmer.
        let (first, later) = (record(100.0, 20.0), record(100.0 + 2.25 * 86_400.0, 23.0));
        let offset = offset_between(&first, &later);
        assert_continued("gyro_y.step", &offset, &[("gyro_y.bias", 1.0)]);
        assert_continued("gyro_x.g_y", &offset, &[("gyro_x.g_y", 1.0)]);
        assert_continued("gyro_z.warmup", &offset, &[("gyro_z.warmup", 1.0)]);
        let ramp = [("gyro_x.bias", 2.25), ("gyro_x.ramp", 1.0)];
        assert_continued("gyro_x.ramp", &offset, &ramp);
        let warmer = [("accel_x.bias", 3.0), ("accel_x.temperature", 1.0)];
        assert_continued("accel_x.temperature", &offset, &warmer);
        // (t + 3)² = t² + 6 t + 9.
        let square = [
            ("accel_x.bias", 9.0),
            ("accel_x.temperature", 6.0),
            ("accel_x.temperature_square", 1.0),
        ];
        assert_continued("accel_x.temperature_square", &offset, &square);
        let of_gyro = [
            ("gyro_y.bias", 9.0),
            ("gyro_y.temperature", 6.0),
            ("gyro_y.temperature_square", 1.0),
        ];
        assert_continued("gyro_y.temperature_square", &offset, &of_gyro);
        for itself in ["gyro_z.temperature_rate", "gyro_z.temperature_hysteresis"] {
            assert_continued(itself, &offset, &[(itself, 1.0)]);
        }
    }

    #[test]
    fn a_wave_of_a_day_goes_on_in_phase() {
        let offset = offset_between(&record(0.0, 20.0), &record(2.25 * 86_400.0, 20.0));
        // A quarter of a day on: sin(x + 90°) = cos x, cos(x + 90°) = -sin x.
        let cosine = [("gyro_x.diurnal.cosine", 1.0)];
        assert_continued("gyro_x.diurnal.sine", &offset, &cosine);
        let sine = [("gyro_x.diurnal.sine", -1.0)];
        assert_continued("gyro_x.diurnal.cosine", &offset, &sine);
        // A clock that began again has lost its phase.
        let again = offset_between(&record(0.0, 20.0), &record(0.0, 20.0));
        assert_continued("gyro_x.diurnal.sine", &again, &[]);
    }
}
