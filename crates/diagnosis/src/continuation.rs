//! How effects continue in a later record of the same plant.

use gyrocal::effect::{Continuation, EffectKind, EffectParameter, Enters, Role};
use gyrocal::generated::catalogue::{self, OUTPUTS, RATES, SHAPES};
use gyrocal::{EFFECTS, Effect};
use gyrocal_record::Record;
use nalgebra::{DMatrix, DVector};

/// Where a later record stands against a first one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RecordOffset {
    /// Time from the first row of the first record to that of the later one, s.
    pub(crate) elapsed_s: f64,
    /// What is known of the phase of periodic effects.
    pub(crate) phase: Phase,
    /// Mean temperature of the later record less that of the first, K.
    pub(crate) warmer_k: f64,
}

/// Phase of periodic effects in a later record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Phase {
    /// It follows from the time that has elapsed.
    Elapsed,
    /// The later record starts at the same phase.
    Same,
    /// The clocks say nothing of it.
    Unknown,
}

impl RecordOffset {
    /// From the clocks and thermometers of two records. A clock that began again says nothing: the
    /// later record then counts as if it followed the first at once.
    pub(crate) fn between(first: &Record, later: &Record) -> Self {
        let ends = |record: &Record| {
            let first_s = record.time_s.first().copied().unwrap_or(0.0);
            [first_s, record.time_s.last().copied().unwrap_or(first_s)]
        };
        let ([from_s, to_s], [later_s, _]) = (ends(first), ends(later));
        let goes_on = later_s > to_s;
        let mean = |record: &Record| {
            let logged = record.temperature_c.as_ref()?;
            Some(logged.iter().sum::<f64>() / logged.len().max(1) as f64)
        };
        Self {
            elapsed_s: if goes_on { later_s } else { to_s } - from_s,
            phase: if goes_on {
                Phase::Elapsed
            } else {
                Phase::Unknown
            },
            warmer_k: match (mean(first), mean(later)) {
                (Some(first), Some(later)) => later - first,
                _ => 0.0,
            },
        }
    }
}

/// The effect and its parameter that a constant parameter of the model is.
pub(crate) fn of_parameter(index: usize) -> Option<(&'static Effect, &'static EffectParameter)> {
    EFFECTS.iter().find_map(|effect| {
        let mut own = effect.parameters.iter();
        let parameter = own.find(|parameter| parameter.role == Role::Parameter(index))?;
        Some((effect, parameter))
    })
}

/// Parameters of a later record that one parameter of the first becomes, with factors.
pub(crate) fn continued(index: usize, offset: &RecordOffset) -> Vec<(usize, f64)> {
    let itself = vec![(index, 1.0)];
    let Some((effect, parameter)) = of_parameter(index) else {
        return itself;
    };
    match effect.continuation {
        Continuation::ThisRecord => Vec::new(),
        Continuation::Stays if effect.kind == EffectKind::Step => {
            constant(effect).map_or_else(Vec::new, |constant| vec![(constant, 1.0)])
        }
        Continuation::GoesOn => match (effect.kind, parameter.weight) {
            // Its onset is carried instead.
            (EffectKind::FromOnset, _) | (_, None) => itself,
            (_, Some(weight)) => shifted(effect, weight, offset),
        },
        Continuation::Stays | Continuation::BeginsAnew => itself,
    }
}

/// Whether an effect is itself again in a later record, whatever has gone before.
pub(crate) fn recurs(effect: &Effect) -> bool {
    let from_before = [EffectKind::Step, EffectKind::FromOnset, EffectKind::Ramp];
    effect.has_term() && !from_before.contains(&effect.kind)
}

/// Shapes as a later record has them: an onset lies before its first row.
pub(crate) fn shapes(first: &[f64; SHAPES.len()], offset: &RecordOffset) -> [f64; SHAPES.len()] {
    let mut later = *first;
    for effect in EFFECTS
        .iter()
        .filter(|e| e.continuation == Continuation::GoesOn)
    {
        if let Some(Role::Onset(Some(index))) = effect.shape().map(|shape| shape.role) {
            later[index] -= offset.elapsed_s;
        }
    }
    later
}

/// The parameter that adds a constant to the one channel that an effect enters.
fn constant(effect: &Effect) -> Option<usize> {
    match effect.enters {
        Enters::Rates(&[rate]) => Some(RATES[rate].constant),
        Enters::Outputs(&[output]) => Some(OUTPUTS[output].constant),
        _ => None,
    }
}

/// Points at which a function of time is compared with itself at a later time, s and K: none is
/// a multiple of another, all within three days.
const POINTS: [(f64, f64); 6] = [
    (1.1e3, 0.7),
    (1.7e4, -1.3),
    (4.3e4, 2.9),
    (7.1e4, -0.4),
    (1.31e5, 1.9),
    (2.03e5, -2.3),
];

/// A function is a sum of others if it differs by less than this share: rounding.
const ROUNDING: f64 = 1e-9;

/// The weight of a parameter at a later time as a sum of the weights of its effect and of a
/// constant: w(t + T, k + K) = sum of c_j w_j(t, k) + c. Nothing where it is no such sum.
fn shifted(effect: &Effect, weight: usize, offset: &RecordOffset) -> Vec<(usize, f64)> {
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
    let at = |time_s: f64, kelvin: f64| {
        catalogue::weights(&[0.0; 3], &[time_s, 1.0, kelvin], &[1.0; SHAPES.len()])
    };
    let targets: Vec<usize> = own
        .iter()
        .map(|(index, _)| *index)
        .chain(constant(effect))
        .collect();
    let design = DMatrix::from_fn(POINTS.len(), targets.len(), |point, column| {
        let (time_s, kelvin) = POINTS[point];
        own.get(column)
            .map_or(1.0, |(_, weight)| at(time_s, kelvin)[*weight])
    });
    let later = DVector::from_fn(POINTS.len(), |point, _| {
        let (time_s, kelvin) = POINTS[point];
        at(time_s + elapsed_s, kelvin + offset.warmer_k)[weight]
    });
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
