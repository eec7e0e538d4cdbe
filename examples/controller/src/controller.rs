//! The controller: filter, compensation and what it tells of itself.

use gyrocal::generated::platform::drift_rate;
use gyrocal::{ControllerError, ControllerFilter, FilterSettings, InitialAttitude, Limits, Site};

use crate::accelerometers::INTERVAL_S;
use crate::health::Health;
use crate::kept::Kept;

/// How the start went.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Start {
    /// From the prior.
    Cold,
    /// From a saved state.
    Warm,
}

/// What a minute gave.
pub(crate) struct Answer {
    /// Commands to the torquers of x, y and z, deg/h.
    pub(crate) rate_command_deg_per_h: [f32; 3],
    /// Why the sample was not used, if it was not.
    pub(crate) refused: Option<ControllerError>,
}

/// All of it; a static.
pub(crate) struct Controller {
    filter: ControllerFilter,
    health: Health,
    sample_g: [f32; 3],
}

impl Controller {
    pub(crate) const fn new() -> Self {
        Self {
            filter: ControllerFilter::unset(),
            health: Health::new(),
            sample_g: [0.0; 3],
        }
    }

    /// Starts, warm if a state was kept.
    pub(crate) fn start(&mut self, kept: &Kept) -> Result<Start, ControllerError> {
        let settings = FilterSettings::at_site(Site::at_latitude_deg(48.2));
        let attitude = InitialAttitude::Angles {
            angles_rad: [12.0, -25.0, 40.0].map(|degrees: f64| degrees.to_radians() as f32),
            sigma_rad: [0.01_f64.to_radians() as f32; 3],
        };
        self.filter.start(&settings, &attitude, Limits::default())?;
        match kept.restore(&mut self.filter) {
            Ok(()) => Ok(Start::Warm),
            Err(_) => Ok(Start::Cold),
        }
    }

    /// Takes the first sample after a cold start, which belongs to the initial attitude.
    pub(crate) fn first(&mut self, sample_g: &[f32; 3]) -> Result<(), ControllerError> {
        self.filter.update(sample_g)?;
        self.sample_g = *sample_g;
        Ok(())
    }

    /// A minute has passed.
    pub(crate) fn minute(&mut self, sample_g: &[f32; 3]) -> Result<Answer, ControllerError> {
        let refused = match self.filter.step(INTERVAL_S, sample_g) {
            Ok(innovation) => {
                self.health.add(innovation.nis);
                self.sample_g = *sample_g;
                None
            }
            // The filter has coasted over a sample that disagrees with its state; after an hour of them
            // it is the state that is wrong.
            Err(error) if error.has_coasted() => {
                if error == ControllerError::Diverged {
                    self.filter.reopen(sample_g)?;
                }
                Some(error)
            }
            // The sample has no meaning, and the minute has passed all the same.
            Err(error) if error.is_refusal() => {
                self.filter.coast(INTERVAL_S)?;
                Some(error)
            }
            Err(error) => return Err(error),
        };
        // At zero angles the axes are those of the platform.
        let drift = self.filter.filter().drift().to_array();
        let drift = drift_rate(&[0.0; 3], &drift, &self.sample_g);
        Ok(Answer {
            rate_command_deg_per_h: drift.map(|rate| -rate),
            refused,
        })
    }

    pub(crate) fn is_healthy(&self) -> bool {
        self.filter.is_running() && self.health.is_good()
    }

    pub(crate) fn filter(&self) -> &ControllerFilter {
        &self.filter
    }
}
