//! The numbers that the tests of a file expect, from the libraries.

use gyrocal::generated::catalogue::{PARAMETERS, SHAPES};
use gyrocal::generated::strapdown::StrapdownInputs;
use gyrocal::scalar::{Model, NamedInputs};
use gyrocal::{
    Catalogue, ControllerFilter, Drift, EFFECTS, ExtensionFilter, FilterSettings, InitialAttitude,
    Limits, Platform, PlatformFilter, Precision, SavedForm, SavedNumber, Site, Strapdown,
    StrapdownCatalogue,
};
use gyrocal_estimation::form::Form;
use gyrocal_record::{Gyros, ModelFile};

use crate::error::EmitError;

/// Time between two samples, s, and their number: eight hours.
pub(crate) const INTERVAL_S: f64 = 120.0;
const SAMPLES: usize = 241;
/// Rows after which estimates are compared.
const COMPARED: [usize; 3] = [1, 30, 240];
pub(crate) const LATITUDE_DEG: f64 = 39.1;
pub(crate) const ANGLES_RAD: [f64; 3] = [0.4, -0.6, 1.1];
pub(crate) const SIGMA_RAD: f64 = 1.745_329_251_994_329_5e-4;
/// The platform of the samples: coefficients of the size that the prior expects.
const DRIFT: [f64; 9] = [0.41, -0.13, 0.04, -0.29, 0.21, -0.07, 0.15, 0.09, 0.02];
/// Sigma of a parameter without an estimate, in typical sizes, as the derivation has it.
const WIDE: f64 = 10.0;
/// So small that a parameter of an effect stays zero.
const NOTHING: f64 = 1e-14;
const ACCEL_NOISE_G: f64 = 1e-5;

/// Change of the vector part of the quaternion of [`axes`] in a row.
pub(crate) const TURN: [f64; 3] = [0.002, 0.003, -0.0015];

/// Estimates and sigmas of the parameters after a row.
pub(crate) struct Expected {
    pub(crate) row: usize,
    pub(crate) estimates: Vec<f64>,
    pub(crate) sigmas: Vec<f64>,
}

/// A parameter of an effect: its id, and start value and sigma.
pub(crate) struct Start {
    pub(crate) id: &'static str,
    pub(crate) value: f64,
    pub(crate) sigma: f64,
}

fn settings<T: Precision>() -> FilterSettings<T> {
    FilterSettings::at_site(Site::at_latitude_deg(LATITUDE_DEG))
}

fn attitude<T: Precision>() -> InitialAttitude<T> {
    InitialAttitude::Angles {
        angles_rad: ANGLES_RAD.map(T::from_f64),
        sigma_rad: [T::from_f64(SIGMA_RAD); 3],
    }
}

/// Axes of the gyros of a strapdown unit in the platform, some rows after the first: of the quaternion
/// (1, x, y, z), whose elements are fractions with the same digits everywhere.
fn axes(rows: f64) -> [[f64; 3]; 3] {
    let [x, y, z] = TURN.map(|change| change * rows);
    let scale = 1.0 / (1.0 + x * x + y * y + z * z);
    [
        [
            1.0 + x * x - y * y - z * z,
            2.0 * (x * y - z),
            2.0 * (x * z + y),
        ],
        [
            2.0 * (x * y + z),
            1.0 - x * x + y * y - z * z,
            2.0 * (y * z - x),
        ],
        [
            2.0 * (x * z - y),
            2.0 * (y * z + x),
            1.0 - x * x - y * y + z * z,
        ],
    ]
    .map(|row| row.map(|element| scale * element))
}

/// Axes over the step to a row, and at it.
fn axes_of(row: usize) -> [[[f64; 3]; 3]; 2] {
    [axes(row as f64 - 0.5), axes(row as f64)]
}

/// Specific forces along the axes of a platform that drifts, with noise, rounded to `f32`, so that they
/// are the same samples in both number types.
pub(crate) fn samples(gyros: Gyros) -> Result<Vec<[f64; 3]>, EmitError> {
    let forces = match gyros {
        Gyros::Platform => forces()?,
        Gyros::Strapdown => strapdown_forces()?,
    };
    let mut state = 1_u64;
    let mut uniform = move || {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        let bits = state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11;
        bits as f64 / (1_u64 << 53) as f64 - 0.5
    };
    // Uniform, of the declared standard deviation.
    let noise = 12_f64.sqrt() * ACCEL_NOISE_G;
    let forces = forces.into_iter();
    let noisy = forces.map(|up| up.map(|force| f64::from((force + noise * uniform()) as f32)));
    Ok(noisy.collect())
}

fn truth() -> FilterSettings<f64> {
    FilterSettings {
        drift: Drift::from_array(DRIFT),
        ..settings()
    }
}

/// Specific forces of a stabilised platform, without noise.
fn forces() -> Result<Vec<[f64; 3]>, EmitError> {
    let mut platform = PlatformFilter::new(&truth(), &attitude())?;
    let mut forces = Vec::with_capacity(SAMPLES);
    for row in 0..SAMPLES {
        if row > 0 {
            platform.predict(INTERVAL_S)?;
        }
        forces.push(platform.platform_c_enu().map(|[_, _, up]| up));
    }
    Ok(forces)
}

