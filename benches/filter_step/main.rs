//! Cost of one filter step (predict over 60 s, update with three accelerometers) with twelve
//! states.
//!
//! `dense_joseph` is the textbook filter of `gyrocal_estimation::dense` with Euler angles in
//! one chart: less work than the default filter does, whose chart moves at every step.
//! `adskalman` and `multicalc` are Joseph-form filters of other packages on the same generated
//! functions, of the Euler step only: with Runge-Kutta they would take the same dense step after
//! the same transition. Compare within one run only; `cargo figures kernel --part filter` judges the ratios.
#![expect(clippy::unwrap_used, reason = "a bench stops at what fails")]

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use gyrocal::estimation::dense::DenseFilter;
use gyrocal::{
    Anchored, Chart, Discretisation, FilterSettings, InitialAttitude, Integration, Platform,
    PlatformFilter, Recentring, Site,
};
use gyrocal_testkit::peer_filters::{Adskalman, Multicalc};
use nalgebra::{SMatrix, SVector};

/// Interval between samples, s.
const STEP_S: f64 = 60.0;
/// Spectral density of 0.002 deg/h held over 60 s, (deg/h)² s.
const DENSITY: [f64; 3] = [2.4e-4; 3];
/// Variance of one sample of 1e-5 g.
const VARIANCE: [f64; 3] = [1e-10; 3];
/// Angle and coefficient sigmas of [`InitialAttitude::aligned`] and [`FilterSettings::at_site`], squared.
const PRIOR_VARIANCE: [f64; 12] = {
    let angle = 0.01 / 180.0 * std::f64::consts::PI;
    let a = angle * angle;
    [a, a, a, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0]
};

fn chart() -> Chart<f64> {
    Chart::east_north_up(Site::at_latitude_deg(39.1))
}

/// Ten hours of noise-free samples of a platform without drift, far from gimbal lock.
fn samples() -> Vec<[f64; 3]> {
    let mut truth = PlatformFilter::new(
        &FilterSettings::at_site(Site::at_latitude_deg(39.1)),
        &InitialAttitude::aligned(),
    )
    .unwrap();
    (0..600)
        .map(|_| {
            truth.predict(STEP_S).unwrap();
            truth.platform_c_enu().map(|row| row[2])
        })
        .collect()
}

/// Time of `iterations` steps, starting again from `start` after each pass over the samples.
fn time<F: Clone>(
    iterations: u64,
    samples: &[[f64; 3]],
    start: &F,
    step: impl Fn(&mut F, &[f64; 3]),
) -> Duration {
    let mut left = iterations as usize;
    let mut elapsed = Duration::ZERO;
    while left > 0 {
        let mut filter = start.clone();
        let count = left.min(samples.len());
        let begin = Instant::now();
        for sample in &samples[..count] {
            step(&mut filter, black_box(sample));
        }
        elapsed += begin.elapsed();
        black_box(&filter);
        left -= count;
    }
    elapsed
}

fn filter_step(criterion: &mut Criterion) {
    let samples = samples();
    for (name, integration) in [("euler", Integration::EULER), ("rk4", Integration::RK4)] {
        let mut group = criterion.benchmark_group(format!("filter_step/{name}"));
        group
            .warm_up_time(Duration::from_millis(500))
            .measurement_time(Duration::from_secs(2));

        let settings = FilterSettings {
            discretisation: Discretisation {
                integration,
                ..Discretisation::default()
            },
            ..FilterSettings::at_site(Site::at_latitude_deg(39.1))
        };
        let start = PlatformFilter::new(&settings, &InitialAttitude::aligned()).unwrap();
        group.bench_function("generated", |bencher| {
            bencher.iter_custom(|iterations| {
                time(iterations, &samples, &start, |filter, sample| {
                    black_box(filter.step(STEP_S, sample).unwrap());
                })
            });
        });

        let dense = |recentring| {
            DenseFilter::<_, _, 3, 3, 12>::new(
                Anchored(Platform),
                chart(),
                integration,
                recentring,
                SVector::zeros(),
                SMatrix::from_diagonal(&SVector::from(PRIOR_VARIANCE)),
            )
        };
        for (label, recentring) in [
            ("dense_joseph", Recentring::Never),
            ("dense_joseph_recentred", Recentring::EveryStep),
        ] {
            let start = dense(recentring);
            group.bench_function(label, |bencher| {
                bencher.iter_custom(|iterations| {
                    time(iterations, &samples, &start, |filter, sample| {
                        filter.predict(STEP_S, &DENSITY);
                        black_box(filter.update(sample, &VARIANCE).unwrap());
                    })
                });
            });
        }

        if integration == Integration::EULER {
            let start = Adskalman::new(chart(), PRIOR_VARIANCE, DENSITY, VARIANCE);
            group.bench_function("adskalman", |bencher| {
                bencher.iter_custom(|iterations| {
                    time(iterations, &samples, &start, |filter, sample| {
                        filter.step(STEP_S, sample);
                    })
                });
            });
            let start = Multicalc::new(chart(), PRIOR_VARIANCE, DENSITY, VARIANCE);
            group.bench_function("multicalc", |bencher| {
                bencher.iter_custom(|iterations| {
                    time(iterations, &samples, &start, |filter, sample| {
                        filter.step(STEP_S, sample);
                    })
                });
            });
        }
        group.finish();
    }
}

criterion_group!(benches, filter_step);
criterion_main!(benches);
