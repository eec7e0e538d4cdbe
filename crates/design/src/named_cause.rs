//! Named causes of a record.

use std::borrow::Cow;

use gyrocal::effect::{EffectKind, EffectParameter};
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::{
    CalibrationError, FittedPlatform, GyroAxes, NoiseModel, Options, PLATFORM, Run, joined_record,
};
use gyrocal_hypothesis::{HypothesisSet, ModelExtension, RateNoise, recurs};
use gyrocal_record::{Bench, Record};

use crate::error::DesignError;
use gyrocal_answer::{AlternativeKind, Answer, Finding, SizeChoice};
use gyrocal_diagnosis::missing_input;

/// A named cause with its confidence set.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedCause {
    /// Its public id.
    pub effect: String,
    /// Its onset in s or time constant in h, if it has one; of a random walk its size, of a wrong first attitude
    /// of one of several records the start of that record in s.
    pub shape: Option<f64>,
    /// Ids of the rest of its set, with the differences of log-likelihoods.
    pub rivals: Vec<(String, f64)>,
    /// Standard deviations of its sizes over turn-ons, in the unit of the model, where several records have
    /// shown a size for each; empty where the size is one.
    pub turn_on_sigmas: Vec<f64>,
}

impl NamedCause {
    /// The causes of a diagnosis that a run can be planned for.
    #[must_use]
    pub fn all(diagnosis: &Answer) -> Vec<Self> {
        let causes = diagnosis.causes();
        let plannable = causes.filter(|finding| row(&finding.effect).is_ok());
        plannable.map(Self::of).collect()
    }

    /// A cause of a diagnosis.
    #[must_use]
    pub fn of(finding: &Finding) -> Self {
        let row = EFFECTS.iter().find(|row| row.id == finding.effect);
        let shape = row.and_then(|row| finding.parameter(shape_name(row)?));
        Self {
            effect: finding.effect.clone(),
            shape: shape.map(|parameter| parameter.estimate),
            rivals: finding
                .of_kind(AlternativeKind::NotExcluded)
                .filter_map(|other| Some((other.effect.clone(), other.log_likelihood_deficit?)))
                .collect(),
            turn_on_sigmas: row.map_or_else(Vec::new, |row| turn_on_sigmas(row, finding)),
        }
    }

    /// Whether it is noise of the fit and nothing else: a random walk without rivals.
    pub(crate) fn is_noise(&self) -> bool {
        self.rivals.is_empty() && self.row().is_ok_and(is_walk)
    }

    pub(crate) fn row(&self) -> Result<&'static Effect, DesignError> {
        row(&self.effect)
    }

    /// The model that has these causes, fitted to a record: what [`super::plan`] starts from where
    /// there is no diagnosis at hand.
    ///
    /// # Errors
    /// [`DesignError::NotPlannable`], and [`DesignError::Calibration`] if the model cannot be fitted.
    pub fn fitted<'a>(
        named: &[Self],
        run: &Run<'a>,
        noise: &NoiseModel,
        options: &Options,
    ) -> Result<FittedPlatform<'a>, DesignError> {
        Self::fitted_of_unit(named, run, None, noise, options)
    }

    /// The same of a strapdown unit, if the axes of its instruments at each row are given.
    ///
    /// # Errors
    /// As [`Self::fitted`], and [`CalibrationError::GyroAxes`] if there is not one attitude for each row.
    pub fn fitted_of_unit<'a>(
        named: &[Self],
        run: &Run<'a>,
        axes: Option<&GyroAxes>,
        noise: &NoiseModel,
        options: &Options,
    ) -> Result<FittedPlatform<'a>, DesignError> {
        let noise = with_walks(noise, named)?;
        let nominal = FittedPlatform::nominal_of_unit(run, axes, options, &noise)?;
        let extension = extension(named, run, &nominal)?;
        Ok(if extension == *FittedPlatform::extension(&nominal) {
            nominal
        } else {
            nominal.refitted(&extension)?
        })
    }
}

