//! Time of a step of the structured filter, in both forms, and of filters of other packages, relative to the textbook
//! filter.

use std::hint::black_box;

use gyrocal::estimation::dense::DenseFilter;
use gyrocal::{
    Anchored, Chart, Discretisation, EstimationError, FactorisedPlatformFilter, FilterSettings,
    InitialAttitude, Integration, Platform, PlatformFilter, Recentring, Site,
};
use nalgebra::{SMatrix, SVector};

use crate::extended_filter::{DENSITY, STEP_S, VARIANCE, samples};
use crate::peer_filters::{Adskalman, Multicalc};
use crate::timing::{medians, seconds, well_placed};

/// Steps of one round: ten hours.
const STEPS: usize = 600;

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
    let mut result = Vec::new();
    for (rule, integration) in [("euler", Integration::EULER), ("rk4", Integration::RK4)] {
        let settings = FilterSettings {
            discretisation: Discretisation {
                integration,
                ..Discretisation::default()
            },
            ..FilterSettings::at_site(site())
        };
        let attitude = InitialAttitude::aligned();
        let ours = PlatformFilter::new(&settings, &attitude)?;
        let factors = FactorisedPlatformFilter::factorised(&settings, &attitude)?;
        let dense = dense_joseph(integration);
        let (times, ratios) = medians(rounds, || {
            Ok::<_, EstimationError>([
                time(&ours, &samples, |filter, sample| {
                    black_box(filter.step(STEP_S, sample)?);
                    Ok(())
                })?,
                time(&dense, &samples, dense_step)?,
                time(&factors, &samples, |filter, sample| {
                    black_box(filter.step(STEP_S, sample)?);
                    Ok(())
                })?,
            ])
        })?;
        result.push(StepTimes {
            rule,
            ns: times.map(in_ns),
            ratios,
        });
    }
    Ok(result)
}

/// Times of an Euler step, ns, of `dense_joseph`, and of Joseph-form filters of other packages: adskalman and
/// multicalc; and medians over rounds of the ratios to the first of them.
pub fn peer_times(rounds: usize) -> Result<([f64; 3], [f64; 3]), EstimationError> {
    let samples = samples(STEPS)?;
    let (chart, prior) = chart_and_prior();
    let dense = dense_joseph(Integration::EULER);
    let adskalman = Adskalman::new(chart, prior, DENSITY, VARIANCE);
    let multicalc = Multicalc::new(chart, prior, DENSITY, VARIANCE);
    let (times, ratios) = medians(rounds, || {
        Ok::<_, EstimationError>([
            time(&dense, &samples, dense_step)?,
            time(&adskalman, &samples, |filter, sample| {
                filter.step(STEP_S, sample);
                Ok(())
            })?,
            time(&multicalc, &samples, |filter, sample| {
                filter.step(STEP_S, sample);
                Ok(())
            })?,
        ])
    })?;
    Ok((times.map(in_ns), ratios))
}

fn site() -> Site<f64> {
    Site::at_latitude_deg(39.1)
}

/// The first chart, and the variances of the states in it.
fn chart_and_prior() -> (Chart<f64>, [f64; 12]) {
    let mut chart = Chart::east_north_up(site());
    let angle = InitialAttitude::aligned().place(&mut chart).sigma_rad[0];
    let prior = core::array::from_fn(|i| if i < 3 { angle * angle } else { 1.0 });
    (chart, prior)
}

/// The textbook filter.
type Dense = DenseFilter<Anchored<Platform>, Chart<f64>, 3, 3, 12>;

fn dense_joseph(integration: Integration) -> Dense {
    let (chart, prior) = chart_and_prior();
    Dense::new(
        Anchored(Platform),
        chart,
        integration,
        Recentring::Never,
        SVector::zeros(),
        SMatrix::from_diagonal(&SVector::from(prior)),
    )
}

fn dense_step(filter: &mut Dense, sample: &[f64; 3]) -> Result<(), EstimationError> {
    filter.predict(STEP_S, &DENSITY);
    black_box(filter.update(sample, &VARIANCE)?);
    Ok(())
}

fn in_ns(time_s: f64) -> f64 {
    time_s / STEPS as f64 * 1e9
}

/// Time of a copy of a filter for the samples, s.
fn time<F: Clone>(
    start: &F,
    samples: &[[f64; 3]],
    step: impl Fn(&mut F, &[f64; 3]) -> Result<(), EstimationError>,
) -> Result<f64, EstimationError> {
    well_placed(|| passed(start, samples, &step))
}

/// A function of its own for each step, called from one place: in one body with another, or called from two, a step
/// is not inlined and takes a tenth longer.
#[inline(never)]
fn passed<F: Clone>(
    start: &F,
    samples: &[[f64; 3]],
    step: impl Fn(&mut F, &[f64; 3]) -> Result<(), EstimationError>,
) -> Result<f64, EstimationError> {
    let mut filter = black_box(start.clone());
    let time = seconds(|| {
        let mut samples = samples.iter();
        samples.try_for_each(|sample| step(&mut filter, black_box(sample)))
    });
    black_box(&filter);
    time
}
