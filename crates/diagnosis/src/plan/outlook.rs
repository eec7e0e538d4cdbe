//! What records leave: standard deviations and sets.

/// A standard deviation.
#[derive(Clone, Debug, PartialEq)]
pub struct Forecast {
    /// Id of a coefficient, or of an effect with the name of its parameter.
    pub name: String,
    /// The standard deviation.
    pub sigma: f64,
    /// Its unit.
    pub unit: &'static str,
}

/// A member of a named set.
#[derive(Clone, Debug, PartialEq)]
pub struct SetMember {
    /// Its id.
    pub effect: &'static str,
    /// Effects that no run tells from it.
    pub equivalents: Vec<&'static str>,
    /// Probability that it and the named one do not both stay in the set, whichever of the two is
    /// the cause; 1 of the named one.
    pub told_apart: f64,
}

/// A named set.
#[derive(Clone, Debug, PartialEq)]
pub struct SetForecast {
    /// The effect that is named now.
    pub effect: &'static str,
    /// How many members are left on average.
    pub mean_size: f64,
    /// Probability that one is left.
    pub one_left: f64,
    /// All members, the named one first.
    pub members: Vec<SetMember>,
}

/// What records leave.
#[derive(Clone, Debug, PartialEq)]
pub struct Outlook {
    /// Geometric mean over the nine coefficients of sigma over that of the record so far.
    pub sigma_ratio: f64,
    /// The nine coefficients, with what was named in the model.
    pub coefficients: Vec<Forecast>,
    /// Sizes of what was named.
    pub sizes: Vec<Forecast>,
    /// The named sets.
    pub sets: Vec<SetForecast>,
}

impl Outlook {
    /// Members that are left on average beyond one for each set.
    #[must_use]
    pub fn surplus(&self) -> f64 {
        self.sets.iter().map(|set| set.mean_size - 1.0).sum()
    }
}

/// Geometric mean of ratios.
pub(crate) fn ratio(after: &[Forecast], before: &[Forecast]) -> f64 {
    let logarithms = after
        .iter()
        .zip(before)
        .map(|(after, before)| (after.sigma / before.sigma).ln());
    (logarithms.sum::<f64>() / before.len() as f64).exp()
}
