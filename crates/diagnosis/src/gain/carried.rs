//! What a fit to one record says of a later record of the same platform.

use core::f64::consts::{SQRT_2, TAU};

use gyrocal::generated::catalogue::{PARAMETERS, SHAPES};
use gyrocal_calibration::{BIASES, CalibrationError, Column, Expectation, Extended, Run};
use gyrocal_record::Record;
use nalgebra::{Cholesky, DMatrix, DVector};

use crate::COEFFICIENTS;

const SECONDS_PER_DAY: f64 = 86_400.0;

/// How the parameters of a later record follow from the values of a fit.
///
/// Terms of specific force, temperature and site stay as they are. A warm-up begins anew with the
/// record. A step and a random walk leave the drift where they brought it, ageing goes on. A knock
/// and an error of the first attitude belong to their record. A wave of 24 h goes on if the clock
/// of the records does.
pub(crate) struct Carried {
    /// A row for each parameter of the catalogue, a column for each value of the fit.
    map: DMatrix<f64>,
    /// Standard deviation that a new turn-on adds to each constant drift, deg/h.
    turn_on: [f64; 3],
}

impl Carried {
    /// From a fit to a record to a later record.
    pub(crate) fn new(fit: &Extended<'_>, first: &Run<'_>, later: &Record) -> Self {
        let extension = fit.extension();
        let further = extension.further.columns();
        let values = COEFFICIENTS + extension.parameters.len() + further.len();
        let mut map = DMatrix::zeros(PARAMETERS.len(), values);
        for coefficient in 0..COEFFICIENTS {
            map[(coefficient, coefficient)] = 1.0;
        }
        let clock = Clock::new(first.record, later);
        for (offset, (parameter, _)) in extension.parameters.iter().enumerate() {
            carry(&mut map, *parameter, COEFFICIENTS + offset, &clock);
        }
        let base = COEFFICIENTS + extension.parameters.len();
        for (offset, column) in further.iter().enumerate() {
            if let Column::Onset { parameter, .. } = column {
                map[(*parameter, base + offset)] = 1.0;
            }
        }
        Self {
            map,
            turn_on: first.bench.prior.turn_on_sigma_deg_per_h,
        }
    }

    /// Parameters of the catalogue, beyond the nine, that the later record may show.
    pub(crate) fn parameters(&self) -> impl Iterator<Item = usize> {
        (COEFFICIENTS..PARAMETERS.len())
            .filter(|parameter| self.map.row(*parameter).iter().any(|share| *share != 0.0))
    }

    /// What is known of them.
    ///
    /// # Errors
    /// [`CalibrationError::NotPositiveDefinite`].
    pub(crate) fn expectation(&self, fit: &Extended<'_>) -> Result<Expectation, CalibrationError> {
        let values = DVector::from_column_slice(fit.values());
        let cholesky =
            Cholesky::new(fit.covariance().clone()).ok_or(CalibrationError::NotPositiveDefinite)?;
        let known = &self.map * cholesky.l();
        let mut factor = known.clone().insert_columns(known.ncols(), 3, 0.0);
        for (axis, bias) in BIASES.into_iter().enumerate() {
            // One turn-on from the mean to this record, one from it to the other.
            factor[(bias, known.ncols() + axis)] = SQRT_2 * self.turn_on[axis];
        }
        Ok(Expectation {
            mean: (&self.map * values).iter().copied().collect(),
            factor,
        })
    }
}

