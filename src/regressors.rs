/// What effects depend on that follows from the measured temperature.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Regressors<T> {
    /// Temperature about its mean over the record that the model was fitted to, K.
    pub temperature_k: T,
    /// Rate of change of the temperature, K/h.
    pub temperature_rate_k_per_h: T,
    /// Temperature less what follows it with the play of that record, K.
    pub temperature_hysteresis_k: T,
}

impl<T: Copy> Regressors<T> {
    /// The values, in the order in which they end the conditions of a generated model.
    #[must_use]
    pub fn to_array(&self) -> [T; 3] {
        [
            self.temperature_k,
            self.temperature_rate_k_per_h,
            self.temperature_hysteresis_k,
        ]
    }

    /// What [`Self::to_array`] gives.
    #[must_use]
    pub fn from_array(
        [
            temperature_k,
            temperature_rate_k_per_h,
            temperature_hysteresis_k,
        ]: [T; 3],
    ) -> Self {
        Self {
            temperature_k,
            temperature_rate_k_per_h,
            temperature_hysteresis_k,
        }
    }
}
