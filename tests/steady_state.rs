//! No step of a filter allocates, with any storage of its numbers.
//!
//! `allocation-counter` replaces the allocator of this test binary only, counts by thread, and
//! needs no unsafe code here.
#![cfg(test)]

use std::hint::black_box;

use allocation_counter::measure;
use gyrocal::estimation::form::Form;
use gyrocal::estimation::{ArrayStorage, Covariance, Factors, Filter, Storage, VecStorage};
use gyrocal::scalar::Recentre;
use gyrocal::{
    Anchored, Chart, Discretisation, FilterSettings, InitialAttitude, Integration, Platform,
    PlatformFilter, Precision, Recentring, Site,
};
use gyrocal_testkit::extended_platform::ExtendedPlatform;

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

fn steps_of<F, D, S>(
    model: D,
    storage: S,
    integration: Integration,
    recentring: Recentring<f64>,
) -> u64
where
    F: Form<f64>,
    D: Recentre<f64, 3, 3, Inputs = Chart<f64>>,
    S: Storage<f64>,
{
    let n = storage.states();
    let mut sigma = vec![1.0; n];
    sigma[..3].fill(2e-4);
    let chart = Chart::east_north_up(Site::at_latitude_deg(39.1));
    let state = vec![0.0; n];
    let mut filter = Filter::<_, _, _, _, 3, 3, F>::with_form(
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

fn no_step_of_the_form_allocates<F: Form<f64>>(form: &str) {
    for integration in INTEGRATIONS {
        for recentring in [
            Recentring::EveryStep,
            Recentring::Beyond(0.2),
            Recentring::Never,
        ] {
            let what = format!("{form}, {integration:?}, {recentring:?}");
            let array = ArrayStorage::<f64, 3, 3, 12>::new();
            let nominal = Anchored(Platform);
            assert_eq!(
                steps_of::<F, _, _>(nominal, array, integration, recentring),
                0,
                "arrays, {what}"
            );
            for additional in [0, 6, 48] {
                let model = ExtendedPlatform { additional };
                let storage = VecStorage::new(12 + additional, 3, 3);
                let count = steps_of::<F, _, _>(model, storage, integration, recentring);
                assert_eq!(
                    count, 0,
                    "vectors, {additional} additional parameters, {what}"
                );
            }
        }
    }
}

#[test]
fn no_step_allocates() {
    no_step_of_the_form_allocates::<Covariance>("covariance");
    no_step_of_the_form_allocates::<Factors>("factors");
}

/// Allocations of every call of the filter of a platform, in the number type `T`.
fn calls_of<T: Precision, F: Form<T>>(integration: Integration) -> u64 {
    let settings = FilterSettings {
        discretisation: Discretisation {
            integration,
            ..Discretisation::default()
        },
        ..FilterSettings::at_site(Site::at_latitude_deg(39.1))
    };
    let samples = SAMPLES.map(|sample| sample.map(T::from_f64));
    allocations(|| {
        let mut filter =
            PlatformFilter::<T, F>::with_form(&settings, &InitialAttitude::aligned()).unwrap();
        for sample in samples.iter().cycle().take(STEPS) {
            filter.step(T::from_f64(60.0), sample).unwrap();
            filter.predict(T::from_f64(1000.0)).unwrap();
            filter.update_gated(sample, T::from_f64(50.0)).unwrap();
            black_box((
                filter.drift(),
                filter.drift_sigma(),
                filter.drift_covariance(),
            ));
            black_box((filter.angles_rad(), filter.platform_c_enu()));
        }
    })
}

#[test]
fn no_call_of_the_platform_filter_allocates() {
    for integration in INTEGRATIONS {
        let count = calls_of::<f64, Covariance>(integration);
        assert_eq!(count, 0, "covariance, {integration:?}");
        let count = calls_of::<f64, Factors>(integration);
        assert_eq!(count, 0, "factors, {integration:?}");
        let count = calls_of::<f32, Factors>(integration);
        assert_eq!(count, 0, "factors in single precision, {integration:?}");
    }
}
