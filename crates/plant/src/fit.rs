//! The fit of the nominal model alone: estimates, what they rest on, and errors of simulations.

mod criteria;

use std::sync::Arc;

use gyrocal_answer::{LaterFit, OutputFit, PlantFit};
use gyrocal_inference::stop;
use gyrocal_words::plant::is_coloured;

use crate::answer::{noise, output_tests, parameters, summary};
use crate::error::{PlantError, or_none};
use crate::fitted::FittedPlant;
use crate::identifiability::Determined;
use crate::left_out::left_out_rms;
use crate::loaded::LoadedPlant;
use crate::prediction::horizon_s;
use crate::record::{NamedRecord, PlantRecord};
use crate::simulation::output_fits;

/// Estimates of the noise and of what is fitted in it, one after the other: the noise of an output is its weight.
const ROUNDS: usize = 2;

/// A fit with its answer.
#[derive(Clone, Debug)]
pub struct Fit {
    /// The answer.
    pub answer: PlantFit,
    /// The fitted model.
    pub fitted: FittedPlant,
}

/// Fits the nominal model of a plant to a record, and searches nothing.
///
/// The steps are those that [`crate::diagnose`] makes of the nominal model: a parameter is held for each direction that
/// the record does not determine, and the noise is estimated; where white noise leaves what is not white, with process
/// noise of the rates and correlated noise of the outputs, so that standard deviations stay fair. All rows are fitted.
/// The errors do not count the first `first_rows` of each record. `at` is told each stage of the work as it begins, with
/// the share of the work that is done by then.
///
/// # Errors
/// [`PlantError::Input`] if `first_rows` leave no reading, [`PlantError::NoFit`], [`PlantError::NotFinite`],
/// [`PlantError::Singular`], and [`PlantError::Stopped`] if the job was asked to end.
///
/// # Example
/// ```no_run
/// use std::path::Path;
///
/// use gyrocal_plant::{ColumnMap, LoadedPlant, fit};
///
/// let plant = LoadedPlant::read(Path::new("plant.json"))?;
/// let columns = ColumnMap::read(Path::new("columns.toml"))?;
/// let record = columns.named_record(plant.description(), Path::new("record.csv"))?;
/// let fit = fit(&plant, record, None, 0, &mut |_, _| ())?;
/// for one in &fit.answer.coefficients.nominal {
///     println!("{} {} ± {} {}", one.name, one.estimate, one.sigma, one.unit);
/// }
/// # Ok::<(), gyrocal_plant::PlantError>(())
/// ```
pub fn fit(
    plant: &LoadedPlant,
    record: NamedRecord,
    later: Option<NamedRecord>,
    first_rows: usize,
    at: &mut dyn FnMut(&'static str, f64),
) -> Result<Fit, PlantError> {
    stop::finished(fit_record(plant, record, later, first_rows, at))
}

fn fit_record(
    plant: &LoadedPlant,
    record: NamedRecord,
    later: Option<NamedRecord>,
    first_rows: usize,
    at: &mut dyn FnMut(&'static str, f64),
) -> Result<Fit, PlantError> {
    refuse_without_readings(&record, first_rows, false)?;
    if let Some(later) = &later {
        // Its first rows alone set its initial states, if its rates have no noise.
        let begins = plant.description().noises.is_empty();
        refuse_without_readings(later, first_rows, begins)?;
    }
    at("parameters", 0.0);
    let Determined {
        nominal,
        held,
        directions,
    } = FittedPlant::determined(plant, record.record, None)?;
    at("noise", 0.3);
    let fitted = nominal.in_estimated_noise()?;
    let record = fitted.record();
    let mut coefficients = parameters(plant, &fitted, &fitted, false);
    coefficients.covariance = fitted.covariance_of_coefficients();
    let (correlations, condition) = criteria::correlations(&coefficients, &held);
    let (noise, undeclared_noise) = (noise(plant, &fitted)?, fitted.undeclared_noise()?);
    let (log_likelihood, values) = fitted.log_likelihood()?;
    let unknowns = fitted.problem.nominal() - held.len() + fitted.noise.unknowns().len();
    let [aic, bic] = criteria::criteria(log_likelihood, unknowns, values);
    at("left-out parts", 0.6);
    let outputs = outputs(&fitted, first_rows)?;
    at("later record", 0.9);
    let later = later.map(|later| fitted.on_later(later.record, first_rows));
    let answer = PlantFit {
        plant: plant.description.name.clone(),
        record: summary(record),
        first_rows,
        coefficients,
        correlations,
        condition,
        undetermined: directions,
        still_inputs: record.still_inputs(&plant.description),
        starts: fitted.starts(),
        noise,
        undeclared_noise,
        remainder: output_tests(&fitted)?,
        values,
        unknowns,
        log_likelihood,
        aic,
        bic,
        horizon_s: horizon_s(plant, record),
        outputs,
        later: later.transpose()?,
    };
    Ok(Fit { answer, fitted })
}

/// Refuses a record without a reading after the first rows, or in them if it `begins` with these.
fn refuse_without_readings(
    named: &NamedRecord,
    first_rows: usize,
    begins: bool,
) -> Result<(), PlantError> {
    let record = &named.record;
    let outputs = record.outputs.len() / record.len().max(1);
    let first = outputs * first_rows.min(record.len());
    let (before, after) = record.outputs.split_at(first);
    let has_none = |readings: &[f64]| readings.iter().all(|value| value.is_nan());
    let (rows, origin) = (record.len(), named.name.clone());
    let refuse = |problem: String, advice: &str| {
        Err(PlantError::Input {
            origin,
            problem,
            advice: advice.to_owned(),
        })
    };
    if has_none(&record.outputs) {
        return refuse(
            "it has no reading".to_owned(),
            "give a record with readings",
        );
    }
    if has_none(after) {
        let problem = format!(
            "the first {first_rows} of its {rows} rows are not to count, and no reading is left"
        );
        return refuse(problem, "let fewer rows be free");
    }
    if begins && first_rows > 0 && has_none(before) {
        let problem = format!("its first {first_rows} rows, which are to be free, have no reading");
        return refuse(problem, "let more rows be free, or none");
    }
    Ok(())
}

/// Errors of the simulations of the record.
fn outputs(fitted: &FittedPlant, first_rows: usize) -> Result<Vec<OutputFit>, PlantError> {
    let simulated = (&fitted.simulated()[..], &fitted.one_step()?[..]);
    let mut all = output_fits(fitted.loaded(), fitted.record(), simulated, first_rows);
    let left_out = or_none(left_out_rms(fitted))?.unwrap_or_default();
    for (own, left_out) in all.iter_mut().zip(left_out) {
        own.left_out_rms = left_out;
    }
    Ok(all)
}

impl FittedPlant {
    /// The same model in the noise that it leaves: white, and if what is left is not, all noise.
    fn in_estimated_noise(self) -> Result<Self, PlantError> {
        let mut fitted = self;
        for _ in 0..ROUNDS {
            fitted = fitted.in_white_noise()?;
        }
        if !output_tests(&fitted)?.iter().any(is_coloured) {
            return Ok(fitted);
        }
        let noisy = or_none(fitted.in_all_noise())?.flatten();
        Ok(noisy.unwrap_or(fitted))
    }

    /// Errors of a later record, simulated with the parameters of this fit.
    fn on_later(&self, later: PlantRecord, first_rows: usize) -> Result<LaterFit, PlantError> {
        let plant = self.loaded();
        let later = Arc::new(later);
        let all = self.predict(&later)?;
        let open_loop = if first_rows > 0 && plant.description.noises.is_empty() {
            let mut begun = (*later).clone();
            let outputs = plant.description.outputs.len();
            begun.outputs[first_rows * outputs..].fill(f64::NAN);
            self.predict(&Arc::new(begun))?.simulated
        } else {
            all.simulated
        };
        let simulated = (&open_loop[..], &all.one_step[..]);
        Ok(LaterFit {
            record: summary(&later),
            log_score_nats: all.log_density,
            outputs: output_fits(plant, &later, simulated, first_rows),
        })
    }
}
