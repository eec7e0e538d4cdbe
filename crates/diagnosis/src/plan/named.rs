//! What was named in a record, as a plan needs it.

use gyrocal::effect::EffectKind;
use gyrocal::{EFFECTS, Effect};
use gyrocal_calibration::{CalibrationError, Extended, Extension, NoiseModel, Options, Run};

use super::error::PlanError;
use crate::cause::{self, Finding, extend};
use crate::continuation::recurs;

/// A cause that was named, and what the record does not tell it from.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    /// Its public id.
    pub effect: String,
    /// Its onset in s or time constant in h, if it has one; of a random walk its size.
    pub shape: Option<f64>,
    /// Ids of the rest of its set, with the differences of log-likelihoods.
    pub rivals: Vec<(String, f64)>,
}

impl Named {
    /// Of a finding of a search.
    #[must_use]
    pub fn of(finding: &Finding) -> Self {
        let row = EFFECTS.iter().find(|row| row.id == finding.effect);
        // Of a random walk its size.
        let wanted = row.and_then(|row| {
            let first = row.parameters.first().filter(|_| is_walk(row));
            row.shape().or(first)
        });
        let mut found = finding.parameters.iter();
        let shape = found.find(|parameter| Some(parameter.name) == wanted.map(|p| p.name));
        Self {
            effect: finding.effect.to_owned(),
            shape: shape.map(|parameter| parameter.estimate),
            rivals: finding
                .rivals
                .iter()
                .map(|rival| (rival.effect.to_owned(), rival.log_likelihood_deficit))
                .collect(),
        }
    }

    /// Whether a run can be planned for an effect: one with a signature.
    #[must_use]
    pub fn is_cause(effect: &str) -> bool {
        let mut effects = EFFECTS.iter();
        effects.any(|row| row.id == effect && (row.has_signature() || is_walk(row)))
    }

    pub(crate) fn row(&self) -> Result<&'static Effect, PlanError> {
        row(&self.effect)
    }

    /// The model that has these causes, fitted to a record: what [`super::plan`] starts from where
    /// there is no diagnosis at hand.
    ///
    /// # Errors
    /// [`PlanError::UnknownEffect`], and [`PlanError::Calibration`] if the model cannot be fitted.
    pub fn fitted<'a>(
        named: &[Self],
        run: &Run<'a>,
        noise: &NoiseModel,
        options: &Options,
    ) -> Result<Extended<'a>, PlanError> {
        let nominal = Extended::nominal(run, options, noise)?;
        let extension = extension(named, run, nominal.extension())?;
        Ok(if extension == *nominal.extension() {
            nominal
        } else {
            nominal.refitted(&extension)?
        })
    }
}

/// The model that has these causes.
pub(crate) fn extension(
    named: &[Named],
    run: &Run<'_>,
    base: &Extension,
) -> Result<Extension, PlanError> {
    let also: Vec<&str> = named.iter().map(|named| named.effect.as_str()).collect();
    let plan = cause::Plan::new(run.record, run.bench, &also);
    let mut extension = base.clone();
    for named in named {
        let row = named.row()?;
        let family = plan
            .families
            .iter()
            .position(|family| family.id() == named.effect)
            .ok_or_else(|| unknown(&named.effect))?;
        let shape = match named.shape {
            Some(size) if is_walk(row) => Some(size * size * plan.onset_interval_h(run.record)),
            shape => shape,
        };
        extend(&plan, run.record, &mut extension, family, shape);
    }
    Ok(extension)
}

/// A row of the catalogue.
pub(crate) fn row(effect: &str) -> Result<&'static Effect, PlanError> {
    EFFECTS
        .iter()
        .find(|row| row.id == effect && (row.has_signature() || is_walk(row)))
        .ok_or_else(|| unknown(effect))
}

pub(crate) fn is_walk(row: &Effect) -> bool {
    row.kind == EffectKind::RandomWalk
}

fn unknown(effect: &str) -> PlanError {
    PlanError::UnknownEffect {
        effect: effect.to_owned(),
    }
}

/// Those that come again in a later run by themselves: all terms but what goes on from before.
pub(crate) fn recurring(named: &[Named]) -> Vec<Named> {
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

/// As [`Named::fitted`], without what cannot be fitted to a run by itself.
pub(crate) fn fitted_alone<'a>(
    named: &[Named],
    run: &Run<'a>,
    noise: &NoiseModel,
    options: &Options,
) -> Result<Extended<'a>, CalibrationError> {
    let nominal = Extended::nominal(run, options, noise)?;
    let named = recurring(named);
    let extended = extension(&named, run, nominal.extension())
        .ok()
        .filter(|extension| extension != nominal.extension())
        .and_then(|extension| nominal.refitted(&extension).ok());
    Ok(extended.unwrap_or(nominal))
}
