//! A plant as data: its effects and channels, and the functions of time of its terms.

use gyrocal_scalar::Element;
use gyrocal_scalar::effect::{Channel, Effect, EffectParameter, Enters, Role};

/// Inputs of the weights of a plant at one time.
#[derive(Clone, Copy, Debug)]
pub struct WeightInputs<'a> {
    /// Time since the first row, s: of the middle of a step or of a row.
    pub time_s: f64,
    /// Length of the step, s; one for a row.
    pub interval_s: f64,
    /// Regressors about their means over the record, then what derives from them.
    pub regressors: &'a [f64],
    /// Covariates: known functions of the moving states, such as specific force.
    pub covariates: &'a [f64],
    /// Onsets and time constants, in the order of the plant's shapes.
    pub shapes: &'a [f64],
}

/// Generated tables of a plant.
#[derive(Clone, Copy, Debug)]
pub struct Plant {
    /// Every effect, in the order in which exact equivalents are named.
    pub effects: &'static [Effect],
    /// Constant parameters of the model with all effects; the nominal ones come first.
    pub parameters: &'static [Element],
    /// Number of nominal parameters, which every fit estimates.
    pub nominal_parameters: usize,
    /// Onsets and time constants of the model.
    pub shapes: &'static [Element],
    /// Rate channels.
    pub rates: &'static [Channel],
    /// Moving state that each rate channel drives.
    pub rate_states: &'static [usize],
    /// Output channels.
    pub outputs: &'static [Channel],
    /// Number of moving states.
    pub moving_states: usize,
    /// Number of weights.
    pub weight_count: usize,
    /// Writes the weights: what a unit of a parameter of a time-dependent term adds to its channel.
    pub weights: fn(&WeightInputs<'_>, &mut [f64]),
    /// Periods of the plant's own motion, s: at these and their second and third harmonics several
    /// effects together look like a spectral line.
    pub natural_periods_s: &'static [f64],
}

impl Plant {
    /// Whether a parameter is where an effect bends, and no size.
    #[must_use]
    pub fn is_knee(&self, parameter: usize) -> bool {
        let mut all = self.effects.iter().flat_map(|effect| effect.parameters);
        all.any(|own| matches!(own.role, Role::Knee(index) if index == parameter))
    }

    /// The effect with this id.
    #[must_use]
    pub fn effect(&self, id: &str) -> Option<&'static Effect> {
        self.effects.iter().find(|effect| effect.id == id)
    }

    /// The effect and its parameter that a constant parameter of the model is.
    #[must_use]
    pub fn owner(&self, parameter: usize) -> Option<(&'static Effect, &'static EffectParameter)> {
        self.effects.iter().find_map(|effect| {
            let mut own = effect.parameters.iter();
            let found = own.find(|own| own.role == Role::Parameter(parameter))?;
            Some((effect, found))
        })
    }

    /// The channel that an effect enters, if it enters exactly one.
    #[must_use]
    pub fn channel(&self, effect: &Effect) -> Option<&'static Channel> {
        match effect.enters {
            Enters::Rates(&[rate]) => self.rates.get(rate),
            Enters::Outputs(&[output]) => self.outputs.get(output),
            _ => None,
        }
    }
}
