//! The set of an oracle, which knows the hidden effect and its strength.

use gyrocal_hypothesis::{CONFIDENCE_SET_DEVIANCE, FittedModel as _, Plant};
use gyrocal_plant::FittedPlant;
use gyrocal_scalar::effect::{Effect, EffectKind, Role};
use gyrocal_statistics::normal_probability;
use nalgebra::{Cholesky, DMatrix};

/// Least information of an effect that counts as any, over its raw information.
const LEAST: f64 = 1e-6;

/// Expected number of effects in the set of an oracle: the hidden one, and those whose likelihood comes
/// within the deviance of a set. An effect with the correlation c to a hidden one of d standard deviations
/// lacks d²(1 − c²) on average, with twice the root of that for its standard deviation. Effects with an
/// onset are left out. `None` if the hidden effect is one of these.
pub(super) fn set_size(nominal: &FittedPlant, hidden: &str, strength: f64) -> Option<f64> {
    let tables = nominal.plant();
    let information = remaining(nominal)?;
    let own = tables.effects.iter().find(|effect| effect.id == hidden)?;
    let place = column(tables, own)?;
    let own_information = information[(place, place)];
    let others = tables
        .effects
        .iter()
        .filter(|other| other.id != own.id && !own.equivalents.contains(&other.id));
    let likely = others.filter_map(|other| {
        let other = column(tables, other)?;
        let whole = information[(other, other)];
        if whole <= 0.0 || own_information <= 0.0 {
            return None;
        }
        let cross = information[(place, other)];
        let lacking = (1.0 - cross * cross / (whole * own_information)).max(0.0);
        let lacks = strength * lacking.sqrt();
        Some(if lacks > 0.0 {
            normal_probability((CONFIDENCE_SET_DEVIANCE - lacks * lacks) / (2.0 * lacks))
        } else {
            1.0
        })
    });
    Some(1.0 + likely.sum::<f64>())
}

/// Whether an effect has an onset.
pub(super) fn has_onset(tables: &Plant, id: &str) -> bool {
    let mut effects = tables.effects.iter();
    effects.any(|effect| effect.id == id && effect.kind == EffectKind::Step)
}

/// Place of the one size of an effect among the parameters beyond the nominal ones.
fn column(tables: &Plant, effect: &Effect) -> Option<usize> {
    if effect.kind == EffectKind::Step {
        return None;
    }
    match effect.parameters {
        [one] => match one.role {
            Role::Parameter(index) => index.checked_sub(tables.nominal_parameters),
            _ => None,
        },
        _ => None,
    }
}

/// Information on all sizes that nominal parameters and initial states leave; zero where they leave none.
fn remaining(nominal: &FittedPlant) -> Option<DMatrix<f64>> {
    let gram = nominal.signatures_gram(&[]).ok()?;
    let count = nominal.plant().nominal_parameters;
    let sizes = gram.nrows() - 1 - count;
    let mut own = gram.view((1, 1), (count, count)).into_owned();
    for (index, sigma) in nominal.prior_sigma().iter().enumerate().take(count) {
        own[(index, index)] += sigma.powi(-2);
    }
    let cross = gram.view((1, 1 + count), (count, sizes)).into_owned();
    let raw = gram
        .view((1 + count, 1 + count), (sizes, sizes))
        .into_owned();
    let mut left = &raw - cross.tr_mul(&Cholesky::new(own)?.solve(&cross));
    for index in 0..sizes {
        if left[(index, index)] < LEAST * raw[(index, index)] {
            left[(index, index)] = 0.0;
        }
    }
    Some(left)
}
