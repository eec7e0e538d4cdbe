//! Filters on the extended models, and the charts that give them their inputs.
#![cfg(feature = "catalogue")]
#![cfg(test)]

use gyrocal::estimation::{Filter, VecStorage};
use gyrocal::generated::catalogue::{CatalogueInputs, conditions_index, parameters_index};
use gyrocal::generated::platform::PlatformInputs;
use gyrocal::generated::surveyed::SurveyedInputs;
use gyrocal::scalar::{Model, Recentre};
use gyrocal::{
    Anchored, Catalogue, Chart, ChartInputs, Drift, ExtensionFilter, FilterSettings,
    InitialAttitude, Integration, Platform, Recentring, Regressors, Site, Surveyed,
};

const LATITUDE_DEG: f64 = 39.1;
const STEPS: usize = 300;
const STEP_S: f64 = 60.0;
/// (0.002 deg/h)² held over 60 s.
const DENSITY: [f64; 3] = [2.4e-4; 3];
/// (1e-5 g)².
const VARIANCE: [f64; 3] = [1e-10; 3];
/// Small enough to keep a parameter of an effect constant.
const NOTHING: f64 = 1e-14;

type Of<D, I> = Filter<f64, Anchored<D>, Chart<f64, I>, VecStorage<f64>, 3, 3>;

fn site() -> Site<f64> {
    Site::at_latitude_deg(LATITUDE_DEG)
}

fn filter<D, I>(model: D) -> Of<D, I>
where
    I: ChartInputs<f64>,
    D: Model<f64, 3, 3, Inputs = I>,
{
    let parameters = model.parameters();
    let mut sigma = vec![NOTHING; 3 + parameters];
    sigma[..3].fill(2e-4);
    sigma[3..12].fill(1.0);
    Filter::new(
        Anchored(model),
        Chart::for_model(site()),
        Integration::RK4,
        Recentring::EveryStep,
        VecStorage::new(3 + parameters, 3, 3),
        &vec![0.0; 3 + parameters],
        &sigma,
    )
    .unwrap()
}

/// Samples that no drift reproduces exactly: both filters must process them equally.
fn sample(step: usize) -> [f64; 3] {
    let angle = 2e-3 * step as f64;
    [
        0.3 * angle.sin(),
        -0.2 * angle.sin(),
        (1.0 - 0.13 * angle.sin().powi(2)).sqrt(),
    ]
}

fn run<D, I>(mut filter: Of<D, I>) -> Vec<[f64; 2]>
where
    I: ChartInputs<f64>,
    D: Model<f64, 3, 3, Inputs = I>,
    Anchored<D>: Recentre<f64, 3, 3, Inputs = Chart<f64, I>>,
{
    for step in 0..STEPS {
        if step > 0 {
            filter.predict(STEP_S, &DENSITY).unwrap();
        }
        filter.update(&sample(step), &VARIANCE).unwrap();
    }
    (3..12)
        .map(|i| [filter.state()[i], filter.sigma(i)])
        .collect()
}

#[test]
fn filters_with_effects_that_are_known_to_be_absent_are_the_nominal_one() {
    let nominal = run::<_, PlatformInputs<f64>>(filter(Platform));
    let surveyed = run::<_, SurveyedInputs<f64>>(filter(Surveyed));
    let catalogue = run::<_, CatalogueInputs<f64>>(filter(Catalogue));
    for others in [surveyed, catalogue] {
        for ([value, sigma], [other, other_sigma]) in nominal.iter().zip(others) {
            // Rounding of 300 steps of this form of the covariance is 1e-7 of a sigma.
            assert!(
                (value - other).abs() < 1e-6 * sigma,
                "{value} {other} {sigma}"
            );
            assert!(
                (sigma - other_sigma).abs() < 1e-6 * sigma,
                "{sigma} {other_sigma}"
            );
        }
    }
}

