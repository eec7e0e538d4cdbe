//! The streaming filter's kernel against the textbook dense filter on the platform model.
#![allow(clippy::unwrap_used, clippy::expect_used, missing_docs)]

use gyrocal::estimation::dense::DenseFilter;
use gyrocal::estimation::{ArrayStorage, Factors, Filter, VecStorage};
use gyrocal::{
    Anchored, Chart, FactorisedPlatformFilter, Integration, Platform, PlatformFilter, Recentring,
    Settings, Site,
};
use nalgebra::{SMatrix, SVector};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;

const SIGMA: [f64; 12] = [
    2e-4, 3e-4, 4e-4, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0,
];
const STATE: [f64; 12] = [
    0.3, -0.5, 1.9, 0.2, -0.1, 0.05, 0.3, 0.1, -0.05, 0.1, 0.0, 0.02,
];
/// (0.002 deg/h)² held over 60 s.
const DENSITY: [f64; 3] = [2.4e-4; 3];
const VARIANCE: [f64; 3] = [1e-10; 3];

fn chart() -> Chart<f64> {
    Chart::east_north_up(Site::at_latitude_deg(-33.0))
}

#[test]
fn equals_the_dense_filter_in_every_configuration() {
    for (integration, recentring) in [
        (Integration::RK4, Recentring::EveryStep),
        (Integration::EULER, Recentring::EveryStep),
        (Integration::RK4, Recentring::Never),
        (Integration::EULER, Recentring::Never),
        (Integration::Euler { substeps: 8 }, Recentring::EveryStep),
    ] {
        let mut rng = ChaCha12Rng::seed_from_u64(7);
        let mut filter = Filter::new(
            Anchored(Platform),
            chart(),
            integration,
            recentring,
            ArrayStorage::<f64, 3, 3, 12>::new(),
            &STATE,
            &SIGMA,
        )
        .unwrap();
        let mut factors = Filter::<_, _, _, _, 3, 3, Factors>::with_form(
            Anchored(Platform),
            chart(),
            integration,
            recentring,
            ArrayStorage::<f64, 3, 3, 12>::new(),
            &STATE,
            &SIGMA,
        )
        .unwrap();
        let mut vector = Filter::new(
            Anchored(Platform),
            chart(),
            integration,
            recentring,
            VecStorage::new(12, 3, 3),
            &STATE,
            &SIGMA,
        )
        .unwrap();
        let mut dense = DenseFilter::new(
            Anchored(Platform),
            chart(),
            integration,
            recentring,
            SVector::from(STATE),
            SMatrix::from_diagonal(&SVector::from(SIGMA.map(|sigma| sigma * sigma))),
        );
        let mut truth = filter.clone();
        for step in 0..500 {
            filter.predict(60.0, &DENSITY).unwrap();
            vector.predict(60.0, &DENSITY).unwrap();
            factors.predict(60.0, &DENSITY).unwrap();
            dense.predict(60.0, &DENSITY);
            truth.predict(60.0, &DENSITY).unwrap();
            let measured = {
                use gyrocal::scalar::Model;
                let state = truth.state();
                let moving = [state[0], state[1], state[2]];
                let clean = Anchored(Platform).output(&moving, &state[3..], truth.inputs());
                clean.map(|a: f64| a + 1e-5 * rng.random_range(-1.7..1.7))
            };
            let innovation = filter.update(&measured, &VARIANCE).unwrap();
            vector.update(&measured, &VARIANCE).unwrap();
            factors.update(&measured, &VARIANCE).unwrap();
            let reference = dense.update(&measured, &VARIANCE).unwrap();
            // The first updates shrink variances by 1e4 and more, where the dense form loses
            // digits; both agree to the dense form's own rounding.
            assert!(
                (innovation.nis - reference.nis).abs() < 1e-6 * (1.0 + reference.nis),
                "{integration:?} {recentring:?} step {step}: {} {}",
                innovation.nis,
                reference.nis
            );
            for i in 0..12 {
                let sigma = dense.covariance[(i, i)].sqrt();
                let difference = (filter.state()[i] - dense.state[i]).abs() / sigma;
                assert!(
                    difference < 1e-6,
                    "{integration:?} step {step} state {i}: {difference:e}"
                );
                for j in 0..12 {
                    let scale = sigma * dense.covariance[(j, j)].sqrt();
                    let difference =
                        (filter.covariance(i, j) - dense.covariance[(i, j)]).abs() / scale;
                    assert!(
                        difference < 1e-6,
                        "{integration:?} step {step}: {difference:e}"
                    );
                }
            }
        }
        assert_eq!(filter.state(), vector.state());
    }
}

#[test]
fn single_precision_follows_double_precision() {
    let settings = Settings::level_at(Site::at_latitude_deg(39.1));
    let single = Settings::<f32>::level_at(Site::at_latitude_deg(39.1));
    let mut double = PlatformFilter::<f64>::new(&settings).unwrap();
    let mut single = FactorisedPlatformFilter::factorised(&single).unwrap();
    let mut truth = double.clone();
    for _ in 0..300 {
        truth.predict(60.0).unwrap();
        let [_, _, up] = [0, 1, 2].map(|row| truth.platform_c_enu()[row][2]);
        let measured = [
            truth.platform_c_enu()[0][2],
            truth.platform_c_enu()[1][2],
            up,
        ];
        double.step(60.0, &measured).unwrap();
        single.step(60.0, &measured.map(|a| a as f32)).unwrap();
    }
    let (double, expected) = (double.drift().to_array(), double.drift_sigma().to_array());
    let (single, sigma) = (single.drift().to_array(), single.drift_sigma().to_array());
    for i in 0..9 {
        // An f32 attitude is good to 6e-8 rad, 1/160 of the sample noise, in 300 samples.
        let difference = (f64::from(single[i]) - double[i]).abs();
        assert!(
            difference < 0.5 * expected[i],
            "coefficient {i}: {difference} of {}",
            expected[i]
        );
        assert!(
            (f64::from(sigma[i]) / expected[i] - 1.0).abs() < 0.05,
            "sigma {i}"
        );
    }
}

#[test]
fn long_gaps_are_divided_and_equal_many_short_steps() {
    let settings = Settings::level_at(Site::at_latitude_deg(39.1));
    let mut gap = PlatformFilter::<f64>::new(&settings).unwrap();
    let mut steps = gap.clone();
    gap.predict(7200.0).unwrap();
    for _ in 0..60 {
        steps.predict(120.0).unwrap();
    }
    assert_eq!(gap.angles_rad(), steps.angles_rad());
    assert_eq!(gap.drift_covariance(), steps.drift_covariance());
}
