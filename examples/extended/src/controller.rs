use gyrocal::estimation::{ArrayStorage, Filter};
use gyrocal::scalar::{Model, NamedInputs};
use gyrocal::{
    Anchored, Chart, EstimationError, FilterSettings, InitialAttitude, Innovation, Platform,
    Precision,
};

use crate::extended::{Extended, ExtendedInputs, START};

/// The filter: three angles, the nine coefficients and the parameters of the effects.
pub type ExtendedFilter<T> = Filter<
    T,
    Anchored<Extended>,
    Chart<T, ExtendedInputs<T>>,
    ArrayStorage<T, 3, 3, { Extended::STATES }>,
    3,
    3,
>;

/// 1 rad/s in deg/h.
const DEG_PER_H: f64 = 3600.0 * 180.0 / core::f64::consts::PI;

/// Estimates the drift from accelerometer samples, and computes the commands of the torquers.
#[derive(Clone, Debug)]
pub struct Controller<T: Precision> {
    filter: ExtendedFilter<T>,
    accel_variance_g2: [T; 3],
    drift_density: [T; 3],
    time_s: T,
}

impl<T: Precision> Controller<T> {
    /// A controller at the first sample, which [`Self::take`] takes with an interval of zero. The
    /// parameters of the effects start at the values of the model file.
    ///
    /// # Errors
    /// [`EstimationError`] if the settings are refused.
    pub fn new(
        settings: &FilterSettings<T>,
        attitude: &InitialAttitude<T>,
    ) -> Result<Self, EstimationError> {
        let zero = T::from_f64(0.0);
        let (mut state, mut sigma) = ([zero; Extended::STATES], [zero; Extended::STATES]);
        let (nominal, effects) = (3..3 + Platform::PARAMETERS, 3 + Platform::PARAMETERS..);
        let mut chart = Chart::for_model(settings.site);
        let angles = attitude.place(&mut chart);
        state[..3].copy_from_slice(&angles.angles_rad);
        sigma[..3].copy_from_slice(&angles.sigma_rad);
        state[nominal.clone()].copy_from_slice(&settings.drift.to_array());
        sigma[nominal].copy_from_slice(&settings.drift_sigma.to_array());
        for (index, start) in effects.zip(&START) {
            state[index] = T::from_f64(start.value);
            sigma[index] = T::from_f64(start.sigma);
        }
        Ok(Self {
            filter: Filter::new(
                Anchored(Extended),
                chart,
                settings.discretisation.integration,
                settings.discretisation.recentring,
                ArrayStorage::new(),
                &state,
                &sigma,
            )?,
            accel_variance_g2: [settings.accel_noise_g * settings.accel_noise_g; 3],
            drift_density: [settings.drift_noise_density(); 3],
            time_s: zero,
        })
    }

    /// Predicts over `interval_s` without a sample.
    ///
    /// # Errors
    /// [`EstimationError`] if the interval is not positive or the prediction is not finite.
    pub fn coast(&mut self, interval_s: T) -> Result<(), EstimationError> {
        let middle_s = self.time_s + interval_s * T::from_f64(0.5);
        self.condition(middle_s, interval_s);
        self.filter.predict(interval_s, &self.drift_density)?;
        self.time_s = self.time_s + interval_s;
        Ok(())
    }

    /// Predicts over `interval_s`, zero for the first sample, and updates with the sample at its end.
    ///
    /// # Errors
    /// As [`Self::coast`], and if the sample is infinite.
    pub fn take(
        &mut self,
        interval_s: T,
        specific_force_g: &[T; 3],
    ) -> Result<Innovation<T, 3>, EstimationError> {
        if interval_s.is_positive() {
            self.coast(interval_s)?;
            self.condition(self.time_s, interval_s);
        }
        self.filter
            .update(specific_force_g, &self.accel_variance_g2)
    }

    /// The drift of the gyros under this specific force \[deg/h\]. Torquing them by its negative keeps
    /// the platform fixed in inertial space.
    #[must_use]
    pub fn drift_deg_per_h(&self, specific_force_g: &[T; 3]) -> [T; 3] {
        let zero = [T::from_f64(0.0); 3];
        let mut inputs = *self.filter.inputs().inputs();
        // Without Earth rate, and at zero angles, the rates are the drift.
        for (name, value) in [("omega_0", &zero), ("f_0", specific_force_g)] {
            if let Some(group) = inputs.group_mut(name) {
                group.copy_from_slice(value);
            }
        }
        Extended
            .rates(&zero, &self.filter.state()[3..], &inputs)
            .map(|rate| rate * T::from_f64(DEG_PER_H))
    }

    /// The specific force that the accelerometers should read now \[g\].
    #[must_use]
    pub fn expected_g(&self) -> [T; 3] {
        let state = self.filter.state();
        let moving = [state[0], state[1], state[2]];
        Extended.output(&moving, &state[3..], self.filter.inputs().inputs())
    }

    /// The filter, for its state and covariance; `extended_index` names their places.
    #[must_use]
    pub fn filter(&self) -> &ExtendedFilter<T> {
        &self.filter
    }

    /// Sets the conditions of models that use them: the time, and the mean of the temperature. Replace
    /// it by the measured temperature if the model uses it.
    fn condition(&mut self, time_s: T, interval_s: T) {
        let inputs = self.filter.inputs_mut().inputs_mut();
        if let Some([time, interval, temperature_k]) = inputs.group_mut("conditions") {
            (*time, *interval, *temperature_k) = (time_s, interval_s, T::from_f64(0.0));
        }
    }
}
