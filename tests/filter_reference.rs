//! The streaming filter's kernel against the textbook dense filter on the platform model.
#![cfg(test)]

use chacha20::ChaCha12Rng;
use gyrocal::estimation::dense::DenseFilter;
use gyrocal::estimation::form::Form;
use gyrocal::estimation::{ArrayStorage, Covariance, Factors, Filter, Storage, VecStorage};
use gyrocal::scalar::Model;
use gyrocal::{
    Anchored, Chart, FactorisedPlatformFilter, FilterSettings, InitialAttitude, Integration,
    Platform, PlatformFilter, Recentring, Site,
};
use nalgebra::{SMatrix, SVector};
use rand::{RngExt, SeedableRng};

const SIGMA: [f64; 12] = [
    2e-4, 3e-4, 4e-4, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0,
];
const STATE: [f64; 12] = [
    0.3, -0.5, 1.9, 0.2, -0.1, 0.05, 0.3, 0.1, -0.05, 0.1, 0.0, 0.02,
];
/// (0.002 deg/h)² held over 60 s.
const DENSITY: [f64; 3] = [2.4e-4; 3];
const VARIANCE: [f64; 3] = [1e-10; 3];

type Kernel<S, F> = Filter<f64, Anchored<Platform>, Chart<f64>, S, 3, 3, F>;
type Dense = DenseFilter<Anchored<Platform>, Chart<f64>, 3, 3, 12>;

fn chart() -> Chart<f64> {
    Chart::east_north_up(Site::at_latitude_deg(-33.0))
}

fn array() -> ArrayStorage<f64, 3, 3, 12> {
    ArrayStorage::new()
}

fn start<S: Storage<f64>, F: Form<f64>>(
    integration: Integration,
    recentring: Recentring<f64>,
    storage: S,
    sigma: &[f64; 12],
) -> Kernel<S, F> {
    Filter::with_form(
        Anchored(Platform),
        chart(),
        integration,
        recentring,
        storage,
        &STATE,
        sigma,
    )
    .unwrap()
}

/// Samples each minute of a platform that moves by the same rule, with noise of 1e-5 g.
fn samples(integration: Integration, recentring: Recentring<f64>, count: usize) -> Vec<[f64; 3]> {
    let mut rng = ChaCha12Rng::seed_from_u64(7);
    let mut truth = start::<_, Covariance>(integration, recentring, array(), &SIGMA);
    let mut sample = || {
        truth.predict(60.0, &DENSITY).unwrap();
        let (moving, parameters) = truth.state().split_first_chunk().unwrap();
        let clean = Anchored(Platform).output(moving, parameters, truth.inputs());
        clean.map(|a| a + 1e-5 * rng.random_range(-1.7..1.7))
    };
    (0..count).map(|_| sample()).collect()
}

/// State, covariance and NIS, to the dense form's own rounding: the first updates shrink
/// variances by 1e4 and more, where it loses digits.
fn assert_agrees<S: Storage<f64>, F: Form<f64>>(
    what: &str,
    (filter, nis): (&Kernel<S, F>, f64),
    (dense, dense_nis): (&Dense, f64),
) {
    assert!(
        (nis - dense_nis).abs() < 1e-6 * (1.0 + dense_nis),
        "{what}: NIS {nis} {dense_nis}"
    );
    let sigma = |i: usize| dense.covariance[(i, i)].sqrt();
    for i in 0..12 {
        let difference = (filter.state()[i] - dense.state[i]).abs() / sigma(i);
        assert!(difference < 1e-6, "{what}, state {i}: {difference:e}");
        for j in 0..12 {
            let difference = (filter.covariance(i, j) - dense.covariance[(i, j)]).abs();
            let difference = difference / (sigma(i) * sigma(j));
            assert!(
                difference < 1e-6,
                "{what}, covariance {i} {j}: {difference:e}"
            );
        }
    }
}

#[test]
fn equals_the_dense_filter_in_every_configuration() {
    for (integration, recentring) in [
        (Integration::RK4, Recentring::EveryStep),
        (Integration::EULER, Recentring::EveryStep),
        (Integration::RK4, Recentring::Never),
        (Integration::EULER, Recentring::Never),
        (Integration::RK4, Recentring::Beyond(0.35)),
        (Integration::Euler { substeps: 8 }, Recentring::EveryStep),
    ] {
        let mut filter = start::<_, Covariance>(integration, recentring, array(), &SIGMA);
        let mut factors = start::<_, Factors>(integration, recentring, array(), &SIGMA);
        let vectors = VecStorage::new(12, 3, 3);
        let mut vector = start::<_, Covariance>(integration, recentring, vectors, &SIGMA);
        let mut dense = Dense::new(
            Anchored(Platform),
            chart(),
            integration,
            recentring,
            SVector::from(STATE),
            SMatrix::from_diagonal(&SVector::from(SIGMA.map(|sigma| sigma * sigma))),
        );
        let samples = samples(integration, recentring, 500);
        for (step, sample) in samples.iter().enumerate() {
            filter.predict(60.0, &DENSITY).unwrap();
            vector.predict(60.0, &DENSITY).unwrap();
            factors.predict(60.0, &DENSITY).unwrap();
            dense.predict(60.0, &DENSITY);
            let nis = filter.update(sample, &VARIANCE).unwrap().nis;
            let vector_nis = vector.update(sample, &VARIANCE).unwrap().nis;
            let factors_nis = factors.update(sample, &VARIANCE).unwrap().nis;
            let dense_nis = dense.update(sample, &VARIANCE).unwrap().nis;
            let what = |form: &str| format!("{form}, {integration:?} {recentring:?} step {step}");
            let reference = (&dense, dense_nis);
            assert_agrees(&what("covariance"), (&filter, nis), reference);
            assert_agrees(&what("vector"), (&vector, vector_nis), reference);
            assert_agrees(&what("factors"), (&factors, factors_nis), reference);
        }
        // The same operations in the same order, wherever the numbers are.
        assert_eq!(filter.state(), vector.state());
    }
}