/// The model that has some causes, fitted to several records of one platform by their joint diagnosis: where
/// [`super::plan`] starts from, with the joint record beside it. Accelerometer noise is that of each record's own
/// diagnosis, noise of the gyros that of all. `axes` are those of the instruments of a strapdown unit, for each
/// record; of a stabilised platform there are none.
///
/// # Errors
/// As [`NamedCause::fitted_of_unit`], and [`CalibrationError::UnlikeBenches`].
pub fn fitted_to_records(
    diagnosis: &Answer,
    runs: &[Run<'_>],
    axes: &[GyroAxes],
    options: &Options,
) -> Result<(FittedPlatform<'static>, Record), DesignError> {
    let named = NamedCause::all(diagnosis);
    let gyros = with_walks(&noise_of(diagnosis), &named)?;
    let mut parts = Vec::with_capacity(runs.len());
    for (index, (run, one)) in runs.iter().zip(&diagnosis.records).enumerate() {
        let noise = NoiseModel {
            accel_ratio: one
                .alone
                .as_ref()
                .map_or([1.0; 3], |alone| noise_of(alone).accel_ratio),
            ..NoiseModel::default()
        };
        let axes = axes.get(index);
        parts.push(FittedPlatform::nominal_of_unit(run, axes, options, &noise)?);
    }
    let benches: Vec<&Bench> = runs.iter().map(|run| run.bench).collect();
    let records: Vec<&Record> = runs.iter().map(|run| run.record).collect();
    let (record, _) = joined_record(&records);
    let mut fitted = FittedPlatform::joined(&parts, &benches)?;
    let noise = RateNoise {
        white: gyros.gyro_ratio.to_vec(),
        walk: gyros.gyro_walk_deg_per_h_per_sqrt_h.to_vec(),
    };
    if noise != fitted.rate_noise() {
        fitted = fitted.with_rate_noise(&noise)?;
    }
    if let Some(last) = runs.last() {
        let run = Run {
            record: &record,
            bench: last.bench,
        };
        let extension = extension(&named, &run, &fitted)?;
        if extension != *fitted.extension() {
            fitted = fitted.refitted(&extension)?;
        }
    }
    Ok((fitted.into_owned(), record))
}

/// Root mean squares of the sizes of each record, in the unit of the model, where there is one for each
/// turn-on; else none.
fn turn_on_sigmas(row: &Effect, finding: &Finding) -> Vec<f64> {
    let found = finding.by_record.as_ref();
    let Some(found) = found.filter(|found| found.choice == SizeChoice::PerTurnOn) else {
        return Vec::new();
    };
    let of_size = |(index, size): (usize, &EffectParameter)| {
        let estimates = found.sizes.iter().map(|one| one.estimates[index].estimate);
        let squares: f64 = estimates.map(|estimate| estimate * estimate).sum();
        (squares / found.sizes.len() as f64).sqrt() * size.scale
    };
    let sizes = found.sizes.first().map_or(0, |one| one.estimates.len());
    row.sizes().take(sizes).enumerate().map(of_size).collect()
}

/// Noise of the model of a diagnosis; the declared one of a result without it.
#[must_use]
pub fn noise_of(diagnosis: &Answer) -> NoiseModel {
    diagnosis
        .model_noise
        .map_or_else(NoiseModel::default, |noise| NoiseModel {
            accel_ratio: noise.accel_ratio,
            gyro_ratio: noise.gyro_ratio,
            gyro_walk_deg_per_h_per_sqrt_h: noise.gyro_walk_deg_per_h_per_sqrt_h,
            weights: None,
        })
}

/// The noise with the random walks among some causes that it does not have.
fn with_walks(noise: &NoiseModel, named: &[NamedCause]) -> Result<NoiseModel, DesignError> {
    let mut noise = noise.clone();
    for named in named {
        let row = named.row()?;
        if let (true, Some(rate), Some(size)) = (is_walk(row), row.rate(), named.shape) {
            let own = &mut noise.gyro_walk_deg_per_h_per_sqrt_h[rate];
            *own = if *own > 0.0 { *own } else { size };
        }
    }
    Ok(noise)
}

/// The fit that sets are compared with: without the random walks that are named beside rivals, whose steps are
/// among what is compared.
pub(crate) fn without_compared_walks<'a, 'f>(
    fitted: &'f FittedPlatform<'a>,
    named: &[NamedCause],
) -> Result<Cow<'f, FittedPlatform<'a>>, DesignError> {
    let mut noise = fitted.rate_noise();
    for named in named.iter().filter(|named| !named.is_noise()) {
        let row = named.row()?;
        if let Some(rate) = row.rate().filter(|_| is_walk(row)) {
            noise.walk[rate] = 0.0;
        }
    }
    Ok(if noise == fitted.rate_noise() {
        Cow::Borrowed(fitted)
    } else {
        Cow::Owned(fitted.with_rate_noise(&noise)?)
    })
}

/// The extension of the nominal model by these causes.
pub(crate) fn extension(
    named: &[NamedCause],
    run: &Run<'_>,
    nominal: &FittedPlatform<'_>,
) -> Result<ModelExtension, DesignError> {
    let mut effects = Vec::with_capacity(named.len());
    for named in named {
        let effect = named.row()?;
        if let Some(why) = missing_input(effect, run.record, run.bench) {
            return Err(DesignError::MissingInput {
                effect: effect.id,
                why,
            });
        }
        // A random walk is noise.
        if !is_walk(effect) {
            effects.push(effect);
        }
    }
    let rows = nominal.rows(run.record);
    let set = HypothesisSet::new(&PLATFORM, &rows, &effects);
    let mut extension = FittedPlatform::extension(nominal).clone();
    for named in named {
        if is_walk(named.row()?) {
            continue;
        }
        let hypothesis = set
            .index_of(&named.effect)
            .ok_or_else(|| unknown(&named.effect))?;
        set.add_to_model(&PLATFORM, &rows, &mut extension, hypothesis, named.shape);
    }
    Ok(extension)
}

/// A row of the catalogue.
pub(crate) fn row(effect: &str) -> Result<&'static Effect, DesignError> {
    EFFECTS
        .iter()
        .find(|row| row.id == effect && (row.has_signature() || is_walk(row)))
        .ok_or_else(|| unknown(effect))
}

