//! Reduction of a log to means over blocks of equal length.

use nalgebra::{DMatrix, DVector, Rotation3, Unit, Vector3};

use crate::earth_rate::deg_per_h;
use crate::error::{InstrumentError, Unfit};
use crate::log::Log;

/// Means of one log over blocks.
#[derive(Debug, Clone)]
pub(super) struct Blocks {
    /// Length of a block.
    pub(super) block_s: f64,
    /// Middle of each block.
    pub(super) time_s: Vec<f64>,
    /// Mean outputs of the gyros \[rad/s\].
    pub(super) rate: Vec<Vector3<f64>>,
    /// Mean specific force over its norm; zero of gyros alone.
    pub(super) up: Vec<Vector3<f64>>,
    /// Mean temperature \[degrees Celsius\].
    pub(super) temperature_c: Option<Vec<f64>>,
    /// Vertical part of Earth rate \[deg/h\].
    pub(super) vertical_deg_per_h: f64,
    /// Mean rate of the turntable in body axes \[rad/s\].
    pub(super) table: Option<Vec<Vector3<f64>>>,
    /// `true` if the axis of the table is that of specific force, with its error.
    axis_is_up: bool,
    /// Two horizontal directions in body axes at right angles, as the table turns them; means over blocks. Zero of gyros
    /// alone.
    pub(super) horizontal: [Vec<Vector3<f64>>; 2],
    /// Mean specific force of the log over its norm; zero of gyros alone.
    pub(super) mean_up: Vector3<f64>,
}

/// Largest angle between specific force of a block and of the log.
const LARGEST_TILT_DEG: f64 = 10.0;

impl Blocks {
    /// Reduces a log to at most `count` blocks; samples that fill no block are left out at the end.
    pub(super) fn of(
        log: &Log,
        count: usize,
        table_axis: Option<[f64; 3]>,
        vertical_deg_per_h: f64,
    ) -> Result<Self, InstrumentError> {
        let length = (log.len() / count).max(1);
        let means = |of: &dyn Fn(usize) -> Vector3<f64>| -> Vec<Vector3<f64>> {
            (0..log.len() / length)
                .map(|block| {
                    let samples = block * length..(block + 1) * length;
                    samples.map(of).sum::<Vector3<f64>>() / length as f64
                })
                .collect()
        };
        let of_force = |force: &Vec<[f64; 3]>| means(&|sample| Vector3::from(force[sample]));
        let force = log.accel.as_ref().map(of_force);
        let needs_axis = log.table_rate.is_some() && table_axis.is_none();
        if force.is_none() && needs_axis {
            return Err(no_axis());
        }
        let mean_up = force.as_ref().map_or_else(Vector3::zeros, |force| {
            force.iter().sum::<Vector3<f64>>().normalize()
        });
        let up: Vec<Vector3<f64>> = match &force {
            Some(force) => force.iter().map(|force| force.normalize()).collect(),
            None => means(&|_| Vector3::zeros()),
        };
        if force.is_some() {
            refuse_turned(&up, &mean_up)?;
        }
        let axis = table_axis.map_or(mean_up, |axis| Vector3::from(axis).normalize());
        let scalar = |values: &[f64]| -> Vec<f64> {
            let of = |sample: usize| Vector3::new(values[sample], 0.0, 0.0);
            means(&of).into_iter().map(|mean| mean.x).collect()
        };
        let angles = table_angles(log);
        let east = mean_up.cross(&least_along(&mean_up));
        let east = east.try_normalize(0.0).unwrap_or_else(Vector3::zeros);
        let horizontal = [east, mean_up.cross(&east)].map(|direction| {
            means(&|sample| match &angles {
                // What is fixed to the Earth turns against the table in body axes.
                Some(angles) => turned(&axis, -angles[sample]) * direction,
                None => direction,
            })
        });
        Ok(Self {
            block_s: length as f64 * log.interval_s,
            time_s: scalar(&log.time_s),
            rate: means(&|sample| Vector3::from(log.gyro[sample])),
            temperature_c: log.temperature_c.as_deref().map(scalar),
            vertical_deg_per_h,
            axis_is_up: table_axis.is_none(),
            table: log.table_rate.as_deref().map(|rates| {
                let along = scalar(rates);
                along.into_iter().map(|rate| rate * axis).collect()
            }),
            up,
            horizontal,
            mean_up,
        })
    }

    /// Number of blocks.
    pub(super) fn len(&self) -> usize {
        self.time_s.len()
    }

    /// Covariance of the means of a gyro that the unknown heading makes, for a horizontal rate of one.
    pub(super) fn of_heading(&self, gyro: usize) -> DMatrix<f64> {
        let mut sum = DMatrix::zeros(self.len(), self.len());
        for direction in &self.horizontal {
            let along = DVector::from_iterator(self.len(), direction.iter().map(|d| d[gyro]));
            sum += 0.5 * &along * along.transpose();
        }
        sum
    }

    /// Covariance of the means of a gyro \[deg²/h²\] that an error of the level of `sigma_rad` makes, where
    /// specific force stands for the axis of the table.
    pub(super) fn of_level(&self, gyro: usize, sigma_rad: f64) -> Option<DMatrix<f64>> {
        let table = self.table.as_ref().filter(|_| self.axis_is_up)?;
        let across = sigma_rad * sigma_rad * (1.0 - self.mean_up[gyro].powi(2)).max(0.0);
        let rates = table.iter().map(|rate| deg_per_h(rate.dot(&self.mean_up)));
        let rates = DVector::from_iterator(self.len(), rates);
        Some(across * &rates * rates.transpose())
    }
}

/// Angle of the table at each sample, from the beginning.
pub(super) fn table_angles(log: &Log) -> Option<Vec<f64>> {
    let mut angle = 0.0;
    let rates = log.table_rate.as_ref()?;
    let angles = rates.iter().map(|rate| {
        angle += rate * log.interval_s;
        angle
    });
    Some(angles.collect())
}

fn turned(axis: &Vector3<f64>, angle: f64) -> Rotation3<f64> {
    Rotation3::from_axis_angle(&Unit::new_normalize(*axis), angle)
}

/// The axis of the body that a direction is farthest from.
fn least_along(direction: &Vector3<f64>) -> Vector3<f64> {
    let mut axis = Vector3::zeros();
    axis[direction.iamin()] = 1.0;
    axis
}

fn no_axis() -> InstrumentError {
    InstrumentError::unfit(
        Unfit::NoAccelerometers,
        "a turntable without accelerometers, which tell its axis",
        "`axis` in `[table]`, or `[accel]`",
        "give the axis of the table in body axes, such as `axis = [0, 0, 1]`",
    )
}

fn refuse_turned(up: &[Vector3<f64>], mean_up: &Vector3<f64>) -> Result<(), InstrumentError> {
    let largest = up.iter().map(|up| up.angle(mean_up)).fold(0.0, f64::max);
    if largest.to_degrees() <= LARGEST_TILT_DEG {
        return Ok(());
    }
    Err(InstrumentError::unfit(
        Unfit::NeverStatic,
        format!(
            "specific force that turns by {:.0} deg",
            largest.to_degrees()
        ),
        format!("one attitude to gravity within {LARGEST_TILT_DEG} deg in each log"),
        "give a log of its own for each attitude, or use gyrocal tumble, which finds the stops of one log",
    ))
}
