//! Prediction of another record of the same platform with the nominal and the extended model.

use gyrocal::trajectory::{Orientation, rotation_between};
use gyrocal_calibration::{CalibrationError, Expectation, FittedPlatform, Run};
use gyrocal_hypothesis::ModelExtension;
use gyrocal_record::Record;

use super::continued_parameters::{ContinuedParameters, factor};

/// Horizon of the prediction, s; the length of the record if that is shorter.
const HORIZON_S: f64 = 86_400.0;

/// Points of a prediction.
const POINTS: usize = 24;

/// Largest number of starts of predictions, and their least distance, s.
const MOST_STARTS: usize = 9;
const BETWEEN_STARTS_S: f64 = 3.0 * 3600.0;

/// One radian in arc minutes.
const ARCMIN: f64 = 60.0 * 180.0 / core::f64::consts::PI;

/// Prediction of another record with the nominal and the extended model of a first one.
#[derive(Clone, Debug, PartialEq)]
pub struct LaterPrediction {
    /// Predictive log score of the whole record given the first one, nats: nominal, extended.
    pub log_score_nats: [f64; 2],
    /// Error of the predicted attitude.
    pub attitude: AttitudeErrors,
}

/// Attitude of a platform that is compensated by the coefficients of another record, against the attitude from
/// its own accelerometers: root mean squares of the angle between them, arc minutes,
/// over several starts.
#[derive(Clone, Debug, PartialEq)]
pub struct AttitudeErrors {
    /// Number of starts.
    pub starts: usize,
    /// Time since the start, s: zero, then rising to a day or the length of the record.
    pub time_s: Vec<f64>,
    /// With the coefficients of the nominal model.
    pub nominal_arcmin: Vec<f64>,
    /// With those of the extended model.
    pub extended_arcmin: Vec<f64>,
    /// Expected error, from the covariances of the extended model and of the later record's own fit
    /// and the noise of the gyros.
    pub expected_arcmin: Vec<f64>,
}

impl LaterPrediction {
    /// Gain of the extended model in predictive log score, nats.
    #[must_use]
    pub fn gain_nats(&self) -> f64 {
        self.log_score_nats[1] - self.log_score_nats[0]
    }
}

impl AttitudeErrors {
    /// Nominal, extended and expected error at the end, arc minutes.
    #[must_use]
    pub fn at_end_arcmin(&self) -> [f64; 3] {
        [
            &self.nominal_arcmin,
            &self.extended_arcmin,
            &self.expected_arcmin,
        ]
        .map(|values| values.last().copied().unwrap_or(f64::NAN))
    }
}

/// Predicts a later record with two models of a first one; `fitted` is the nominal model of the later
/// record at its best fit.
///
/// The attitude of the later record is that of a fit of its own, in which all parameters that
/// either model has are free: nothing of the first record is in it.
///
/// # Errors
/// [`CalibrationError::Pass`] and [`CalibrationError::NotPositiveDefinite`].
pub(crate) fn predict(
    nominal: &FittedPlatform<'_>,
    extended: &FittedPlatform<'_>,
    first: &Run<'_>,
    fitted: &FittedPlatform<'_>,
    later: &Run<'_>,
) -> Result<LaterPrediction, CalibrationError> {
    let continued = |fit| ContinuedParameters::new(fit, first, later.record);
    let (of_nominal, of_extended) = (continued(nominal)?, continued(extended)?);
    let own = own_fit(fitted, first.record, &of_extended)?;
    let expected = [
        of_nominal.expectation(nominal)?,
        of_extended.expectation(extended)?,
    ];
    Ok(LaterPrediction {
        log_score_nats: [
            own.log_density_given(&expected[0])?,
            own.log_density_given(&expected[1])?,
        ],
        attitude: attitude_errors(&own, &expected, &later.record.time_s)?,
    })
}

