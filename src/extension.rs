use gyrocal_estimation::{ArrayStorage, EstimationError, Filter, Innovation, Precision};
use gyrocal_scalar::{Model, NamedInputs, Real};

use crate::anchor::{Anchored, Chart};
use crate::generated::platform::Platform;
use crate::initial_attitude::InitialAttitude;
use crate::regressors::Regressors;
use crate::rotation::rotate;
use crate::settings::FilterSettings;

/// The filter underneath: three angles, the nine coefficients and the parameters of the effects.
pub type ExtensionKernel<T, M, I, const N: usize> =
    Filter<T, Anchored<M>, Chart<T, I>, ArrayStorage<T, 3, 3, N>, 3, 3>;

/// 1 rad/s in deg/h.
const DEG_PER_H: f64 = 3600.0 * 180.0 / core::f64::consts::PI;
/// The input of models whose gyros are fixed to a body.
const GYRO_AXES: &str = "platform_c_gyros";

/// Estimates the drift from accelerometer samples, and computes the commands of the torquers.
///
/// `M` is the generated model of a model file, `I` are its inputs and `N` its states.
///
/// In the model of a strapdown unit the gyros are fixed to a body and the platform is computed from their
/// outputs, uncorrected. Samples are along the axes of this platform. The matrix that takes components along
/// the axes of the gyros to components along those of the platform is an input:
/// [`Self::take_turning`] has it. Coefficients and effects are errors of the outputs of the instruments, in
/// their own axes.
#[derive(Clone, Debug)]
pub struct ExtensionFilter<T: Precision, M, I, const N: usize> {
    filter: ExtensionKernel<T, M, I, N>,
    accel_variance_g2: [T; 3],
    drift_density: [T; 3],
    time_s: T,
    model: M,
}

