//! Time of a step of the structured filter, in both forms, relative to the textbook filter.

use std::hint::black_box;

use gyrocal::estimation::dense::DenseFilter;
use gyrocal::estimation::form::Form;
use gyrocal::{
    Anchored, Chart, Discretisation, EstimationError, FactorisedPlatformFilter, FilterSettings,
    InitialAttitude, Platform, PlatformFilter, Recentring, Site,
};
use nalgebra::{SMatrix, SVector};

use super::timing::{is_x86_64_v3, medians, seconds, well_placed};
use super::{Error, RULES};
use crate::figure::Figure;
use gyrocal_testkit::extended_filter::samples;

/// Steps of one round: ten hours.
pub(super) const STEPS: usize = 600;
pub(super) const STEP_S: f64 = 60.0;
pub(super) const DENSITY: [f64; 3] = [2.4e-4; 3];
pub(super) const VARIANCE: [f64; 3] = [1e-10; 3];

/// Least ratio of the time of a step of `dense_joseph` of the bench `filter_step` (the same interval,
/// samples and noise, Euler angles in one chart) to that of the structured filter.
pub(crate) fn figures(rounds: usize) -> Result<Vec<Figure>, Error> {
    let samples = samples(STEPS)?;
    let site = Site::at_latitude_deg(39.1);
    let mut figures = Vec::new();
    for (rule, integration) in RULES {
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
        let target = match (rule, is_x86_64_v3()) {
            ("euler", true) => 7.0,
            ("euler", false) => 5.0,
            _ => 4.0,
        };
        let what = format!("{rule} step: time of dense_joseph / of the kernel");
        let bounds = [target, f64::INFINITY];
        figures.push(Figure::within(&what, bounds, ratios[1]).over(rounds, ""));
        let what = format!("{rule}, factors / covariance: time of a step");
        figures.push(Figure::note(&what, format!("{:.2}", ratios[2])).over(rounds, ""));
        let [ours_ns, dense_ns, factors_ns] = times.map(|time| time / STEPS as f64 * 1e9);
        let what = format!("{rule} step: kernel, dense_joseph, kernel on factors");
        let measured = format!("{ours_ns:.0} ns, {dense_ns:.0} ns, {factors_ns:.0} ns");
        figures.push(Figure::note(&what, measured).over(rounds, ""));
    }
    Ok(figures)
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
