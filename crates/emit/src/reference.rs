//! The numbers that the tests of a file expect, from the libraries.

use gyrocal::generated::catalogue::{CatalogueInputs, PARAMETERS, SHAPES};
use gyrocal::{
    Catalogue, ControllerFilter, Drift, EFFECTS, ExtensionFilter, FilterSettings, InitialAttitude,
    Limits, Platform, PlatformFilter, Precision, SavedForm, SavedNumber, Site,
};
use gyrocal_estimation::form::Form;
use gyrocal_record::ModelFile;

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

/// Specific forces along the axes of a platform that drifts, with noise, rounded to `f32`, so that they
/// are the same samples in both number types.
pub(crate) fn samples() -> Result<Vec<[f64; 3]>, EmitError> {
    let truth = FilterSettings {
        drift: Drift::from_array(DRIFT),
        ..settings::<f64>()
    };
    let mut platform = PlatformFilter::new(&truth, &attitude())?;
    let mut state = 1_u64;
    let mut uniform = move || {
        state ^= state >> 12;
        state ^= state << 25;
        state ^= state >> 27;
        let bits = state.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 11;
        bits as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut samples = Vec::with_capacity(SAMPLES);
    for row in 0..SAMPLES {
        if row > 0 {
            platform.predict(INTERVAL_S)?;
        }
        let up = platform.platform_c_enu().map(|[_, _, up]| up);
        // Uniform, of the declared standard deviation.
        let noise = 12_f64.sqrt() * ACCEL_NOISE_G;
        samples.push(up.map(|force| f64::from((force + noise * uniform()) as f32)));
    }
    Ok(samples)
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
    const STATES: usize = Catalogue::STATES;
    type CatalogueFilter = ExtensionFilter<f64, Catalogue, CatalogueInputs<f64>, STATES>;
    let effects = PARAMETERS.iter().skip(Platform::PARAMETERS);
    let start = effects.map(|parameter| {
        let mut starts = starts.iter();
        match starts.find(|start| start.id == parameter.id) {
            Some(start) => [start.value, start.sigma],
            None => [0.0, NOTHING],
        }
    });
    let mut filter = CatalogueFilter::new(Catalogue, start, &settings(), &attitude())?;
    for (place, shape) in filter.inputs_mut().shapes.iter_mut().zip(&SHAPES) {
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
        filter.take(if row == 0 { 0.0 } else { INTERVAL_S }, sample)?;
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
