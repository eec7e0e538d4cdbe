//! Time of a step of the structured filter, in both forms, relative to the textbook filter.

use std::hint::black_box;

use gyrocal::estimation::dense::DenseFilter;
use gyrocal::estimation::form::Form;
use gyrocal::{
    Anchored, Chart, Discretisation, EstimationError, FactorisedPlatformFilter, FilterSettings,
    InitialAttitude, Integration, Platform, PlatformFilter, Recentring, Site,
};
use nalgebra::{SMatrix, SVector};

use crate::extended_filter::samples;
use crate::timing::{medians, seconds, well_placed};

/// Steps of one round: ten hours.
pub const STEPS: usize = 600;
/// Interval between samples, s.
pub const STEP_S: f64 = 60.0;
/// Spectral density of 0.002 deg/h held over 60 s, (deg/h)² s.
pub const DENSITY: [f64; 3] = [2.4e-4; 3];
/// Variance of one sample of 1e-5 g.
pub const VARIANCE: [f64; 3] = [1e-10; 3];

/// Median times of a step by one rule of integration: of the structured filter, of the textbook
/// filter, and of the structured filter on the factors.
pub struct StepTimes {
    /// Name of the rule: `euler` or `rk4`.
    pub rule: &'static str,
    /// Times, ns.
    pub ns: [f64; 3],
    /// Medians over rounds of the ratios to the first of them.
    pub ratios: [f64; 3],
}

/// Times of a step of `dense_joseph` of the bench `filter_step` (the same interval, samples and
/// noise, Euler angles in one chart) and of the structured filter, interleaved.
pub fn step_times(rounds: usize) -> Result<Vec<StepTimes>, EstimationError> {
    let samples = samples(STEPS)?;
    let site = Site::at_latitude_deg(39.1);
    let mut result = Vec::new();
    for (rule, integration) in [("euler", Integration::EULER), ("rk4", Integration::RK4)] {
        let settings = FilterSettings {
            discretisation: Discretisation {
                integration,
                ..Discretisation::default()
            },
            ..FilterSettings::at_site(site)
        };
        let attitude = InitialAttitude::aligned();
        let ours = PlatformFilter::new(&settings, &attitude)?;
        let factors = FactorisedPlatformFilter::factorised(&settings, &attitude)?;
        let mut chart = Chart::east_north_up(site);
        let angle = attitude.place(&mut chart).sigma_rad[0];
        let variances: [f64; 12] =
            core::array::from_fn(|i| if i < 3 { angle * angle } else { 1.0 });
        let dense = DenseFilter::<_, _, 3, 3, 12>::new(
            Anchored(Platform),
            chart,
            integration,
            Recentring::Never,
            SVector::zeros(),
            SMatrix::from_diagonal(&SVector::from(variances)),
        );
        let (times, ratios) = medians(rounds, || {
            let ours_s = well_placed(|| time(&ours, &samples))?;
            let dense_s = well_placed(|| {
                let mut dense = black_box(dense.clone());
                let time = seconds(|| {
                    samples.iter().try_for_each(|sample| {
                        dense.predict(STEP_S, &DENSITY);
                        dense
                            .update(black_box(sample), &VARIANCE)
                            .map(|innovation| {
                                black_box(innovation);
                            })
                    })
                });
                black_box(&dense);
                time
            })?;
            let factors_s = well_placed(|| time(&factors, &samples))?;
            Ok::<_, EstimationError>([ours_s, dense_s, factors_s])
        })?;
        result.push(StepTimes {
            rule,
            ns: times.map(|time| time / STEPS as f64 * 1e9),
            ratios,
        });
    }
    Ok(result)
}

/// Time of a copy of the filter for the samples, s.
///
/// A function of its own for each form, called from one place: in one body with the other form,
/// or called from two, a step is not inlined and takes a tenth longer.
#[inline(never)]
fn time<F: Form<f64> + Clone>(
    start: &PlatformFilter<f64, F>,
    samples: &[[f64; 3]],
) -> Result<f64, EstimationError> {
    let mut filter = black_box(start.clone());
    let time = seconds(|| {
        samples.iter().try_for_each(|sample| {
            filter.step(STEP_S, black_box(sample)).map(|innovation| {
                black_box(innovation);
            })
        })
    });
    black_box(&filter);
    time
}
