//! The filter on the extended model of `examples/extended` against one on the model with every effect
//! of the catalogue, all other effects of which are known to be absent.

use gyrocal::estimation::{ArrayStorage, Filter};
use gyrocal::generated::catalogue::{CatalogueInputs, PARAMETERS as CATALOGUE_PARAMETERS};
use gyrocal::{
    Anchored, Catalogue, Chart, Drift, FilterSettings, InitialAttitude, Integration, Platform,
    Recentring, Site,
};
use gyrocal_extended::extended::{Extended, PARAMETERS, START};
use gyrocal_extended::{Controller, controller};
use gyrocal_truth::{Scenario, simulate};

const STEP_S: f64 = 60.0;
/// (0.002 deg/h)² held over 60 s.
const DENSITY: [f64; 3] = [0.002 * 0.002 * 60.0; 3];
/// (1e-5 g)².
const VARIANCE: [f64; 3] = [1e-10; 3];
/// So small that a parameter of an effect stays what it is.
const NOTHING: f64 = 1e-14;
const FAULT: &str = include_str!("../../../examples/extended/fault.scenario.toml");

type CatalogueFilter = Filter<
    f64,
    Anchored<Catalogue>,
    Chart<f64, CatalogueInputs<f64>>,
    ArrayStorage<f64, 3, 3, { Catalogue::STATES }>,
    3,
    3,
>;

/// Index of each state of the extended model in the model of the catalogue.
fn places() -> [usize; Extended::STATES] {
    let place = |id: &str| {
        let parameter = CATALOGUE_PARAMETERS.iter().position(|other| other.id == id);
        3 + parameter.unwrap()
    };
    std::array::from_fn(|state| match state {
        0..3 => state,
        _ => place(PARAMETERS[state - 3].id),
    })
}

/// Settings of both filters.
pub fn settings(drift: Drift<f64>) -> FilterSettings<f64> {
    FilterSettings {
        drift,
        accel_noise_g: 1e-5,
        drift_noise_deg_per_h: 0.002,
        ..FilterSettings::at_site(Site::at_latitude_deg(39.1))
    }
}

/// Angles known to 0.01 deg.
pub fn attitude(angles_rad: [f64; 3]) -> InitialAttitude<f64> {
    InitialAttitude::Angles {
        angles_rad,
        sigma_rad: [0.01_f64.to_radians(); 3],
    }
}

/// The same start with the effects of the catalogue, all but those of the model file pinned.
fn catalogue_filter(
    settings: &FilterSettings<f64>,
    attitude: &InitialAttitude<f64>,
) -> CatalogueFilter {
    let (mut state, mut sigma) = ([0.0; Catalogue::STATES], [NOTHING; Catalogue::STATES]);
    let places = places();
    let nominal = settings.drift.to_array().into_iter();
    let nominal = nominal.zip(settings.drift_sigma.to_array());
    let mut chart = Chart::for_model(settings.site);
    let angles = attitude.place(&mut chart);
    let angles = angles.angles_rad.into_iter().zip(angles.sigma_rad);
    let known = angles.chain(nominal);
    let effects = START.iter().map(|start| (start.value, start.sigma));
    for (place, (value, deviation)) in places.into_iter().zip(known.chain(effects)) {
        (state[place], sigma[place]) = (value, deviation);
    }
    Filter::new(
        Anchored(Catalogue),
        chart,
        Integration::RK4,
        Recentring::EveryStep,
        ArrayStorage::new(),
        &state,
        &sigma,
    )
    .unwrap()
}

/// The largest difference of a state in sigmas, angles by the axes that the charts give to North
/// and Up, and the largest relative one of a sigma.
fn differences(extended: &Controller<f64>, catalogue: &CatalogueFilter) -> [f64; 2] {
    let extended = extended.filter();
    let places = places();
    let mut largest = [0.0_f64; 2];
    for (state, place) in places.into_iter().enumerate() {
        let sigma = extended.sigma(state);
        let difference = extended.state()[state] - catalogue.state()[place];
        largest[0] = largest[0].max(difference.abs() / sigma);
        largest[1] = largest[1].max((catalogue.sigma(place) / sigma - 1.0).abs());
    }
    let smallest = (0..3).map(|angle| extended.sigma(angle));
    let smallest = smallest.fold(f64::INFINITY, f64::min);
    let axes = |[north, up]: [[f64; 3]; 2]| [north, up].concat();
    let of_extended = axes(extended.inputs().orientation());
    let of_catalogue = axes(catalogue.inputs().orientation());
    for (one, other) in of_extended.iter().zip(of_catalogue) {
        largest[0] = largest[0].max((one - other).abs() / smallest);
    }
    largest
}

/// Differences after one step from the same state: the largest of a state in sigmas, and the largest
/// relative one of a sigma.
pub fn after_one_step() -> [f64; 2] {
    // Angles of any size, coefficients of a bad gyro.
    let drift = [0.41, -0.13, 0.04, -0.29, 0.21, -0.07, 0.15, 0.09, 0.02];
    let settings = settings(Drift::from_array(drift));
    let attitude = attitude([0.4, -0.6, 1.1]);
    let mut extended = controller(&settings, &attitude).unwrap();
    let mut catalogue = catalogue_filter(&settings, &attitude);
    let sample = extended.expected_g();
    extended.take(0.0, &sample).unwrap();
    catalogue.update(&sample, &VARIANCE).unwrap();
    let before = extended.filter().state().to_vec();
    let next = [sample[0] + 4e-3, sample[1] - 3e-3, sample[2] + 1e-3];
    extended.take(STEP_S, &next).unwrap();
    catalogue.predict(STEP_S, &DENSITY).unwrap();
    catalogue.update(&next, &VARIANCE).unwrap();
    assert_ne!(before, extended.filter().state(), "the step did nothing");
    differences(&extended, &catalogue)
}

/// The same after three days of samples.
pub fn after_three_days() -> [f64; 2] {
    let scenario = Scenario::parse(FAULT, "fault.scenario.toml").unwrap();
    let record = simulate(&scenario).unwrap().record;
    let angles = [10.0_f64, -20.0, 35.0].map(f64::to_radians);
    let settings = settings(Drift::from_array([0.0; Platform::PARAMETERS]));
    let attitude = attitude(angles);
    let mut extended = controller(&settings, &attitude).unwrap();
    let mut catalogue = catalogue_filter(&settings, &attitude);
    for (row, sample) in record.accel_g.iter().take(4321).enumerate() {
        if row == 0 {
            extended.take(0.0, sample).unwrap();
        } else {
            extended.take(STEP_S, sample).unwrap();
            catalogue.predict(STEP_S, &DENSITY).unwrap();
        }
        catalogue.update(sample, &VARIANCE).unwrap();
    }
    differences(&extended, &catalogue)
}