/// The later record's own fit, with all that the extended model says it may show.
fn own_fit<'b>(
    fitted: &FittedPlatform<'b>,
    first: &Record,
    continued_parameters: &ContinuedParameters,
) -> Result<FittedPlatform<'b>, CalibrationError> {
    let mut extension = ModelExtension {
        shapes: continued_parameters.shapes.clone(),
        ..fitted.extension().clone()
    };
    let plain = extension.clone();
    for parameter in continued_parameters.parameters() {
        if !extension.parameters.iter().any(|(p, _)| *p == parameter) {
            extension.parameters.push((parameter, f64::INFINITY));
        }
    }
    // What the later record cannot show is not free in it.
    fitted
        .refitted_with_play_of(&extension, first)
        .or_else(|_| fitted.refitted_with_play_of(&plain, first))
}

fn attitude_errors(
    own: &FittedPlatform<'_>,
    [nominal, extended]: &[Expectation; 2],
    time_s: &[f64],
) -> Result<AttitudeErrors, CalibrationError> {
    let first_s = time_s.first().copied().unwrap_or(0.0);
    let last_s = time_s.last().copied().unwrap_or(0.0);
    let horizon_s = HORIZON_S.min(last_s - first_s);
    let spare_s = (last_s - first_s - horizon_s).max(0.0);
    let starts = (1 + (spare_s / BETWEEN_STARTS_S) as usize).min(MOST_STARTS);
    let walk = own.walk_rad2_per_s().iter().sum::<f64>();
    let of_own = factor(own)?;
    let mut squares = [[0.0; 3]; POINTS + 1];
    for start in 0..starts {
        let from_s = first_s + spare_s * start as f64 / (starts.max(2) - 1) as f64;
        let from = time_s.partition_point(|t| *t < from_s);
        let from_s = time_s[from];
        let places: [usize; POINTS + 1] = core::array::from_fn(|point| {
            let at_s = from_s + horizon_s * point as f64 / POINTS as f64;
            // Half a second: sums of intervals are not exact.
            let row = time_s.partition_point(|t| *t < at_s - 0.5);
            row.min(time_s.len() - 1) - from
        });
        let rows = from..from + places[POINTS] + 1;
        let drift = |parameters: &[f64]| own.drift_from(parameters, rows.clone());
        let truth = &own.points()[rows.clone()];
        let predicted = drift(&extended.mean)?;
        add(&mut squares, 0, &places, &drift(&nominal.mean)?, truth);
        add(&mut squares, 1, &places, &predicted, truth);
        for column in extended.factor.column_iter().chain(of_own.column_iter()) {
            if column.iter().all(|x| *x == 0.0) {
                continue;
            }
            let moved: Vec<f64> = extended
                .mean
                .iter()
                .zip(column.iter())
                .map(|(mean, sigma)| mean + sigma)
                .collect();
            add(&mut squares, 2, &places, &drift(&moved)?, &predicted);
        }
        for (square, place) in squares.iter_mut().zip(places) {
            square[2] += walk * (time_s[from + place] - from_s);
        }
    }
    let curve = |which: usize| {
        squares
            .iter()
            .map(|square| ARCMIN * (square[which] / starts as f64).sqrt())
            .collect()
    };
    Ok(AttitudeErrors {
        starts,
        time_s: (0..=POINTS)
            .map(|point| horizon_s * point as f64 / POINTS as f64)
            .collect(),
        nominal_arcmin: curve(0),
        extended_arcmin: curve(1),
        expected_arcmin: curve(2),
    })
}

/// Adds the squares of the angles between two trajectories at some places.
fn add(
    squares: &mut [[f64; 3]; POINTS + 1],
    which: usize,
    places: &[usize; POINTS + 1],
    one: &[Orientation],
    other: &[Orientation],
) {
    for (square, place) in squares.iter_mut().zip(places) {
        let turn = rotation_between(&one[*place], &other[*place]);
        square[which] += turn.iter().map(|angle| angle * angle).sum::<f64>();
    }
}
