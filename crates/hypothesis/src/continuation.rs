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
/// constant, and, of a regressor's effect, of those of its channel's other regressors:
/// w(t + T, r + R) = Σ c_j w_j(t, r) + c. Empty where it is no such sum.
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
    let mut terms: Vec<(usize, usize)> = weighted(effect).collect();
    let courses = Courses::new(plant, elapsed_s, &offset.regressors);
    let constant = constant(plant, effect);
    if let Some(factors) = courses.as_sum(weight, &terms, constant) {
        return factors;
    }
    if effect.kind == EffectKind::Regressor {
        let others = plant.effects.iter().filter(|other| {
            other.kind == effect.kind && other.enters == effect.enters && other.id != effect.id
        });
        let further = others.flat_map(weighted);
        terms.extend(further.filter(|(_, weight)| !courses.is_zero(*weight)));
    }
    courses.as_sum(weight, &terms, constant).unwrap_or_default()
}

/// Parameters of an effect with their weights.
fn weighted(effect: &Effect) -> impl Iterator<Item = (usize, usize)> {
    let parameters = effect.parameters.iter();
    parameters.filter_map(|parameter| match (parameter.role, parameter.weight) {
        (Role::Parameter(index), Some(weight)) => Some((index, weight)),
        _ => None,
    })
}

/// All weights of a plant at [`TIMES_S`], and at these times in a later record.
struct Courses {
    first: Vec<Vec<f64>>,
    later: Vec<Vec<f64>>,
}

impl Courses {
    fn new(plant: &Plant, elapsed_s: f64, changes: &[f64]) -> Self {
        let shapes = vec![1.0; plant.shapes.len()];
        let at = |time_s: f64, regressors: &[f64]| {
            let inputs = WeightInputs {
                time_s,
                interval_s: 1.0,
                regressors,
                covariates: &[],
                shapes: &shapes,
            };
            let mut weights = vec![0.0; plant.weight_count];
            (plant.weights)(&inputs, &mut weights);
            weights
        };
        let (mut first, mut later) = (Vec::new(), Vec::new());
        for (point, time_s) in TIMES_S.into_iter().enumerate() {
            let places = 0..changes.len();
            let mut regressors: Vec<f64> = places
                .map(|place| REGRESSORS[(point + place) % REGRESSORS.len()])
                .collect();
            first.push(at(time_s, &regressors));
            for (regressor, change) in regressors.iter_mut().zip(changes) {
                *regressor += change;
            }
            later.push(at(time_s + elapsed_s, &regressors));
        }
        Self { first, later }
    }

    fn is_zero(&self, weight: usize) -> bool {
        self.first.iter().all(|weights| weights[weight] == 0.0)
    }

    /// A weight in the later record as a sum of those of terms and of a constant in the first.
    fn as_sum(
        &self,
        weight: usize,
        terms: &[(usize, usize)],
        constant: Option<usize>,
    ) -> Option<Vec<(usize, f64)>> {
        let parameters = terms.iter().map(|(parameter, _)| *parameter);
        let targets: Vec<usize> = parameters.chain(constant).collect();
        let design = DMatrix::from_fn(TIMES_S.len(), targets.len(), |point, column| {
            terms
                .get(column)
                .map_or(1.0, |(_, weight)| self.first[point][*weight])
        });
        let later = DVector::from_fn(TIMES_S.len(), |point, _| self.later[point][weight]);
        let inverse = (design.transpose() * &design).try_inverse()?;
        let factors = inverse * design.transpose() * &later;
        if (&design * &factors - &later).amax() > ROUNDING * later.amax().max(1.0) {
            return None;
        }
        let factors = targets.into_iter().zip(factors.iter().copied());
        let present = factors.filter(|(_, factor)| factor.abs() > ROUNDING);
        Some(present.collect())
    }
}
