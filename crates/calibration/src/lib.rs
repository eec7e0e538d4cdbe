//! Drift coefficients and their covariance from accelerometer records.
//!
//! # What it is
//!
//! [`calibrate`] estimates the nine drift coefficients of a platform from one record,
//! [`calibrate_runs`] from several. The default is the batch estimator, an iterated Kalman smoother
//! over whole records; [`Method::Streaming`] runs the filter of [`gyrocal`] that a controller
//! embeds. A [`Calibration`] holds the estimates, their covariance, the statistics of the
//! consistency test, unobservable combinations of coefficients, and the sensitivity to errors of
//! the site. Further entry points: [`average_record`] reduces fast records, [`cramer_rao_bound`]
//! gives the least covariance of any estimator, [`FittedPlatform`] fits the nominal model with effects of
//! the catalogue, and [`PlannedRun`] predicts the information of a run that has not been made.
//!
//! # Method of the batch estimator
//!
//! | letter | meaning |
//! |---|---|
//! | xₖ | error of the attitude at row k about the present trajectory, a rotation vector in platform axes, rad |
//! | p, δp | unknowns that all rows share (coefficients, turn-on offsets, errors of the site), and their change |
//! | p̄ᵢ, σᵢ, W | mean and standard deviation of the prior of unknown i; W = diag(σᵢ⁻²) |
//! | x̄₀, P₀ | mean and covariance of the prior of the first attitude |
//! | Φₖ, Bₖ, Qₖ | derivatives of the step from row k to k + 1 by attitude and unknowns; covariance of its noise |
//! | dₖ | distance of the trajectory at row k + 1 from where the model leads from row k |
//! | zₖ, Hₖ, Cₖ, R | residual of a sample; derivatives of the predicted sample by attitude and unknowns; covariance of its noise |
//! | eⱼ, rⱼ, sⱼ | whitened innovation j, its value at δp = 0, its derivative by δp (*sensitivity column*) |
//!
//! Linearised about a trajectory and values of the unknowns, twice the negative logarithm of the
//! posterior density is, but for a constant,
//!
//! ```text
//! 2J = |x₀ − x̄₀|²_P₀ + Σₖ |xₖ₊₁ − Φₖ xₖ − Bₖ δp + dₖ|²_Qₖ + Σₖ |zₖ − Hₖ xₖ − Cₖ δp|²_R
//!      + Σᵢ (pᵢ + δpᵢ − p̄ᵢ)² / σᵢ²,        |v|²_A = vᵀ A⁻¹ v                         (1)
//! ```
//!
//! For given δp the minimum over all attitudes is found by a Kalman filter with three states, and
//! is the sum of its squared whitened innovations. These are linear in δp; every column is carried
//! through the filter like a state:
//!
//! ```text
//! eⱼ = rⱼ + sⱼᵀ δp                                                                  (2)
//! ```
//!
//! So one pass over a record *eliminates the attitudes* and leaves the Gram matrix of residual and
//! columns: the *information form*, with A the information of the records on all unknowns and g
//! the gradient. The matrices of several records add.
//!
//! ```text
//! G = Σⱼ [rⱼ; sⱼ] [rⱼ, sⱼᵀ] = [ρ  gᵀ; g  A]                                         (3)
//! ```
//!
//! *Gauss-Newton*: the step of the estimated unknowns solves the normal equations (4), a
//! Rauch-Tung-Striebel smoother with that δp gives the corrections xₖ of all attitudes (5), and
//! both are applied, the attitudes as rotations. The length ℓ of a step (6), in standard deviations of
//! the whole problem, decides when to stop.
//!
//! ```text
//! (A + W) δp = −g + W (p̄ − p)                                                       (4)
//! xₖ = smoother(δp)                                                                 (5)
//! ℓ² = 2J(x = 0, δp = 0) − min 2J                                                   (6)
//! ```
//!
//! The covariance of the estimates is the inverse of the matrix in (4). Latitude, Earth rate and
//! gravity are *considered* parameters: they keep their assumed values c, and their variances σ_c²
//! enter through the sensitivity of the estimates (Schmidt; Bierman, *Factorization Methods for
//! Discrete Sequential Estimation*, 1977, ch. VIII):
//!
//! ```text
//! P = (A + W)⁻¹ + Σ_c S_c σ_c² S_cᵀ,        S_c = −(A + W)⁻¹ A_c                    (7)
//! ```
//!
//! The iteration starts from the trajectory of the streaming filter, over a record without gross
//! errors of the specific-force magnitude. If the bench description declares no attitude, filters
//! from 24 azimuths are compared and the most likely solution is chosen. On request the noise is
//! estimated by maximum likelihood (Fisher's scoring) and the influence of outliers is bounded by
//! Huber's weights.
//!
//! # Example
//!
//! ```no_run
//! use gyrocal_calibration::{Options, calibrate};
//! use gyrocal_record::{Bench, Record};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let record = Record::read("record.csv".as_ref())?;
//! let bench = Bench::read("bench.toml".as_ref())?;
//! let calibration = calibrate(&record, &bench, &Options::default(), |_| ())?;
//! for coefficient in calibration.coefficients() {
//!     println!("{} {} ± {}", coefficient.id, coefficient.estimate, coefficient.sigma);
//! }
//! # Ok(())
//! # }
//! ```
//!
//! # What it does not do
//!
//! It reads and writes no files, prints nothing, and does not look for causes of a misfit.

