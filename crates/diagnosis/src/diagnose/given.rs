//! The drift coefficients with effects in the model that the caller gives.

use gyrocal::EFFECTS;
use gyrocal::effect::EffectKind;
use gyrocal::generated::platform::DRIFT;
use gyrocal_calibration::{DETERMINED, FittedPlatform, GyroAxes, NoiseModel, Run, rows};
use gyrocal_hypothesis::{FittedModel, Selection, fit_with, stop};
use gyrocal_record::{Coefficient, FittedEffect, FittedEffects, FittedParameter};

use super::noise_audited_fit::noise_audited_fit;
use super::{DiagnoseOptions, search_options};
use crate::error::DiagnosisError;
use crate::error_budget::shares;
use crate::noise::AuditOptions;
use crate::request;

/// Estimates the drift coefficients with effects of the catalogue in the model, without a test of whether
/// the record has them, of a strapdown unit in the axes of its instruments: noise as a diagnosis estimates it, onsets and time constants with all sizes.
///
/// # Errors
/// [`DiagnosisError`]: effects that are in no catalogue, that this record cannot show, that are in the
/// list twice, or that the record does not determine beside each other.
pub fn fit_effects(
    run: &Run<'_>,
    axes: Option<&GyroAxes>,
    effects: &[String],
    options: &DiagnoseOptions,
) -> Result<FittedEffects, DiagnosisError> {
    request::check(effects, run.record, run.bench)?;
    let mut selection = Selection::default();
    for id in effects {
        let Some(effect) = EFFECTS.iter().find(|effect| effect.id == id) else {
            continue;
        };
        let twin = selection
            .effects
            .iter()
            .find(|other| other.id == effect.id || other.equivalents.contains(&effect.id));
        if let Some(twin) = twin {
            return Err(DiagnosisError::NotTogether {
                effect: effect.id,
                other: twin.id,
            });
        }
        let is_term = effect.has_signature() || effect.kind == EffectKind::RandomWalk;
        if !is_term || effect.is_nominal {
            return Err(DiagnosisError::NoTerm { effect: effect.id });
        }
        selection.effects.push(effect);
    }
    let shares = shares(options.false_alarm_probability);
    let declared = NoiseModel::default();
    let audited = noise_audited_fit(
        run,
        axes,
        &declared,
        &AuditOptions::with_share(shares.noise_audit),
        &options.calibration,
    );
    let audited = stop::finished(audited)?;
    let rows = rows(run.record, audited.nominal.covariates());
    let search = search_options(options, &shares, 0);
    let found = fit_with(audited.nominal, rows, &selection, &search);
    let found = stop::finished(found.map_err(DiagnosisError::from))?;
    let described = found.effects.iter().zip(&selection.effects);
    Ok(FittedEffects {
        effects: described
            .map(|((id, parameters), effect)| FittedEffect {
                effect: (*id).to_owned(),
                name: effect.name.to_owned(),
                parameters: parameters
                    .iter()
                    .map(|one| FittedParameter {
                        name: one.name.to_owned(),
                        estimate: one.estimate,
                        sigma: one.sigma,
                        interval: one.interval.clone(),
                        unit: one.unit.to_owned(),
                    })
                    .collect(),
            })
            .collect(),
        gained_nats: found.gained_nats,
        coefficients: coefficients(&found.fitted),
        covariance: (0..DRIFT.len())
            .map(|i| {
                let row = found.fitted.covariance().row(i);
                row.iter().take(DRIFT.len()).copied().collect()
            })
            .collect(),
    })
}

fn coefficients(fitted: &FittedPlatform<'_>) -> Vec<Coefficient> {
    let prior = fitted.prior_sigma();
    let all = DRIFT.iter().enumerate();
    all.map(|(index, element)| {
        let sigma = fitted.covariance()[(index, index)].sqrt();
        Coefficient {
            name: element.id.to_owned(),
            estimate: fitted.values()[index],
            sigma,
            unit: element.unit.to_owned(),
            determined: sigma < DETERMINED * prior[index],
        }
    })
    .collect()
}
