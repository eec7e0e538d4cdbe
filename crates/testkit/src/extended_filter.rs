//! Filters with a varying number of constant parameters on the same samples, for timing.

use std::hint::black_box;

use gyrocal::estimation::{Filter, VecStorage};
use gyrocal::{
    Chart, FilterSettings, InitialAttitude, Integration, PlatformFilter, Recentring, Site,
};

use crate::extended_platform::ExtendedPlatform;

/// Numbers of states.
pub const SIZES: [usize; 6] = [12, 14, 18, 24, 36, 60];
/// Interval between samples, s.
pub const STEP_S: f64 = 60.0;
/// Spectral density of 0.002 deg/h held over 60 s, (deg/h)² s.
pub const DENSITY: [f64; 3] = [2.4e-4; 3];
/// Variance of one sample of 1e-5 g.
pub const VARIANCE: [f64; 3] = [1e-10; 3];
const LATITUDE_DEG: f64 = 39.1;

/// The filter on [`ExtendedPlatform`].
pub type ExtendedFilter = Filter<f64, ExtendedPlatform, Chart<f64>, VecStorage<f64>, 3, 3>;

/// Noise-free samples of a platform without drift.
pub fn samples(count: usize) -> Result<Vec<[f64; 3]>, gyrocal::EstimationError> {
    let settings = FilterSettings::at_site(Site::at_latitude_deg(LATITUDE_DEG));
    let mut truth = PlatformFilter::new(&settings, &InitialAttitude::aligned())?;
    let sample = |_| {
        truth.predict(STEP_S)?;
        Ok(truth.platform_c_enu().map(|row| row[2]))
    };
    (0..count).map(sample).collect()
}

/// A filter with `states` states, at least 12, at the start of the samples.
pub fn start(
    states: usize,
    integration: Integration,
) -> Result<ExtendedFilter, gyrocal::EstimationError> {
    let mut sigma = vec![1.0; states];
    sigma[..3].fill(2e-4);
    sigma[12..].fill(0.1);
    Filter::new(
        ExtendedPlatform {
            additional: states - 12,
        },
        Chart::east_north_up(Site::at_latitude_deg(LATITUDE_DEG)),
        integration,
        Recentring::EveryStep,
        VecStorage::new(states, 3, 3),
        &vec![0.0; states],
        &sigma,
    )
}

/// Prediction and update of one sample.
#[inline]
pub fn step(
    filter: &mut ExtendedFilter,
    sample: &[f64; 3],
) -> Result<(), gyrocal::EstimationError> {
    filter.predict(STEP_S, &DENSITY)?;
    black_box(filter.update(black_box(sample), &VARIANCE)?);
    Ok(())
}
