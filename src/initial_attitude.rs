use gyrocal_estimation::EstimationError;
use gyrocal_scalar::Real;

use crate::anchor::Chart;
use crate::chart_vectors::ChartInputs;
use crate::settings::is_sigma;

/// Prior of the platform's attitude at the first sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InitialAttitude<T> {
    /// Platform angles against East-North-Up with independent errors. At theta_y = ±90° the angles
    /// leave one rotation open, which then counts as known: describe such an attitude by
    /// [`Self::Orientation`].
    Angles {
        /// Angles about x, then y, then z, rad.
        angles_rad: [T; 3],
        /// Their standard deviations, rad.
        sigma_rad: [T; 3],
    },
    /// Any attitude, described without angles.
    Orientation {
        /// Components of the unit vectors North and Up along the platform axes.
        north_and_up: [[T; 3]; 2],
        /// Standard deviations of the attitude's error as a rotation about the platform axes, rad.
        sigma_rad: [T; 3],
    },
}

/// Platform angles in a chart and their standard deviations: the first three states of a filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChartAngles<T> {
    /// Angles about x, then y, then z, rad.
    pub angles_rad: [T; 3],
    /// Their standard deviations, rad.
    pub sigma_rad: [T; 3],
}

impl<T: Real> InitialAttitude<T> {
    /// A platform aligned with East-North-Up to 0.01 deg about each axis.
    #[must_use]
    pub fn aligned() -> Self {
        Self::Angles {
            angles_rad: [T::from_f64(0.0); 3],
            sigma_rad: [T::from_f64(0.01_f64.to_radians()); 3],
        }
    }

    /// Checks that every number has a meaning: that all are finite, and sigmas and their squares positive.
    ///
    /// # Errors
    /// [`EstimationError::InvalidArgument`].
    pub fn check(&self) -> Result<(), EstimationError> {
        let finite = |number: &T| number.is_finite();
        let (all_finite, sigma_rad) = match self {
            Self::Angles {
                angles_rad,
                sigma_rad,
            } => (angles_rad.iter().all(finite), sigma_rad),
            Self::Orientation {
                north_and_up,
                sigma_rad,
            } => (north_and_up.as_flattened().iter().all(finite), sigma_rad),
        };
        if all_finite && sigma_rad.iter().all(|sigma| is_sigma(*sigma)) {
            return Ok(());
        }
        Err(EstimationError::InvalidArgument {
            expected: "an attitude that is finite, with sigmas that are positive and finite, as are their squares",
        })
    }

    /// Sets the orientation of a chart, which must be East-North-Up, and returns the platform
    /// angles in it: angles leave the chart as it is, an orientation becomes that of the chart.
    pub fn place<I: ChartInputs<T>>(&self, chart: &mut Chart<T, I>) -> ChartAngles<T> {
        match *self {
            Self::Angles {
                angles_rad,
                sigma_rad,
            } => ChartAngles {
                angles_rad,
                sigma_rad,
            },
            Self::Orientation {
                north_and_up,
                sigma_rad,
            } => {
                chart.set_orientation(&north_and_up);
                ChartAngles {
                    angles_rad: [T::from_f64(0.0); 3],
                    sigma_rad,
                }
            }
        }
    }
}