/// Name of the parameter that is the shape of a named cause.
fn shape_name(row: &Effect) -> Option<&'static str> {
    match row.kind {
        EffectKind::RandomWalk => row.parameters.first().map(|size| size.name),
        EffectKind::InitialState => Some("onset_s"),
        _ => row.shape().map(|shape| shape.name),
    }
}

pub(crate) fn is_walk(row: &Effect) -> bool {
    row.kind == EffectKind::RandomWalk
}

fn unknown(effect: &str) -> DesignError {
    DesignError::NotPlannable {
        effect: effect.to_owned(),
    }
}

/// The causes that are present again in a later run by themselves.
pub(crate) fn recurring(named: &[NamedCause]) -> Vec<NamedCause> {
    named
        .iter()
        .filter(|named| {
            EFFECTS
                .iter()
                .any(|row| row.id == named.effect && recurs(row))
        })
        .cloned()
        .collect()
}

/// As [`NamedCause::fitted_of_unit`], without what cannot be fitted to a run by itself.
pub(crate) fn fitted_alone<'a>(
    named: &[NamedCause],
    run: &Run<'a>,
    axes: Option<&GyroAxes>,
    noise: &NoiseModel,
    options: &Options,
) -> Result<FittedPlatform<'a>, CalibrationError> {
    let nominal = FittedPlatform::nominal_of_unit(run, axes, options, noise)?;
    let named = recurring(named);
    let extended = extension(&named, run, &nominal)
        .ok()
        .filter(|extension| *extension != *FittedPlatform::extension(&nominal))
        .and_then(|extension| nominal.refitted(&extension).ok());
    Ok(extended.unwrap_or(nominal))
}
