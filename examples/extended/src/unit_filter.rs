use gyrocal::{EstimationError, ExtensionFilter, FilterSettings, InitialAttitude, Precision};

use crate::unit::{START, Unit, UnitInputs};

/// Estimates the errors of the outputs of a strapdown unit from accelerometer samples along the platform
/// that is computed from these outputs.
pub type UnitFilter<T> = ExtensionFilter<T, Unit, UnitInputs<T>, { Unit::STATES }>;

/// A filter at the first sample, whose parameters of effects start at the values of the model file.
///
/// # Errors
/// [`EstimationError`] if the settings are refused.
pub fn unit_filter<T: Precision>(
    settings: &FilterSettings<T>,
    attitude: &InitialAttitude<T>,
) -> Result<UnitFilter<T>, EstimationError> {
    let start = START.iter().map(|start| [start.value, start.sigma]);
    UnitFilter::new(Unit, start, settings, attitude)
}
