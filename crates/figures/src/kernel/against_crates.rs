//! Time of the textbook filter relative to Joseph-form filters of other packages: the reference of the
//! kernel must not be a slow one.

use std::hint::black_box;

use gyrocal::estimation::dense::DenseFilter;
use gyrocal::{Anchored, Chart, EstimationError, Integration, Platform, Recentring, Site};
use nalgebra::{SMatrix, SVector};

use super::Error;
use crate::figure::Figure;
use gyrocal_testkit::extended_filter::samples;
use gyrocal_testkit::peer_filters::{Adskalman, Multicalc};
use gyrocal_testkit::step_times::{DENSITY, STEP_S, STEPS, VARIANCE};
use gyrocal_testkit::timing::{medians, seconds, well_placed};

/// Largest time relative to the fastest of them.
const ALLOWED: f64 = 1.1;
const ANGLE_SIGMA_RAD: f64 = 2e-4;

pub(crate) fn figures(rounds: usize) -> Result<Vec<Figure>, Error> {
    let samples = samples(STEPS)?;
    let chart = Chart::east_north_up(Site::at_latitude_deg(39.1));
    let mut prior = [1.0; 12];
    prior[..3].fill(ANGLE_SIGMA_RAD * ANGLE_SIGMA_RAD);
    let dense = DenseFilter::<_, _, 3, 3, 12>::new(
        Anchored(Platform),
        chart,
        Integration::EULER,
        Recentring::Never,
        SVector::zeros(),
        SMatrix::from_diagonal(&SVector::from(prior)),
    );
    let adskalman = Adskalman::new(chart, prior, DENSITY, VARIANCE);
    let multicalc = Multicalc::new(chart, prior, DENSITY, VARIANCE);
    let (times, ratios) = medians(rounds, || {
        Ok::<_, EstimationError>([
            time(&dense, &samples, |filter, sample| {
                filter.predict(STEP_S, &DENSITY);
                black_box(filter.update(sample, &VARIANCE)?);
                Ok(())
            })?,
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
    let [dense_ns, adskalman_ns, multicalc_ns] = times.map(|time| time / STEPS as f64 * 1e9);
    let ratio = 1.0 / ratios[1].min(ratios[2]);
    let what = "euler step: dense_joseph / fastest Joseph-form crate";
    let times = format!("{dense_ns:.0} ns, {adskalman_ns:.0} ns, {multicalc_ns:.0} ns");
    Ok(vec![
        Figure::within(what, [f64::NEG_INFINITY, ALLOWED], ratio).over(rounds, ""),
        Figure::note("euler step: dense_joseph, adskalman, multicalc", times).over(rounds, ""),
    ])
}

/// Time of a copy of a filter for the samples, s.
fn time<F: Clone>(
    start: &F,
    samples: &[[f64; 3]],
    step: impl Fn(&mut F, &[f64; 3]) -> Result<(), EstimationError>,
) -> Result<f64, EstimationError> {
    well_placed(|| {
        let mut filter = black_box(start.clone());
        let time = seconds(|| {
            samples
                .iter()
                .try_for_each(|sample| step(&mut filter, black_box(sample)))
        });
        black_box(&filter);
        time
    })
}
