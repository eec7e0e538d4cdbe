use gyrocal::{EstimationError, ExtensionFilter, FilterSettings, InitialAttitude, Precision};

use crate::extended::{Extended, ExtendedInputs, START};

/// Estimates the drift from accelerometer samples, and computes the commands of the torquers.
pub type Controller<T> = ExtensionFilter<T, Extended, ExtendedInputs<T>, { Extended::STATES }>;

/// A controller at the first sample, whose parameters of effects start at the values of the model file.
///
/// # Errors
/// [`EstimationError`] if the settings are refused.
pub fn controller<T: Precision>(
    settings: &FilterSettings<T>,
    attitude: &InitialAttitude<T>,
) -> Result<Controller<T>, EstimationError> {
    let start = START.iter().map(|start| [start.value, start.sigma]);
    Controller::new(Extended, start, settings, attitude)
}
