//! Options of the estimators.

use gyrocal::{Discretisation, Recentring};

/// Estimator of the coefficients.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// Batch estimator: iterated smoothing of whole records.
    Batch,
    /// Streaming filter, as a controller embeds it.
    Streaming,
}

/// Options of a calibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Estimator of the coefficients.
    pub method: Method,
    /// Discretisation of the model. The batch estimator moves the chart at every step, whatever
    /// [`Discretisation::recentring`] says.
    pub discretisation: Discretisation<f64>,
    /// True if the streaming filter carries the covariance as its factors: slower, for very wide
    /// priors.
    pub factorised: bool,
    /// True if the batch estimator also estimates the noise by maximum likelihood.
    pub noise: bool,
    /// Residual, in standard deviations of the noise, beyond which the batch estimator reduces the
    /// weight of a value (Huber); `None` gives every value its full weight.
    pub outlier_bound: Option<f64>,
}

impl Default for Options {
    /// The batch estimator with the default discretisation, without an estimate of the noise.
    fn default() -> Self {
        Self {
            method: Method::Batch,
            discretisation: Discretisation::default(),
            factorised: false,
            noise: false,
            outlier_bound: None,
        }
    }
}

impl Options {
    /// The streaming filter.
    #[must_use]
    pub fn streaming() -> Self {
        Self {
            method: Method::Streaming,
            ..Self::default()
        }
    }

    /// The paper's filter: Euler angles as states in one chart, one Euler step a sample.
    #[must_use]
    pub fn paper_baseline() -> Self {
        Self {
            discretisation: Discretisation::paper_baseline(),
            ..Self::streaming()
        }
    }

    /// The discretisation with the chart moved at every step.
    pub(crate) fn moving_chart(&self) -> Discretisation<f64> {
        Discretisation {
            recentring: Recentring::EveryStep,
            ..self.discretisation
        }
    }
}
