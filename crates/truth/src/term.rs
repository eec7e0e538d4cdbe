//! Hidden effects defined by the caller.

/// The variables that a hidden effect may depend on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[non_exhaustive]
pub struct Moment {
    /// True time since the first row.
    pub time_s: f64,
    /// True specific force in platform axes \[g\].
    pub accel_g: [f64; 3],
    /// Temperature about its mean over the rows of the record; 0 if none is logged.
    pub temperature_k: f64,
    /// Rate of change of the temperature \[K/h\].
    pub temperature_rate_k_per_h: f64,
    /// Part of the temperature by which its ways up and down differ \[K\]: what a friction holds that
    /// slips at an eighth of the range over the rows of the record, about its mean.
    pub temperature_hysteresis_k: f64,
    /// The Earth's magnetic field in platform axes \[gauss\]; 0 if the scenario has none.
    pub field_gauss: [f64; 3],
}

/// A function of the moment that adds to drift or output.
pub(crate) type AtMoment = dyn Fn(&Moment) -> [f64; 3] + Send + Sync;

/// A hidden effect defined by the caller; [`Hidden`](crate::Hidden) has the named ones.
#[non_exhaustive]
pub enum Term {
    /// Drift to be added to that of the three gyros \[deg/h\].
    Drift(Box<AtMoment>),
    /// Error to be added to the three accelerometers' outputs before noise \[g\].
    Output(Box<AtMoment>),
    /// Changes a noisy sample \[g\]; the first argument is its row on the regular grid.
    Noise(Box<dyn Fn(usize, [f64; 3]) -> [f64; 3] + Send + Sync>),
    /// True time since the first row when the record's clock shows some time since it \[s\];
    /// must rise and start at zero.
    Time(Box<dyn Fn(f64) -> f64 + Send + Sync>),
}

impl core::fmt::Debug for Term {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        formatter.write_str(match self {
            Self::Drift(_) => "Term::Drift",
            Self::Output(_) => "Term::Output",
            Self::Noise(_) => "Term::Noise",
            Self::Time(_) => "Term::Time",
        })
    }
}