/// The factor of what a fit knows of its own parameters: a row for each parameter of the catalogue.
///
/// # Errors
/// [`CalibrationError::NotPositiveDefinite`].
pub(crate) fn factor(fit: &Extended<'_>) -> Result<DMatrix<f64>, CalibrationError> {
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

/// Shapes that a later record has too: time constants, as onsets are past.
pub(crate) fn shapes(fit: &Extended<'_>) -> [f64; SHAPES.len()] {
    fit.extension().shapes
}

/// What the clocks and thermometers of two records say of each other.
struct Clock {
    /// From the first row of the first record to that of the later one, s.
    elapsed_s: f64,
    /// Whether that is read from one clock.
    goes_on: bool,
    /// Mean temperature of the later record less that of the first, K.
    warmer_k: f64,
}

impl Clock {
    fn new(first: &Record, later: &Record) -> Self {
        let ends = |record: &Record| {
            let first_s = record.time_s.first().copied().unwrap_or(0.0);
            [first_s, record.time_s.last().copied().unwrap_or(first_s)]
        };
        let ([from_s, to_s], [later_s, _]) = (ends(first), ends(later));
        let goes_on = later_s > to_s;
        let mean = |record: &Record| {
            let logged = record.temperature_c.as_ref()?;
            Some(logged.iter().sum::<f64>() / logged.len().max(1) as f64)
        };
        Self {
            // A clock that began again says nothing: as if one record followed the other.
            elapsed_s: if goes_on { later_s } else { to_s } - from_s,
            goes_on,
            warmer_k: match (mean(first), mean(later)) {
                (Some(first), Some(later)) => later - first,
                _ => 0.0,
            },
        }
    }
}

/// Sets the column of one parameter of the first record.
fn carry(map: &mut DMatrix<f64>, parameter: usize, column: usize, clock: &Clock) {
    let id = PARAMETERS[parameter].id;
    let (channel, term) = id.split_once('.').unwrap_or((id, ""));
    let constant = format!("{channel}.bias");
    let constant = PARAMETERS.iter().position(|p| p.id == constant);
    let mut set = |row: Option<usize>, share: f64| {
        if let Some(row) = row {
            map[(row, column)] += share;
        }
    };
    match term {
        "step" => set(constant, 1.0),
        "ramp" => {
            set(Some(parameter), 1.0);
            set(constant, clock.elapsed_s / SECONDS_PER_DAY);
        }
        "temperature" => {
            set(Some(parameter), 1.0);
            set(constant, clock.warmer_k);
        }
        "diurnal.sine" | "diurnal.cosine" => {
            if clock.goes_on {
                let (sine, cosine) = (TAU * clock.elapsed_s / SECONDS_PER_DAY).sin_cos();
                let other = |name: &str| {
                    let id = format!("{channel}.{name}");
                    PARAMETERS.iter().position(|p| p.id == id)
                };
                let (own_sine, own_cosine) = (other("diurnal.sine"), other("diurnal.cosine"));
                if term == "diurnal.sine" {
                    set(own_sine, cosine);
                    set(own_cosine, sine);
                } else {
                    set(own_sine, -sine);
                    set(own_cosine, cosine);
                }
            }
        }
        _ => set(Some(parameter), 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Shares of the parameters of a later record in one parameter of a first record.
    fn carried(id: &str, clock: &Clock) -> Vec<(&'static str, f64)> {
        let place = |id: &str| PARAMETERS.iter().position(|p| p.id == id);
        let mut map = DMatrix::zeros(PARAMETERS.len(), 1);
        carry(&mut map, place(id).unwrap_or(usize::MAX), 0, clock);
        let shares = map.iter().enumerate().filter(|(_, share)| **share != 0.0);
        shares
            .map(|(row, share)| (PARAMETERS[row].id, *share))
            .collect()
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
        let clock = Clock::new(&record(100.0, 20.0), &record(100.0 + 2.25 * 86_400.0, 23.0));
        assert_eq!(carried("gyro_y.step", &clock), [("gyro_y.bias", 1.0)]);
        assert_eq!(carried("gyro_x.g_y", &clock), [("gyro_x.g_y", 1.0)]);
        assert_eq!(carried("gyro_z.warmup", &clock), [("gyro_z.warmup", 1.0)]);
        assert_eq!(
            carried("gyro_x.ramp", &clock),
            [("gyro_x.bias", 2.25), ("gyro_x.ramp", 1.0)]
        );
        assert_eq!(
            carried("accel_x.temperature", &clock),
            [("accel_x.bias", 3.0), ("accel_x.temperature", 1.0)]
        );
    }

    #[test]
    fn a_wave_of_a_day_goes_on_in_phase() {
        let clock = Clock::new(&record(0.0, 20.0), &record(2.25 * 86_400.0, 20.0));
        // A quarter of a day on: sin(x + 90°) = cos x, cos(x + 90°) = -sin x.
        let near = |found: &[(&str, f64)], id: &str| {
            found
                .iter()
                .find(|(other, _)| *other == id)
                .map_or(0.0, |(_, share)| *share)
        };
        let sine = carried("gyro_x.diurnal.sine", &clock);
        let cosine = carried("gyro_x.diurnal.cosine", &clock);
        // Sine and cosine of a few turns: roundings of 1e-16.
        assert!(
            (near(&sine, "gyro_x.diurnal.cosine") - 1.0).abs() < 1e-14,
            "{sine:?}"
        );
        assert!(
            (near(&cosine, "gyro_x.diurnal.sine") + 1.0).abs() < 1e-14,
            "{cosine:?}"
        );
        // A clock that began again has lost its phase.
        let again = Clock::new(&record(0.0, 20.0), &record(0.0, 20.0));
        assert_eq!(carried("gyro_x.diurnal.sine", &again), []);
    }
}