mod attitude;
mod averaging;
mod azimuth;
mod batch;
mod budget;
mod calibrate;
mod check;
mod coefficients;
#[cfg(test)]
mod convergence_tests;
mod cramer_rao;
mod error;
mod fit;
mod fitted_platform;
mod gross_errors;
mod gyro_axes;
mod initial_guess;
mod initial_trajectory;
mod law;
mod layout;
mod noise;
mod observability;
mod options;
mod planned_run;
mod platform;
mod problem;
mod result;
mod robust;
mod run;
mod same_rows;
mod settings;
mod single_run;
mod solve;
mod spread;
mod start;
mod streaming;
mod temperature;
mod uncertainty;
mod unit_start;
mod variances;
mod work;

pub use averaging::{AveragedRecord, attitude_walk_share, average_between, average_record};
pub use budget::{
    CoefficientBudget, Contribution, ModelEstimate, UncertaintyBudget, calibrate_with_budget,
};
pub use calibrate::{calibrate, calibrate_runs, calibrate_strapdown, first_run_sigmas};
pub use check::check_record;
pub use coefficients::BIASES;
pub use cramer_rao::cramer_rao_bound;
pub use error::CalibrationError;
pub use fit::{Consistency, FitStatistics, NIS_FALSE_ALARM, is_gross};
pub use fitted_platform::{
    Estimates, Expectation, FittedPlatform, GYRO_NOISE_PRIOR_SIGMA, NoiseModel, RecordSizes,
    SiteBias, WalkEnd, joined_record,
};
pub use gross_errors::gross_errors;
pub use gyro_axes::GyroAxes;
pub use gyrocal_record::{NoiseDifference, NoiseEstimate, NoiseRatio};
pub use layout::SiteQuantity;
pub use noise::is_gyro_noise_implausible;
pub use observability::{DETERMINED, UnobservableCombination};
pub use options::{Method, Options};
pub use planned_run::{PlannedRun, PredictedInformation};
pub use platform::{PLATFORM, rows};
pub use result::{AzimuthSearch, Calibration, CoefficientEstimate, ConsiderSensitivity, RunResult};
pub use run::Run;
pub use same_rows::{SharedRows, shared_rows, times_overlap};
pub use settings::{declared_attitude, filter_settings};
pub use spread::{CoefficientSpread, Spread, spread};
pub use streaming::{FilterWatch, StrapdownWatch, run_factorised_filter, run_strapdown_filter};
pub use temperature::{REGRESSORS, TemperatureScale, regressor_means};
pub use unit_start::UnitStart;
pub use variances::UncertaintySource;
pub use work::work;
