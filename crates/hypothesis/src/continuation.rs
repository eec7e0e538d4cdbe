//! Continuation of effects in a later record of the same plant.
//!
//! Terms of states and regressors stay; a step leaves its channel changed; ageing goes on; an
//! effect of one record ends with it. What a time-dependent term becomes follows from its function of
//! time: its weight at the later time is a sum of the weights of its effect and of a constant, found
//! by least squares.

use gyrocal_scalar::effect::{Continuation, Effect, EffectKind, Enters, Role};
use nalgebra::{DMatrix, DVector};

use crate::plant::{Plant, WeightInputs};

/// Time and conditions of a later record relative to a first one.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordOffset {
    /// Time from the first row of the first record to that of the later one, s.
    pub elapsed_s: f64,
    /// Phase of periodic effects.
    pub phase: Phase,
    /// Mean of each regressor in the later record less that in the first.
    pub regressors: Vec<f64>,
}

/// Phase of periodic effects in a later record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// It follows from the time that has elapsed.
    Elapsed,
    /// The later record starts at the same phase.
    Same,
    /// The clocks say nothing of it.
    Unknown,
}

/// Parameters of a later record that one parameter of the first becomes, with factors.
#[must_use]
pub fn continued(plant: &Plant, parameter: usize, offset: &RecordOffset) -> Vec<(usize, f64)> {
    let itself = vec![(parameter, 1.0)];
    let Some((effect, own)) = plant.owner(parameter) else {
        return itself;
    };
    match effect.continuation {
        Continuation::ThisRecord => Vec::new(),
        Continuation::Stays if effect.kind == EffectKind::Step => {
            constant(plant, effect).map_or_else(Vec::new, |constant| vec![(constant, 1.0)])
        }
        Continuation::GoesOn => match (effect.kind, own.weight) {
            // Its onset is continued instead.
            (EffectKind::FromOnset, _) | (_, None) => itself,
            (_, Some(weight)) => shifted(plant, effect, weight, offset),
        },
        Continuation::Stays | Continuation::BeginsAnew => itself,
    }
}

/// Whether an effect is present again in a later record by itself, whatever happened before it.
#[must_use]
pub fn recurs(effect: &Effect) -> bool {
    let from_before = [EffectKind::Step, EffectKind::FromOnset, EffectKind::Ramp];
    effect.has_term() && !from_before.contains(&effect.kind)
}

/// Shapes in a later record: an onset of an effect that goes on lies before its first row.
#[must_use]
pub fn continued_shapes(plant: &Plant, first: &[f64], offset: &RecordOffset) -> Vec<f64> {
    let mut later = first.to_vec();
    let effects = plant.effects.iter();
    for effect in effects.filter(|effect| effect.continuation == Continuation::GoesOn) {
        if let Some(Role::Onset(Some(index))) = effect.shape().map(|shape| shape.role) {
            later[index] -= offset.elapsed_s;
        }
    }
    later
}

/// The parameter that adds a constant to the one channel that an effect enters.
fn constant(plant: &Plant, effect: &Effect) -> Option<usize> {
    match effect.enters {
        Enters::Rates(&[rate]) => Some(plant.rates.get(rate)?.constant),
        Enters::Outputs(&[output]) => Some(plant.outputs.get(output)?.constant),
        _ => None,
    }
}

/// Times at which a function is compared with itself at a later time, s: none is a multiple of
/// another, all are within three days.
const TIMES_S: [f64; 6] = [1.1e3, 1.7e4, 4.3e4, 7.1e4, 1.31e5, 2.03e5];

/// Values of the regressors at these times, each regressor starting at another place of the list.
const REGRESSORS: [f64; 6] = [0.7, -1.3, 2.9, -0.4, 1.9, -2.3];

/// A function is a sum of others if it differs by less than this share: rounding.
const ROUNDING: f64 = 1e-9;

/// The weight of a parameter at a later time as a sum of the weights of its effect and of a
/// constant: w(t + T, r + R) = Σ c_j w_j(t, r) + c. Empty where it is no such sum.
fn shifted(
    plant: &Plant,
    effect: &Effect,
    weight: usize,
    offset: &RecordOffset,
) -> Vec<(usize, f64)> {
    let elapsed_s = match (effect.kind, offset.phase) {
        (EffectKind::Periodic, Phase::Unknown) => return Vec::new(),
        (EffectKind::Periodic, Phase::Same) => 0.0,
        _ => offset.elapsed_s,
    };
    let own: Vec<(usize, usize)> = effect
        .parameters
        .iter()
        .filter_map(|parameter| match (parameter.role, parameter.weight) {
            (Role::Parameter(index), Some(weight)) => Some((index, weight)),
            _ => None,
        })
        .collect();
    let constant = constant(plant, effect);
    let targets: Vec<usize> = own
        .iter()
        .map(|(index, _)| *index)
        .chain(constant)
        .collect();
    let shapes = vec![1.0; plant.shapes.len()];
    let mut weights = vec![0.0; plant.weight_count];
    let mut design = DMatrix::from_element(TIMES_S.len(), targets.len(), 1.0);
    let mut later = DVector::zeros(TIMES_S.len());
    let at = |time_s: f64, regressors: &[f64], weights: &mut Vec<f64>| {
        let inputs = WeightInputs {
            time_s,
            interval_s: 1.0,
            regressors,
            covariates: &[],
            shapes: &shapes,
        };
        (plant.weights)(&inputs, weights);
    };
    for (point, time_s) in TIMES_S.into_iter().enumerate() {
        let places = 0..offset.regressors.len();
        let mut regressors: Vec<f64> = places
            .map(|place| REGRESSORS[(point + place) % REGRESSORS.len()])
            .collect();
        at(time_s, &regressors, &mut weights);
        for (column, (_, weight)) in own.iter().enumerate() {
            design[(point, column)] = weights[*weight];
        }
        for (regressor, change) in regressors.iter_mut().zip(&offset.regressors) {
            *regressor += change;
        }
        at(time_s + elapsed_s, &regressors, &mut weights);
        later[point] = weights[weight];
    }
    let Some(inverse) = (design.transpose() * &design).try_inverse() else {
        return Vec::new();
    };
    let factors = inverse * design.transpose() * &later;
    if (&design * &factors - &later).amax() > ROUNDING * later.amax().max(1.0) {
        return Vec::new();
    }
    let factors = targets.into_iter().zip(factors.iter().copied());
    factors
        .filter(|(_, factor)| factor.abs() > ROUNDING)
        .collect()
}