/// All public results of a filter after a step, as bits.
fn bits<F: Form<f64>>(filter: &Kernel<ArrayStorage<f64, 3, 3, 12>, F>, nis: f64) -> Vec<u64> {
    let covariance = (0..144).map(|at| filter.covariance(at / 12, at % 12));
    let state = filter.state().iter().copied();
    let numbers = state.chain(covariance).chain([nis]);
    numbers.map(f64::to_bits).collect()
}

fn a_limit_that_is_never_reached<F: Form<f64>>() {
    let never = Recentring::Never;
    let mut single = start::<_, F>(Integration::RK4, never, array(), &SIGMA);
    let beyond = Recentring::Beyond(1e9);
    let mut limited = start::<_, F>(Integration::RK4, beyond, array(), &SIGMA);
    for sample in samples(Integration::RK4, never, 300) {
        single.predict(60.0, &DENSITY).unwrap();
        limited.predict(60.0, &DENSITY).unwrap();
        let nis = single.update(&sample, &VARIANCE).unwrap().nis;
        let limited_nis = limited.update(&sample, &VARIANCE).unwrap().nis;
        assert_eq!(bits(&single, nis), bits(&limited, limited_nis));
    }
    assert_eq!(single.inputs(), &chart());
    assert_eq!(limited.inputs(), &chart());
}

#[test]
fn a_limit_that_is_never_reached_changes_no_bit() {
    a_limit_that_is_never_reached::<Covariance>();
    a_limit_that_is_never_reached::<Factors>();
}

#[test]
fn a_chart_that_moves_now_and_then_agrees_with_one_that_moves_at_every_step() {
    // Between charts an error of the attitude, 4e-4 rad, is the same to first order. Its square,
    // 1.6e-7 rad, is 0.016 of a sample's noise; sigmas change by 4e-4 with what they are
    // linearised at. Coefficients this narrow add 3e-6 rad a minute and do not matter.
    let mut sigma = SIGMA;
    sigma[3..].fill(0.01);
    let every = Recentring::EveryStep;
    let mut always = start::<_, Covariance>(Integration::RK4, every, array(), &sigma);
    let limit = Recentring::Beyond(0.35);
    let mut limited = start::<_, Covariance>(Integration::RK4, limit, array(), &sigma);
    let mut moves = 0;
    let mut largest = (0.0_f64, 0.0_f64);
    for sample in samples(Integration::RK4, every, 360) {
        let before = *limited.inputs();
        always.predict(60.0, &DENSITY).unwrap();
        limited.predict(60.0, &DENSITY).unwrap();
        moves += usize::from(*limited.inputs() != before);
        always.update(&sample, &VARIANCE).unwrap();
        limited.update(&sample, &VARIANCE).unwrap();
        for i in 3..12 {
            let difference = limited.state()[i] - always.state()[i];
            largest.0 = largest.0.max(difference.abs() / always.sigma(i));
            largest.1 = largest
                .1
                .max((limited.sigma(i) / always.sigma(i) - 1.0).abs());
        }
    }
    // Six hours are 90 degrees, at 20 a chart, less what is not about one axis.
    assert!((3..=6).contains(&moves), "{moves} moves");
    // Three and five times that.
    assert!(largest.0 < 0.05 && largest.1 < 2e-3, "{largest:?}");
}

#[test]
fn single_precision_follows_double_precision() {
    let settings = FilterSettings::at_site(Site::at_latitude_deg(39.1));
    let single = FilterSettings::<f32>::at_site(Site::at_latitude_deg(39.1));
    let mut double = PlatformFilter::<f64>::new(&settings, &InitialAttitude::aligned()).unwrap();
    let mut single =
        FactorisedPlatformFilter::factorised(&single, &InitialAttitude::aligned()).unwrap();
    let mut truth = double.clone();
    for _ in 0..300 {
        truth.predict(60.0).unwrap();
        let [_, _, up] = core::array::from_fn(|row| truth.platform_c_enu()[row][2]);
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
    let settings = FilterSettings::at_site(Site::at_latitude_deg(39.1));
    let mut gap = PlatformFilter::<f64>::new(&settings, &InitialAttitude::aligned()).unwrap();
    let mut steps = gap.clone();
    gap.predict(7200.0).unwrap();
    for _ in 0..60 {
        steps.predict(120.0).unwrap();
    }
    assert_eq!(gap.angles_rad(), steps.angles_rad());
    assert_eq!(gap.drift_covariance(), steps.drift_covariance());
}
