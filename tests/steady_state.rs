//! No step of a filter allocates, wherever the filter keeps its numbers.
//!
//! `allocation-counter` replaces the allocator of this test binary only, counts by thread, and
//! needs no unsafe code here.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "numerics/extended_platform.rs"]
mod extended_platform;

use std::hint::black_box;

use allocation_counter::measure;
use gyrocal::estimation::{ArrayStorage, Filter, Storage, VecStorage};
use gyrocal::scalar::Recentre;
use gyrocal::{Anchored, Chart, Integration, Platform, PlatformFilter, Recentring, Settings, Site};

use extended_platform::ExtendedPlatform;

const STEPS: usize = 200;
const DENSITY: [f64; 3] = [2.4e-4; 3];
const VARIANCE: [f64; 3] = [1e-10; 3];
/// Whole samples and samples with a missing component.
const SAMPLES: [[f64; 3]; 2] = [[0.0, 0.0, 1.0], [0.0, f64::NAN, 1.0]];
const INTEGRATIONS: [Integration; 3] = [
    Integration::EULER,
    Integration::RK4,
    Integration::Rk4 { substeps: 3 },
];

fn allocations(work: impl FnOnce()) -> u64 {
    measure(work).count_total
}

#[test]
fn the_counter_counts() {
    assert_eq!(
        allocations(|| drop(black_box(vec![0_u8; black_box(100)]))),
        1
    );
}

fn steps_of<D, S>(
    model: D,
    storage: S,
    integration: Integration,
    recentring: Recentring<f64>,
) -> u64
where
    D: Recentre<f64, 3, 3, Inputs = Chart<f64>>,
    S: Storage<f64>,
{
    let n = storage.states();
    let mut sigma = vec![1.0; n];
    sigma[..3].fill(2e-4);
    let chart = Chart::east_north_up(Site::at_latitude_deg(39.1));
    let state = vec![0.0; n];
    let mut filter = Filter::new(
        model,
        chart,
        integration,
        recentring,
        storage,
        &state,
        &sigma,
    )
    .unwrap();
    allocations(|| {
        for step in 0..STEPS {
            filter.predict(60.0, &DENSITY).unwrap();
            let sample = &SAMPLES[step % 2];
            if step % 5 == 4 {
                filter.update_gated(sample, &VARIANCE, 50.0).unwrap();
            } else {
                filter.update(sample, &VARIANCE).unwrap();
            }
            black_box((filter.state(), filter.sigma(3), filter.covariance(0, n - 1)));
        }
    })
}

#[test]
fn no_step_allocates() {
    for integration in INTEGRATIONS {
        for recentring in [
            Recentring::EveryStep,
            Recentring::Beyond(0.2),
            Recentring::Never,
        ] {
            let what = format!("{integration:?}, {recentring:?}");
            let array = ArrayStorage::<f64, 3, 3, 12>::new();
            let nominal = Anchored(Platform);
            assert_eq!(
                steps_of(nominal, array, integration, recentring),
                0,
                "arrays, {what}"
            );
            for additional in [0, 6, 48] {
                let model = ExtendedPlatform { additional };
                let storage = VecStorage::new(12 + additional, 3, 3);
                let count = steps_of(model, storage, integration, recentring);
                assert_eq!(
                    count, 0,
                    "vectors, {additional} additional parameters, {what}"
                );
            }
        }
    }
}

#[test]
fn no_call_of_the_platform_filter_allocates() {
    for integration in INTEGRATIONS {
        let settings = Settings {
            integration,
            ..Settings::level_at(Site::at_latitude_deg(39.1))
        };
        let count = allocations(|| {
            let mut filter = PlatformFilter::<f64>::new(&settings).unwrap();
            for sample in SAMPLES.iter().cycle().take(STEPS) {
                filter.step(60.0, sample).unwrap();
                filter.predict(1000.0).unwrap();
                filter.update_gated(sample, 50.0).unwrap();
                black_box((
                    filter.drift(),
                    filter.drift_sigma(),
                    filter.drift_covariance(),
                ));
                black_box((filter.angles_rad(), filter.platform_c_enu()));
            }
        });
        assert_eq!(count, 0, "{integration:?}");
    }
}