impl<T, M, I, const N: usize> ExtensionFilter<T, M, I, N>
where
    T: Precision,
    M: Model<T, 3, 3, Inputs = I> + Copy,
    I: NamedInputs<T>,
{
    /// A filter at the first sample, which [`Self::take`] takes with an interval of zero. `start` has
    /// value and standard deviation of each parameter after the nine coefficients, in order: the
    /// table `START` of a generated model.
    ///
    /// # Errors
    /// [`EstimationError`] if the settings are refused, or if `start` has not as many rows.
    pub fn new(
        model: M,
        start: impl IntoIterator<Item = [f64; 2]>,
        settings: &FilterSettings<T>,
        attitude: &InitialAttitude<T>,
    ) -> Result<Self, EstimationError> {
        let zero = T::from_f64(0.0);
        let (mut state, mut sigma) = ([zero; N], [zero; N]);
        let (nominal, effects) = (3..3 + Platform::PARAMETERS, 3 + Platform::PARAMETERS..N);
        if N < 3 + Platform::PARAMETERS {
            return Err(EstimationError::InvalidArgument {
                expected: "a model with the nine drift coefficients",
            });
        }
        let mut chart = Chart::for_model(settings.site);
        let angles = attitude.place(&mut chart);
        state[..3].copy_from_slice(&angles.angles_rad);
        sigma[..3].copy_from_slice(&angles.sigma_rad);
        state[nominal.clone()].copy_from_slice(&settings.drift.to_array());
        sigma[nominal].copy_from_slice(&settings.drift_sigma.to_array());
        let mut start = start.into_iter();
        for (index, [value, deviation]) in effects.zip(&mut start) {
            state[index] = T::from_f64(value);
            sigma[index] = T::from_f64(deviation);
        }
        if start.next().is_some() {
            return Err(EstimationError::InvalidArgument {
                expected: "a start value for each parameter of the effects",
            });
        }
        let mut this = Self {
            filter: Filter::new(
                Anchored(model),
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
            model,
        };
        this.set_regressors(&Regressors::from_array([zero; 3]));
        this.set_gyro_axes(&identity());
        Ok(this)
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

    /// [`Self::take`] for gyros that are fixed to a body, which turns in the platform: with the matrix of
    /// [`Self::set_gyro_axes`] at the middle of the interval and at the sample.
    ///
    /// # Errors
    /// As [`Self::take`].
    pub fn take_turning(
        &mut self,
        interval_s: T,
        [middle, sample]: [&[[T; 3]; 3]; 2],
        specific_force_g: &[T; 3],
    ) -> Result<Innovation<T, 3>, EstimationError> {
        if interval_s.is_positive() {
            self.set_gyro_axes(middle);
            self.coast(interval_s)?;
            self.condition(self.time_s, interval_s);
        }
        self.set_gyro_axes(sample);
        self.take(T::from_f64(0.0), specific_force_g)
    }

    /// The drift of the gyros under this specific force along their axes \[deg/h\]. Torquing them by its
    /// negative keeps the platform fixed in inertial space. Of gyros that are fixed to a body it is the
    /// error of their outputs, which is to be subtracted from them.
    #[must_use]
    pub fn drift_deg_per_h(&self, specific_force_g: &[T; 3]) -> [T; 3] {
        let zero = [T::from_f64(0.0); 3];
        let mut inputs = *self.filter.inputs().inputs();
        let axes = matrix_of(&mut inputs);
        let along_platform = match &axes {
            Some(platform_c_gyros) => rotate(platform_c_gyros, specific_force_g),
            None => *specific_force_g,
        };
        // Without Earth rate, and at zero angles, the rates are the drift.
        for (name, value) in [("omega_0", &zero), ("f_0", &along_platform)] {
            if let Some(group) = inputs.group_mut(name) {
                group.copy_from_slice(value);
            }
        }
        let state = self.filter.state();
        let rates = self.model.rates(&zero, &state[3..], &inputs);
        let drift = match &axes {
            // A platform that is computed turns by minus the errors.
            Some(platform_c_gyros) => {
                let back = transposed(platform_c_gyros);
                rotate(&back, &rates).map(|rate| zero[0] - rate)
            }
            None => rates,
        };
        drift.map(|rate| rate * T::from_f64(DEG_PER_H))
    }

    /// The specific force that the accelerometers should read now \[g\].
    #[must_use]
    pub fn expected_g(&self) -> [T; 3] {
        let state = self.filter.state();
        let moving = [state[0], state[1], state[2]];
        self.model
            .output(&moving, &state[3..], self.filter.inputs().inputs())
    }

    /// Sets what follows from the measured temperature, for the next steps and samples; zero before. Does
    /// nothing in a model that does not use it.
    pub fn set_regressors(&mut self, regressors: &Regressors<T>) {
        if let Some([_, _, own @ ..]) = self.inputs_mut().group_mut("conditions") {
            for (own, given) in own.iter_mut().zip(regressors.to_array()) {
                *own = given;
            }
        }
    }

    /// Sets the matrix, by rows, that takes components along the axes of gyros fixed to a body to components
    /// along the axes of the platform that is computed from their outputs, for the next steps, samples and
    /// drifts; the identity before. Over a step it is the one at its middle. Does nothing in a model of a
    /// stabilised platform.
    pub fn set_gyro_axes(&mut self, platform_c_gyros: &[[T; 3]; 3]) {
        if let Some(own) = self.inputs_mut().group_mut(GYRO_AXES) {
            for (own, given) in own.iter_mut().zip(platform_c_gyros.as_flattened()) {
                *own = *given;
            }
        }
    }

    /// The inputs of the model, for shapes.
    pub fn inputs_mut(&mut self) -> &mut I {
        self.filter.inputs_mut().inputs_mut()
    }

    /// The filter, for its state and covariance; the generated table of indices names their places.
    #[must_use]
    pub fn filter(&self) -> &ExtensionKernel<T, M, I, N> {
        &self.filter
    }

    /// Sets the time of models that use it.
    fn condition(&mut self, time_s: T, interval_s: T) {
        if let Some([time, interval, ..]) = self.inputs_mut().group_mut("conditions") {
            (*time, *interval) = (time_s, interval_s);
        }
    }
}

/// The axes of gyros that are fixed to a body; `None` of those of a stabilised platform.
fn matrix_of<T: Real, I: NamedInputs<T>>(inputs: &mut I) -> Option<[[T; 3]; 3]> {
    let elements: &[T; 9] = (&*inputs.group_mut(GYRO_AXES)?).try_into().ok()?;
    Some(core::array::from_fn(|i| {
        core::array::from_fn(|j| elements[3 * i + j])
    }))
}

fn identity<T: Real>() -> [[T; 3]; 3] {
    core::array::from_fn(|i| core::array::from_fn(|j| T::from_f64(f64::from(u8::from(i == j)))))
}

fn transposed<T: Real>(matrix: &[[T; 3]; 3]) -> [[T; 3]; 3] {
    core::array::from_fn(|i| core::array::from_fn(|j| matrix[j][i]))
}
