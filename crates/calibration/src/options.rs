use gyrocal::{Integration, Recentring};

/// How coefficients are estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Method {
    /// Iterated smoothing of whole records.
    Batch,
    /// One pass of the filter that a controller embeds.
    Streaming,
}

/// How records are read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// How coefficients are estimated.
    pub method: Method,
    /// How the angles are integrated over a step.
    pub integration: Integration,
    /// When the chart of the streaming filter moves; the batch estimator moves it at every step.
    pub recentring: Recentring<f64>,
    /// Longest interval integrated in one step, s; longer ones are divided.
    pub longest_step_s: f64,
    /// Whether the streaming filter carries the covariance as its factors: slower, for priors
    /// that are too wide otherwise.
    pub factorised: bool,
    /// Whether the batch estimator also estimates the noise by maximum likelihood.
    pub noise: bool,
    /// Standard deviations of the noise beyond which the batch estimator bounds the influence
    /// of a value (Huber's weights); `None` trusts every value.
    pub outlier_bound: Option<f64>,
}

impl Default for Options {
    /// The batch estimator with RK4, chart moved at every step, steps of at most two minutes, the covariance itself.
    fn default() -> Self {
        Self {
            method: Method::Batch,
            integration: Integration::RK4,
            recentring: Recentring::EveryStep,
            longest_step_s: 120.0,
            factorised: false,
            noise: false,
            outlier_bound: None,
        }
    }
}

impl Options {
    /// One pass of the streaming filter.
    #[must_use]
    pub fn streaming() -> Self {
        Self {
            method: Method::Streaming,
            ..Self::default()
        }
    }

    /// The paper's own filter: Euler angles in one chart, one Euler step a sample.
    #[must_use]
    pub fn of_the_paper() -> Self {
        Self {
            method: Method::Streaming,
            integration: Integration::EULER,
            recentring: Recentring::Never,
            longest_step_s: f64::INFINITY,
            factorised: false,
            noise: false,
            outlier_bound: None,
        }
    }
}