#[test]
fn a_chart_carries_all_that_is_fixed_to_the_earth() {
    let mut chart: Chart<f64, CatalogueInputs<f64>> = Chart::for_model(site());
    chart.set_field_gauss([0.02, 0.27, -0.44]);
    chart.inputs_mut().conditions[conditions_index::TIME_S] = 1234.5;
    assert_eq!(chart.inputs().field_0, [0.02, 0.27, -0.44]);
    let model = Anchored(Catalogue);
    for _ in 0..10 {
        let mut moving = [0.3, -0.2, 0.5];
        model.recentre(&mut moving, &mut chart).unwrap();
    }
    let inputs = *chart.inputs();
    let c = chart.chart_c_enu();
    let in_chart =
        |enu: [f64; 3]| -> [f64; 3] { c.map(|row| row.iter().zip(enu).map(|(a, b)| a * b).sum()) };
    let (sine, cosine) = LATITUDE_DEG.to_radians().sin_cos();
    let rate = gyrocal::EARTH_RATE_RAD_PER_S;
    for (given, expected, scale) in [
        (inputs.east_0, in_chart([1.0, 0.0, 0.0]), 1.0),
        (inputs.f_0, in_chart([0.0, 0.0, 1.0]), 1.0),
        (
            inputs.omega_0,
            in_chart([0.0, rate * cosine, rate * sine]),
            rate,
        ),
        (inputs.field_0, in_chart([0.02, 0.27, -0.44]), 1.0),
    ] {
        for (given, expected) in given.iter().zip(expected) {
            // Ten turns of a few roundings each.
            assert!(
                (given - expected).abs() < 1e-14 * scale,
                "{given} {expected}"
            );
        }
    }
    assert_eq!(inputs.conditions[conditions_index::TIME_S], 1234.5);
}

#[test]
fn a_filter_with_effects_of_temperature_takes_what_follows_from_it() {
    const STATES: usize = Catalogue::STATES;
    type Extended = ExtensionFilter<f64, Catalogue, CatalogueInputs<f64>, STATES>;
    let sizes = [
        (parameters_index::GYRO_X_TEMPERATURE, 0.01),
        (parameters_index::GYRO_X_TEMPERATURE_SQUARE, 0.002),
        (parameters_index::GYRO_X_TEMPERATURE_RATE, 0.03),
        (parameters_index::GYRO_X_TEMPERATURE_HYSTERESIS, 0.05),
    ];
    let start = (Platform::PARAMETERS..Catalogue::PARAMETERS).map(|place| {
        let own = sizes.iter().find(|(index, _)| *index == place);
        [own.map_or(0.0, |(_, size)| *size), NOTHING]
    });
    let settings = FilterSettings {
        drift_sigma: Drift::from_array([NOTHING; 9]),
        ..FilterSettings::at_site(site())
    };
    let attitude = InitialAttitude::Angles {
        angles_rad: [0.0; 3],
        sigma_rad: [1e-5; 3],
    };
    let mut filter = Extended::new(Catalogue, start, &settings, &attitude).unwrap();
    let up = [0.0, 0.0, 1.0];
    filter.take(0.0, &up).unwrap();
    // Without a temperature the effects are silent.
    assert!(filter.drift_deg_per_h(&up)[0].abs() < 1e-12);
    filter.set_regressors(&Regressors {
        temperature_k: 3.0,
        temperature_rate_k_per_h: -0.5,
        temperature_hysteresis_k: 0.2,
    });
    let expected = 0.01 * 3.0 + 0.002 * 9.0 - 0.03 * 0.5 + 0.05 * 0.2;
    for _ in 0..2 {
        // To the sigma that the sizes are given, and rounding.
        let drift = filter.drift_deg_per_h(&up)[0];
        assert!((drift - expected).abs() < 1e-10, "{drift} {expected}");
        // A step keeps them.
        filter.coast(60.0).unwrap();
    }
}

#[test]
fn a_greater_latitude_is_the_chart_of_that_latitude() {
    let mut parameters = [0.0; Surveyed::PARAMETERS];
    parameters[gyrocal::generated::surveyed::parameters_index::SITE_LATITUDE] = 0.25;
    let here: Chart<f64, SurveyedInputs<f64>> = Chart::for_model(site());
    let there = Chart::east_north_up(Site::at_latitude_deg(LATITUDE_DEG + 0.25));
    let theta = [0.4, -0.3, 0.9];
    let surveyed = Surveyed.rates(&theta, &parameters, here.inputs());
    let nominal = Platform.rates(&theta, &[0.0; Platform::PARAMETERS], there.inputs());
    for (surveyed, nominal) in surveyed.iter().zip(nominal) {
        // Rates of 7e-5 rad/s, some ten roundings.
        assert!(
            (surveyed - nominal).abs() < 2e-19,
            "{surveyed:e} {nominal:e}"
        );
    }
}

#[test]
fn fresh_inputs_have_no_division_by_zero() {
    let chart: Chart<f64, CatalogueInputs<f64>> = Chart::for_model(site());
    let mut parameters = [0.1; Catalogue::PARAMETERS];
    parameters[parameters_index::GYRO_X_STEP] = 1.0;
    let rates = Catalogue.rates(&[0.1; 3], &parameters, chart.inputs());
    assert!(rates.iter().all(|rate| rate.is_finite()), "{rates:?}");
}
