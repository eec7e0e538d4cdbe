//! Columns of an effect in a record, and in the run after it.

use gyrocal::Effect;
use gyrocal::effect::{Continuation, EffectKind, Role};
use gyrocal::generated::catalogue::RATES;
use gyrocal_calibration::{PLATFORM, REGRESSORS};
use gyrocal_hypothesis::{Phase, RecordOffset, continued};

use crate::design_column::DesignColumn;

/// A linear combination of columns.
pub(crate) type Combination = Vec<(DesignColumn, f64)>;

/// The columns of one size of an effect: in the record, and in the next run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SizeColumns {
    pub(crate) first: Combination,
    pub(crate) next: Combination,
}

/// Durations of the record and of the next run.
#[derive(Clone, Debug)]
pub(crate) struct Times {
    /// Duration of the record, s.
    pub(crate) first_s: f64,
    /// Duration of the next run, s.
    pub(crate) next_s: f64,
    /// Onsets of the steps of a random walk in the record, s.
    pub(crate) onsets_s: Vec<f64>,
}

impl Times {
    /// The next run follows the record at once, at the same time of day and temperature.
    pub(crate) fn offset(&self) -> RecordOffset {
        offset_after(self.first_s)
    }

    /// Variance of a step of a random walk of this size, deg/h/√h, in the record.
    pub(crate) fn variance_of_steps(&self, size: f64) -> f64 {
        let steps = self.onsets_s.len().max(1) as f64;
        size * size * self.first_s / 3600.0 / steps
    }
}

/// The offset of a run that follows a record of some duration at once.
pub(crate) fn offset_after(duration_s: f64) -> RecordOffset {
    RecordOffset {
        elapsed_s: duration_s,
        phase: Phase::Same,
        regressors: vec![0.0; REGRESSORS],
    }
}

/// Columns of all sizes of an effect; `shape` is its onset \[s\] or time constant \[h\].
pub(crate) fn size_columns(
    effect: &'static Effect,
    shape: Option<f64>,
    times: &Times,
) -> Vec<SizeColumns> {
    match (effect.kind, effect.rate(), shape) {
        (EffectKind::RandomWalk, Some(rate), _) => walk(rate, times),
        (EffectKind::Step, Some(rate), Some(onset_s)) => vec![SizeColumns {
            first: vec![(DesignColumn::Step { rate, onset_s }, 1.0)],
            next: vec![(DesignColumn::Parameter(RATES[rate].constant), 1.0)],
        }],
        (EffectKind::InitialState | EffectKind::StateJump, ..) => {
            states(effect, Some(shape.unwrap_or(0.0)))
        }
        (_, _, Some(shape)) if effect.shape().is_some() => shaped(effect, shape, times),
        _ => {
            let next = |parameter| {
                let next = continued(&PLATFORM, parameter, &times.offset()).into_iter();
                next.map(|(target, factor)| (DesignColumn::Parameter(target), factor))
            };
            let parameters = effect.model_parameters();
            parameters
                .map(|parameter| SizeColumns {
                    first: vec![(DesignColumn::Parameter(parameter), 1.0)],
                    next: next(parameter).collect(),
                })
                .collect()
        }
    }
}

/// A change of the moving states, which belongs to its record.
fn states(effect: &'static Effect, shape: Option<f64>) -> Vec<SizeColumns> {
    (0..PLATFORM.moving_states)
        .map(|index| SizeColumns {
            first: vec![(signature_column(effect, shape, index), 1.0)],
            next: Vec::new(),
        })
        .collect()
}

/// A term with an onset or a time constant, continued as its table says.
fn shaped(effect: &'static Effect, shape: f64, times: &Times) -> Vec<SizeColumns> {
    let onset = matches!(effect.shape().map(|own| own.role), Some(Role::Onset(_)));
    let later = match effect.continuation {
        Continuation::ThisRecord => None,
        Continuation::GoesOn if onset => Some(shape - times.first_s),
        _ => Some(shape),
    };
    (0..effect.sizes().count())
        .map(|index| SizeColumns {
            first: vec![(signature_column(effect, Some(shape), index), 1.0)],
            next: later
                .map(|later| (signature_column(effect, Some(later), index), 1.0))
                .into_iter()
                .collect(),
        })
        .collect()
}

fn signature_column(effect: &'static Effect, shape: Option<f64>, index: usize) -> DesignColumn {
    DesignColumn::Signature {
        effect,
        shape,
        index,
    }
}

/// Increments at onsets: those of the record stay, the next run has its own. All have one
/// variance, so those of longer intervals count for more.
fn walk(rate: usize, times: &Times) -> Vec<SizeColumns> {
    let constant = DesignColumn::Parameter(RATES[rate].constant);
    let step = |onset_s: f64| DesignColumn::Step { rate, onset_s };
    let ratio = times.next_s / times.first_s;
    let onsets = times.onsets_s.iter();
    let of_record = onsets.clone().map(|onset_s| SizeColumns {
        first: vec![(step(*onset_s), 1.0)],
        next: vec![(constant.clone(), 1.0)],
    });
    let of_next = onsets.map(|onset_s| SizeColumns {
        first: Vec::new(),
        next: vec![(step(onset_s * ratio), ratio.sqrt())],
    });
    of_record.chain(of_next).collect()
}
