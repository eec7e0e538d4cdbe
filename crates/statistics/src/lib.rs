//! Statistics of time series: pure functions of plain slices.
//!
//! # What it is
//!
//! - [`nis`], [`autocorrelation`]: whiteness of innovations (mean of squares, Ljung and Box).
//! - [`periodogram`], [`FrequencySearch`]: spectral lines, and the probability of the largest.
//! - [`binned_means`]: regression of residuals on a covariate.
//! - [`allan`]: overlapping Allan deviation, types of noise, noise coefficients; [`allan_test`]:
//!   test of innovations against white noise at all averaging times.
//! - [`Proportion`], [`chi_square_band`] and others: exact intervals of proportions and of mean
//!   squares.
//! - [`median`], [`quantile`], [`robust_sigma`] and others: descriptive statistics.
//! - [`local_slopes`], [`local_lines`], [`followed_with_play`]: slope, smooth course and hysteresis of a
//!   series.
//! - [`deviates`]: normal deviates from a seed.
//! - [`mod@format`]: p-values, estimates and rounded numbers as text.
//! - [`math`]: exponential, logarithm, sine and others, the same on every machine.
//! - [`two_sided_p`], [`ln_chi_square_tail`] and others: tail probabilities and their inverses.
//!
//! # The domain in brief
//!
//! The innovation of a filter is a measurement less its prediction. Divided by its predicted
//! standard deviation it is *whitened*: for a right model and noise it is white and standard normal.
//! Each test has this null hypothesis and power against one kind of departure, and returns a
//! p-value: the probability of as large a departure in white noise. `NaN` is a missing value
//! everywhere. Terms are defined in `docs/glossary.md`.
//!
//! # Example
//!
//! ```
//! use gyrocal_statistics::{autocorrelation, nis};
//!
//! # fn main() -> Result<(), gyrocal_statistics::StatisticsError> {
//! // Alternating signs: of the right size, but far from white.
//! let whitened: Vec<[f64; 3]> = (0..100).map(|k| [if k % 2 == 0 { 1.0 } else { -1.0 }; 3]).collect();
//! assert!(nis(&whitened, 0.01)?.p_value > 0.5);
//! assert!(autocorrelation(&whitened, 5, 0.01)?.p_value < 1e-6);
//! # Ok(())
//! # }
//! ```
//!
//! # What it does not do
//!
//! It has no gyros, records or files, and prints nothing.

pub mod allan;
mod allan_test;
mod bands;
mod binned_means;
mod descriptive;
pub mod deviates;
mod error;
pub mod format;
mod history;
pub mod math;
mod periodogram;
mod probability;
mod proportion;
mod robust;
mod sampling;
mod whiteness;

pub use allan_test::{AllanTest, NoiseCourse, allan_test};
pub use bands::{chi_square_band, mean_square_band, rms_ratio_interval};
pub use binned_means::{BinMean, BinnedMeans, EqualMeans, binned_means};
pub use descriptive::{
    mean, median, quantile, rms_of_present, root_mean_square, standard_error, upper_median,
};
pub use error::StatisticsError;
pub use history::{PLAY_OF_HYSTERESIS, followed_with_play, local_lines, local_slopes};
pub use periodogram::{
    FrequencySearch, Periodogram, SpectralLine, fourier_powers, periodogram, strongest_line,
};
pub use probability::{
    CHI_SQUARE_99, NORMAL_97_5, chi_square_equivalent, chi_square_quantile, chi_square_tail,
    chi_square_two_sided_p, chi_square_z, f_tail, ln_chi_square_tail, normal_probability,
    normal_quantile, p_of_least, student_probability, student_quantile, student_two_sided_p,
    two_sided_p, z_of_two_sided_p,
};
pub use proportion::{Judgement, Proportion};
pub use robust::{NORMAL_MAD, robust_sigma, theil_sen_at_zero};
pub use sampling::median_interval_s;
pub use whiteness::{Autocorrelation, Nis, autocorrelation, nis};