/// Those of the platform that is computed from gyros fixed to a body.
fn strapdown_forces() -> Result<Vec<[f64; 3]>, EmitError> {
    const STATES: usize = Strapdown::STATES;
    const OF_SITE: usize = Strapdown::PARAMETERS - Platform::PARAMETERS;
    type StrapdownFilter = ExtensionFilter<f64, Strapdown, StrapdownInputs<f64>, STATES>;
    let start = [[0.0, NOTHING]; OF_SITE];
    let mut platform = StrapdownFilter::new(Strapdown, start, &truth(), &attitude())?;
    let mut forces = Vec::with_capacity(SAMPLES);
    for row in 0..SAMPLES {
        if row > 0 {
            let [middle, _] = axes_of(row);
            platform.set_gyro_axes(&middle);
            platform.coast(INTERVAL_S)?;
        }
        forces.push(platform.expected_g());
    }
    Ok(forces)
}

/// What a filter of a controller finds, in numbers of its type.
pub(crate) fn nominal<T: SavedNumber>(samples: &[[f64; 3]]) -> Result<Vec<Expected>, EmitError>
where
    T::Form: Form<T> + SavedForm,
{
    let mut filter = ControllerFilter::<T>::unset();
    filter.start(&settings(), &attitude(), Limits::default())?;
    let mut expected = Vec::new();
    for (row, sample) in samples.iter().enumerate() {
        let sample = sample.map(T::from_f64);
        if row == 0 {
            filter.update(&sample)?;
        } else {
            filter.step(T::from_f64(INTERVAL_S), &sample)?;
        }
        if COMPARED.contains(&row) {
            let numbers = |drift: Drift<T>| drift.to_array().map(|number| number.to_f64()).to_vec();
            expected.push(Expected {
                row,
                estimates: numbers(filter.filter().drift()),
                sigmas: numbers(filter.filter().drift_sigma()),
            });
        }
    }
    Ok(expected)
}

/// Start values of the parameters of a model file's effects.
pub(crate) fn starts(model: &ModelFile) -> Result<Vec<Start>, EmitError> {
    let mut starts = Vec::new();
    for id in &model.effects {
        let no_term = || EmitError::NoTerm { id: id.clone() };
        let effect = EFFECTS.iter().find(|effect| effect.id == id);
        let effect = effect.ok_or_else(no_term)?;
        for at in effect.model_parameters() {
            let id = PARAMETERS.get(at).ok_or_else(no_term)?.id;
            let mut estimates = model.estimates.iter();
            let estimate = estimates.find(|estimate| estimate.parameter == id);
            starts.push(Start {
                id,
                value: estimate.map_or(0.0, |estimate| estimate.value),
                sigma: estimate.map_or(WIDE * effect.typical_size, |estimate| estimate.sigma),
            });
        }
    }
    Ok(starts)
}

/// What a filter on the model of the catalogue finds, all other effects of which are known to be absent:
/// of the nine coefficients, and of the parameters in the order of `starts`.
pub(crate) fn extended(
    model: &ModelFile,
    starts: &[Start],
    samples: &[[f64; 3]],
) -> Result<Vec<Expected>, EmitError> {
    match model.gyros {
        Gyros::Platform => extended_of(Catalogue, model, starts, samples),
        Gyros::Strapdown => extended_of(StrapdownCatalogue, model, starts, samples),
    }
}

/// Parameters of both catalogues are the same, in the same order.
fn extended_of<M, I>(
    catalogue: M,
    model: &ModelFile,
    starts: &[Start],
    samples: &[[f64; 3]],
) -> Result<Vec<Expected>, EmitError>
where
    M: Model<f64, 3, 3, Inputs = I> + Copy,
    I: NamedInputs<f64>,
{
    const STATES: usize = Catalogue::STATES;
    let effects = PARAMETERS.iter().skip(Platform::PARAMETERS);
    let start = effects.map(|parameter| {
        let mut starts = starts.iter();
        match starts.find(|start| start.id == parameter.id) {
            Some(start) => [start.value, start.sigma],
            None => [0.0, NOTHING],
        }
    });
    let mut filter =
        ExtensionFilter::<f64, M, I, STATES>::new(catalogue, start, &settings(), &attitude())?;
    let shapes = filter.inputs_mut().group_mut("shapes");
    for (place, shape) in shapes.unwrap_or_default().iter_mut().zip(&SHAPES) {
        let mut given = model.shapes.iter();
        if let Some((_, value)) = given.find(|(id, _)| id == shape.id) {
            *place = *value;
        }
    }
    let coefficients = (0..Platform::PARAMETERS).map(Some);
    let of_effects = starts.iter().map(|start| {
        PARAMETERS
            .iter()
            .position(|parameter| parameter.id == start.id)
    });
    let places: Vec<usize> = coefficients
        .chain(of_effects)
        .flatten()
        .map(|at| 3 + at)
        .collect();
    let mut expected = Vec::new();
    for (row, sample) in samples.iter().enumerate() {
        let interval_s = if row == 0 { 0.0 } else { INTERVAL_S };
        // The axes concern a strapdown unit only.
        let [middle, end] = axes_of(row);
        filter.take_turning(interval_s, [&middle, &end], sample)?;
        if COMPARED.contains(&row) {
            let kernel = filter.filter();
            expected.push(Expected {
                row,
                estimates: places.iter().map(|at| kernel.state()[*at]).collect(),
                sigmas: places.iter().map(|at| kernel.sigma(*at)).collect(),
            });
        }
    }
    Ok(expected)
}
