//! What an effect does in a record, and in the run after it.

use gyrocal::Effect;
use gyrocal::effect::EffectKind;
use gyrocal::generated::catalogue::RATES;

use super::piece::Piece;
use crate::continuation::{Phase, RecordOffset, continued};

/// A sum of pieces.
pub(crate) type Sum = Vec<(Piece, f64)>;

/// One unknown size of an effect: what a unit of it does in the record, and in the next run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Size {
    pub(crate) first: Sum,
    pub(crate) next: Sum,
}

/// When the runs are.
#[derive(Clone, Debug)]
pub(crate) struct Times {
    /// Duration of the record, s.
    pub(crate) first_s: f64,
    /// Duration of the next run, s.
    pub(crate) next_s: f64,
    /// Onsets that a random walk is made up from in the record, s.
    pub(crate) onsets_s: Vec<f64>,
}

/// The sizes of an effect; `shape` is its onset in s or time constant in h, if it has one.
pub(crate) fn sizes(row: &Effect, shape: Option<f64>, times: &Times) -> Vec<Size> {
    let same = |piece: Piece| Size {
        first: vec![(piece.clone(), 1.0)],
        next: vec![(piece, 1.0)],
    };
    let once = |piece: Piece| Size {
        first: vec![(piece, 1.0)],
        next: Vec::new(),
    };
    let constant = row.rate().map(|rate| RATES[rate].constant);
    match (row.kind, constant, shape) {
        (EffectKind::InitialState, ..) => (0..3).map(|axis| once(Piece::Start(axis))).collect(),
        (EffectKind::StateJump, ..) => {
            let onset_s = shape.unwrap_or(0.0);
            (0..3)
                .map(|axis| once(Piece::Jump { onset_s, axis }))
                .collect()
        }
        (EffectKind::RandomWalk, Some(parameter), _) => walk(parameter, times),
        (EffectKind::Step, Some(parameter), Some(onset_s)) => vec![Size {
            first: vec![(Piece::Onset { parameter, onset_s }, 1.0)],
            next: vec![(Piece::Parameter(parameter), 1.0)],
        }],
        (EffectKind::Exponential, Some(parameter), Some(time_constant_h)) => {
            vec![same(Piece::WarmUp {
                parameter,
                time_constant_h,
            })]
        }
        _ => {
            let next = |parameter| {
                let next = continued(parameter, &times.offset()).into_iter();
                next.map(|(target, factor)| (Piece::Parameter(target), factor))
            };
            let parameters = row.model_parameters();
            parameters
                .map(|parameter| Size {
                    first: vec![(Piece::Parameter(parameter), 1.0)],
                    next: next(parameter).collect(),
                })
                .collect()
        }
    }
}

impl Times {
    /// The next run follows the record at once, at the same time of day.
    pub(crate) fn offset(&self) -> RecordOffset {
        RecordOffset {
            elapsed_s: self.first_s,
            phase: Phase::Same,
            warmer_k: 0.0,
        }
    }
}

/// Increments at onsets: those of the record stay, the next run has its own. All have one
/// variance, so those of longer intervals count for more.
fn walk(parameter: usize, times: &Times) -> Vec<Size> {
    let mut sizes: Vec<Size> = times
        .onsets_s
        .iter()
        .map(|onset_s| Size {
            first: vec![(
                Piece::Onset {
                    parameter,
                    onset_s: *onset_s,
                },
                1.0,
            )],
            next: vec![(Piece::Parameter(parameter), 1.0)],
        })
        .collect();
    let ratio = times.next_s / times.first_s;
    sizes.extend(times.onsets_s.iter().map(|onset_s| Size {
        first: Vec::new(),
        next: vec![(
            Piece::Onset {
                parameter,
                onset_s: onset_s * ratio,
            },
            ratio.sqrt(),
        )],
    }));
    sizes
}
